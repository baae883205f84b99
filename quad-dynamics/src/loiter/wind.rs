//! A circle over the ground in a steady wind.

use nalgebra::Vector3;

use super::limits::first_violation;
use super::{LoiterSpec, LoiterYaw};
use crate::error::Error;
use crate::frames::{Direction, GRAVITY, Heading};
use crate::loiter::Limit;
use crate::models::Air;
use crate::motion::{Kinematics, Motion};
use crate::vehicle::Vehicle;

/// A circle flown at constant height and ground speed in a steady wind.
///
/// Unlike in still air thrust, attitude and body rates change round the circle: the drag does.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct WindyLoiter {
    /// Radius, m.
    pub radius: f64,
    /// Ground speed, m/s.
    pub speed: f64,
    /// What keeps the ground speed from being greater, somewhere on the circle.
    pub limit: Limit,
    /// Steady wind, m/s, world.
    pub wind: Vector3<f64>,
    /// Direction in which it is flown.
    pub direction: Direction,
    yaw: LoiterYaw,
    vehicle: Vehicle,
}

/// Angles round the circle at which limits are looked at: thrust is a smooth function of few harmonics of the angle, and
/// between two angles half a degree apart it rises by less than 1e-4 of its range.
const N_ANGLES: usize = 360;
/// Angles at which speeds are scanned before all are looked at.
const N_SCANNED: usize = 24;

impl WindyLoiter {
    /// The fastest constant ground speed for which thrust budget, body rates and rotors hold all the way round, and the
    /// specification's other limits too (speed limit: ground speed).
    ///
    /// # Errors
    /// As [`Loiter::new`](crate::Loiter::new), and [`Error::WindTooStrong`] if not even hovering in this wind stays in the
    /// thrust budget.
    ///
    /// # Complexity
    /// About a millisecond: 24 angles at some hundred speeds, 360 at some fifty. Does not allocate.
    pub fn new(
        vehicle: &Vehicle,
        spec: &LoiterSpec,
        wind: Vector3<f64>,
        direction: Direction,
    ) -> Result<Self, Error> {
        spec.check(vehicle)?;
        let budget = spec.thrust_budget * vehicle.max_thrust();
        let circle = |speed: f64| Self {
            radius: spec.radius,
            speed,
            limit: Limit::Thrust,
            wind,
            direction,
            yaw: spec.yaw,
            vehicle: vehicle.clone(),
        };
        let hover = (Vector3::new(0.0, 0.0, vehicle.weight()) + vehicle.drag(&wind)).norm();
        if hover.is_nan() || hover >= budget {
            return Err(Error::WindTooStrong { wind: wind.norm(), thrust: hover, budget });
        }
        // Where a level wind blows against the track more thrust is needed than in still air; the margin is for updraughts.
        let still = super::limits::thrust_limited_speed(vehicle, spec.radius, budget);
        let top = super::limits::closed_form_speed(spec, 1.5 * still + wind.norm());
        let mut probe = circle(0.0);
        let mut violated = |speed: f64, n_angles: usize| {
            probe.speed = speed;
            probe.round(n_angles).find_map(|motion| super::limits::violated(vehicle, spec, &motion, budget))
        };
        let scanned = first_violation(top.1, |speed| violated(speed, N_SCANNED)).unwrap_or(top);
        // What the angles in between take away is little, and all that is left to find.
        let (limit, speed) = match violated(scanned.1, N_ANGLES) {
            None => scanned,
            Some(_) => first_violation(scanned.1, |speed| {
                let n_angles = if speed < 0.9 * scanned.1 { N_SCANNED } else { N_ANGLES };
                violated(speed, n_angles)
            })
            .unwrap_or(scanned),
        };
        Ok(Self { limit, ..circle(speed) })
    }

    /// The vehicle at so many equally spaced angles round the circle.
    fn round(&self, n_angles: usize) -> impl Iterator<Item = Motion> {
        let step = std::f64::consts::TAU / n_angles as f64;
        (0..n_angles).map(move |i| self.state(i as f64 * step))
    }

    /// Greatest collective thrust round the circle, N.
    #[must_use]
    pub fn greatest_thrust(&self) -> f64 {
        self.round(N_ANGLES).map(|motion| motion.collective_thrust).fold(0.0, f64::max)
    }

    /// Greatest magnitude of each body rate round the circle, rad/s.
    #[must_use]
    pub fn greatest_body_rates(&self) -> Vector3<f64> {
        self.round(N_ANGLES).fold(Vector3::zeros(), |most, motion| most.sup(&motion.body_rates.abs()))
    }

    /// The vehicle at `angle` (rad from east, around the centre); the position is relative to the centre.
    #[must_use]
    pub fn state(&self, angle: f64) -> Motion {
        let outward = Vector3::new(angle.cos(), angle.sin(), 0.0);
        let turn = self.direction.sign() * self.speed / self.radius;
        let velocity = Vector3::new(-outward.y, outward.x, 0.0) * (self.direction.sign() * self.speed);
        let acceleration = -outward * (self.speed * self.speed / self.radius);
        let jerk = Vector3::new(-acceleration.y, acceleration.x, 0.0) * turn;
        let mass = self.vehicle.mass();
        let drag = self.vehicle.drag(&(velocity - self.wind));
        let mut air = Air::new(&self.vehicle);
        air.wind = self.wind;
        let kinematics = Kinematics {
            position: outward * self.radius,
            velocity,
            acceleration,
            jerk,
            force: (acceleration + Vector3::new(0.0, 0.0, GRAVITY)) * mass - drag,
            force_rate: (jerk - air.drag_rate(&velocity, &acceleration)) * mass,
        };
        let heading = match self.yaw {
            LoiterYaw::AlongTrack => Heading::AlongTrack,
            LoiterYaw::AtTarget => Heading::Towards(Vector3::zeros()),
        };
        Motion::from_kinematics(&self.vehicle, &kinematics, heading)
    }

    /// Angular speed around the target, rad/s.
    #[must_use]
    pub fn angular_speed(&self) -> f64 {
        self.speed / self.radius
    }

    /// Time of one full circle, s.
    #[must_use]
    pub fn period(&self) -> f64 {
        std::f64::consts::TAU / self.angular_speed()
    }
}
