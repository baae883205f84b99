//! Settings of the conic path.

use crate::Error;

/// Settings of [`solve_conic`](crate::solve_conic). Lengths of steps are in units of the variables' scales.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ConicOptions {
    /// Scaled KKT residual at which a problem counts as solved. Default 1e-6.
    pub tolerance: f64,
    /// Scaled KKT residual that counts as acceptable when no further progress is possible. Default 1e-4.
    pub acceptable_tolerance: f64,
    /// Limit of cone programs. Default 200.
    pub max_iterations: usize,
    /// First radius of the trust region. Default 1.
    pub trust_radius: f64,
    /// First weight of virtual controls, relative to the scale of the cost. Default 10. It grows tenfold, up to 1e6, when a step
    /// that the trust region does not hold back leaves constraints violated.
    pub penalty: f64,
}

impl Default for ConicOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            acceptable_tolerance: 1e-4,
            max_iterations: 200,
            trust_radius: 1.0,
            penalty: 10.0,
        }
    }
}

impl ConicOptions {
    /// Sets [`tolerance`](Self::tolerance).
    #[must_use]
    pub fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Sets [`max_iterations`](Self::max_iterations).
    #[must_use]
    pub fn with_max_iterations(mut self, n: usize) -> Self {
        self.max_iterations = n;
        self
    }

    /// Sets [`trust_radius`](Self::trust_radius).
    #[must_use]
    pub fn with_trust_radius(mut self, radius: f64) -> Self {
        self.trust_radius = radius;
        self
    }

    /// Sets [`penalty`](Self::penalty).
    #[must_use]
    pub fn with_penalty(mut self, penalty: f64) -> Self {
        self.penalty = penalty;
        self
    }

    pub(super) fn validate(&self) -> Result<(), Error> {
        for (option, value) in [
            ("tolerance", self.tolerance),
            ("acceptable_tolerance", self.acceptable_tolerance),
            ("trust_radius", self.trust_radius),
            ("penalty", self.penalty),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::InvalidOption { option, value });
            }
        }
        Ok(())
    }
}
