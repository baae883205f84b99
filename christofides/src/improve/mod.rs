//! Local search.

mod array_tour;
mod chain;
mod kick;
mod lin_kernighan;
mod neighbours;
mod pinned;

use crate::error::Error;
use crate::exact::subsets;
use crate::kd_tree::KdTree;
use crate::metric::{Geometry, Metric};
use crate::points::Points;
use crate::tour::{Ends, Path, Tour};
use chain::{Effort, chained};
use neighbours::Neighbours;
pub(crate) use pinned::Pinned;
#[cfg(test)]
pub(crate) use pinned::check_ends;

/// Neighbours in the lists of the local search: fewer make steps quicker and tours longer.
const NEIGHBOURS: usize = 8;

/// Below this number of vertices the subsets are searched: as quick, and exact.
const SEARCH_FROM: usize = 8;

/// Improves a tour by Lin-Kernighan moves until none helps; never makes it longer.
///
/// # Errors
/// [`Error::DimensionMismatch`] if the tour has another number of vertices than the metric.
pub fn improve(metric: &impl Metric, tour: Tour) -> Result<Tour, Error> {
    chained_improve(metric, tour, 0, 0, &mut || false)
}

/// Improves a path by Lin-Kernighan moves until none helps, its named ends fixed; never makes it longer.
///
/// # Errors
/// [`Error::VertexOutOfRange`], [`Error::EqualEnds`], or [`Error::NotAPermutation`] if the path has not the ends named.
pub fn improve_path(metric: &impl Metric, path: Path, ends: Ends) -> Result<Path, Error> {
    chained_improve_path(metric, path, ends, 0, 0, &mut || false)
}

/// Chained Lin-Kernighan on a tour: `kicks` local double bridges, each repaired and kept if the tour is no longer.
///
/// A tour whose cost is not finite is returned as it is. Deterministic by `seed`; `should_stop` is asked now and then and only cuts the same sequence short.
///
/// # Errors
/// As [`improve`].
pub fn chained_improve(
    metric: &impl Metric,
    tour: Tour,
    kicks: usize,
    seed: u64,
    should_stop: &mut dyn FnMut() -> bool,
) -> Result<Tour, Error> {
    let before = Tour::new(metric, tour.into_order())?;
    if !before.cost().is_finite() {
        return Ok(before);
    }
    let effort = Effort { kicks, seed, should_stop };
    let after = Tour::measured(metric, search(metric, before.order(), effort));
    Ok(if after.cost() < before.cost() { after } else { before })
}

/// Chained Lin-Kernighan on a path, its named ends fixed; see [`chained_improve`].
///
/// # Errors
/// As [`improve_path`].
pub fn chained_improve_path(
    metric: &impl Metric,
    path: Path,
    ends: Ends,
    kicks: usize,
    seed: u64,
    should_stop: &mut dyn FnMut() -> bool,
) -> Result<Path, Error> {
    ends.validate(metric.len())?;
    let before = Path::new(metric, path.into_order())?;
    pinned::check_ends(before.order(), ends)?;
    if metric.len() < 3 || !before.cost().is_finite() {
        return Ok(before);
    }
    let pinned = Pinned::new(metric, ends, before.cost());
    let closed = pinned.close(before.order().to_vec());
    let effort = Effort { kicks, seed, should_stop };
    let order = if closed.len() < SEARCH_FROM {
        subsets::tour(&pinned)
    } else {
        let has_free_end = !matches!(ends, Ends::Both(..));
        let neighbours = Neighbours::nearest(metric, NEIGHBOURS).with_joint(has_free_end);
        widen(&chained(&pinned, &neighbours, narrow(&closed), effort))
    };
    let after = Path::measured(metric, pinned.open(order));
    Ok(if after.cost() < before.cost() { after } else { before })
}

/// Points are renumbered in the order of a k-d tree, so that near vertices are near in memory.
fn search(metric: &impl Metric, order: &[usize], effort: Effort<'_>) -> Vec<usize> {
    if order.len() < SEARCH_FROM {
        return subsets::tour(metric);
    }
    match metric.geometry() {
        Geometry::Planar(points) => search_points(points, order, effort),
        Geometry::Spatial(points) => search_points(points, order, effort),
        Geometry::Abstract => {
            let neighbours = Neighbours::nearest(metric, NEIGHBOURS);
            widen(&chained(metric, &neighbours, narrow(order), effort))
        }
    }
}

fn search_points<const D: usize>(points: &[[f64; D]], order: &[usize], effort: Effort<'_>) -> Vec<usize> {
    let tree = KdTree::new(points);
    let mut number = vec![0; points.len()];
    for (k, &v) in tree.order.iter().enumerate() {
        number[v as usize] = k as u32;
    }
    let metric = Points(&tree.points);
    let neighbours = Neighbours::nearest(&metric, NEIGHBOURS);
    let renumbered = order.iter().map(|&v| number[v]).collect();
    let improved = chained(&metric, &neighbours, renumbered, effort);
    improved.into_iter().map(|k| tree.order[k as usize] as usize).collect()
}

fn narrow(order: &[usize]) -> Vec<u32> {
    order.iter().map(|&v| v as u32).collect()
}

fn widen(order: &[u32]) -> Vec<usize> {
    order.iter().map(|&v| v as usize).collect()
}
