//! Short lists of near vertices, with their distances.

use crate::kd_tree::KdTree;
use crate::metric::{Geometry, Metric};

/// For every vertex its nearest ones, nearest first.
#[derive(Debug, Clone, Default)]
pub(crate) struct Neighbours {
    start: Vec<u32>,
    entries: Vec<(f64, u32)>,
}

impl Neighbours {
    /// The `k` nearest of every vertex; `O(n log n)` for points, else `O(n^2)`.
    pub fn nearest(metric: &impl Metric, k: usize) -> Self {
        match metric.geometry() {
            Geometry::Planar(points) => Self::of_points(points, k),
            Geometry::Spatial(points) => Self::of_points(points, k),
            Geometry::Abstract => Self::by_pairs(metric, k),
        }
    }

    fn of_points<const D: usize>(points: &[[f64; D]], k: usize) -> Self {
        let tree = KdTree::new(points);
        let k = k.min(points.len().saturating_sub(1));
        let mut entries = vec![(0.0, 0); points.len() * k];
        let (mut found, mut stack) = (Vec::new(), Vec::new());
        for (position, &index) in tree.order.iter().enumerate() {
            tree.nearest(position, k, &mut found, &mut stack);
            let row = &mut entries[index as usize * k..][..k];
            for (slot, &(squared, other)) in row.iter_mut().zip(&found) {
                *slot = (squared.sqrt(), tree.order[other as usize]);
            }
        }
        Self { start: (0..=points.len()).map(|v| (v * k) as u32).collect(), entries }
    }

    fn by_pairs(metric: &impl Metric, k: usize) -> Self {
        let n = metric.len();
        let k = k.min(n.saturating_sub(1));
        let mut entries = Vec::with_capacity(n * k);
        let mut row: Vec<(f64, u32)> = Vec::with_capacity(n);
        let order = |a: &(f64, u32), b: &(f64, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
        for i in 0..n {
            row.clear();
            row.extend((0..n).filter(|&j| j != i).map(|j| (metric.distance(i, j), j as u32)));
            if k > 0 && k < row.len() {
                row.select_nth_unstable_by(k - 1, order);
            }
            row[..k].sort_unstable_by(order);
            entries.extend(&row[..k]);
        }
        Self { start: (0..=n).map(|v| (v * k) as u32).collect(), entries }
    }

    /// Adds the joint of a path (see [`Pinned`](super::pinned::Pinned)): a neighbour of every vertex at distance zero if
    /// an end is free.
    pub fn with_joint(self, is_near_all: bool) -> Self {
        let n = self.start.len() - 1;
        let mut joined = Neighbours::default();
        for v in 0..n as u32 {
            joined.start.push(joined.entries.len() as u32);
            joined.entries.extend(is_near_all.then_some((0.0, n as u32)));
            joined.entries.extend(self.of(v));
        }
        joined.start.extend([joined.entries.len() as u32; 2]);
        joined
    }

    #[inline]
    pub fn of(&self, v: u32) -> &[(f64, u32)] {
        &self.entries[self.start[v as usize] as usize..self.start[v as usize + 1] as usize]
    }
}
