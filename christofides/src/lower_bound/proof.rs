//! The least 1-tree of the complete graph: what makes a value a bound.

use crate::metric::{Geometry, Metric};
use crate::spanning_tree::{Prim, boruvka};

/// Up to this number of vertices all pairs are looked at.
const DENSE_UP_TO: usize = 3000;

/// The least 1-tree of the complete graph with the last vertex outside the tree.
pub(crate) struct Proof {
    /// Its cost less twice the multipliers, rounded down: a lower bound on every tour.
    pub value: f64,
    /// Its edges.
    pub edges: Vec<(u32, u32)>,
}

impl Proof {
    /// `O(n^2)`, or `O(n log n)` typically for many points.
    pub fn new(metric: &impl Metric, pi: &[f64]) -> Self {
        let inner = metric.len() - 1;
        let cost = |u: usize, v: usize| metric.distance(u, v) + pi[u] + pi[v];
        let mut edges = match metric.geometry() {
            Geometry::Planar(points) if inner > DENSE_UP_TO => boruvka(&points[..inner], &pi[..inner]),
            Geometry::Spatial(points) if inner > DENSE_UP_TO => boruvka(&points[..inner], &pi[..inner]),
            _ => {
                let mut edges = Vec::with_capacity(inner + 1);
                Prim::default().run(inner, cost, |from, to, _| edges.push([from, to]));
                edges
            }
        };
        let mut two = [0, 1];
        if cost(inner, 1) < cost(inner, 0) {
            two = [1, 0];
        }
        for v in 2..inner {
            if cost(inner, v) < cost(inner, two[0]) {
                two = [v, two[0]];
            } else if cost(inner, v) < cost(inner, two[1]) {
                two[1] = v;
            }
        }
        edges.extend(two.map(|v| [v, inner]));
        let total: f64 = edges.iter().map(|&[u, v]| cost(u, v)).sum();
        let value = total - 2.0 * pi.iter().sum::<f64>() - rounding(metric, pi, &edges);
        Proof { value, edges: edges.iter().map(|&[u, v]| (u as u32, v as u32)).collect() }
    }
}

/// What the sums may have lost: one unit in the last place of the magnitude per addition, and of every edge.
fn rounding(metric: &impl Metric, pi: &[f64], edges: &[[usize; 2]]) -> f64 {
    let lengths: f64 = edges.iter().map(|&[u, v]| metric.distance(u, v) + pi[u].abs() + pi[v].abs()).sum();
    let magnitude = lengths + 2.0 * pi.iter().map(|p| p.abs()).sum::<f64>();
    magnitude * (pi.len() as f64 + 8.0) * f64::EPSILON
}
