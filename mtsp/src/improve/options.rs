//! Options of the search.

use crate::objective::Objective;

/// How [`solve`](crate::solve) works.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// What is to be least (default [`Objective::Makespan`]).
    pub objective: Objective,
    /// Ruin-and-recreate iterations at most (default 200 000: about 0.5 s for 100 targets).
    pub iterations: u64,
    /// Iterations after which the first annealing is cold (default: `iterations`). Later ones start warm. With a caller that stops by a
    /// clock, set it to about what fits, and `iterations` to more.
    pub horizon: Option<u64>,
    /// Seed of the generator (default 0).
    pub seed: u64,
    /// Stop when the objective is within this of its lower bound, relatively (default 1e-9).
    pub gap: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self { objective: Objective::Makespan, iterations: 200_000, horizon: None, seed: 0, gap: 1e-9 }
    }
}

impl Options {
    /// Sets the objective.
    #[must_use]
    pub fn with_objective(mut self, objective: Objective) -> Self {
        self.objective = objective;
        self
    }

    /// Sets the greatest number of iterations.
    #[must_use]
    pub fn with_iterations(mut self, iterations: u64) -> Self {
        self.iterations = iterations;
        self
    }

    /// Sets the length of the first annealing.
    #[must_use]
    pub fn with_horizon(mut self, horizon: u64) -> Self {
        self.horizon = Some(horizon);
        self
    }

    /// Sets the seed.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Sets the relative gap at which to stop.
    #[must_use]
    pub fn with_gap(mut self, gap: f64) -> Self {
        self.gap = gap;
        self
    }
}
