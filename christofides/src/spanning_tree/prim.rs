//! Prim's algorithm on the complete graph, without a heap.

use crate::metric::Metric;

/// Storage of the algorithm: the vertices outside the tree, each with its nearest vertex inside.
#[derive(Debug, Clone, Default)]
pub(crate) struct Prim {
    vertex: Vec<u32>,
    nearest: Vec<u32>,
    cost: Vec<f64>,
}

impl Prim {
    /// Appends the tree that grows from vertex 0 by its nearest outside vertex (Prim 1957); `O(n^2)` time, `O(n)` memory.
    pub fn tree(&mut self, metric: &impl Metric, tree: &mut Vec<[usize; 2]>) {
        self.run(metric.len(), |u, v| metric.distance(u, v), |from, to, _| tree.push([from, to]));
    }

    /// Calls `add` with every edge of a minimum spanning tree on `0..n` and its cost; vertices are named in the order in
    /// which they join.
    #[inline]
    pub fn run(
        &mut self,
        n: usize,
        cost: impl Fn(usize, usize) -> f64,
        mut add: impl FnMut(usize, usize, f64),
    ) {
        if n < 2 {
            return;
        }
        self.vertex.clear();
        self.vertex.extend(1..n as u32);
        self.nearest.clear();
        self.nearest.resize(n - 1, 0);
        self.cost.clear();
        self.cost.extend((1..n).map(|v| cost(0, v)));
        // The smallest entry is found in the same pass that updates the entries.
        let mut best = least(&self.cost);
        loop {
            let added = self.vertex.swap_remove(best) as usize;
            let from = self.nearest.swap_remove(best) as usize;
            add(from, added, self.cost.swap_remove(best));
            if self.vertex.is_empty() {
                return;
            }
            let mut smallest = f64::INFINITY;
            best = 0;
            let entries = self.vertex.iter().zip(&mut self.nearest).zip(&mut self.cost);
            for (k, ((&v, nearest), least)) in entries.enumerate() {
                let candidate = cost(added, v as usize);
                if candidate < *least {
                    *least = candidate;
                    *nearest = added as u32;
                }
                if *least < smallest {
                    smallest = *least;
                    best = k;
                }
            }
        }
    }
}

fn least(costs: &[f64]) -> usize {
    (0..costs.len()).fold(0, |a, b| if costs[b] < costs[a] { b } else { a })
}
