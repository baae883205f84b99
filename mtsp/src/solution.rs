//! Routes and what is known about them.

use crate::check::check;
use crate::error::Error;
use crate::lower_bound::{self, LowerBounds};
use crate::objective::Objective;
use crate::problem::Problem;
use christofides::Metric;

/// Routes of all vehicles with their lengths and certified lower bounds.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Solution {
    /// The targets of each vehicle in the order of their visits; depots are implied at both ends. A vehicle may stay at home.
    pub routes: Vec<Vec<usize>>,
    /// The length of each route.
    pub lengths: Vec<f64>,
    /// The length of the longest route.
    pub makespan: f64,
    /// The sum of all lengths.
    pub total_cost: f64,
    /// What no solution of this problem can be below.
    pub lower_bounds: LowerBounds,
}

impl Solution {
    /// Checks routes and measures them; lower bounds as [`lower_bound::both`] gives them.
    ///
    /// # Errors
    /// Those of [`check`].
    pub fn of<M: Metric>(problem: &Problem<'_, M>, routes: Vec<Vec<usize>>) -> Result<Self, Error> {
        let bounds = lower_bound::both(problem);
        Self::with_bounds(problem, routes, bounds)
    }

    pub(crate) fn with_bounds<M: Metric>(
        problem: &Problem<'_, M>,
        routes: Vec<Vec<usize>>,
        lower_bounds: LowerBounds,
    ) -> Result<Self, Error> {
        let measured = check(problem, &routes)?;
        let (makespan, total_cost) = (measured.makespan, measured.total_cost);
        Ok(Self { routes, lengths: measured.lengths, makespan, total_cost, lower_bounds })
    }

    /// The value of an objective.
    #[must_use]
    pub fn value(&self, objective: Objective) -> f64 {
        match objective {
            Objective::Total => self.total_cost,
            Objective::Makespan => self.makespan,
        }
    }

    /// The certified lower bound of an objective.
    #[must_use]
    pub fn lower_bound(&self, objective: Objective) -> f64 {
        match objective {
            Objective::Total => self.lower_bounds.total_cost,
            Objective::Makespan => self.lower_bounds.makespan,
        }
    }

    /// `value / lower_bound - 1`: how far the solution can be from the best; 0 if both are 0, infinite if only the bound is.
    #[must_use]
    pub fn gap(&self, objective: Objective) -> f64 {
        let (value, bound) = (self.value(objective), self.lower_bound(objective));
        if value <= bound { 0.0 } else { value / bound - 1.0 }
    }
}
