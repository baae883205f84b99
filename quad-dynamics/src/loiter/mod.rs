//! Circling a target: how fast, in which attitude, and what says so.

mod circle;
mod limits;
mod radius;
mod spec;
mod wind;

pub use crate::frames::Direction;
pub use limits::{Limit, loiter_speed};
pub use spec::{CameraLimit, LoiterSpec, LoiterYaw};
pub use wind::WindyLoiter;

use crate::error::{Error, Field, Requirement};
use crate::motion::Motion;
use crate::vehicle::Vehicle;

/// A circle flown at constant height and speed around a target, in still air.
///
/// Thrust carries weight, centripetal force and drag, which are perpendicular to each other:
/// `T^2 = (m g)^2 + (m v^2/r)^2 + (c_d v^2/2)^2` (Gao, Mandal and Bhattacharya 2020, eq. 6). The attitude turns at
/// `v/r` about the vertical, so thrust, body rates and rotor thrusts are constant along the circle.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Loiter {
    /// Radius, m.
    pub radius: f64,
    /// Speed, m/s.
    pub speed: f64,
    /// What keeps the speed from being greater; `None` if the speed was chosen below every limit.
    pub limit: Option<Limit>,
    /// Angle flown around the target, rad.
    pub sweep: f64,
    /// Collective thrust, N.
    pub thrust: f64,
    /// Bank `phi`, rad: `tan(phi) = v^2/(r g)`.
    pub bank: f64,
    /// Pitch `theta` into the drag, rad: `sin(theta) = D/T`.
    pub pitch: f64,
    /// Where body x points.
    pub yaw: LoiterYaw,
    pub(crate) vehicle: Vehicle,
}

impl Loiter {
    /// The fastest loiter that the vehicle and the specification allow.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a number that means nothing, [`Error::BudgetBelowWeight`] if the thrust budget does not
    /// carry the weight.
    ///
    /// # Complexity
    /// Some microseconds: closed forms, and a scan with bisection for body-rate and rotor limits. Does not allocate.
    pub fn new(vehicle: &Vehicle, spec: &LoiterSpec) -> Result<Self, Error> {
        spec.check(vehicle)?;
        let (limit, speed) = limits::greatest_speed(vehicle, spec);
        Ok(Self::build(vehicle, spec, speed, Some(limit)))
    }

    /// The loiter at a wanted speed (m/s) within the same limits.
    ///
    /// # Errors
    /// As [`Loiter::new`], and [`Error::SpeedAboveLimit`] if a limit forbids the speed.
    pub fn at_speed(vehicle: &Vehicle, spec: &LoiterSpec, speed: f64) -> Result<Self, Error> {
        Requirement::Positive.check(Field::Speed, speed)?;
        let fastest = Self::new(vehicle, spec)?;
        match fastest.limit {
            Some(limit) if speed > fastest.speed => {
                Err(Error::SpeedAboveLimit { speed, allowed: fastest.speed, limit })
            }
            _ => Ok(Self::build(vehicle, spec, speed, None)),
        }
    }

    fn build(vehicle: &Vehicle, spec: &LoiterSpec, speed: f64, limit: Option<Limit>) -> Self {
        let motion = circle::motion(vehicle, spec.radius, speed, spec.yaw, 0.0, Direction::CounterClockwise);
        let centripetal = vehicle.mass() * speed * speed / spec.radius;
        let drag = 0.5 * vehicle.drag_coefficient() * speed * speed;
        Self {
            radius: spec.radius,
            speed,
            limit,
            sweep: spec.sweep,
            thrust: motion.collective_thrust,
            bank: centripetal.atan2(vehicle.weight()),
            pitch: drag.atan2(vehicle.weight().hypot(centripetal)),
            yaw: spec.yaw,
            vehicle: vehicle.clone(),
        }
    }

    /// The vehicle at `angle` (rad from east, around the centre), flying in `direction`; positions are relative to the
    /// centre ([`Motion::translated`] puts it there).
    #[must_use]
    pub fn state(&self, angle: f64, direction: Direction) -> Motion {
        circle::motion(&self.vehicle, self.radius, self.speed, self.yaw, angle, direction)
    }

    /// Angle on the circle at which a loiter entered at `angle` ends: a sweep further on.
    #[must_use]
    pub fn exit_angle(&self, angle: f64, direction: Direction) -> f64 {
        angle + direction.sign() * self.sweep
    }

    /// The state in which a loiter entered at `angle` ends.
    #[must_use]
    pub fn exit_state(&self, angle: f64, direction: Direction) -> Motion {
        self.state(self.exit_angle(angle, direction), direction)
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

    /// Time of the sweep, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.sweep / self.angular_speed()
    }

    /// Length of the sweep, m.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.sweep * self.radius
    }

    /// Angle between thrust and vertical, rad.
    #[must_use]
    pub fn tilt(&self) -> f64 {
        (self.vehicle.weight() / self.thrust).min(1.0).acos()
    }
}
