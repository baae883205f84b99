//! Options of k-means.

use crate::error::{Error, OptionName};

/// How [`kmeans`](crate::kmeans) works; the defaults are those of scikit-learn 1.x with ten restarts, but for the tolerance.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct KMeansOptions {
    /// Seed of the generator (default 0): equal seeds give equal results.
    pub seed: u64,
    /// Number of runs from different seeds, of which the one with the least inertia is returned (default 10).
    pub n_init: usize,
    /// Greatest number of Lloyd iterations a run (default 300).
    pub max_iterations: usize,
    /// A run has converged when the squared shifts of the centroids sum to no more than this times the mean variance of
    /// the coordinates; 0 runs to a fixed point. Default 1e-6: scikit-learn's 1e-4 leaves up to 0.5 % of the inertia on the table (100 000
    /// uniform points), and iterations are cheap here.
    pub tolerance: f64,
}

impl Default for KMeansOptions {
    fn default() -> Self {
        Self { seed: 0, n_init: 10, max_iterations: 300, tolerance: 1e-6 }
    }
}

impl KMeansOptions {
    /// Sets the seed.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Sets the number of runs.
    #[must_use]
    pub fn with_n_init(mut self, n_init: usize) -> Self {
        self.n_init = n_init;
        self
    }

    /// Sets the greatest number of iterations a run.
    #[must_use]
    pub fn with_max_iterations(mut self, max_iterations: usize) -> Self {
        self.max_iterations = max_iterations;
        self
    }

    /// Sets the relative tolerance on the shift of the centroids.
    #[must_use]
    pub fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    pub(crate) fn validate(&self) -> Result<(), Error> {
        let at_least = |option, minimum: f64, found: f64| {
            // Written so that NaN fails.
            if found >= minimum { Ok(()) } else { Err(Error::OptionTooSmall { option, minimum, found }) }
        };
        at_least(OptionName::NInit, 1.0, self.n_init as f64)?;
        at_least(OptionName::MaxIterations, 1.0, self.max_iterations as f64)?;
        at_least(OptionName::Tolerance, 0.0, self.tolerance)
    }
}
