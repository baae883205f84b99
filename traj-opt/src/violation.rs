//! How far a solution leaves its bounds and path constraints between the knots.

use crate::{Problem, Solution};
use nalgebra::SVector;

/// What is violated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum ConstraintKind {
    /// A bound on a component of the state.
    State,
    /// A bound on a component of the control.
    Control,
    /// A path constraint.
    Path,
}

/// The greatest violation found along a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Violation {
    /// What is violated.
    pub kind: ConstraintKind,
    /// Component of the state or control, or index of the path constraint.
    pub index: usize,
    /// Time, s.
    pub time: f64,
    /// Distance beyond the bound, in the units of the constraint; infinite where its value is not a number.
    pub amount: f64,
}

impl<const NX: usize, const NU: usize> Solution<NX, NU> {
    /// The greatest violation of state bounds, control bounds and path constraints at `samples + 1` equidistant times of
    /// each segment, both ends included (`samples` 0 counts as 1); `None` if there is none. Amounts of different units are
    /// compared as they are; of equal ones the first is returned.
    ///
    /// State and control are the interpolants of the solution. It is a sampled value, hence a lower bound on the greatest
    /// violation of the interpolants. Cost: `samples + 1` evaluations of the path functions a segment.
    #[must_use]
    pub fn greatest_violation<P: Problem<NX, NU>>(&self, problem: &P, samples: usize) -> Option<Violation> {
        let samples = samples.max(1);
        let mut worst = None;
        let mut path = vec![0.0; problem.n_path()];
        for k in 0..self.times().len() - 1 {
            let (start, end) = (self.times()[k], self.times()[k + 1]);
            for i in 0..=samples {
                let time = start + (end - start) * (i as f64 / samples as f64);
                let (x, u) = (self.state_at(time), self.control_in_segment(k, time));
                worst_at(problem, time, &x, &u, &mut path, &mut worst);
            }
        }
        worst
    }
}

/// Replaces `worst` by any greater violation at one point.
fn worst_at<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &P,
    time: f64,
    x: &SVector<f64, NX>,
    u: &SVector<f64, NU>,
    path: &mut [f64],
    worst: &mut Option<Violation>,
) {
    let bounds = problem.bounds();
    let mut see = |kind, index, value: f64, lower: f64, upper: f64| {
        let excess = if value.is_nan() { f64::INFINITY } else { (lower - value).max(value - upper) };
        if excess > worst.map_or(0.0, |w: Violation| w.amount) {
            *worst = Some(Violation { kind, index, time, amount: excess });
        }
    };
    for i in 0..NX {
        see(ConstraintKind::State, i, x[i], bounds.state_lower[i], bounds.state_upper[i]);
    }
    for i in 0..NU {
        see(ConstraintKind::Control, i, u[i], bounds.control_lower[i], bounds.control_upper[i]);
    }
    problem.path(time, x, u, path);
    for (i, &value) in path.iter().enumerate() {
        let (lower, upper) = problem.path_bounds(i);
        see(ConstraintKind::Path, i, value, lower, upper);
    }
}
