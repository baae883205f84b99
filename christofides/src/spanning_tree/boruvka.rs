//! Boruvka's algorithm over a k-d tree, with an additive weight on every point.

use crate::kd_tree::{KdTree, squared_distance};

const NONE: u32 = u32::MAX;

/// A minimum spanning tree under `|p_i - p_j| + weight_i + weight_j`; `O(n log n)` queries, each `O(log n)` typically.
///
/// In every round each component finds its lightest edge to another one; boxes inside one component are skipped.
pub(crate) fn boruvka<const D: usize>(points: &[[f64; D]], weights: &[f64]) -> Vec<[usize; 2]> {
    let n = points.len();
    if n < 2 {
        return Vec::new();
    }
    let tree = KdTree::new(points);
    let mut forest = Forest::new(tree, weights);
    let mut edges = Vec::with_capacity(n - 1);
    while edges.len() + 1 < n {
        forest.summarise();
        let mut lightest = vec![(f64::INFINITY, NONE, NONE); n];
        for position in 0..n as u32 {
            forest.query(position, &mut lightest);
        }
        for (_, from, to) in lightest.into_iter().filter(|edge| edge.1 != NONE) {
            if forest.unite(from, to) {
                edges.push([
                    forest.tree.order[from as usize] as usize,
                    forest.tree.order[to as usize] as usize,
                ]);
            }
        }
    }
    edges
}

struct Forest<const D: usize> {
    tree: KdTree<D>,
    /// Weights in the order of the tree.
    weights: Vec<f64>,
    /// Disjoint sets; after `summarise` every entry is a root.
    component: Vec<u32>,
    /// A lower bound on the lightest edge of every point to another component, from earlier rounds.
    known: Vec<f64>,
    least_weight: Vec<f64>,
    common: Vec<u32>,
    stack: Vec<(f64, u32)>,
}

impl<const D: usize> Forest<D> {
    fn new(tree: KdTree<D>, weights: &[f64]) -> Self {
        let weights: Vec<f64> = tree.order.iter().map(|&v| weights[v as usize]).collect();
        let n = weights.len();
        let mut least_weight = vec![f64::INFINITY; tree.nodes.len()];
        for (slot, node) in least_weight.iter_mut().zip(&tree.nodes) {
            *slot = weights[node.range()].iter().copied().fold(f64::INFINITY, f64::min);
        }
        let (common, known) = (vec![NONE; tree.nodes.len()], vec![f64::NEG_INFINITY; n]);
        Forest {
            tree,
            weights,
            component: (0..n as u32).collect(),
            known,
            least_weight,
            common,
            stack: Vec::new(),
        }
    }

    fn find(&mut self, mut v: u32) -> u32 {
        while self.component[v as usize] != v {
            self.component[v as usize] = self.component[self.component[v as usize] as usize];
            v = self.component[v as usize];
        }
        v
    }

    fn unite(&mut self, u: u32, v: u32) -> bool {
        let (u, v) = (self.find(u), self.find(v));
        self.component[u.max(v) as usize] = u.min(v);
        u != v
    }

    /// Flattens the sets and notes for every box the component if it has only one.
    fn summarise(&mut self) {
        for v in 0..self.component.len() as u32 {
            self.component[v as usize] = self.find(v);
        }
        for index in (0..self.tree.nodes.len()).rev() {
            let node = &self.tree.nodes[index];
            let left = node.left as usize;
            self.common[index] = if left != 0 {
                if self.common[left] == self.common[left + 1] { self.common[left] } else { NONE }
            } else {
                let first = self.component[node.begin as usize];
                if self.component[node.range()].iter().all(|&c| c == first) { first } else { NONE }
            };
        }
    }

    /// Improves the lightest edge of the component of a point; ties go to the smaller pair of positions.
    fn query(&mut self, position: u32, lightest: &mut [(f64, u32, u32)]) {
        let at = position as usize;
        let own = self.component[at];
        let slot = &mut lightest[own as usize];
        if self.known[at] > slot.0 {
            return;
        }
        let point = self.tree.points[at];
        let weight = self.weights[at];
        let mut best = f64::INFINITY;
        self.stack.clear();
        self.stack.push((f64::NEG_INFINITY, 0));
        while let Some((bound, index)) = self.stack.pop() {
            if bound > slot.0 || self.common[index as usize] == own {
                best = best.min(if self.common[index as usize] == own { f64::INFINITY } else { bound });
                continue;
            }
            let node = &self.tree.nodes[index as usize];
            if node.left != 0 {
                let child = |index: u32| {
                    let squared = self.tree.nodes[index as usize].squared_distance(&point);
                    (squared.sqrt() + weight + self.least_weight[index as usize], index)
                };
                let (left, right) = (child(node.left), child(node.left + 1));
                self.stack.extend(if left.0 <= right.0 { [right, left] } else { [left, right] });
                continue;
            }
            for other in node.range().filter(|&other| self.component[other] != own) {
                let length = squared_distance(&point, &self.tree.points[other]).sqrt();
                let cost = length + weight + self.weights[other];
                best = best.min(cost);
                let edge = (cost, position.min(other as u32), position.max(other as u32));
                if edge < *slot {
                    *slot = edge;
                }
            }
        }
        self.known[at] = best;
    }
}
