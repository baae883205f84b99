//! What an autopilot leaves of the commands it is given.

use crate::error::{Error, Field, Requirement};

/// Limits within which an autopilot shapes position targets: bounds for the jerk-limited model.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct ShapingLimits {
    /// Greatest horizontal speed, m/s.
    pub speed: f64,
    /// Greatest horizontal acceleration, m/s^2.
    pub acceleration: f64,
    /// Greatest horizontal jerk, m/s^3.
    pub jerk: f64,
    /// Greatest climb rate, m/s.
    pub climb_speed: f64,
    /// Greatest descent rate, m/s.
    pub descent_speed: f64,
    /// Greatest vertical acceleration, m/s^2.
    pub vertical_acceleration: f64,
    /// Greatest vertical jerk, m/s^3.
    pub vertical_jerk: f64,
}

impl ShapingLimits {
    /// ArduCopter 4.6 with its default parameters: `WPNAV_SPEED` 10 m/s, `WPNAV_ACCEL` 2.5 m/s^2, `PSC_JERK_XY`
    /// 5 m/s^3, `WPNAV_SPEED_UP` 2.5 m/s, `WPNAV_SPEED_DN` 1.5 m/s, `WPNAV_ACCEL_Z` 1 m/s^2, `PSC_JERK_Z` 5 m/s^3
    /// (ArduPilot's parameter reference; streamed guided setpoints pass the same limiter).
    #[must_use]
    pub fn arducopter() -> Self {
        Self {
            speed: 10.0,
            acceleration: 2.5,
            jerk: 5.0,
            climb_speed: 2.5,
            descent_speed: 1.5,
            vertical_acceleration: 1.0,
            vertical_jerk: 5.0,
        }
    }

    /// The same with another horizontal speed limit, m/s.
    #[must_use]
    pub fn with_speed(mut self, speed: f64) -> Self {
        self.speed = speed;
        self
    }

    /// The same with another horizontal acceleration limit, m/s^2.
    #[must_use]
    pub fn with_acceleration(mut self, acceleration: f64) -> Self {
        self.acceleration = acceleration;
        self
    }

    /// The same with another horizontal jerk limit, m/s^3.
    #[must_use]
    pub fn with_jerk(mut self, jerk: f64) -> Self {
        self.jerk = jerk;
        self
    }

    /// Checks that every limit is finite and positive.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] with the first that is not.
    pub fn check(&self) -> Result<(), Error> {
        let all = [
            self.speed,
            self.acceleration,
            self.jerk,
            self.climb_speed,
            self.descent_speed,
            self.vertical_acceleration,
            self.vertical_jerk,
        ];
        all.into_iter().try_for_each(|value| Requirement::Positive.check(Field::ShapingLimits, value))
    }
}
