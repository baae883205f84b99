//! The Held-Karp lower bound.

mod dense;

use crate::error::Error;
use crate::metric::Metric;
use crate::validate::validate_finite;

/// A proven lower bound on the cost of every tour.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use]
pub struct LowerBound {
    pub(crate) value: f64,
    pub(crate) multipliers: Vec<f64>,
}

impl LowerBound {
    /// The bound, rounded down.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.value
    }

    /// The multiplier of every vertex; the bound is the least 1-tree under `distance(i, j) + multipliers[i] + multipliers[j]`
    /// less twice their sum.
    #[must_use]
    pub fn multipliers(&self) -> &[f64] {
        &self.multipliers
    }
}

/// Held-Karp bound by subgradient ascent on 1-trees (Held and Karp 1970, 1971).
///
/// # Errors
/// Distances that are not finite, symmetric and non-negative.
pub fn held_karp(metric: &impl Metric, iterations: usize) -> Result<LowerBound, Error> {
    validate_finite(metric)?;
    Ok(dense::ascend(metric, iterations))
}
