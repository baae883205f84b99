//! What is asked of a loiter.

use crate::error::{Error, Field, Requirement};
use crate::vehicle::Vehicle;

/// Where body x points on the circle, as far as the thrust leaves it free.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum LoiterYaw {
    /// Along the tangent, projected orthogonally to the thrust.
    #[default]
    AlongTrack,
    /// At the target, projected orthogonally to the thrust.
    AtTarget,
}

/// What the camera tolerates, as a greatest angular speed around the target.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CameraLimit {
    /// Greatest angular speed around the target, rad/s.
    pub angular_speed: f64,
}

impl CameraLimit {
    /// At least `views` pictures per full circle at `frame_rate` pictures a second.
    #[must_use]
    pub fn from_frame_rate(frame_rate: f64, views: f64) -> Self {
        Self { angular_speed: std::f64::consts::TAU * frame_rate / views }
    }

    /// A surface of the target `target_radius` (m) from its centre smears over at most `blur` (m) in one `exposure` (s):
    /// against a camera that keeps facing the target it moves at `(v/r) target_radius`.
    #[must_use]
    pub fn from_blur(blur: f64, exposure: f64, target_radius: f64) -> Self {
        Self { angular_speed: blur / (exposure * target_radius) }
    }
}

/// What is asked of a loiter; [`Loiter::new`](crate::Loiter::new) answers with the fastest one.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LoiterSpec {
    /// Radius of the circle, m, above 1e-9 and at most 1e9.
    pub radius: f64,
    /// Fraction of the greatest thrust that may be used, in (0, 1]. Default 0.6: the rest is for control.
    pub thrust_budget: f64,
    /// Where body x points. Default along the track.
    pub yaw: LoiterYaw,
    /// Angle flown around the target, rad. Default one full circle.
    pub sweep: f64,
    /// Greatest speed, m/s. Default none.
    pub speed_limit: Option<f64>,
    /// Greatest bank `phi` (`tan(phi) = v^2/(r g)`), rad, below pi/2. Default none.
    pub bank_limit: Option<f64>,
    /// Greatest centripetal acceleration that the autopilot allows, m/s^2. Default none.
    pub acceleration_limit: Option<f64>,
    /// What the camera tolerates. Default anything.
    pub camera_limit: Option<CameraLimit>,
    /// Whether the vehicle's greatest body rates bind. Default yes.
    pub body_rate_limits: bool,
    /// Whether the least and greatest thrust of each rotor bind. Default yes.
    pub rotor_limits: bool,
}

impl LoiterSpec {
    /// Fraction of the greatest thrust used where nothing is said.
    pub const DEFAULT_THRUST_BUDGET: f64 = 0.6;

    /// One full circle of this radius (m) with default options.
    #[must_use]
    pub fn new(radius: f64) -> Self {
        Self {
            radius,
            thrust_budget: Self::DEFAULT_THRUST_BUDGET,
            yaw: LoiterYaw::AlongTrack,
            sweep: std::f64::consts::TAU,
            speed_limit: None,
            bank_limit: None,
            acceleration_limit: None,
            camera_limit: None,
            body_rate_limits: true,
            rotor_limits: true,
        }
    }

    /// The same with another thrust budget, a fraction of the greatest thrust.
    #[must_use]
    pub fn with_thrust_budget(mut self, thrust_budget: f64) -> Self {
        self.thrust_budget = thrust_budget;
        self
    }

    /// The same with body x pointing elsewhere.
    #[must_use]
    pub fn with_yaw(mut self, yaw: LoiterYaw) -> Self {
        self.yaw = yaw;
        self
    }

    /// The same with another sweep, rad.
    #[must_use]
    pub fn with_sweep(mut self, sweep: f64) -> Self {
        self.sweep = sweep;
        self
    }

    /// The same with a speed limit, m/s.
    #[must_use]
    pub fn with_speed_limit(mut self, speed_limit: f64) -> Self {
        self.speed_limit = Some(speed_limit);
        self
    }

    /// The same with a bank limit, rad.
    #[must_use]
    pub fn with_bank_limit(mut self, bank_limit: f64) -> Self {
        self.bank_limit = Some(bank_limit);
        self
    }

    /// The same with an acceleration limit, m/s^2.
    #[must_use]
    pub fn with_acceleration_limit(mut self, acceleration_limit: f64) -> Self {
        self.acceleration_limit = Some(acceleration_limit);
        self
    }

    /// The same with a camera limit.
    #[must_use]
    pub fn with_camera_limit(mut self, camera_limit: CameraLimit) -> Self {
        self.camera_limit = Some(camera_limit);
        self
    }

    /// The same with the vehicle's body-rate limits heeded or not.
    #[must_use]
    pub fn with_body_rate_limits(mut self, heeded: bool) -> Self {
        self.body_rate_limits = heeded;
        self
    }

    /// The same with the rotors' limits heeded or not.
    #[must_use]
    pub fn with_rotor_limits(mut self, heeded: bool) -> Self {
        self.rotor_limits = heeded;
        self
    }

    /// Everything that is wrong with this specification for this vehicle; empty if [`Loiter::new`](crate::Loiter::new)
    /// accepts it.
    #[must_use]
    pub fn problems(&self, vehicle: &Vehicle) -> Vec<Error> {
        self.checks(vehicle).filter_map(Result::err).collect()
    }

    pub(super) fn check(&self, vehicle: &Vehicle) -> Result<(), Error> {
        self.checks(vehicle).collect()
    }

    fn checks(&self, vehicle: &Vehicle) -> impl Iterator<Item = Result<(), Error>> {
        use Requirement::{Positive, Within};
        let quarter = std::f64::consts::FRAC_PI_2;
        // Beyond these radii the square of a length or of a speed leaves the numbers.
        let radius = Within { low: 1e-9, high: 1e9 };
        let camera = self.camera_limit.map(|camera| camera.angular_speed);
        let given = [
            Some((Field::Radius, self.radius, radius)),
            Some((Field::ThrustBudget, self.thrust_budget, Within { low: 0.0, high: 1.0 })),
            Some((Field::Sweep, self.sweep, Positive)),
            self.speed_limit.map(|limit| (Field::SpeedLimit, limit, Positive)),
            self.bank_limit
                .map(|limit| (Field::BankLimit, limit, Requirement::Between { low: 0.0, high: quarter })),
            self.acceleration_limit.map(|limit| (Field::AccelerationLimit, limit, Positive)),
            camera.map(|limit| (Field::CameraLimit, limit, Positive)),
        ];
        let ranges =
            given.into_iter().flatten().map(|(field, value, requirement)| requirement.check(field, value));
        ranges.chain(std::iter::once(self.check_budget(vehicle)))
    }

    fn check_budget(&self, vehicle: &Vehicle) -> Result<(), Error> {
        let (weight, thrust) = (vehicle.weight(), self.thrust_budget * vehicle.max_thrust());
        let thrust_budget = self.thrust_budget;
        let too_small = thrust_budget > 0.0 && thrust <= weight;
        let least_budget = weight / vehicle.max_thrust();
        if too_small {
            Err(Error::BudgetBelowWeight { thrust_budget, thrust, weight, least_budget })
        } else {
            Ok(())
        }
    }
}
