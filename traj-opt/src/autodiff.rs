//! First and second derivatives by forward-mode automatic differentiation with the vector dual numbers of `num-dual`.
//!
//! States and controls are seeded in separate passes, because the sum of two const generics is not a const generic.

use crate::{Dynamics, Hessian, Jacobian};
use nalgebra::{SMatrix, SVector};
use num_dual::{Derivative, Dual2SVec64, Dual64, DualSVec64, HyperDual64, HyperDualSVec64};

/// Seeds `values` with unit directions.
pub(crate) fn seed<const N: usize>(values: &SVector<f64, N>) -> SVector<DualSVec64<N>, N> {
    SVector::from_fn(|i, _| DualSVec64::from_re(values[i]).derivative(i))
}

/// Lifts constants into dual numbers without derivative parts.
pub(crate) fn constant<const M: usize, const N: usize>(
    values: &SVector<f64, M>,
) -> SVector<DualSVec64<N>, M> {
    values.map(DualSVec64::from_re)
}

/// Gradient of a vector dual number.
pub(crate) fn gradient<const N: usize>(value: &DualSVec64<N>) -> SVector<f64, N> {
    value.eps.0.unwrap_or_else(SVector::zeros)
}

pub(crate) fn seed2<const N: usize>(values: &SVector<f64, N>) -> SVector<Dual2SVec64<N>, N> {
    SVector::from_fn(|i, _| Dual2SVec64::from_re(values[i]).derivative(i))
}

pub(crate) fn constant2<const M: usize, const N: usize>(
    values: &SVector<f64, M>,
) -> SVector<Dual2SVec64<N>, M> {
    values.map(Dual2SVec64::from_re)
}

pub(crate) fn hessian_part<const N: usize>(value: &Dual2SVec64<N>) -> SMatrix<f64, N, N> {
    value.v2.0.unwrap_or_else(SMatrix::zeros)
}

/// Seeds the rows of a mixed second derivative.
pub(crate) fn seed_rows<const M: usize, const N: usize>(
    values: &SVector<f64, M>,
) -> SVector<HyperDualSVec64<M, N>, M> {
    SVector::from_fn(|i, _| HyperDualSVec64::from_re(values[i]).derivative1(i))
}

/// Seeds the columns of a mixed second derivative.
pub(crate) fn seed_columns<const M: usize, const N: usize>(
    values: &SVector<f64, N>,
) -> SVector<HyperDualSVec64<M, N>, N> {
    SVector::from_fn(|i, _| HyperDualSVec64::from_re(values[i]).derivative2(i))
}

pub(crate) fn mixed_part<const M: usize, const N: usize>(
    value: &HyperDualSVec64<M, N>,
) -> SMatrix<f64, M, N> {
    value.eps1eps2.0.unwrap_or_else(SMatrix::zeros)
}

pub(crate) fn jacobian<const NX: usize, const NU: usize, D: Dynamics<NX, NU> + ?Sized>(
    dynamics: &D,
    time: f64,
    state: &SVector<f64, NX>,
    control: &SVector<f64, NU>,
) -> Jacobian<NX, NU> {
    let by_state = dynamics.derivative(DualSVec64::from_re(time), &seed(state), &constant::<NU, NX>(control));
    let by_control =
        dynamics.derivative(DualSVec64::from_re(time), &constant::<NX, NU>(state), &seed(control));
    let mut result = Jacobian {
        value: by_state.map(|v| v.re),
        state: SMatrix::zeros(),
        control: SMatrix::zeros(),
        time: SVector::zeros(),
    };
    for i in 0..NX {
        result.state.set_row(i, &gradient(&by_state[i]).transpose());
        result.control.set_row(i, &gradient(&by_control[i]).transpose());
    }
    if !dynamics.is_autonomous() {
        let t = Dual64::from_re(time).derivative();
        result.time =
            dynamics.derivative(t, &state.map(Dual64::from_re), &control.map(Dual64::from_re)).map(|v| v.eps);
    }
    result
}

pub(crate) fn hessian<const NX: usize, const NU: usize, D: Dynamics<NX, NU> + ?Sized>(
    dynamics: &D,
    time: f64,
    state: &SVector<f64, NX>,
    control: &SVector<f64, NU>,
    weight: &SVector<f64, NX>,
) -> Hessian<NX, NU> {
    let mut result = Hessian::zeros();
    let xx = dynamics.derivative(Dual2SVec64::from_re(time), &seed2(state), &constant2::<NU, NX>(control));
    let uu = dynamics.derivative(Dual2SVec64::from_re(time), &constant2::<NX, NU>(state), &seed2(control));
    let xu = dynamics.derivative(
        HyperDualSVec64::from_re(time),
        &seed_rows::<NX, NU>(state),
        &seed_columns::<NX, NU>(control),
    );
    for i in 0..NX {
        result.state_state += hessian_part(&xx[i]) * weight[i];
        result.control_control += hessian_part(&uu[i]) * weight[i];
        result.state_control += mixed_part(&xu[i]) * weight[i];
    }
    if !dynamics.is_autonomous() {
        time_parts(dynamics, time, state, control, weight, &mut result);
    }
    result
}

/// Second derivatives that involve time.
fn time_parts<const NX: usize, const NU: usize, D: Dynamics<NX, NU> + ?Sized>(
    dynamics: &D,
    time: f64,
    state: &SVector<f64, NX>,
    control: &SVector<f64, NU>,
    weight: &SVector<f64, NX>,
    result: &mut Hessian<NX, NU>,
) {
    let one = |_| Derivative::some(SMatrix::<f64, 1, 1>::repeat(1.0));
    let mut tx = HyperDualSVec64::<NX, 1>::from_re(time);
    tx.eps2 = one(());
    let by_state =
        dynamics.derivative(tx, &seed_rows::<NX, 1>(state), &control.map(HyperDualSVec64::from_re));
    let mut tu = HyperDualSVec64::<NU, 1>::from_re(time);
    tu.eps2 = one(());
    let by_control =
        dynamics.derivative(tu, &state.map(HyperDualSVec64::from_re), &seed_rows::<NU, 1>(control));
    let t = HyperDual64::new(time, 1.0, 1.0, 0.0);
    let by_time =
        dynamics.derivative(t, &state.map(HyperDual64::from_re), &control.map(HyperDual64::from_re));
    for i in 0..NX {
        result.state_time += mixed_part(&by_state[i]) * weight[i];
        result.control_time += mixed_part(&by_control[i]) * weight[i];
        result.time_time += by_time[i].eps1eps2 * weight[i];
    }
}
