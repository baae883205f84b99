//! Minimum spanning trees.

mod boruvka;
mod kruskal;
mod prim;

use crate::error::Error;
use crate::metric::{Geometry, Metric};
use crate::validate::validate_finite;
pub(crate) use boruvka::boruvka;
pub(crate) use prim::Prim;

/// Up to this number of points the quadratic algorithm is the quickest.
const DENSE_UP_TO: usize = 150;

/// A minimum spanning tree of the complete graph of a metric: `n - 1` edges.
///
/// Points of the plane by Kruskal's algorithm (1956) on the Delaunay triangulation, points of space by Boruvka's
/// (1926) over a k-d tree, everything else (and few points) by Prim's (1957) without a heap.
///
/// # Errors
/// Distances that are not finite, symmetric and non-negative.
///
/// # Complexity
/// `O(n log n)` time for points of the plane, typically also of space; `O(n^2)` for other metrics; `O(n)` memory.
///
/// # Examples
/// ```
/// use christofides::{Points, minimum_spanning_tree};
///
/// let tree = minimum_spanning_tree(&Points(&[[0.0, 0.0], [5.0, 0.0], [1.0, 0.0]]))?;
/// assert_eq!(tree.len(), 2);
/// # Ok::<(), christofides::Error>(())
/// ```
pub fn minimum_spanning_tree(metric: &impl Metric) -> Result<Vec<[usize; 2]>, Error> {
    validate_finite(metric)?;
    Ok(spanning_tree(metric))
}

pub(crate) fn spanning_tree(metric: &impl Metric) -> Vec<[usize; 2]> {
    let mut tree = Vec::with_capacity(metric.len().saturating_sub(1));
    spanning_tree_into(metric, &mut Prim::default(), &mut tree);
    tree
}

/// The same in given storage; only the algorithms of points allocate.
pub(crate) fn spanning_tree_into(metric: &impl Metric, prim: &mut Prim, tree: &mut Vec<[usize; 2]>) {
    tree.clear();
    match metric.geometry() {
        Geometry::Planar(points) if points.len() > DENSE_UP_TO => tree.extend(kruskal::kruskal(points)),
        Geometry::Spatial(points) if points.len() > DENSE_UP_TO => {
            tree.extend(boruvka(points, &vec![0.0; points.len()]));
        }
        _ => prim.tree(metric, tree),
    }
}

#[cfg(test)]
mod tests {
    use super::{Prim, boruvka, kruskal::kruskal};
    use crate::metric::Metric;
    use crate::points::Points;
    use proptest::prelude::*;

    fn weight(points: &[[f64; 2]], tree: &[[usize; 2]]) -> f64 {
        tree.iter().map(|&[u, v]| Points(points).distance(u, v)).sum()
    }

    fn points() -> impl Strategy<Value = Vec<[f64; 2]>> {
        let real = prop::collection::vec([-1e3..1e3, -1e3..1e3], 0..120);
        let grid = prop::collection::vec([0..9i32, 0..9i32].prop_map(|p| p.map(f64::from)), 0..120);
        let line =
            prop::collection::vec((-99..99i32).prop_map(|x| [f64::from(x), 2.0 * f64::from(x)]), 0..120);
        prop_oneof![real, grid, line]
    }

    proptest! {
        #[test]
        fn three_algorithms_agree(points in points()) {
            let mut dense = Vec::new();
            Prim::default().tree(&Points(&points), &mut dense);
            for tree in [kruskal(&points), boruvka(&points, &vec![0.0; points.len()])] {
                prop_assert_eq!(tree.len(), dense.len());
                prop_assert!((weight(&points, &tree) - weight(&points, &dense)).abs() <= 1e-9 * weight(&points, &dense));
            }
        }
    }
}
