//! Least 1-trees among candidate edges.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Candidate edges by rows, with their lengths. The last vertex is the one outside the tree.
#[derive(Debug, Default)]
pub(crate) struct CandidateGraph {
    start: Vec<u32>,
    arcs: Vec<(f64, u32)>,
}

/// A 1-tree: its cost under the multipliers and the degrees of its vertices.
#[derive(Debug, Default)]
pub(crate) struct OneTree {
    pub cost: f64,
    pub degree: Vec<i32>,
    cost_of: Vec<f64>,
    parent: Vec<u32>,
    heap: BinaryHeap<(Reverse<u64>, u32)>,
}

/// Integers in the order of the floating-point numbers.
#[inline]
fn ordered(x: f64) -> u64 {
    let bits = x.to_bits();
    if bits >> 63 == 0 { bits | 1 << 63 } else { !bits }
}

const DONE: f64 = f64::NEG_INFINITY;

impl CandidateGraph {
    /// A graph of undirected edges, each once.
    pub fn new(n: usize, edges: &[(u32, u32)], length: impl Fn(u32, u32) -> f64) -> Self {
        let mut start = vec![0; n + 2];
        for &(u, v) in edges {
            start[u as usize + 2] += 1;
            start[v as usize + 2] += 1;
        }
        for v in 2..n + 2 {
            start[v] += start[v - 1];
        }
        let mut arcs = vec![(0.0, 0); 2 * edges.len()];
        for &(u, v) in edges {
            let length = length(u, v);
            for (tail, head) in [(u, v), (v, u)] {
                let slot = &mut start[tail as usize + 1];
                arcs[*slot as usize] = (length, head);
                *slot += 1;
            }
        }
        CandidateGraph { start, arcs }
    }

    fn arcs(&self, v: usize) -> &[(f64, u32)] {
        &self.arcs[self.start[v] as usize..self.start[v + 1] as usize]
    }
}

impl OneTree {
    /// The least 1-tree of a graph under multipliers (Prim's algorithm with a heap); infinite cost if there is none.
    pub fn solve(&mut self, graph: &CandidateGraph, pi: &[f64]) {
        let n = pi.len();
        let special = n - 1;
        self.degree.clear();
        self.degree.resize(n, 0);
        self.cost_of.clear();
        self.cost_of.resize(n, f64::INFINITY);
        self.parent.resize(n, 0);
        self.heap.clear();
        self.cost = 0.0;
        self.cost_of[special] = DONE;
        let mut joined = 0;
        let mut next = Some(0_usize);
        while let Some(v) = next {
            joined += 1;
            if v != 0 {
                self.cost += self.cost_of[v];
                self.degree[v] += 1;
                self.degree[self.parent[v] as usize] += 1;
            }
            self.cost_of[v] = DONE;
            for &(length, head) in graph.arcs(v) {
                let cost = length + pi[v] + pi[head as usize];
                if cost < self.cost_of[head as usize] {
                    self.cost_of[head as usize] = cost;
                    self.parent[head as usize] = v as u32;
                    self.heap.push((Reverse(ordered(cost)), head));
                }
            }
            next = loop {
                let Some((Reverse(key), v)) = self.heap.pop() else { break None };
                if self.cost_of[v as usize] != DONE && ordered(self.cost_of[v as usize]) == key {
                    break Some(v as usize);
                }
            };
        }
        self.attach(graph, pi);
        if joined + 1 < n {
            self.cost = f64::INFINITY;
        }
    }

    /// The two cheapest edges of the special vertex.
    fn attach(&mut self, graph: &CandidateGraph, pi: &[f64]) {
        let special = pi.len() - 1;
        let mut two = [(f64::INFINITY, special); 2];
        for &(length, head) in graph.arcs(special) {
            let cost = length + pi[special] + pi[head as usize];
            if cost < two[0].0 {
                two = [(cost, head as usize), two[0]];
            } else if cost < two[1].0 {
                two[1] = (cost, head as usize);
            }
        }
        for (cost, head) in two {
            self.cost += cost;
            self.degree[head] += 1;
            self.degree[special] += 1;
        }
    }

    /// Whether the 1-tree is a tour.
    pub fn is_tour(&self) -> bool {
        self.degree.iter().all(|&degree| degree == 2)
    }
}
