//! Comparison of user-supplied derivatives with automatic ones.

use crate::nlp::path::{Rows, automatic_hessian, automatic_jacobian};
use crate::nlp::program::Scratch;
use crate::{Dynamics, Hessian, Problem, autodiff};
use nalgebra::SVector;

/// Greatest relative difference between a model's own [`Dynamics::jacobian`] and [`Dynamics::hessian`] and those of automatic
/// differentiation at a point. Zero if the model does not override them; anything above about 1e-10 is a mistake.
#[must_use]
pub fn check_derivatives<const NX: usize, const NU: usize>(
    dynamics: &impl Dynamics<NX, NU>,
    time: f64,
    state: &SVector<f64, NX>,
    control: &SVector<f64, NU>,
) -> f64 {
    let mut worst: f64 = 0.0;
    let mut compare = |a: f64, b: f64| worst = greater(worst, (a - b).abs() / (1.0 + b.abs()));
    let (own, auto) =
        (dynamics.jacobian(time, state, control), autodiff::jacobian(dynamics, time, state, control));
    own.value.iter().zip(&auto.value).for_each(|(a, b)| compare(*a, *b));
    own.state.iter().zip(&auto.state).for_each(|(a, b)| compare(*a, *b));
    own.control.iter().zip(&auto.control).for_each(|(a, b)| compare(*a, *b));
    own.time.iter().zip(&auto.time).for_each(|(a, b)| compare(*a, *b));
    // unequal weights, so that an error in one component cannot hide behind another
    let weight = SVector::from_fn(|i, _| 1.0 + 0.37 * i as f64);
    let own = dynamics.hessian(time, state, control, &weight);
    let auto = autodiff::hessian(dynamics, time, state, control, &weight);
    greater(worst, difference(&own, &auto))
}

/// The same for a problem's own [`Problem::path_gradients`] and [`Problem::path_hessian`]. Zero if it has none; not a number or
/// above about 1e-10 is a mistake, infinite if it has only one of the two. Boundary constraints, costs and path functions that
/// depend on time are always differentiated automatically.
#[must_use]
pub fn check_path_derivatives<const NX: usize, const NU: usize>(
    problem: &impl Problem<NX, NU>,
    state: &SVector<f64, NX>,
    control: &SVector<f64, NU>,
) -> f64 {
    let n = problem.n_path();
    let (mut by_state, mut by_control) = (vec![SVector::zeros(); n], vec![SVector::zeros(); n]);
    let weights: Vec<f64> = (0..n).map(|i| 1.0 + 0.37 * i as f64).collect();
    let mut own = Hessian::zeros();
    let has_gradients = problem.path_gradients(state, control, &mut by_state, &mut by_control);
    let has_hessian = problem.path_hessian(state, control, &weights, &mut own);
    if has_gradients != has_hessian {
        return f64::INFINITY;
    }
    if !has_gradients {
        return 0.0;
    }
    let mut scratch = Scratch::default();
    scratch.resize(n);
    let (mut x, mut u, mut t) = (vec![SVector::zeros(); n], vec![SVector::zeros(); n], vec![0.0; n]);
    let mut rows = Rows { x: &mut x, u: &mut u, t: &mut t };
    // own derivatives are only asked of problems in which no time occurs
    let at = (0.0, state, control);
    automatic_jacobian(problem, at, false, &mut rows, &mut scratch);
    let auto = automatic_hessian(problem, at, false, &weights, &mut scratch);
    let pairs = |a: &f64, b: &f64| (a - b).abs() / (1.0 + b.abs());
    let states = by_state.iter().zip(&x).flat_map(|(a, b)| a.iter().zip(b));
    let controls = by_control.iter().zip(&u).flat_map(|(a, b)| a.iter().zip(b));
    let gradients = states.chain(controls).map(|(a, b)| pairs(a, b)).fold(0.0, greater);
    greater(gradients, difference(&own, &auto))
}

/// Greatest relative difference of two sets of second derivatives.
fn difference<const NX: usize, const NU: usize>(own: &Hessian<NX, NU>, auto: &Hessian<NX, NU>) -> f64 {
    let first = own.state_state.iter().zip(&auto.state_state);
    let second = own.state_control.iter().zip(&auto.state_control);
    let third = own.control_control.iter().zip(&auto.control_control);
    let by_time =
        own.state_time.iter().zip(&auto.state_time).chain(own.control_time.iter().zip(&auto.control_time));
    let all = first.chain(second).chain(third).chain(by_time).chain([(&own.time_time, &auto.time_time)]);
    all.map(|(a, b)| (a - b).abs() / (1.0 + b.abs())).fold(0.0, greater)
}

/// The greater number; not a number if either is.
fn greater(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}
