//! When a solve ends, and when it is stuck.

use crate::{Iteration, Options, Residuals, Status};
use std::ops::ControlFlow;

/// A solve whose steps are shorter than this, this many times in a row, far from feasible, is stuck.
const SHORT_STEP: f64 = 0.03;
const SHORT_STEPS: usize = 4;
pub(super) const FAR_FROM_FEASIBLE: f64 = 1e-2;
/// Acceptable iterates in a row with which a solve ends, as in IPOPT.
const ENOUGH_ACCEPTABLE: usize = 15;

/// How a solve has gone so far.
pub(super) struct Course {
    /// Length of the last step.
    pub step_length: f64,
    /// Acceptable iterates in a row.
    acceptable: usize,
    /// Short steps in a row, far from feasible.
    short_steps: usize,
    pub restorations: usize,
}

impl Course {
    /// Before the first iterate.
    pub fn new() -> Self {
        Self { step_length: 1.0, acceptable: 0, short_steps: 0, restorations: 0 }
    }

    /// The status with which the solve ends at an iterate; `None` to go on.
    pub fn conclusion(
        &mut self,
        entry: &Iteration,
        options: &Options,
        monitor: &mut impl FnMut(&Iteration) -> ControlFlow<()>,
    ) -> Option<Status> {
        // a point of infinite cost is no solution, whatever the tolerance
        let worst = if entry.objective.is_finite() { worst_of(&entry.residuals) } else { f64::INFINITY };
        if worst <= options.tolerance {
            return Some(Status::Solved);
        }
        self.acceptable = if worst <= options.acceptable_tolerance { self.acceptable + 1 } else { 0 };
        if self.acceptable >= ENOUGH_ACCEPTABLE {
            return Some(Status::Acceptable);
        }
        if monitor(entry).is_break() {
            return Some(Status::Stopped);
        }
        (entry.iteration == options.max_iterations).then(|| self.fallback(Status::IterationLimit))
    }

    /// Whether so many steps in a row were short that the method has jammed; they are counted anew then.
    pub fn is_stuck(&mut self, residuals: &Residuals) -> bool {
        let is_short = self.step_length < SHORT_STEP && residuals.primal > FAR_FROM_FEASIBLE;
        self.short_steps = if is_short { self.short_steps + 1 } else { 0 };
        let is_stuck = self.short_steps >= SHORT_STEPS;
        if is_stuck {
            self.short_steps = 0;
        }
        is_stuck
    }

    /// A status, unless the iterate is acceptable.
    pub fn fallback(&self, status: Status) -> Status {
        if self.acceptable > 0 { Status::Acceptable } else { status }
    }
}

/// The greatest residual; infinite if one is not a number.
pub(super) fn worst_of(r: &Residuals) -> f64 {
    let worst = r.primal.max(r.dual).max(r.complementarity);
    if r.primal.is_nan() || r.dual.is_nan() || r.complementarity.is_nan() { f64::INFINITY } else { worst }
}
