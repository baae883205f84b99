//! The vehicle with an inner rate loop that is perfect: collective thrust and body rates are the controls.

use nalgebra::{RealField, SVector, Vector3};

use super::{Air, entries, quaternion_rate, thrust_direction};
use crate::frames::from_wxyz;
use crate::motion::{Motion, steady_rotor_thrusts};
use crate::vehicle::Vehicle;

/// `p' = v`, `v' = (T/m) z_b - g e_z - (c_d/2m) |v_air| v_air`, `q' = q (0, w)/2`; state (p, v, q), control (T, w).
///
/// The bounds that belong to it are the vehicle's least and greatest thrust (N) and its body rates (rad/s).
#[derive(Debug, Clone, PartialEq)]
pub struct ThrustRate {
    vehicle: Vehicle,
    pub(super) air: Air,
}

impl ThrustRate {
    /// Number of states.
    pub const N_STATES: usize = 10;
    /// Number of controls.
    pub const N_CONTROLS: usize = 4;

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

    /// Time derivative of the state. The quaternion may have any norm but zero.
    #[inline]
    #[must_use]
    pub fn derivative<T: RealField + Copy>(
        &self,
        state: &SVector<T, 10>,
        control: &SVector<T, 4>,
    ) -> SVector<T, 10> {
        let velocity: [T; 3] = entries(state, 3);
        let q: [T; 4] = entries(state, 6);
        let thrust = control[0] * nalgebra::convert(self.air.inverse_mass);
        let up = thrust_direction(q);
        let free = self.air.acceleration(velocity);
        let [qw, qx, qy, qz] = quaternion_rate(q, entries(control, 1));
        let [vx, vy, vz] = velocity;
        let [ax, ay, az] = [0, 1, 2].map(|i| free[i] + up[i] * thrust);
        SVector::from([vx, vy, vz, ax, ay, az, qw, qx, qy, qz])
    }

    /// Everything at one instant, as flown with these controls held.
    #[must_use]
    pub fn motion(&self, state: &SVector<f64, 10>, control: &SVector<f64, 4>) -> Motion {
        let rate = self.derivative(state, control);
        let velocity = Vector3::from(entries(state, 3));
        let acceleration = Vector3::from(entries(&rate, 3));
        let attitude = from_wxyz(state[6], state[7], state[8], state[9]);
        let body_rates = Vector3::from(entries(control, 1));
        let thrust = control[0];
        let turning = attitude * body_rates.cross(&Vector3::new(0.0, 0.0, thrust * self.air.inverse_mass));
        Motion {
            position: Vector3::from(entries(state, 0)),
            velocity,
            acceleration,
            jerk: turning + self.air.drag_rate(&velocity, &acceleration),
            attitude,
            body_rates,
            collective_thrust: thrust,
            rotor_thrusts: steady_rotor_thrusts(&self.vehicle, thrust, &body_rates),
        }
    }
}
