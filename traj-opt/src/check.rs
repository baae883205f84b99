//! Comparison of user-supplied derivatives with automatic ones.

use crate::{Dynamics, autodiff};
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
    let mut compare = |a: f64, b: f64| worst = worst.max((a - b).abs() / (1.0 + b.abs()));
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
    own.state_state.iter().zip(&auto.state_state).for_each(|(a, b)| compare(*a, *b));
    own.state_control.iter().zip(&auto.state_control).for_each(|(a, b)| compare(*a, *b));
    own.control_control.iter().zip(&auto.control_control).for_each(|(a, b)| compare(*a, *b));
    own.state_time.iter().zip(&auto.state_time).for_each(|(a, b)| compare(*a, *b));
    own.control_time.iter().zip(&auto.control_time).for_each(|(a, b)| compare(*a, *b));
    compare(own.time_time, auto.time_time);
    worst
}
