//! How a circle is flown: in still air or in a steady wind.

use crate::mission::Environment;
use nalgebra::Vector3;
use quad_dynamics::{Direction, Error, Limit, Loiter, LoiterSpec, Motion, Vehicle, WindyLoiter};

/// A loiter at constant ground speed, in either direction.
#[derive(Debug, Clone)]
pub(crate) enum Round {
    /// Thrust and body rates are constant.
    Still(Box<Loiter>),
    /// Thrust, attitude and body rates change round the circle.
    Windy { clockwise: Box<WindyLoiter>, counter_clockwise: Box<WindyLoiter>, sweep: f64 },
}

impl Round {
    /// The fastest within the limits, and in wind within them all the way round: equally fast in both directions, so that
    /// the time of a loiter does not depend on its entry.
    pub(crate) fn new(
        vehicle: &Vehicle,
        spec: &LoiterSpec,
        environment: &Environment,
    ) -> Result<Self, Error> {
        if !environment.is_windy() {
            return Loiter::new(vehicle, spec).map(|loiter| Self::Still(Box::new(loiter)));
        }
        let one = |direction| WindyLoiter::new(vehicle, spec, environment.air(), direction).map(Box::new);
        let (mut clockwise, mut counter_clockwise) =
            (one(Direction::Clockwise)?, one(Direction::CounterClockwise)?);
        // Limits hold from rest up to the speed found.
        let speed = clockwise.speed.min(counter_clockwise.speed);
        (clockwise.speed, counter_clockwise.speed) = (speed, speed);
        Ok(Self::Windy { clockwise, counter_clockwise, sweep: spec.sweep })
    }

    /// Ground speed (m/s).
    pub(crate) fn speed(&self) -> f64 {
        match self {
            Self::Still(loiter) => loiter.speed,
            Self::Windy { clockwise, .. } => clockwise.speed,
        }
    }

    /// What keeps the speed from being greater.
    pub(crate) fn limit(&self) -> Option<Limit> {
        match self {
            Self::Still(loiter) => loiter.limit,
            Self::Windy { clockwise, .. } => Some(clockwise.limit),
        }
    }

    fn radius(&self) -> f64 {
        match self {
            Self::Still(loiter) => loiter.radius,
            Self::Windy { clockwise, .. } => clockwise.radius,
        }
    }

    fn sweep(&self) -> f64 {
        match self {
            Self::Still(loiter) => loiter.sweep,
            Self::Windy { sweep, .. } => *sweep,
        }
    }

    /// The motion at an angle (rad), relative to the centre.
    pub(crate) fn state(&self, angle: f64, direction: Direction) -> Motion {
        match (self, direction) {
            (Self::Still(loiter), _) => loiter.state(angle, direction),
            (Self::Windy { clockwise, .. }, Direction::Clockwise) => clockwise.state(angle),
            (Self::Windy { counter_clockwise, .. }, _) => counter_clockwise.state(angle),
        }
    }

    /// Greatest collective thrust on the way round (N).
    pub(crate) fn thrust(&self) -> f64 {
        match self {
            Self::Still(loiter) => loiter.thrust,
            Self::Windy { clockwise, counter_clockwise, .. } => {
                clockwise.greatest_thrust().max(counter_clockwise.greatest_thrust())
            }
        }
    }

    /// Greatest magnitude of each body rate on the way round (rad/s).
    pub(crate) fn body_rates(&self) -> Vector3<f64> {
        match self {
            Self::Still(loiter) => loiter.state(0.0, Direction::CounterClockwise).body_rates.abs(),
            Self::Windy { clockwise, counter_clockwise, .. } => {
                clockwise.greatest_body_rates().sup(&counter_clockwise.greatest_body_rates())
            }
        }
    }

    /// Whether attitude and body rates are the same all the way round, but for the turn of the circle.
    pub(crate) fn is_even(&self) -> bool {
        matches!(self, Self::Still(_))
    }

    /// Angle (rad) at which a loiter entered at `angle` ends.
    pub(crate) fn exit_angle(&self, angle: f64, direction: Direction) -> f64 {
        angle + direction.sign() * self.sweep()
    }

    /// Around the target (rad/s).
    pub(crate) fn angular_speed(&self) -> f64 {
        self.speed() / self.radius()
    }

    /// Time of the sweep (s).
    pub(crate) fn duration(&self) -> f64 {
        self.sweep() / self.angular_speed()
    }

    /// No less energy (J) is used in the sweep; in wind only what the avionics take at `avionics` (W) is counted.
    pub(crate) fn least_energy(&self, avionics: f64) -> f64 {
        match self {
            Self::Still(loiter) => loiter.energy(),
            Self::Windy { .. } => avionics * self.duration(),
        }
    }

    /// Length of the sweep (m).
    pub(crate) fn length(&self) -> f64 {
        self.sweep() * self.radius()
    }
}
