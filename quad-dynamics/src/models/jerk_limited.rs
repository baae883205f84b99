//! What an autopilot's shaping leaves: a point with bounded speed, acceleration and jerk.

use nalgebra::{RealField, SVector, Vector3};

use super::{Air, entries};
use crate::frames::Heading;
use crate::motion::{Kinematics, Motion};
use crate::vehicle::Vehicle;

/// `p' = v`, `v' = a`, `a' = j`; state (p, v, a), control the jerk (m/s^3, world).
///
/// The bounds that belong to it are [`ShapingLimits`](crate::ShapingLimits). The vehicle and the wind only enter the
/// thrust and attitude that the motion implies.
#[derive(Debug, Clone, PartialEq)]
pub struct JerkLimited {
    vehicle: Vehicle,
    air: Air,
}

impl JerkLimited {
    /// Number of states.
    pub const N_STATES: usize = 9;
    /// Number of controls.
    pub const N_CONTROLS: usize = 3;

    /// The model of a vehicle in still air.
    #[must_use]
    pub fn new(vehicle: &Vehicle) -> Self {
        Self { air: Air::new(vehicle), vehicle: vehicle.clone() }
    }

    /// The same in a steady wind, m/s, world.
    #[must_use]
    pub fn with_wind(mut self, wind: Vector3<f64>) -> Self {
        self.air.wind = wind;
        self
    }

    /// Time derivative of the state.
    #[inline]
    #[must_use]
    pub fn derivative<T: RealField + Copy>(
        &self,
        state: &SVector<T, 9>,
        control: &SVector<T, 3>,
    ) -> SVector<T, 9> {
        SVector::from_fn(|row, _| if row < 6 { state[row + 3] } else { control[row - 6] })
    }

    /// The thrust force (N, world) that the state needs: `m (a + g e_z) + (c_d/2) |v_air| v_air`.
    #[inline]
    #[must_use]
    pub fn thrust_force<T: RealField + Copy>(&self, state: &SVector<T, 9>) -> SVector<T, 3> {
        let free = self.air.acceleration(entries(state, 3));
        let mass: T = nalgebra::convert(self.vehicle.mass());
        SVector::from_fn(|row, _| (state[6 + row] - free[row]) * mass)
    }

    /// Everything at one instant: the attitude is the one that the thrust implies.
    #[must_use]
    pub fn motion(&self, state: &SVector<f64, 9>, control: &SVector<f64, 3>, heading: Heading) -> Motion {
        let velocity = Vector3::from(entries(state, 3));
        let acceleration = Vector3::from(entries(state, 6));
        let drag_rate = self.air.drag_rate(&velocity, &acceleration);
        let kinematics = Kinematics {
            position: Vector3::from(entries(state, 0)),
            velocity,
            acceleration,
            jerk: *control,
            force: self.thrust_force(state),
            force_rate: (control - drag_rate) * self.vehicle.mass(),
        };
        Motion::from_kinematics(&self.vehicle, &kinematics, heading)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{GRAVITY, VehicleParameters};

    #[test]
    fn at_rest_the_thrust_is_the_weight() -> Result<(), crate::Error> {
        let vehicle = Vehicle::new(VehicleParameters::survey_450())?;
        let force = JerkLimited::new(&vehicle).thrust_force(&SVector::<f64, 9>::zeros());
        assert_eq!(force, Vector3::new(0.0, 0.0, 1.5 * GRAVITY));
        Ok(())
    }
}
