//! Short lists of near vertices, with their distances.

use crate::kd_tree::KdTree;
use crate::metric::{Geometry, Metric};

/// Neighbours of a point in each quadrant that are taken before nearer ones in others.
const PER_QUADRANT: usize = 2;

/// For every vertex its nearest ones, nearest first.
#[derive(Debug, Clone, Default)]
pub(crate) struct Neighbours {
    start: Vec<u32>,
    entries: Vec<(f64, u32)>,
    row: Vec<(f64, u32)>,
    stack: Vec<(f64, u32)>,
    chosen: Vec<u32>,
}

impl Neighbours {
    /// Lists the `k` nearest of every vertex; `O(n log n)` for points, else `O(n^2)`.
    pub fn fill(&mut self, metric: &impl Metric, k: usize) {
        let n = metric.len();
        let k = k.min(n.saturating_sub(1));
        self.start.clear();
        self.start.extend((0..=n).map(|v| (v * k) as u32));
        match metric.positions() {
            Geometry::Planar(points) => self.fill_near(metric, &KdTree::new(points), k),
            Geometry::Spatial(points) => self.fill_near(metric, &KdTree::new(points), k),
            Geometry::Abstract => self.fill_by_pairs(metric, k),
        }
    }

    /// Of the three times as many nearest ones that are looked at, up to two in each quadrant come first, so that a vertex
    /// at the edge of a cluster has neighbours on both sides.
    fn fill_near<const D: usize>(&mut self, metric: &impl Metric, tree: &KdTree<D>, k: usize) {
        let Neighbours { entries, row: found, stack, chosen, .. } = self;
        entries.resize(tree.order.len() * k, (0.0, 0));
        for (position, &index) in tree.order.iter().enumerate() {
            tree.nearest(position, 3 * k, found, stack);
            chosen.clear();
            let mut in_quadrant = [0; 4];
            let quadrant = |other: u32| {
                let (a, b) = (&tree.points[position], &tree.points[other as usize]);
                usize::from(b[0] > a[0]) + 2 * usize::from(b[1] > a[1])
            };
            found.retain(|&(_, other)| {
                let count = &mut in_quadrant[quadrant(other)];
                *count += 1;
                let is_chosen = *count <= PER_QUADRANT && chosen.len() < k;
                chosen.extend(is_chosen.then_some(other));
                !is_chosen
            });
            chosen.extend(found.iter().map(|&(_, other)| other).take(k - chosen.len()));
            let row = &mut entries[index as usize * k..][..k];
            for (slot, &other) in row.iter_mut().zip(&*chosen) {
                let neighbour = tree.order[other as usize];
                *slot = (metric.distance(index as usize, neighbour as usize), neighbour);
            }
            row.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        }
    }

    fn fill_by_pairs(&mut self, metric: &impl Metric, k: usize) {
        let n = metric.len();
        let Neighbours { entries, row, .. } = self;
        entries.clear();
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
