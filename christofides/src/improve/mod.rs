//! Local search.

mod pinned;
mod simple;

use crate::error::Error;
use crate::metric::Metric;
use crate::tour::{Ends, Path, Tour};
use pinned::Pinned;

/// Improves a tour by 2-opt and Or-opt until neither helps; never makes it longer.
///
/// # Errors
/// [`Error::DimensionMismatch`] if the tour has another number of vertices than the metric.
pub fn improve(metric: &impl Metric, tour: Tour) -> Result<Tour, Error> {
    let mut order = Tour::new(metric, tour.into_order())?.into_order();
    simple::improve(metric, &mut order);
    Ok(Tour::measured(metric, order))
}

/// Improves a path by 2-opt and Or-opt, its named ends fixed; never makes it longer.
///
/// # Errors
/// [`Error::VertexOutOfRange`], [`Error::EqualEnds`], or [`Error::NotAPermutation`] if the path has not the ends named.
pub fn improve_path(metric: &impl Metric, path: Path, ends: Ends) -> Result<Path, Error> {
    ends.validate(metric.len())?;
    let path = Path::new(metric, path.into_order())?;
    pinned::check_ends(path.order(), ends)?;
    let pinned = Pinned::new(metric, ends, path.cost());
    let mut order = pinned.close(path.into_order());
    simple::improve(&pinned, &mut order);
    Ok(Path::measured(metric, pinned.open(order)))
}
