//! Everything about a vehicle at one instant.

use nalgebra::{SVector, UnitQuaternion, Vector3, Vector4};

use crate::frames::{Heading, from_axes, project_heading, to_wxyz};
use crate::vehicle::Vehicle;

/// A vehicle at one instant, with the state vector and control of every model.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Motion {
    /// Position, m, world.
    pub position: Vector3<f64>,
    /// Velocity, m/s, world.
    pub velocity: Vector3<f64>,
    /// Acceleration, m/s^2, world.
    pub acceleration: Vector3<f64>,
    /// Jerk, m/s^3, world.
    pub jerk: Vector3<f64>,
    /// Attitude, body to world.
    pub attitude: UnitQuaternion<f64>,
    /// Body rates, rad/s, body axes.
    pub body_rates: Vector3<f64>,
    /// Collective thrust, N, along body z.
    pub collective_thrust: f64,
    /// Rotor thrusts, N, that give this thrust and hold these body rates (torque `w x J w`).
    pub rotor_thrusts: Vector4<f64>,
}

/// A motion of the centre of mass and the thrust force that causes it.
pub(crate) struct Kinematics {
    pub position: Vector3<f64>,
    pub velocity: Vector3<f64>,
    pub acceleration: Vector3<f64>,
    pub jerk: Vector3<f64>,
    /// Thrust force, N, world, and its time derivative, N/s.
    pub force: Vector3<f64>,
    pub force_rate: Vector3<f64>,
}

impl Motion {
    /// Hovering at `position` (m) with body x at `yaw` (rad from east), in still air.
    #[must_use]
    pub fn hover(vehicle: &Vehicle, position: Vector3<f64>, yaw: f64) -> Self {
        Self::hover_in_wind(vehicle, position, yaw, Vector3::zeros())
    }

    /// Hovering at `position` (m) in a steady `wind` (m/s, world) with body x at `yaw` (rad from east), leaning into the wind:
    /// the thrust is `m g e_z - (c_d/2) |wind| wind`.
    #[must_use]
    pub fn hover_in_wind(vehicle: &Vehicle, position: Vector3<f64>, yaw: f64, wind: Vector3<f64>) -> Self {
        let zero = Vector3::zeros();
        let kinematics = Kinematics {
            position,
            velocity: zero,
            acceleration: zero,
            jerk: zero,
            force: Vector3::new(0.0, 0.0, vehicle.weight()) - vehicle.drag(&-wind),
            force_rate: zero,
        };
        Self::from_kinematics(vehicle, &kinematics, Heading::Yaw(yaw))
    }

    /// The attitude that a thrust force implies, and the body rates that its change and the heading's imply.
    ///
    /// With `z = F/|F|`, heading `h` and `u = h - (h.z) z`: `x = u/|u|`, `y = z x x`, and the rates are
    /// `(-y.z', x.z', (y.h' - (h.z)(y.z'))/|u|)`. No force at all leaves body z up.
    pub(crate) fn from_kinematics(vehicle: &Vehicle, k: &Kinematics, heading: Heading) -> Self {
        let thrust = k.force.norm();
        let has_thrust = thrust > f64::MIN_POSITIVE && thrust.is_finite();
        let z = if has_thrust { k.force / thrust } else { Vector3::z() };
        let z_rate =
            if has_thrust { (k.force_rate - z * z.dot(&k.force_rate)) / thrust } else { Vector3::zeros() };
        let [wanted, wanted_rate] = heading.direction(&k.position, &k.velocity, &k.acceleration);
        let fixed = |axis| move || Some((axis, Vector3::zeros()));
        let (x, length, h, h_rate) = Some((wanted, wanted_rate))
            .into_iter()
            .chain(fixed(Vector3::x())())
            .chain(fixed(Vector3::y())())
            .find_map(|(h, rate)| project_heading(&z, &h).map(|(x, length)| (x, length, h, rate)))
            .unwrap_or((Vector3::x(), 1.0, Vector3::x(), Vector3::zeros()));
        let y = z.cross(&x);
        let yaw_rate = (y.dot(&h_rate) - h.dot(&z) * y.dot(&z_rate)) / length;
        let body_rates = Vector3::new(-y.dot(&z_rate), x.dot(&z_rate), yaw_rate);
        Self {
            position: k.position,
            velocity: k.velocity,
            acceleration: k.acceleration,
            jerk: k.jerk,
            attitude: from_axes(x, y, z),
            body_rates,
            collective_thrust: thrust,
            rotor_thrusts: steady_rotor_thrusts(vehicle, thrust, &body_rates),
        }
    }

    /// The same motion with its position moved by `offset` (m): a loiter state put on its centre.
    #[must_use]
    pub fn translated(mut self, offset: &Vector3<f64>) -> Self {
        self.position += offset;
        self
    }

    /// Angle between the thrust and the vertical, rad, in [0, pi].
    #[must_use]
    pub fn tilt(&self) -> f64 {
        let up = self.attitude * Vector3::z();
        up.xy().norm().atan2(up.z)
    }

    /// Thrust force, N, world axes.
    #[must_use]
    pub fn thrust_force(&self) -> Vector3<f64> {
        self.attitude * Vector3::new(0.0, 0.0, self.collective_thrust)
    }

    /// State of [`PointMass`](crate::PointMass): p, v.
    #[must_use]
    pub fn point_mass_state(&self) -> SVector<f64, 6> {
        stack(&[self.position.as_slice(), self.velocity.as_slice()])
    }

    /// Control of [`PointMass`](crate::PointMass): the thrust force, N.
    #[must_use]
    pub fn point_mass_control(&self) -> SVector<f64, 3> {
        self.thrust_force()
    }

    /// State of [`JerkLimited`](crate::JerkLimited): p, v, a. The control is [`jerk`](Self::jerk).
    #[must_use]
    pub fn jerk_limited_state(&self) -> SVector<f64, 9> {
        stack(&[self.position.as_slice(), self.velocity.as_slice(), self.acceleration.as_slice()])
    }

    /// State of [`ThrustRate`](crate::ThrustRate): p, v, q.
    #[must_use]
    pub fn thrust_rate_state(&self) -> SVector<f64, 10> {
        stack(&[self.position.as_slice(), self.velocity.as_slice(), to_wxyz(&self.attitude).as_slice()])
    }

    /// Control of [`ThrustRate`](crate::ThrustRate): collective thrust (N), body rates (rad/s).
    #[must_use]
    pub fn thrust_rate_control(&self) -> SVector<f64, 4> {
        stack(&[&[self.collective_thrust], self.body_rates.as_slice()])
    }

    /// State of [`RigidBody`](crate::RigidBody): p, v, q, w. The control is [`rotor_thrusts`](Self::rotor_thrusts).
    #[must_use]
    pub fn rigid_body_state(&self) -> SVector<f64, 13> {
        let attitude = to_wxyz(&self.attitude);
        let parts = [
            self.position.as_slice(),
            self.velocity.as_slice(),
            attitude.as_slice(),
            self.body_rates.as_slice(),
        ];
        stack(&parts)
    }
}

/// Rotor thrusts that give `thrust` and keep `rates` constant: the torque is `w x J w`.
pub(crate) fn steady_rotor_thrusts(vehicle: &Vehicle, thrust: f64, rates: &Vector3<f64>) -> Vector4<f64> {
    let torque = rates.cross(&(vehicle.inertia_tensor() * rates));
    vehicle.mixer().rotor_thrusts(thrust, &torque)
}

/// Parts one after the other; entries beyond the parts stay zero.
fn stack<const N: usize>(parts: &[&[f64]]) -> SVector<f64, N> {
    let mut stacked = SVector::<f64, N>::zeros();
    for (slot, value) in stacked.iter_mut().zip(parts.iter().copied().flatten()) {
        *slot = *value;
    }
    stacked
}
