//! Subgradient ascent on candidate edges, repeated with the edges that the complete graph adds.

use super::LowerBound;
use super::one_tree::{CandidateGraph, OneTree};
use super::proof::Proof;
use crate::candidates::near_edges;
use crate::metric::Metric;
use crate::spanning_tree::spanning_tree;

/// Relative difference between the values on candidates and on the complete graph that is not worth another ascent.
const LOSS: f64 = 1e-6;

/// Ascents at most; later ones are shorter and start from smaller steps.
const ROUNDS: usize = 4;

/// Iterations between two questions whether to stop.
const PATIENCE: usize = 16;

/// The ascent; the value is that of the complete graph.
pub(crate) fn ascend(
    metric: &impl Metric,
    iterations: usize,
    should_stop: &mut dyn FnMut() -> bool,
) -> LowerBound {
    let n = metric.len();
    let mut edges = near_edges(metric);
    let tree = spanning_tree(metric);
    edges.extend(tree.iter().map(|&[u, v]| (u as u32, v as u32)));
    let span: f64 = tree.iter().map(|&[u, v]| metric.distance(u, v).max(0.0)).sum();
    let mut best = LowerBound { value: 0.0, multipliers: vec![0.0; n] };
    let first = Proof::new(metric, &best.multipliers);
    best.value = first.value;
    edges.extend(&first.edges);
    let mut ascent = Ascent::new(n, span / (2.0 * n as f64));
    for round in 0..ROUNDS {
        normalise(&mut edges);
        let graph = CandidateGraph::new(n, &edges, |u, v| metric.distance(u as usize, v as usize));
        let share = if round == 0 { iterations } else { iterations / 4 };
        ascent.climb(&graph, share, should_stop);
        let proof = Proof::new(metric, &ascent.best);
        if proof.value > best.value {
            best.value = proof.value;
            best.multipliers.copy_from_slice(&ascent.best);
        }
        if ascent.value - proof.value <= LOSS * ascent.value.abs() || should_stop() {
            break;
        }
        edges.extend(&proof.edges);
        ascent.value = f64::NEG_INFINITY;
        ascent.step *= 0.1;
    }
    best
}

fn normalise(edges: &mut Vec<(u32, u32)>) {
    for edge in edges.iter_mut() {
        *edge = (edge.0.min(edge.1), edge.0.max(edge.1));
    }
    edges.sort_unstable();
    edges.dedup();
}

struct Ascent {
    step: f64,
    pi: Vec<f64>,
    best: Vec<f64>,
    value: f64,
    tree: OneTree,
    previous: Vec<i32>,
}

impl Ascent {
    fn new(n: usize, step: f64) -> Self {
        let zeros = || vec![0.0; n];
        let tree = OneTree::default();
        Ascent { step, pi: zeros(), best: zeros(), value: f64::NEG_INFINITY, tree, previous: vec![0; n] }
    }

    /// Moves the multipliers along the degrees' excess over two, with steps that fall to zero over the iterations.
    fn climb(&mut self, graph: &CandidateGraph, iterations: usize, should_stop: &mut dyn FnMut() -> bool) {
        self.pi.copy_from_slice(&self.best);
        for iteration in 0..=iterations {
            self.tree.solve(graph, &self.pi);
            let value = self.tree.cost - 2.0 * self.pi.iter().sum::<f64>();
            if value > self.value {
                self.value = value;
                self.best.copy_from_slice(&self.pi);
            }
            if self.tree.is_tour() || iteration % PATIENCE == 0 && should_stop() {
                return;
            }
            let step = self.step * decay(iteration, iterations);
            for ((pi, degree), previous) in self.pi.iter_mut().zip(&self.tree.degree).zip(&mut self.previous)
            {
                let excess = degree - 2;
                *pi += step * (0.7 * f64::from(excess) + 0.3 * f64::from(*previous));
                *previous = excess;
            }
        }
    }
}

/// Falls from one to about a thousandth.
fn decay(iteration: usize, iterations: usize) -> f64 {
    (-7.0 * iteration as f64 / iterations.max(1) as f64).exp()
}
