//! Storage that is kept from one solution to the next.

use crate::error::Error;
use crate::euler::Walk;
use crate::improve::{Effort, LocalSearch};
use crate::matching::Solver;
use crate::metric::{Geometry, Metric};
use crate::points::Points;
use crate::shortcut::Ring;
use crate::spanning_tree::{Prim, spanning_tree_into};
use crate::tour::Tour;

/// Euler walks that are shortcut, of which the shortest tour is kept.
///
/// The walks differ in the edges that they prefer at each vertex. Four make tours of 12, 100 and 1000 uniform points 1.6, 1.3 and 0.3 % shorter
/// than one.
const WALKS: usize = 4;

/// Above this number of vertices one walk must do: more gain less and less, and the local search wipes it out.
const SEVERAL_WALKS_UP_TO: usize = 1000;

/// Storage of [`christofides_with`](crate::christofides_with) and [`solve_with`](crate::solve_with).
///
/// Every buffer grows to the greatest need so far and stays. Up to 150 vertices Christofides' algorithm then allocates nothing;
/// above that the Delaunay triangulation and the k-d trees, which are rebuilt for new points, do. Of [`solve_with`](crate::solve_with)
/// the local search keeps its storage, but for a k-d tree; exact solution and lower bound allocate theirs.
///
/// # Examples
/// ```
/// use christofides::{Points, Workspace, christofides_with};
///
/// let mut workspace = Workspace::default();
/// for shift in 0..3 {
///     let targets = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0 + f64::from(shift)], [0.0, 1.0]];
///     let tour = christofides_with(&mut workspace, &Points(&targets))?;
///     assert_eq!(tour.order().len(), 4);
/// }
/// # Ok::<(), christofides::Error>(())
/// ```
#[derive(Debug, Default)]
pub struct Workspace {
    prim: Prim,
    /// The spanning tree, then also the matching.
    edges: Vec<[usize; 2]>,
    is_odd: Vec<bool>,
    odd: Vec<usize>,
    planar: Vec<[f64; 2]>,
    spatial: Vec<[f64; 3]>,
    matching: Solver,
    walk: Walk,
    ring: Ring,
    local: LocalSearch,
    shortest: Tour,
    pub(crate) tour: Tour,
}

impl Workspace {
    /// The steps of the algorithm; the bound holds only in a metric, a tour comes out of any symmetric distance.
    pub(crate) fn run(&mut self, metric: &impl Metric) -> Result<(), Error> {
        let n = metric.len();
        if n < 4 {
            self.tour.replace(metric, 0..n);
            return Ok(());
        }
        spanning_tree_into(metric, &mut self.prim, &mut self.edges);
        self.find_odd_vertices(n);
        self.add_matching(metric)?;
        self.shortcut_walk(metric, 0)?;
        let n_walks = if n <= SEVERAL_WALKS_UP_TO { WALKS } else { 1 };
        for k in 1..n_walks {
            std::mem::swap(&mut self.tour, &mut self.shortest);
            self.shortcut_walk(metric, k * self.edges.len() / n_walks)?;
            if self.shortest.cost() <= self.tour.cost() {
                std::mem::swap(&mut self.tour, &mut self.shortest);
            }
        }
        Ok(())
    }

    /// One Euler walk, shortcut; `first` is the edge to begin with.
    fn shortcut_walk(&mut self, metric: &impl Metric, first: usize) -> Result<(), Error> {
        self.walk.find(metric.len(), &self.edges, first)?;
        self.ring.shortcut(metric, self.walk.circuit())?;
        self.tour.replace(metric, self.ring.order(self.walk.circuit()));
        Ok(())
    }

    /// Shortens the tour.
    pub(crate) fn improve(&mut self, metric: &impl Metric, effort: Effort<'_>) {
        self.local.shorten(metric, &mut self.tour, effort);
    }

    fn find_odd_vertices(&mut self, n: usize) {
        self.is_odd.clear();
        self.is_odd.resize(n, false);
        for &vertex in self.edges.iter().flatten() {
            self.is_odd[vertex] ^= true;
        }
        self.odd.clear();
        self.odd.extend((0..n).filter(|&vertex| self.is_odd[vertex]));
    }

    fn add_matching(&mut self, metric: &impl Metric) -> Result<(), Error> {
        let odd = &self.odd;
        let named = |(i, j): (usize, usize)| [odd[i], odd[j]];
        match metric.geometry() {
            Geometry::Planar(points) => {
                self.planar.clear();
                self.planar.extend(odd.iter().map(|&v| points[v]));
                let pairs = self.matching.pairs_unchecked(&Points(&self.planar))?;
                self.edges.extend(pairs.map(named));
            }
            Geometry::Spatial(points) => {
                self.spatial.clear();
                self.spatial.extend(odd.iter().map(|&v| points[v]));
                let pairs = self.matching.pairs_unchecked(&Points(&self.spatial))?;
                self.edges.extend(pairs.map(named));
            }
            Geometry::Abstract => {
                let pairs = self.matching.pairs_unchecked(&Subset { metric, vertices: odd })?;
                self.edges.extend(pairs.map(named));
            }
        }
        Ok(())
    }
}

/// Some vertices of a metric.
struct Subset<'a, M> {
    metric: &'a M,
    vertices: &'a [usize],
}

impl<M: Metric> Metric for Subset<'_, M> {
    fn len(&self) -> usize {
        self.vertices.len()
    }

    #[inline]
    fn distance(&self, i: usize, j: usize) -> f64 {
        self.metric.distance(self.vertices[i], self.vertices[j])
    }
}
