//! The vehicle as a rigid body pushed by four rotors.

use nalgebra::{Matrix3x4, RealField, SVector, Vector3};

use super::{Air, angular_acceleration, entries, quaternion_rate, thrust_direction};
use crate::frames::from_wxyz;
use crate::motion::Motion;
use crate::vehicle::Vehicle;

/// `p' = v`, `v' = (T/m) z_b - g e_z - (c_d/2m) |v_air| v_air`, `q' = q (0, w)/2`, `w' = J^-1 (tau - w x J w)`; state
/// (p, v, q, w), control the four rotor thrusts (N).
///
/// Thrust and torque come from the rotors by the [`Mixer`](crate::Mixer)'s map. The bounds that belong to it are the
/// least and greatest thrust of a rotor, and body rates as bounds on states.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidBody {
    pub(super) vehicle: Vehicle,
    pub(super) air: Air,
    /// Angular acceleration per newton of each rotor, rad/s^2/N.
    pub(super) spin_by_rotor: Matrix3x4<f64>,
    /// Rows: roll, pitch and yaw torque per newton of each rotor, m.
    torque: [[f64; 4]; 3],
}

impl RigidBody {
    /// Number of states.
    pub const N_STATES: usize = 13;
    /// Number of controls.
    pub const N_CONTROLS: usize = 4;

    /// The model of a vehicle in still air.
    #[must_use]
    pub fn new(vehicle: &Vehicle) -> Self {
        let unit = |i: usize| vehicle.mixer().thrust_and_torque(&SVector::ith(i, 1.0)).1;
        let columns: [Vector3<f64>; 4] = std::array::from_fn(unit);
        let torque = std::array::from_fn(|row| std::array::from_fn(|rotor| columns[rotor][row]));
        let spin_by_rotor = vehicle.inverse_inertia_tensor() * Matrix3x4::from_columns(&columns);
        Self { air: Air::new(vehicle), vehicle: vehicle.clone(), spin_by_rotor, torque }
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
        state: &SVector<T, 13>,
        control: &SVector<T, 4>,
    ) -> SVector<T, 13> {
        let velocity: [T; 3] = entries(state, 3);
        let q: [T; 4] = entries(state, 6);
        let rates: [T; 3] = entries(state, 10);
        let thrust =
            (control[0] + control[1] + control[2] + control[3]) * nalgebra::convert(self.air.inverse_mass);
        let up = thrust_direction(q);
        let free = self.air.acceleration(velocity);
        let [qw, qx, qy, qz] = quaternion_rate(q, rates);
        let [wx, wy, wz] = angular_acceleration(&self.vehicle, rates, self.torque(control));
        let [vx, vy, vz] = velocity;
        let [ax, ay, az] = [0, 1, 2].map(|i| free[i] + up[i] * thrust);
        SVector::from([vx, vy, vz, ax, ay, az, qw, qx, qy, qz, wx, wy, wz])
    }

    /// Roll, pitch and yaw torque of rotor thrusts, N m.
    #[inline]
    fn torque<T: RealField + Copy>(&self, rotor_thrusts: &SVector<T, 4>) -> [T; 3] {
        self.torque.map(|row| {
            let [a, b, c, d] = row.map(nalgebra::convert::<f64, T>);
            a * rotor_thrusts[0] + b * rotor_thrusts[1] + c * rotor_thrusts[2] + d * rotor_thrusts[3]
        })
    }

    /// Everything at one instant, as flown with these rotor thrusts held.
    #[must_use]
    pub fn motion(&self, state: &SVector<f64, 13>, control: &SVector<f64, 4>) -> Motion {
        let rate = self.derivative(state, control);
        let velocity = Vector3::from(entries(state, 3));
        let acceleration = Vector3::from(entries(&rate, 3));
        let attitude = from_wxyz(state[6], state[7], state[8], state[9]);
        let body_rates = Vector3::from(entries(state, 10));
        let thrust = control.sum();
        let turning = attitude * body_rates.cross(&Vector3::new(0.0, 0.0, thrust * self.air.inverse_mass));
        Motion {
            position: Vector3::from(entries(state, 0)),
            velocity,
            acceleration,
            jerk: turning + self.air.drag_rate(&velocity, &acceleration),
            attitude,
            body_rates,
            collective_thrust: thrust,
            rotor_thrusts: *control,
        }
    }
}
