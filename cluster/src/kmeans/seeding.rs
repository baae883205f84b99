//! Greedy k-means++ seeding.
//!
//! Each new seed is the best of `2 + floor(ln k)` candidates drawn with probability proportional to the squared
//! distance to the nearest seed so far (Arthur and Vassilvitskii 2007, section 6; the number is scikit-learn's). Leaves
//! of the tree that are too far from a candidate to gain from it are skipped, which makes a seed cost O(n / j) after j seeds.

use crate::geometry::squared_distance;
use crate::tree::{Node, Tree};
use rand::{RngExt, rngs::Xoshiro256PlusPlus};

/// The state of seeding: for each point its squared distance to the nearest seed, for each leaf their sum and maximum.
struct Potential<'a, const D: usize> {
    tree: &'a Tree<D>,
    leaves: Vec<&'a Node<D>>,
    nearest: Vec<f64>,
    sum: Vec<f64>,
    max: Vec<f64>,
}

/// At most `k` distinct seeds; fewer only when there are no more distinct points.
pub(super) fn greedy<const D: usize>(
    tree: &Tree<D>,
    k: usize,
    rng: &mut Xoshiro256PlusPlus,
) -> Vec<[f64; D]> {
    let n_candidates = 2 + (k as f64).ln() as usize;
    let first = first_seed(tree, rng);
    let mut potential = Potential::new(tree, first);
    let mut seeds = Vec::with_capacity(k.min(tree.points.len()));
    seeds.push(first);
    while seeds.len() < k {
        let total: f64 = potential.sum.iter().sum();
        if total <= 0.0 {
            break;
        }
        let mut best: Option<(f64, [f64; D])> = None;
        for _ in 0..n_candidates {
            let candidate = tree.points[potential.draw(total * rng.random::<f64>())];
            let left = potential.after(&candidate, best.map_or(f64::INFINITY, |b| b.0));
            if best.is_none_or(|b| left < b.0) {
                best = Some((left, candidate));
            }
        }
        let Some((_, seed)) = best else { break };
        potential.add(&seed);
        seeds.push(seed);
    }
    seeds
}

fn first_seed<const D: usize>(tree: &Tree<D>, rng: &mut Xoshiro256PlusPlus) -> [f64; D] {
    let n = tree.points.len();
    if tree.weights.is_empty() {
        let i = (rng.random::<f64>() * n as f64) as usize;
        return tree.points[i.min(n - 1)];
    }
    let mut left = rng.random::<f64>() * tree.nodes[0].weight;
    let chosen = tree.weights.iter().position(|w| {
        left -= w;
        left < 0.0
    });
    tree.points[chosen.unwrap_or(n - 1)]
}

impl<'a, const D: usize> Potential<'a, D> {
    fn new(tree: &'a Tree<D>, seed: [f64; D]) -> Self {
        let leaves: Vec<_> = tree.leaves().collect();
        let nearest = vec![f64::INFINITY; tree.points.len()];
        let (sum, max) = (vec![f64::INFINITY; leaves.len()], vec![f64::INFINITY; leaves.len()]);
        let mut potential = Self { tree, leaves, nearest, sum, max };
        potential.add(&seed);
        potential
    }

    /// The point at which the running sum of potentials passes `target`; always one with a positive potential.
    fn draw(&self, mut target: f64) -> usize {
        let mut last_positive = 0;
        for (leaf, &sum) in self.leaves.iter().zip(&self.sum) {
            if sum <= 0.0 {
                continue;
            }
            if target >= sum {
                target -= sum;
                // Remember a fallback: rounding may let the target pass the very end.
                last_positive = leaf.start;
                continue;
            }
            for i in leaf.start..leaf.end {
                let value = self.tree.weight(i) * self.nearest[i];
                if value > 0.0 {
                    last_positive = i;
                    target -= value;
                    if target < 0.0 {
                        return i;
                    }
                }
            }
            return last_positive;
        }
        // The end was passed by rounding: the last leaf with potential has a positive point.
        let positive = |i: &usize| self.nearest[*i] > 0.0;
        (last_positive..self.nearest.len()).find(positive).unwrap_or(last_positive)
    }

    /// The potential if `candidate` were added; gives up (returning infinity) once it passes `limit`.
    fn after(&self, candidate: &[f64; D], limit: f64) -> f64 {
        let mut total = 0.0;
        for (index, leaf) in self.leaves.iter().enumerate() {
            if box_distance(leaf, candidate) >= self.max[index] {
                total += self.sum[index];
            } else {
                for i in leaf.start..leaf.end {
                    let squared = squared_distance(&self.tree.points[i], candidate);
                    total += self.tree.weight(i) * self.nearest[i].min(squared);
                }
            }
            if total >= limit {
                return f64::INFINITY;
            }
        }
        total
    }

    fn add(&mut self, seed: &[f64; D]) {
        for (index, leaf) in self.leaves.iter().enumerate() {
            if box_distance(leaf, seed) >= self.max[index] {
                continue;
            }
            let (mut sum, mut max) = (0.0, 0.0_f64);
            for i in leaf.start..leaf.end {
                let squared = squared_distance(&self.tree.points[i], seed).min(self.nearest[i]);
                self.nearest[i] = squared;
                sum += self.tree.weight(i) * squared;
                max = max.max(squared);
            }
            self.sum[index] = sum;
            self.max[index] = max;
        }
    }
}

/// Squared distance from a point to a node's box.
fn box_distance<const D: usize>(node: &Node<D>, point: &[f64; D]) -> f64 {
    let mut sum = 0.0;
    for axis in 0..D {
        let outside = (node.low[axis] - point[axis]).max(point[axis] - node.high[axis]).max(0.0);
        sum += outside * outside;
    }
    sum
}
