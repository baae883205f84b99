//! Euclidean points as a metric.

use crate::metric::{Geometry, Metric};

/// Points of `D`-dimensional space under the Euclidean distance.
///
/// # Examples
/// ```
/// use christofides::{Metric, Points};
///
/// let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 4.0]];
/// assert_eq!(Points(&corners).distance(0, 2), 5.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Points<'a, const D: usize>(
    /// The points, one array of coordinates each.
    pub &'a [[f64; D]],
);

impl<const D: usize> Metric for Points<'_, D> {
    fn len(&self) -> usize {
        self.0.len()
    }

    #[inline]
    fn distance(&self, i: usize, j: usize) -> f64 {
        let (a, b) = (&self.0[i], &self.0[j]);
        let mut sum = 0.0;
        for k in 0..D {
            let difference = a[k] - b[k];
            sum += difference * difference;
        }
        sum.sqrt()
    }

    fn geometry(&self) -> Geometry<'_> {
        // The flat view and its chunks recover the concrete array type without a cast.
        match D {
            2 => Geometry::Planar(self.0.as_flattened().as_chunks::<2>().0),
            3 => Geometry::Spatial(self.0.as_flattened().as_chunks::<3>().0),
            _ => Geometry::Abstract,
        }
    }
}
