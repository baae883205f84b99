//! The assignment step: which centroid is nearest, found by filtering candidates down the tree.
//!
//! Centroid `b` is dominated by `a` over a box if even the corner of the box that lies farthest in the direction from
//! `a` to `b` is nearer to `a` (Kanungo et al. 2002, section 2). A node whose candidates are down to one is assigned whole, from
//! its stored moments.

use crate::geometry::squared_distance;
use crate::tree::{Node, Tree};

/// Relative margin by which a centroid must lose before it is dropped: above the rounding of the two squared distances
/// compared (about 4 D units in the last place), so that the labels are the same to the bit as those of a full search.
const MARGIN: f64 = 1e-12;

/// Sums and weights of the clusters, collected in one pass over the tree.
#[derive(Default)]
pub(super) struct Moments<const D: usize> {
    pub sums: Vec<[f64; D]>,
    pub weights: Vec<f64>,
    candidates: Vec<u32>,
}

impl<const D: usize> Moments<D> {
    /// Collects the moments of each cluster under the nearest-centroid assignment.
    pub fn collect(&mut self, tree: &Tree<D>, centroids: &[[f64; D]]) {
        self.sums.clear();
        self.sums.resize(centroids.len(), [0.0; D]);
        self.weights.clear();
        self.weights.resize(centroids.len(), 0.0);
        self.candidates.clear();
        self.candidates.extend(0..centroids.len() as u32);
        let mut visit = |node: &Node<D>, only: Option<usize>, candidates: &[u32]| {
            if let Some(label) = only {
                self.weights[label] += node.weight;
                for axis in 0..D {
                    self.sums[label][axis] += node.sum[axis];
                }
                return;
            }
            for i in node.start..node.end {
                let label = nearest_of(&tree.points[i], centroids, candidates).0;
                let w = tree.weight(i);
                self.weights[label] += w;
                for axis in 0..D {
                    self.sums[label][axis] += w * tree.points[i][axis];
                }
            }
        };
        descend(tree, 0, centroids, &mut self.candidates, 0, &mut visit);
    }
}

/// Labels every point; returns the inertia.
pub(super) fn assign<const D: usize>(tree: &Tree<D>, centroids: &[[f64; D]], labels: &mut Vec<u32>) -> f64 {
    labels.clear();
    labels.resize(tree.points.len(), 0);
    let mut inertia = 0.0;
    let mut candidates: Vec<u32> = (0..centroids.len() as u32).collect();
    let mut visit = |node: &Node<D>, _: Option<usize>, candidates: &[u32]| {
        for i in node.start..node.end {
            let (label, squared) = nearest_of(&tree.points[i], centroids, candidates);
            labels[i] = label as u32;
            inertia += tree.weight(i) * squared;
        }
    };
    descend(tree, 0, centroids, &mut candidates, 0, &mut visit);
    inertia
}

/// Calls `visit` on a set of nodes that covers each point once, with the candidates left there (and the only one, if
/// one is left). Candidates are the tail of the stack from `from` on, in ascending order.
fn descend<const D: usize>(
    tree: &Tree<D>,
    index: usize,
    centroids: &[[f64; D]],
    stack: &mut Vec<u32>,
    from: usize,
    visit: &mut impl FnMut(&Node<D>, Option<usize>, &[u32]),
) {
    let node = &tree.nodes[index];
    let here = stack.len();
    // A single leaf is the whole set: nothing to gain from its box.
    if index != 0 || node.right != 0 {
        keep_undominated(node, centroids, stack, from);
    } else {
        stack.extend_from_within(from..here);
    }
    let kept = &stack[here..];
    if kept.len() == 1 {
        visit(node, Some(kept[0] as usize), kept);
    } else if node.right == 0 {
        visit(node, None, kept);
    } else {
        descend(tree, index + 1, centroids, stack, here, visit);
        descend(tree, node.right, centroids, stack, here, visit);
    }
    stack.truncate(here);
}

/// Pushes those of the candidates that may be nearest to some point of the node's box.
fn keep_undominated<const D: usize>(
    node: &Node<D>,
    centroids: &[[f64; D]],
    stack: &mut Vec<u32>,
    from: usize,
) {
    let here = stack.len();
    let mut middle = [0.0; D];
    for axis in 0..D {
        middle[axis] = 0.5 * (node.low[axis] + node.high[axis]);
    }
    let best = nearest_of(&middle, centroids, &stack[from..here]).0;
    let a = &centroids[best];
    for position in from..here {
        let candidate = stack[position];
        let b = &centroids[candidate as usize];
        let mut corner = [0.0; D];
        for axis in 0..D {
            corner[axis] = if b[axis] > a[axis] { node.high[axis] } else { node.low[axis] };
        }
        let loses = squared_distance(&corner, a) < squared_distance(&corner, b) * (1.0 - MARGIN);
        if candidate as usize == best || !loses {
            stack.push(candidate);
        }
    }
}

/// The nearest of the candidates and its squared distance; the first on ties.
#[inline(always)]
pub(super) fn nearest_of<const D: usize>(
    point: &[f64; D],
    centroids: &[[f64; D]],
    candidates: &[u32],
) -> (usize, f64) {
    let (mut best, mut least) = (candidates[0], f64::INFINITY);
    for &candidate in candidates {
        let squared = squared_distance(point, &centroids[candidate as usize]);
        if squared < least {
            (best, least) = (candidate, squared);
        }
    }
    (best as usize, least)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]
        #[test]
        fn filtering_labels_as_a_full_search_does(
            seed in 0u64..1_000_000, n in 1usize..2000, k in 1usize..30, coarse in any::<bool>(),
        ) {
            use rand::{RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
            // A coarse grid makes ties and duplicates.
            let mut draw = || {
                let x: f64 = rng.random();
                if coarse { (x * 8.0).floor() } else { x }
            };
            let points: Vec<[f64; 2]> = (0..n).map(|_| [draw(), draw()]).collect();
            let centroids: Vec<[f64; 2]> = (0..k).map(|_| [draw(), draw()]).collect();
            let tree = Tree::new(&points, None);
            let (mut labels, mut moments) = (vec![], Moments::default());
            let inertia = assign(&tree, &centroids, &mut labels);
            moments.collect(&tree, &centroids);
            let all: Vec<u32> = (0..k as u32).collect();
            let (mut total, mut weights) = (0.0, vec![0.0; k]);
            for (point, label) in points.iter().zip(tree.in_original_order(&labels)) {
                let (nearest, squared) = nearest_of(point, &centroids, &all);
                prop_assert_eq!(nearest, label);
                total += squared;
                weights[label] += 1.0;
            }
            prop_assert!((total - inertia).abs() <= 1e-9 * total);
            prop_assert_eq!(weights, moments.weights);
        }
    }
}
