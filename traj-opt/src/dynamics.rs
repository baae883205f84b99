//! The equation of motion and its derivatives.

use crate::autodiff;
use nalgebra::{RealField, SMatrix, SVector};

/// Dynamics `dx/dt = f(t, x, u)` with `NX` states and `NU` controls.
///
/// Only [`derivative`](Dynamics::derivative) has to be written, once, generic over the scalar: the solver evaluates it on
/// floats and on the dual numbers of `num-dual`. [`jacobian`](Dynamics::jacobian) and [`hessian`](Dynamics::hessian) may be
/// replaced by analytic forms where speed asks for them; [`check_derivatives`](crate::check_derivatives) compares the two.
///
/// The trait is open: implement it for any type.
///
/// # Examples
/// A double integrator:
/// ```
/// use traj_opt::Dynamics;
/// use traj_opt::nalgebra::{RealField, SVector};
///
/// struct DoubleIntegrator;
/// impl Dynamics<2, 1> for DoubleIntegrator {
///     fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
///         SVector::from([x[1], u[0]])
///     }
/// }
/// let jacobian = DoubleIntegrator.jacobian(0.0, &SVector::from([1.0, 2.0]), &SVector::from([3.0]));
/// assert_eq!(jacobian.value, SVector::from([2.0, 3.0]));
/// assert_eq!(jacobian.state[(0, 1)], 1.0);
/// assert_eq!(jacobian.control[(1, 0)], 1.0);
/// ```
pub trait Dynamics<const NX: usize, const NU: usize> {
    /// Time derivative of the state, `f(t, x, u)`.
    fn derivative<T: RealField + Copy>(
        &self,
        time: T,
        state: &SVector<T, NX>,
        control: &SVector<T, NU>,
    ) -> SVector<T, NX>;

    /// True if `f` does not depend on time; saves the derivatives with respect to time. Default: false (always safe).
    fn is_autonomous(&self) -> bool {
        false
    }

    /// Value and first derivatives of `f`. Default: forward-mode automatic differentiation.
    fn jacobian(&self, time: f64, state: &SVector<f64, NX>, control: &SVector<f64, NU>) -> Jacobian<NX, NU> {
        autodiff::jacobian(self, time, state, control)
    }

    /// Second derivatives of `weight . f`. Default: second-order forward-mode automatic differentiation.
    fn hessian(
        &self,
        time: f64,
        state: &SVector<f64, NX>,
        control: &SVector<f64, NU>,
        weight: &SVector<f64, NX>,
    ) -> Hessian<NX, NU> {
        autodiff::hessian(self, time, state, control, weight)
    }
}

/// Value and first derivatives of a vector function `f(t, x, u)` with `NX` components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jacobian<const NX: usize, const NU: usize> {
    /// `f`.
    pub value: SVector<f64, NX>,
    /// `df/dx`, row i the gradient of component i.
    pub state: SMatrix<f64, NX, NX>,
    /// `df/du`.
    pub control: SMatrix<f64, NX, NU>,
    /// `df/dt`.
    pub time: SVector<f64, NX>,
}

impl<const NX: usize, const NU: usize> Jacobian<NX, NU> {
    /// Value and all first derivatives zero.
    pub(crate) fn zeros() -> Self {
        Self {
            value: SVector::zeros(),
            state: SMatrix::zeros(),
            control: SMatrix::zeros(),
            time: SVector::zeros(),
        }
    }
}

/// Second derivatives of a scalar function of `(t, x, u)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hessian<const NX: usize, const NU: usize> {
    /// State by state, symmetric.
    pub state_state: SMatrix<f64, NX, NX>,
    /// State (row) by control (column).
    pub state_control: SMatrix<f64, NX, NU>,
    /// Control by control, symmetric.
    pub control_control: SMatrix<f64, NU, NU>,
    /// State by time.
    pub state_time: SVector<f64, NX>,
    /// Control by time.
    pub control_time: SVector<f64, NU>,
    /// Time by time.
    pub time_time: f64,
}

impl<const NX: usize, const NU: usize> Hessian<NX, NU> {
    /// All second derivatives zero.
    #[must_use]
    pub fn zeros() -> Self {
        Self {
            state_state: SMatrix::zeros(),
            state_control: SMatrix::zeros(),
            control_control: SMatrix::zeros(),
            state_time: SVector::zeros(),
            control_time: SVector::zeros(),
            time_time: 0.0,
        }
    }
}
