//! Settings of the solver.

use crate::Error;

/// How Newton systems are factorised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum LinearAlgebra {
    /// Riccati recursion over the segments: fastest, cost linear in their number.
    #[default]
    Riccati,
    /// Sparse `L D L'` of the whole system in an order of minimum degree, with inertia read off the pivots and iterative
    /// refinement: does not rely on the stages, and costs several times as much. For many boundary constraints that couple both
    /// ends, and as an independent check. Allocates when the shape changes, not between iterations.
    #[cfg(feature = "faer")]
    Sparse,
}

/// Settings of the interior-point solver.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Options {
    /// Scaled KKT residual at which a problem counts as solved. Default 1e-8 (that of IPOPT).
    pub tolerance: f64,
    /// Scaled KKT residual that counts as acceptable when no further progress is possible. Default 1e-6.
    pub acceptable_tolerance: f64,
    /// Limit of iterations. Default 300.
    pub max_iterations: usize,
    /// First barrier parameter. Default 0.1 (that of IPOPT).
    pub initial_mu: f64,
    /// First barrier parameter of a solve that starts from a neighbour's solution ([`solve_from`](crate::solve_from)) or from one on
    /// a coarser mesh ([`solve_refined`](crate::solve_refined)), relative to the scale of the cost; for a neighbour also its last one if it is at most a third of the tolerance. Default 3e-6.
    pub warm_mu: f64,
    /// How often a solve with free final time that gets stuck far from feasibility is begun again, each time from a guess twice
    /// as long: a guess that is too short for the vehicle can lead into a local minimum of the violation. If that does not help, guesses
    /// 16 and 256 times as short as the first and as long as the last follow. Default 6; 0 for a single solve.
    pub time_restarts: usize,
    /// How Newton systems are factorised. Default [`LinearAlgebra::Riccati`].
    pub linear_algebra: LinearAlgebra,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            acceptable_tolerance: 1e-6,
            max_iterations: 300,
            initial_mu: 0.1,
            warm_mu: 3e-6,
            time_restarts: 6,
            linear_algebra: LinearAlgebra::default(),
        }
    }
}

impl Options {
    /// Sets [`tolerance`](Self::tolerance).
    #[must_use]
    pub fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Sets [`acceptable_tolerance`](Self::acceptable_tolerance).
    #[must_use]
    pub fn with_acceptable_tolerance(mut self, tolerance: f64) -> Self {
        self.acceptable_tolerance = tolerance;
        self
    }

    /// Sets [`max_iterations`](Self::max_iterations).
    #[must_use]
    pub fn with_max_iterations(mut self, n: usize) -> Self {
        self.max_iterations = n;
        self
    }

    /// Sets [`initial_mu`](Self::initial_mu).
    #[must_use]
    pub fn with_initial_mu(mut self, mu: f64) -> Self {
        self.initial_mu = mu;
        self
    }

    /// Sets [`warm_mu`](Self::warm_mu).
    #[must_use]
    pub fn with_warm_mu(mut self, mu: f64) -> Self {
        self.warm_mu = mu;
        self
    }

    /// Sets [`time_restarts`](Self::time_restarts).
    #[must_use]
    pub fn with_time_restarts(mut self, n: usize) -> Self {
        self.time_restarts = n;
        self
    }

    /// Sets [`linear_algebra`](Self::linear_algebra).
    #[must_use]
    pub fn with_linear_algebra(mut self, linear_algebra: LinearAlgebra) -> Self {
        self.linear_algebra = linear_algebra;
        self
    }

    pub(crate) fn validate(&self) -> Result<(), Error> {
        let positive = [
            ("tolerance", self.tolerance),
            ("acceptable_tolerance", self.acceptable_tolerance),
            ("initial_mu", self.initial_mu),
            ("warm_mu", self.warm_mu),
        ];
        for (option, value) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::InvalidOption { option, value });
            }
        }
        Ok(())
    }
}
