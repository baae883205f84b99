//! Sparse graphs in which matchings and 1-trees are searched first.

use crate::delaunay::delaunay_edges;
use crate::kd_tree::KdTree;
use crate::metric::{Geometry, Metric};

/// Up to this size the complete graph is searched at once: cheaper than to price it.
const COMPLETE_UP_TO: usize = 12;

/// Neighbours of a point of the plane in addition to the Delaunay edges.
const PLANAR_NEIGHBOURS: usize = 5;

/// Neighbours where there is no Delaunay triangulation.
const NEIGHBOURS: usize = 10;

/// Up to this number of vertices all pairs are looked at, also of points.
pub(crate) const DENSE_UP_TO: usize = 150;

/// Storage of candidate edges.
#[derive(Debug, Default)]
pub(crate) struct Candidates {
    edges: Vec<(u32, u32)>,
    row: Vec<(f64, u32)>,
}

impl Candidates {
    /// Edges among which most of an optimal matching is likely to be found, each once; they contain a perfect matching.
    ///
    /// `O(n log n)` for points, `O(n^2)` for other metrics.
    pub fn for_matching(&mut self, metric: &impl Metric) -> &[(u32, u32)] {
        let n = metric.len();
        self.edges.clear();
        if n <= COMPLETE_UP_TO {
            self.edges.extend((0..n as u32).flat_map(|i| (i + 1..n as u32).map(move |j| (i, j))));
            return &self.edges;
        }
        if n <= DENSE_UP_TO {
            abstract_neighbours(metric, &mut self.row, &mut self.edges);
        } else {
            self.edges.extend(near_edges(metric));
        }
        for edge in &mut self.edges {
            *edge = (edge.0.min(edge.1), edge.0.max(edge.1));
        }
        self.edges.sort_unstable();
        self.edges.dedup();
        &self.edges
    }
}

/// Edges between near vertices that join all of them; some may occur twice.
pub(crate) fn near_edges(metric: &impl Metric) -> Vec<(u32, u32)> {
    match metric.geometry() {
        Geometry::Planar(points) => {
            let mut edges = delaunay_edges(points);
            add_neighbours(points, PLANAR_NEIGHBOURS, &mut edges);
            edges
        }
        Geometry::Spatial(points) => {
            let mut edges = Vec::new();
            add_neighbours(points, NEIGHBOURS, &mut edges);
            edges
        }
        Geometry::Abstract => {
            let mut edges = Vec::new();
            abstract_neighbours(metric, &mut Vec::new(), &mut edges);
            edges
        }
    }
}

/// The nearest neighbours of each point, and a path through all of them, which contains a perfect matching.
fn add_neighbours<const D: usize>(points: &[[f64; D]], k: usize, edges: &mut Vec<(u32, u32)>) {
    let tree = KdTree::new(points);
    let (mut found, mut stack) = (Vec::new(), Vec::new());
    for (position, &index) in tree.order.iter().enumerate() {
        tree.nearest(position, k, &mut found, &mut stack);
        edges.extend(found.iter().map(|&(_, other)| (index, tree.order[other as usize])));
    }
    edges.extend(tree.order.windows(2).map(|pair| (pair[0], pair[1])));
}

fn abstract_neighbours(metric: &impl Metric, row: &mut Vec<(f64, u32)>, edges: &mut Vec<(u32, u32)>) {
    let n = metric.len();
    edges.extend((1..n as u32).map(|j| (j - 1, j)));
    for i in 0..n {
        row.clear();
        row.extend((0..n).filter(|&j| j != i).map(|j| (metric.distance(i, j), j as u32)));
        let k = NEIGHBOURS.min(row.len());
        row.select_nth_unstable_by(k - 1, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        edges.extend(row[..k].iter().map(|&(_, j)| (i as u32, j)));
    }
}
