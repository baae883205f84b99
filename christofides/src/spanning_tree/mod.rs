//! Minimum spanning trees.

mod prim;

use crate::error::Error;
use crate::metric::Metric;
use crate::validate::validate_finite;

/// A minimum spanning tree of the complete graph of a metric: `n - 1` edges.
///
/// # Errors
/// Distances that are not finite, symmetric and non-negative.
pub fn minimum_spanning_tree(metric: &impl Metric) -> Result<Vec<[usize; 2]>, Error> {
    validate_finite(metric)?;
    Ok(spanning_tree(metric))
}

pub(crate) fn spanning_tree(metric: &impl Metric) -> Vec<[usize; 2]> {
    prim::prim(metric)
}
