//! What a tour is measured by: a symmetric, non-negative distance that obeys the triangle inequality.

/// The points behind a metric, if its distance is the Euclidean distance between points.
///
/// Algorithms use them to look at few of the `n (n - 1) / 2` pairs; what they return does not depend on it.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Geometry<'a> {
    /// Points of the plane.
    Planar(&'a [[f64; 2]]),
    /// Points of space.
    Spatial(&'a [[f64; 3]]),
    /// No coordinates: algorithms look at every pair.
    Abstract,
}

/// A finite metric space over the vertices `0..len()`.
///
/// Implementors promise `distance(i, i) = 0`, symmetry, non-negativity and, unless [`is_metric`](Metric::is_metric)
/// says otherwise, the triangle inequality; the bounds of this crate hold only then. Open trait: implement it for your
/// own data, and see [`validate`](crate::validate) for a check of the promise.
pub trait Metric {
    /// The number of vertices.
    fn len(&self) -> usize;

    /// Whether there is no vertex at all.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The distance from vertex `i` to vertex `j`.
    ///
    /// # Panics
    /// May panic if `i` or `j` is not below [`len`](Metric::len).
    fn distance(&self, i: usize, j: usize) -> f64;

    /// Whether the implementor promises the triangle inequality.
    ///
    /// Where this is `false`, an algorithm whose bound needs a metric first checks every triangle and refuses what
    /// fails; the others (improvement, lower bound, exact solution) take any symmetric distance.
    fn is_metric(&self) -> bool {
        true
    }

    /// The points whose Euclidean distance [`distance`](Metric::distance) is.
    ///
    /// To return anything but [`Geometry::Abstract`] is to promise that `distance` is the Euclidean one up to rounding.
    fn geometry(&self) -> Geometry<'_> {
        Geometry::Abstract
    }

    /// Points that are near to each other where distances are short; a hint for the local search alone.
    ///
    /// Rounded Euclidean distances are no [`geometry`](Metric::geometry), but have positions.
    fn positions(&self) -> Geometry<'_> {
        self.geometry()
    }
}

impl<M: Metric + ?Sized> Metric for &M {
    fn len(&self) -> usize {
        (**self).len()
    }

    #[inline]
    fn distance(&self, i: usize, j: usize) -> f64 {
        (**self).distance(i, j)
    }

    fn is_metric(&self) -> bool {
        (**self).is_metric()
    }

    fn geometry(&self) -> Geometry<'_> {
        (**self).geometry()
    }

    fn positions(&self) -> Geometry<'_> {
        (**self).positions()
    }
}
