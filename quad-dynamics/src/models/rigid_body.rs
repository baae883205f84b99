//! The vehicle as a rigid body pushed by four rotors.

use nalgebra::{Matrix3, RealField, SVector, Vector3};

use super::{Air, entries, quaternion_rate, thrust_direction};
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
    vehicle: Vehicle,
    air: Air,
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
        Self { air: Air::new(vehicle), vehicle: vehicle.clone(), torque }
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
        let [wx, wy, wz] = self.angular_acceleration(rates, control);
        let [vx, vy, vz] = velocity;
        let [ax, ay, az] = [0, 1, 2].map(|i| free[i] + up[i] * thrust);
        SVector::from([vx, vy, vz, ax, ay, az, qw, qx, qy, qz, wx, wy, wz])
    }

    /// `J^-1 (tau - w x J w)`.
    #[inline]
    fn angular_acceleration<T: RealField + Copy>(
        &self,
        rates: [T; 3],
        rotor_thrusts: &SVector<T, 4>,
    ) -> [T; 3] {
        let [p, q, r] = rates;
        let [hx, hy, hz] = multiply(self.vehicle.inertia_tensor(), rates);
        let torque = self.torque.map(|row| {
            let [a, b, c, d] = row.map(nalgebra::convert::<f64, T>);
            a * rotor_thrusts[0] + b * rotor_thrusts[1] + c * rotor_thrusts[2] + d * rotor_thrusts[3]
        });
        let net =
            [torque[0] - (q * hz - r * hy), torque[1] - (r * hx - p * hz), torque[2] - (p * hy - q * hx)];
        multiply(self.vehicle.inverse_inertia_tensor(), net)
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

/// Matrix times vector; the matrix's numbers are constants.
#[inline]
fn multiply<T: RealField + Copy>(matrix: &Matrix3<f64>, vector: [T; 3]) -> [T; 3] {
    [0, 1, 2].map(|row| {
        let entry = |column: usize| nalgebra::convert::<f64, T>(matrix[(row, column)]) * vector[column];
        entry(0) + entry(1) + entry(2)
    })
}
