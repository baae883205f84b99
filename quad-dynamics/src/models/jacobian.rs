//! Analytic derivatives of the models, for floats: several times as fast as dual numbers.

use nalgebra::{Matrix3, Matrix3x4, Matrix4, Matrix4x3, SMatrix, SVector, Vector3, Vector4};

use super::{Air, entries};
use super::{JerkLimited, PointMass, RigidBody, ThrustRate, thrust_direction};

/// Value and first derivatives of `f(x, u)` with `NX` states and `NU` controls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jacobian<const NX: usize, const NU: usize> {
    /// `f`.
    pub value: SVector<f64, NX>,
    /// `df/dx`; row i belongs to component i.
    pub state: SMatrix<f64, NX, NX>,
    /// `df/du`.
    pub control: SMatrix<f64, NX, NU>,
}

impl<const NX: usize, const NU: usize> Jacobian<NX, NU> {
    /// The derivatives that all models share: `p' = v`, and drag in rows 3 to 5.
    #[inline]
    fn of(value: SVector<f64, NX>) -> Self {
        let mut state = SMatrix::zeros();
        for i in 0..3 {
            state[(i, i + 3)] = 1.0;
        }
        Self { value, state, control: SMatrix::zeros() }
    }
}

impl PointMass {
    /// [`derivative`](Self::derivative) with its analytic derivatives.
    #[inline]
    #[must_use]
    pub fn jacobian(&self, state: &SVector<f64, 6>, control: &SVector<f64, 3>) -> Jacobian<6, 3> {
        let mut jacobian = Jacobian::of(self.derivative(state, control));
        let drag = drag_gradient(&self.air, &entries(state, 3));
        jacobian.state.fixed_view_mut::<3, 3>(3, 3).copy_from(&drag);
        for i in 0..3 {
            jacobian.control[(i + 3, i)] = self.air.inverse_mass;
        }
        jacobian
    }
}

impl JerkLimited {
    /// [`derivative`](Self::derivative) with its derivatives, which are constant.
    #[inline]
    #[must_use]
    pub fn jacobian(&self, state: &SVector<f64, 9>, control: &SVector<f64, 3>) -> Jacobian<9, 3> {
        let mut jacobian = Jacobian::of(self.derivative(state, control));
        for i in 0..3 {
            jacobian.state[(i + 3, i + 6)] = 1.0;
            jacobian.control[(i + 6, i)] = 1.0;
        }
        jacobian
    }
}

impl ThrustRate {
    /// [`derivative`](Self::derivative) with its analytic derivatives.
    #[inline]
    #[must_use]
    pub fn jacobian(&self, state: &SVector<f64, 10>, control: &SVector<f64, 4>) -> Jacobian<10, 4> {
        let mut jacobian = Jacobian::of(self.derivative(state, control));
        let q = Vector4::from(entries(state, 6));
        let rates = Vector3::from(entries(control, 1));
        let drag = drag_gradient(&self.air, &entries(state, 3));
        let turn = direction_gradient(&q) * (control[0] * self.air.inverse_mass);
        jacobian.state.fixed_view_mut::<3, 3>(3, 3).copy_from(&drag);
        jacobian.state.fixed_view_mut::<3, 4>(3, 6).copy_from(&turn);
        jacobian.state.fixed_view_mut::<4, 4>(6, 6).copy_from(&quaternion_rate_by_quaternion(&rates));
        let up = Vector3::from(thrust_direction(q.into())) * self.air.inverse_mass;
        jacobian.control.fixed_view_mut::<3, 1>(3, 0).copy_from(&up);
        jacobian.control.fixed_view_mut::<4, 3>(6, 1).copy_from(&quaternion_rate_by_rates(&q));
        jacobian
    }
}

impl RigidBody {
    /// [`derivative`](Self::derivative) with its analytic derivatives.
    #[inline]
    #[must_use]
    pub fn jacobian(&self, state: &SVector<f64, 13>, control: &SVector<f64, 4>) -> Jacobian<13, 4> {
        let mut jacobian = Jacobian::of(self.derivative(state, control));
        let q = Vector4::from(entries(state, 6));
        let rates = Vector3::from(entries(state, 10));
        let drag = drag_gradient(&self.air, &entries(state, 3));
        let turn = direction_gradient(&q) * (control.sum() * self.air.inverse_mass);
        jacobian.state.fixed_view_mut::<3, 3>(3, 3).copy_from(&drag);
        jacobian.state.fixed_view_mut::<3, 4>(3, 6).copy_from(&turn);
        jacobian.state.fixed_view_mut::<4, 4>(6, 6).copy_from(&quaternion_rate_by_quaternion(&rates));
        jacobian.state.fixed_view_mut::<4, 3>(6, 10).copy_from(&quaternion_rate_by_rates(&q));
        let inertia = self.vehicle.inertia_tensor();
        // d(w x J w) = -(J w) x dw + w x J dw
        let gyroscopic = (inertia * rates).cross_matrix() - rates.cross_matrix() * inertia;
        let spin = self.vehicle.inverse_inertia_tensor() * gyroscopic;
        jacobian.state.fixed_view_mut::<3, 3>(10, 10).copy_from(&spin);
        let up = Vector3::from(thrust_direction(q.into())) * self.air.inverse_mass;
        for rotor in 0..4 {
            jacobian.control.fixed_view_mut::<3, 1>(3, rotor).copy_from(&up);
        }
        jacobian.control.fixed_view_mut::<3, 4>(10, 0).copy_from(&self.spin_by_rotor);
        jacobian
    }
}

/// `d(-k |v| v)/dv = -k (|v| I + v v^T / |v|)`, zero at rest.
#[inline]
fn drag_gradient(air: &Air, velocity: &[f64; 3]) -> Matrix3<f64> {
    let v = Vector3::from(*velocity) - air.wind;
    let speed = v.norm();
    if speed > 0.0 {
        (Matrix3::from_diagonal_element(speed) + v * (v / speed).transpose()) * -air.drag_per_mass
    } else {
        Matrix3::zeros()
    }
}

/// Derivative of the thrust direction `n(q)/|q|^2` by `(w, x, y, z)`.
#[inline]
fn direction_gradient(q: &Vector4<f64>) -> Matrix3x4<f64> {
    let [w, x, y, z] = (*q).into();
    let scale = 2.0 / q.norm_squared();
    let direction = Vector3::from(thrust_direction([w, x, y, z]));
    #[rustfmt::skip]
    let numerator = Matrix3x4::new(
         y,  z,  w, x,
        -x, -w,  z, y,
         w, -x, -y, z,
    );
    (numerator - direction * q.transpose()) * scale
}

/// `d(q (0, rates)/2)/dq`.
#[inline]
fn quaternion_rate_by_quaternion(rates: &Vector3<f64>) -> Matrix4<f64> {
    let (p, q, r) = (0.5 * rates.x, 0.5 * rates.y, 0.5 * rates.z);
    #[rustfmt::skip]
    let matrix = Matrix4::new(
        0.0, -p, -q, -r,
        p, 0.0, r, -q,
        q, -r, 0.0, p,
        r, q, -p, 0.0,
    );
    matrix
}

/// `d(q (0, rates)/2)/drates`.
#[inline]
fn quaternion_rate_by_rates(q: &Vector4<f64>) -> Matrix4x3<f64> {
    let [w, x, y, z] = (*q * 0.5).into();
    #[rustfmt::skip]
    let matrix = Matrix4x3::new(
        -x, -y, -z,
        w, -z, y,
        z, w, -x,
        -y, x, w,
    );
    matrix
}
