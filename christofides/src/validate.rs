//! Checks of what a metric promises.

use crate::error::Error;
use crate::metric::{Geometry, Metric};

/// Relative excess over a triangle's two other sides that counts as rounding.
///
/// Two additions and a square root leave less than four units in the last place of the larger side.
const TRIANGLE_TOLERANCE: f64 = 1e-12;

/// Most vertices that are taken: their numbers, doubled and with those of blossoms, fit 32 bits.
const MOST_VERTICES: usize = 1 << 30;

/// Refuses more vertices than can be numbered.
pub(crate) fn check_count(n: usize) -> Result<(), Error> {
    if n > MOST_VERTICES { Err(Error::TooManyVertices { n, limit: MOST_VERTICES }) } else { Ok(()) }
}

/// Checks every promise of a metric: finite, symmetric, non-negative, zero from a vertex to itself, triangle inequality.
///
/// # Errors
/// The first violation in lexicographic order, with its indices; [`Error::TooManyVertices`] above 2^30.
///
/// # Complexity
/// `O(n^3)` time for distances without coordinates, `O(n)` for points, whose distance cannot break a promise. Allocates nothing.
/// It cannot be interrupted.
pub fn validate(metric: &impl Metric) -> Result<(), Error> {
    if !matches!(metric.geometry(), Geometry::Abstract) {
        return validate_finite(metric);
    }
    validate_symmetric(metric)?;
    validate_triangles(metric)
}

/// Refuses coordinates and distances that are not finite, and negative distances; `O(n)` for points, else `O(n^2)`.
pub(crate) fn validate_finite(metric: &impl Metric) -> Result<(), Error> {
    match metric.geometry() {
        Geometry::Planar(points) => validate_points(points),
        Geometry::Spatial(points) => validate_points(points),
        Geometry::Abstract => validate_symmetric(metric),
    }
}

/// What an algorithm asks whose bound needs the triangle inequality.
pub(crate) fn validate_promised(metric: &impl Metric) -> Result<(), Error> {
    validate_finite(metric)?;
    if metric.is_metric() { Ok(()) } else { validate_triangles(metric) }
}

fn validate_points<const D: usize>(points: &[[f64; D]]) -> Result<(), Error> {
    check_count(points.len())?;
    let mut extent = [[f64::INFINITY, f64::NEG_INFINITY]; D];
    for (point, coordinates) in points.iter().enumerate() {
        for (axis, &x) in coordinates.iter().enumerate() {
            if !x.is_finite() {
                return Err(Error::NonFiniteCoordinate { point, axis });
            }
            extent[axis] = [extent[axis][0].min(x), extent[axis][1].max(x)];
        }
    }
    let squares: f64 = extent.iter().map(|[low, high]| (high - low).powi(2)).sum();
    let fits = points.is_empty() || (squares * (points.len() as f64 + 1.0).powi(2)).is_finite();
    if fits { Ok(()) } else { Err(Error::Overflow) }
}

/// Checks finiteness, symmetry, signs and the diagonal of every pair.
pub(crate) fn validate_symmetric(metric: &impl Metric) -> Result<(), Error> {
    let n = metric.len();
    check_count(n)?;
    let mut greatest = 0.0_f64;
    for i in 0..n {
        if metric.distance(i, i) != 0.0 {
            return Err(Error::NonZeroDiagonal { i });
        }
        for j in i + 1..n {
            let there = metric.distance(i, j);
            if !there.is_finite() {
                return Err(Error::NonFiniteDistance { i, j });
            }
            if there < 0.0 {
                return Err(Error::NegativeDistance { i, j });
            }
            if there != metric.distance(j, i) {
                return Err(Error::Asymmetric { i, j });
            }
            greatest = greatest.max(there);
        }
    }
    if (greatest * (n as f64 + 1.0)).is_finite() { Ok(()) } else { Err(Error::Overflow) }
}

/// Checks every triangle of a symmetric distance.
pub(crate) fn validate_triangles(metric: &impl Metric) -> Result<(), Error> {
    let n = metric.len();
    for i in 0..n {
        for j in i + 1..n {
            let direct = metric.distance(i, j) * (1.0 - TRIANGLE_TOLERANCE);
            let shorter = |&via: &usize| metric.distance(i, via) + metric.distance(via, j) < direct;
            if let Some(via) = (0..n).find(shorter) {
                return Err(Error::TriangleInequality { i, j, via });
            }
        }
    }
    Ok(())
}
