//! The vehicle as a point that thrust can push in any direction at once.

use nalgebra::{RealField, SVector, Vector3};

use super::{Air, entries};
use crate::frames::Heading;
use crate::motion::{Kinematics, Motion};
use crate::vehicle::Vehicle;

/// `p' = v`, `v' = F/m - g e_z - (c_d/2m) |v_air| v_air`; state (p, v), control the thrust force `F` (N, world).
///
/// The bound that belongs to it is `|F| <= T_max`.
#[derive(Debug, Clone, PartialEq)]
pub struct PointMass {
    vehicle: Vehicle,
    pub(super) air: Air,
}

impl PointMass {
    /// Number of states.
    pub const N_STATES: usize = 6;
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
        state: &SVector<T, 6>,
        control: &SVector<T, 3>,
    ) -> SVector<T, 6> {
        let velocity: [T; 3] = entries(state, 3);
        let free = self.air.acceleration(velocity);
        let inverse_mass: T = nalgebra::convert(self.air.inverse_mass);
        let [vx, vy, vz] = velocity;
        let [ax, ay, az] = [0, 1, 2].map(|i| free[i] + control[i] * inverse_mass);
        SVector::from([vx, vy, vz, ax, ay, az])
    }

    /// Everything at one instant, as flown with this force held: the attitude is the one that the force implies.
    #[must_use]
    pub fn motion(&self, state: &SVector<f64, 6>, control: &SVector<f64, 3>, heading: Heading) -> Motion {
        let rate = self.derivative(state, control);
        let velocity = Vector3::from(entries(state, 3));
        let acceleration = Vector3::from(entries(&rate, 3));
        let kinematics = Kinematics {
            position: Vector3::from(entries(state, 0)),
            velocity,
            acceleration,
            jerk: self.air.drag_rate(&velocity, &acceleration),
            force: *control,
            force_rate: Vector3::zeros(),
        };
        Motion::from_kinematics(&self.vehicle, &kinematics, heading)
    }
}
