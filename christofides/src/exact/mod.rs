//! Small instances solved to proof.

pub(crate) mod subsets;

use crate::error::Error;
use crate::metric::Metric;
use crate::tour::{Ends, Path, Tour};
use crate::validate::validate_finite;

/// The shortest tour.
///
/// # Errors
/// [`Error::TooManyVertices`], and distances that are not finite, symmetric and non-negative.
pub fn exact_tour(metric: &impl Metric) -> Result<Tour, Error> {
    validate_finite(metric)?;
    check_size(metric.len())?;
    let tour = Tour::measured(metric, subsets::tour(metric));
    let bound = tour.cost();
    Ok(tour.with_lower_bound(bound))
}

/// The shortest path with the given ends.
///
/// # Errors
/// As [`exact_tour`]; [`Error::VertexOutOfRange`] and [`Error::EqualEnds`].
pub fn exact_path(metric: &impl Metric, ends: Ends) -> Result<Path, Error> {
    validate_finite(metric)?;
    ends.validate(metric.len())?;
    check_size(metric.len())?;
    let path = Path::measured(metric, subsets::path(metric, ends));
    let bound = path.cost();
    Ok(path.with_lower_bound(bound))
}

fn check_size(n: usize) -> Result<(), Error> {
    if n > subsets::LIMIT { Err(Error::TooManyVertices { n, limit: subsets::LIMIT }) } else { Ok(()) }
}
