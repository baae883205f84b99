//! The models of motion, each with one generic `derivative`.
//!
//! | model | state | control |
//! |---|---|---|
//! | [`PointMass`] | p, v (6) | thrust force (3), N, world |
//! | [`JerkLimited`] | p, v, a (9) | jerk (3), m/s^3, world |
//! | [`ThrustRate`] | p, v, q (10) | collective thrust, N; body rates (3), rad/s |
//! | [`RigidBody`] | p, v, q, w (13) | rotor thrusts (4), N |
//! | [`RotorLag`] (simulation only) | p, v, q, w, rotor speeds (17) | commanded rotor speeds (4), rad/s |
//!
//! Positions and velocities are in the world frame, `q = (w, x, y, z)` is body to world, `w` are body rates
//! ([`frames`](crate::frames)). Forces are those of one equation:
//! `m a = T z_b - m g e_z - (c_d/2) |v_air| v_air`, `v_air = v - wind`.
//!
//! `derivative` is generic over the scalar, so that dual numbers give its derivatives.

mod hessian;
mod jacobian;
mod jerk_limited;
mod point_mass;
mod rigid_body;
mod rotor_lag;
mod thrust_rate;

pub use hessian::Hessian;
pub use jacobian::Jacobian;
pub use jerk_limited::JerkLimited;
pub use point_mass::PointMass;
pub use rigid_body::RigidBody;
pub use rotor_lag::RotorLag;
pub use thrust_rate::ThrustRate;

use nalgebra::{Matrix3, RealField, SVector, Vector3};

use crate::frames::GRAVITY;
use crate::vehicle::Vehicle;

/// What the translational models share: gravity, drag and steady wind, per unit of mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Air {
    /// 1/m, 1/kg.
    pub inverse_mass: f64,
    /// `c_d/(2 m)`, 1/m.
    pub drag_per_mass: f64,
    /// Steady wind, m/s, world.
    pub wind: Vector3<f64>,
}

impl Air {
    pub fn new(vehicle: &Vehicle) -> Self {
        let inverse_mass = vehicle.mass().recip();
        Self {
            inverse_mass,
            drag_per_mass: 0.5 * vehicle.drag_coefficient() * inverse_mass,
            wind: Vector3::zeros(),
        }
    }

    /// Acceleration by gravity and drag at a velocity, m/s^2.
    #[inline]
    pub fn acceleration<T: RealField + Copy>(&self, velocity: [T; 3]) -> [T; 3] {
        let wind = &self.wind;
        let air = [0, 1, 2].map(|i| velocity[i] - nalgebra::convert(wind[i]));
        let squared = air[0] * air[0] + air[1] * air[1] + air[2] * air[2];
        // |v| v is differentiable at 0, its factor |v| is not: a dual number would give 0/0 there.
        let speed = if squared > T::zero() { squared.sqrt() } else { T::zero() };
        let factor = speed * nalgebra::convert(-self.drag_per_mass);
        [air[0] * factor, air[1] * factor, air[2] * factor - nalgebra::convert(GRAVITY)]
    }

    /// Time derivative of the drag acceleration `-k |v| v` when the velocity changes at `acceleration`, m/s^3.
    pub fn drag_rate(&self, velocity: &Vector3<f64>, acceleration: &Vector3<f64>) -> Vector3<f64> {
        let air = velocity - self.wind;
        let speed = air.norm();
        let along = if speed > 0.0 { air * (air.dot(acceleration) / speed) } else { Vector3::zeros() };
        (acceleration * speed + along) * -self.drag_per_mass
    }
}

/// Unit thrust direction (third column of the rotation), for a quaternion of any norm but zero.
///
/// Divided by |q|^2, so that a norm that drifts creates no thrust.
#[inline]
pub(crate) fn thrust_direction<T: RealField + Copy>(q: [T; 4]) -> [T; 3] {
    let [w, x, y, z] = q;
    let scale = (w * w + x * x + y * y + z * z).recip();
    let twice = scale + scale;
    [twice * (x * z + w * y), twice * (y * z - w * x), scale * (w * w - x * x - y * y + z * z)]
}

/// The body axes in the world: columns of the rotation, for a quaternion of any norm but zero.
#[inline]
pub(crate) fn rotation<T: RealField + Copy>(q: [T; 4]) -> [[T; 3]; 3] {
    let [w, x, y, z] = q;
    let scale = (w * w + x * x + y * y + z * z).recip();
    let twice = scale + scale;
    [
        [scale * (w * w + x * x - y * y - z * z), twice * (x * y + w * z), twice * (x * z - w * y)],
        [twice * (x * y - w * z), scale * (w * w - x * x + y * y - z * z), twice * (y * z + w * x)],
        thrust_direction(q),
    ]
}

/// `J^-1 (torque - w x J w)`.
#[inline]
pub(crate) fn angular_acceleration<T: RealField + Copy>(
    vehicle: &Vehicle,
    rates: [T; 3],
    torque: [T; 3],
) -> [T; 3] {
    let [p, q, r] = rates;
    let [hx, hy, hz] = multiply(vehicle.inertia_tensor(), rates);
    let net = [torque[0] - (q * hz - r * hy), torque[1] - (r * hx - p * hz), torque[2] - (p * hy - q * hx)];
    multiply(vehicle.inverse_inertia_tensor(), net)
}

/// Matrix times vector; the matrix's numbers are constants.
#[inline]
fn multiply<T: RealField + Copy>(matrix: &Matrix3<f64>, vector: [T; 3]) -> [T; 3] {
    let [x, y, z] = vector;
    // Fields instead of indices: no bounds to check.
    let rows = [
        [matrix.m11, matrix.m12, matrix.m13],
        [matrix.m21, matrix.m22, matrix.m23],
        [matrix.m31, matrix.m32, matrix.m33],
    ];
    rows.map(|row| {
        let [a, b, c] = row.map(nalgebra::convert::<f64, T>);
        a * x + b * y + c * z
    })
}

/// `q' = q (0, rates) / 2`.
#[inline]
pub(crate) fn quaternion_rate<T: RealField + Copy>(q: [T; 4], rates: [T; 3]) -> [T; 4] {
    let half: T = nalgebra::convert(0.5);
    let [w, x, y, z] = q;
    let [p, q, r] = rates.map(|rate| rate * half);
    [-(x * p + y * q + z * r), w * p + y * r - z * q, w * q + z * p - x * r, w * r + x * q - y * p]
}

/// `N` entries of a vector from `start` on.
#[inline]
pub(crate) fn entries<T: RealField + Copy, const N: usize, const S: usize>(
    vector: &SVector<T, S>,
    start: usize,
) -> [T; N] {
    std::array::from_fn(|i| vector[start + i])
}
