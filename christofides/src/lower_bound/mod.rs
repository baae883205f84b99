//! The Held-Karp lower bound.

mod ascent;
mod one_tree;
mod proof;

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

/// The Held-Karp bound by subgradient ascent on 1-trees (Held and Karp 1970, 1971; steps of Volgenant and Jonker 1982).
///
/// A 1-tree is a spanning tree of all vertices but one, and two edges at that one; every tour is a 1-tree, and adding a
/// multiplier to all edges of a vertex changes all tours by the same amount. The ascent looks at candidate edges only; the
/// value returned is that of the least 1-tree of the complete graph under the final multipliers, rounded down.
///
/// # Arguments
/// `iterations`: 1-trees of the ascent; about 1000 come within 1e-4 of the limit.
///
/// # Errors
/// Distances that are not finite, symmetric and non-negative.
///
/// # Complexity
/// `O(n log n)` per iteration for points and large instances, `O(n^2)` per iteration for small ones.
///
/// # Examples
/// ```
/// use christofides::{Points, exact_tour, held_karp};
///
/// let points = [[0.0, 0.0], [4.0, 1.0], [5.0, 3.0], [1.0, 4.0], [2.0, 2.0]];
/// let bound = held_karp(&Points(&points), 200)?;
/// let optimum = exact_tour(&Points(&points))?.cost();
/// assert!(bound.value() <= optimum && optimum < 1.01 * bound.value());
/// # Ok::<(), christofides::Error>(())
/// ```
pub fn held_karp(metric: &impl Metric, iterations: usize) -> Result<LowerBound, Error> {
    validate_finite(metric)?;
    let mut bound = bound(metric, iterations, &mut || false);
    bound.value = bound.value.max(0.0);
    Ok(bound)
}

pub(crate) fn bound(
    metric: &impl Metric,
    iterations: usize,
    should_stop: &mut dyn FnMut() -> bool,
) -> LowerBound {
    let n = metric.len();
    if n < 3 {
        let value = if n == 2 { 2.0 * metric.distance(0, 1) } else { 0.0 };
        return LowerBound { value, multipliers: vec![0.0; n] };
    }
    ascent::ascend(metric, iterations, should_stop)
}
