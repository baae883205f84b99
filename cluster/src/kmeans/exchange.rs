//! Hartigan's exchange: single points change their cluster where that lowers the inertia, the shift of both centroids counted.
//!
//! Moving a point of weight w from a cluster of weight A to one of weight B changes the inertia by
//! `w B / (B + w) d_b^2 - w A / (A - w) d_a^2`. Where no such move helps, each point is nearest to its own centroid, so these are fixed points of
//! Lloyd's iteration, and fewer of them (Hartigan 1975; Telgarsky and Vattani 2010). The gain fades as clusters grow.

use super::lloyd::Run;
use crate::geometry::squared_distance;
use crate::tree::Tree;

/// With more points a cluster than this, single points hardly weigh, and a pass over all would cost more than filtering does.
const POINTS_A_CLUSTER: usize = 64;

/// Relative gain below which a move is rounding.
const MARGIN: f64 = 1e-9;

/// Passes at most; the next Lloyd iteration goes on from there.
const PASSES: usize = 20;

/// Moves points and centroids until no move helps, given current labels; whether any did.
pub(super) fn exchange<const D: usize>(tree: &Tree<D>, run: &mut Run<D>) -> bool {
    let k = run.centroids.len();
    if tree.points.len() > POINTS_A_CLUSTER * k {
        return false;
    }
    let mut weights = vec![0.0; k];
    for (i, &label) in run.labels.iter().enumerate() {
        weights[label as usize] += tree.weight(i);
    }
    let n = tree.points.len();
    let (mut any, mut unmoved) = (false, 0);
    for i in (0..n).cycle().take(PASSES * n) {
        if let Some(to) = better(tree, run, &weights, i) {
            shift(tree, run, &mut weights, i, to);
            (any, unmoved) = (true, 0);
        } else {
            unmoved += 1;
        }
        if unmoved == n {
            break;
        }
    }
    any
}

/// The cluster that point `i` had better join.
#[inline]
fn better<const D: usize>(tree: &Tree<D>, run: &Run<D>, weights: &[f64], i: usize) -> Option<usize> {
    let (point, w, own) = (&tree.points[i], tree.weight(i), run.labels[i] as usize);
    let left = weights[own] - w;
    if left <= MARGIN * weights[own] {
        return None; // alone, so at its centroid
    }
    let mut least = weights[own] / left * squared_distance(point, &run.centroids[own]) * (1.0 - MARGIN);
    let mut best = None;
    for (b, (centroid, &weight)) in run.centroids.iter().zip(weights).enumerate() {
        let squared = squared_distance(point, centroid);
        // Multiplied out: a division for each centroid took a fifth of the run.
        let total = weight + w;
        if squared * weight < least * total && b != own {
            (least, best) = (squared * weight / total, Some(b));
        }
    }
    best
}

fn shift<const D: usize>(tree: &Tree<D>, run: &mut Run<D>, weights: &mut [f64], i: usize, to: usize) {
    let (point, w, from) = (&tree.points[i], tree.weight(i), run.labels[i] as usize);
    for axis in 0..D {
        run.centroids[from][axis] += w / (weights[from] - w) * (run.centroids[from][axis] - point[axis]);
        run.centroids[to][axis] += w / (weights[to] + w) * (point[axis] - run.centroids[to][axis]);
    }
    weights[from] -= w;
    weights[to] += w;
    run.labels[i] = to as u32;
}
