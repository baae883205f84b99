//! Costs between the vertices of the search: targets `0..n`, then one vertex a vehicle for both ends of its route.

use crate::problem::{End, Problem};
use christofides::Metric;

/// The cost of going from one vertex to another, service at the second included.
pub(crate) trait Arcs {
    fn arc(&self, from: usize, to: usize) -> f64;
}

/// All arcs stored, row by row.
pub(crate) struct Stored {
    width: usize,
    matrix: Vec<f64>,
}

/// Arcs from the metric, for problems too large to store.
pub(crate) struct Computed<'a, M: Metric> {
    problem: &'a Problem<'a, M>,
}

/// Up to this many vertices all arcs are stored: 72 MB.
pub(crate) const STORED: usize = 3000;

impl Stored {
    pub fn new<M: Metric>(problem: &Problem<'_, M>) -> Self {
        let computed = Computed::new(problem);
        let width = problem.targets().len() + problem.vehicles();
        let mut matrix = Vec::with_capacity(width * width);
        for from in 0..width {
            matrix.extend((0..width).map(|to| computed.arc(from, to)));
        }
        Self { width, matrix }
    }
}

impl Arcs for Stored {
    #[inline(always)]
    fn arc(&self, from: usize, to: usize) -> f64 {
        self.matrix[from * self.width + to]
    }
}

impl<'a, M: Metric> Computed<'a, M> {
    pub fn new(problem: &'a Problem<'a, M>) -> Self {
        Self { problem }
    }
}

impl<M: Metric> Arcs for Computed<'_, M> {
    #[inline]
    fn arc(&self, from: usize, to: usize) -> f64 {
        let targets = self.problem.targets();
        let n = targets.len();
        if from >= n && to >= n {
            return 0.0; // a vehicle that stays at home
        }
        let start = if from < n { targets[from] } else { self.problem.start(from - n) };
        if to < n {
            let end = targets[to];
            return self.problem.metric().distance(start, end) + self.problem.service()[end];
        }
        match self.problem.end(to - n) {
            End::At(end) => self.problem.metric().distance(start, end),
            End::Open => 0.0,
        }
    }
}

/// The `count` nearest other targets of each target, nearest first, in one array.
pub(crate) struct Neighbours {
    count: usize,
    list: Vec<u32>,
}

impl Neighbours {
    /// O(n^2) distances.
    pub fn new<M: Metric>(problem: &Problem<'_, M>, count: usize) -> Self {
        let (targets, metric) = (problem.targets(), problem.metric());
        let n = targets.len();
        let count = count.min(n.saturating_sub(1));
        let mut list = Vec::with_capacity(n * count);
        let mut row: Vec<(f64, u32)> = Vec::with_capacity(n);
        for i in 0..n {
            row.clear();
            let distance = |j: usize| metric.distance(targets[i], targets[j]);
            row.extend((0..n).filter(|&j| j != i).map(|j| (distance(j), j as u32)));
            let by_distance = |a: &(f64, u32), b: &(f64, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
            if count > 0 && count < row.len() {
                row.select_nth_unstable_by(count - 1, by_distance);
                row.truncate(count);
            }
            row.sort_unstable_by(by_distance);
            list.extend(row.iter().map(|entry| entry.1));
        }
        Self { count, list }
    }

    #[inline(always)]
    pub fn of(&self, target: usize) -> &[u32] {
        &self.list[target * self.count..(target + 1) * self.count]
    }
}
