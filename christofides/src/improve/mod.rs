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
use chain::Chain;
pub(crate) use chain::Effort;
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
    let mut tour = Tour::new(metric, tour.into_order())?;
    LocalSearch::default().shorten(metric, &mut tour, Effort { kicks, seed, should_stop });
    Ok(tour)
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
        let mut neighbours = Neighbours::default();
        neighbours.fill(metric, NEIGHBOURS);
        let mut chain = Chain::default();
        chain.arrays.tour.load(closed.iter().map(|&v| v as u32));
        chain.run(&pinned, &neighbours.with_joint(has_free_end), effort);
        chain.arrays.tour.order().iter().map(|&v| v as usize).collect()
    };
    let after = Path::measured(metric, pinned.open(order));
    Ok(if after.cost() < before.cost() { after } else { before })
}

/// Storage of the local search on tours.
#[derive(Debug, Default)]
pub(crate) struct LocalSearch {
    neighbours: Neighbours,
    chain: Chain,
    /// New numbers of the vertices.
    number: Vec<u32>,
    after: Tour,
}

impl LocalSearch {
    /// Improves a measured tour; one whose cost is not finite is left as it is.
    pub fn shorten(&mut self, metric: &impl Metric, tour: &mut Tour, effort: Effort<'_>) {
        if !tour.cost().is_finite() {
            return;
        }
        if metric.len() < SEARCH_FROM {
            self.after.replace(metric, subsets::tour(metric).into_iter());
        } else {
            match metric.geometry() {
                Geometry::Planar(points) => self.search_points(metric, points, tour, effort),
                Geometry::Spatial(points) => self.search_points(metric, points, tour, effort),
                Geometry::Abstract => self.search(metric, tour, effort),
            }
        }
        if self.after.cost() < tour.cost() {
            std::mem::swap(tour, &mut self.after);
        }
    }

    fn search(&mut self, metric: &impl Metric, tour: &Tour, effort: Effort<'_>) {
        self.neighbours.fill(metric, NEIGHBOURS);
        self.chain.arrays.tour.load(tour.order().iter().map(|&v| v as u32));
        self.chain.run(metric, &self.neighbours, effort);
        self.after.replace(metric, self.chain.arrays.tour.order().iter().map(|&v| v as usize));
    }

    /// Points are renumbered in the order of a k-d tree, so that near vertices are near in memory.
    fn search_points<const D: usize>(
        &mut self,
        metric: &impl Metric,
        points: &[[f64; D]],
        tour: &Tour,
        effort: Effort<'_>,
    ) {
        let tree = KdTree::new(points);
        self.number.resize(points.len(), 0);
        for (k, &v) in tree.order.iter().enumerate() {
            self.number[v as usize] = k as u32;
        }
        let renumbered = Points(&tree.points);
        self.neighbours.fill(&renumbered, NEIGHBOURS);
        self.chain.arrays.tour.load(tour.order().iter().map(|&v| self.number[v]));
        self.chain.run(&renumbered, &self.neighbours, effort);
        let order = self.chain.arrays.tour.order();
        self.after.replace(metric, order.iter().map(|&k| tree.order[k as usize] as usize));
    }
}
