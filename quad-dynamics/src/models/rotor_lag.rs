//! The rigid body with rotors that take time to change speed, and with drag on body axes and rotors: for simulation.

use nalgebra::{RealField, SVector, Vector3};

use super::{Air, angular_acceleration, entries, quaternion_rate, rotation};
use crate::frames::GRAVITY;
use crate::vehicle::Vehicle;

/// The rigid body with four more states: rotor speeds `s` (rad/s) that follow their commands, `s' = (command - s)/tau`.
///
/// State (p, v, q, w, s), control the commanded rotor speeds (rad/s). Rotor `i` at `r_i` gives the thrust `k s_i^2` and the
/// yaw torque of its spin, and with its own air velocity `u_i = R^T v_air + w x r_i` the rotor drag `-s_i K u_i` at its
/// hub. The body adds `-(c_d + C)/2 |v_air| v_air` in body axes. `k`, `tau`, `K` and `C` are the vehicle's
/// [`Propulsion`](crate::Propulsion) and [`Aerodynamics`](crate::Aerodynamics).
#[derive(Debug, Clone, PartialEq)]
pub struct RotorLag {
    vehicle: Vehicle,
    air: Air,
    thrust_coefficient: f64,
}

impl RotorLag {
    /// Number of states.
    pub const N_STATES: usize = 17;
    /// Number of controls.
    pub const N_CONTROLS: usize = 4;

    /// The model of a vehicle in still air.
    #[must_use]
    pub fn new(vehicle: &Vehicle) -> Self {
        let thrust_coefficient = vehicle.thrust_coefficient();
        Self { air: Air::new(vehicle), vehicle: vehicle.clone(), thrust_coefficient }
    }

    /// The same in a wind that is steady over a step, m/s, world.
    #[must_use]
    pub fn with_wind(mut self, wind: Vector3<f64>) -> Self {
        self.air.wind = wind;
        self
    }

    /// Changes the wind, m/s, world.
    pub fn set_wind(&mut self, wind: Vector3<f64>) {
        self.air.wind = wind;
    }

    /// Time derivative of the state. The quaternion may have any norm but zero.
    #[inline]
    #[must_use]
    pub fn derivative<T: RealField + Copy>(
        &self,
        state: &SVector<T, 17>,
        control: &SVector<T, 4>,
    ) -> SVector<T, 17> {
        let velocity: [T; 3] = entries(state, 3);
        let q: [T; 4] = entries(state, 6);
        let rates: [T; 3] = entries(state, 10);
        let speeds: [T; 4] = entries(state, 13);
        let columns = rotation(q);
        let wind = &self.air.wind;
        let air = [0, 1, 2].map(|i| velocity[i] - nalgebra::convert(wind[i]));
        let body_air = columns.map(|axis| axis[0] * air[0] + axis[1] * air[1] + axis[2] * air[2]);
        let (force, torque) = self.force_and_torque(body_air, rates, speeds);
        let inverse_mass: T = nalgebra::convert(self.air.inverse_mass);
        let gravity = [T::zero(), T::zero(), nalgebra::convert(GRAVITY)];
        let world =
            [0, 1, 2].map(|i| columns[0][i] * force[0] + columns[1][i] * force[1] + columns[2][i] * force[2]);
        let [ax, ay, az] = [0, 1, 2].map(|i| world[i] * inverse_mass - gravity[i]);
        let [qw, qx, qy, qz] = quaternion_rate(q, rates);
        let [wx, wy, wz] = angular_acceleration(&self.vehicle, rates, torque);
        let inverse_lag: T = nalgebra::convert(self.vehicle.parameters().propulsion.time_constant.recip());
        let [s0, s1, s2, s3] = [0, 1, 2, 3].map(|i| (control[i] - speeds[i]) * inverse_lag);
        let [vx, vy, vz] = velocity;
        SVector::from([vx, vy, vz, ax, ay, az, qw, qx, qy, qz, wx, wy, wz, s0, s1, s2, s3])
    }

    /// Force and torque on the body without weight, body axes, N and N m.
    #[inline]
    fn force_and_torque<T: RealField + Copy>(
        &self,
        air: [T; 3],
        rates: [T; 3],
        speeds: [T; 4],
    ) -> ([T; 3], [T; 3]) {
        let aerodynamics = &self.vehicle.parameters().aerodynamics;
        let squared = air[0] * air[0] + air[1] * air[1] + air[2] * air[2];
        let air_speed = if squared > T::zero() { squared.sqrt() } else { T::zero() };
        let half_drag = aerodynamics.body_drag.map(|c| -0.5 * (c + self.vehicle.drag_coefficient()));
        let mut force = [0, 1, 2].map(|i| air_speed * air[i] * nalgebra::convert(half_drag[i]));
        let mut torque = [T::zero(); 3];
        let yaw: T = nalgebra::convert(self.vehicle.torque_to_thrust());
        for (rotor, speed) in self.vehicle.rotors().iter().zip(speeds) {
            let [x, y] = rotor.position.map(nalgebra::convert::<f64, T>);
            // w x r for r = (x, y, 0)
            let hub = [air[0] - rates[2] * y, air[1] + rates[2] * x, air[2] + rates[0] * y - rates[1] * x];
            let drag = [0, 1, 2].map(|i| speed * hub[i] * nalgebra::convert(-aerodynamics.rotor_drag[i]));
            let thrust = speed * speed * nalgebra::convert(self.thrust_coefficient);
            let up = thrust + drag[2];
            force = [force[0] + drag[0], force[1] + drag[1], force[2] + up];
            let reaction = thrust * yaw * nalgebra::convert(rotor.spin.yaw_sign());
            torque =
                [torque[0] + y * up, torque[1] - x * up, torque[2] + x * drag[1] - y * drag[0] + reaction];
        }
        (force, torque)
    }
}
