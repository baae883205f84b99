//! Lloyd's iteration from given seeds, with repair of empty clusters, and exchanges of single points where it rests.

use super::exchange::exchange;
use super::filter::{Moments, assign};
use super::{KMeansOptions, KMeansStatus};
use crate::geometry::squared_distance;
use crate::tree::Tree;

/// One run; labels are in the tree's order.
pub(super) struct Run<const D: usize> {
    pub centroids: Vec<[f64; D]>,
    pub labels: Vec<u32>,
    pub inertia: f64,
    pub iterations: usize,
    pub status: KMeansStatus,
}

impl<const D: usize> Default for Run<D> {
    fn default() -> Self {
        let status = KMeansStatus::Converged;
        Run { centroids: vec![], labels: vec![], inertia: f64::INFINITY, iterations: 0, status }
    }
}

/// Iterates until the centroids rest; the labels returned belong to the centroids returned.
pub(super) fn run<const D: usize>(tree: &Tree<D>, seeds: Vec<[f64; D]>, options: &KMeansOptions) -> Run<D> {
    let mut run = Run { centroids: seeds, ..Run::default() };
    let mut moments = Moments::default();
    iterate(tree, &mut run, &mut moments, options);
    run.inertia = assign(tree, &run.centroids, &mut run.labels);
    if run.status == KMeansStatus::Converged && exchange(tree, &mut run) {
        // At a fixed point of this iteration, unless rounding or the limit of passes says otherwise.
        iterate(tree, &mut run, &mut moments, options);
        run.inertia = assign(tree, &run.centroids, &mut run.labels);
    }
    settle(tree, &mut run);
    run
}

/// Lloyd's iteration until the centroids rest or the limit is reached.
fn iterate<const D: usize>(
    tree: &Tree<D>,
    run: &mut Run<D>,
    moments: &mut Moments<D>,
    options: &KMeansOptions,
) {
    let tolerance = options.tolerance * tree.mean_variance;
    run.status = KMeansStatus::IterationLimit;
    while run.iterations < options.max_iterations {
        run.iterations += 1;
        moments.collect(tree, &run.centroids);
        let shift = move_centroids(&mut run.centroids, moments);
        if moments.weights.contains(&0.0) {
            repair(tree, run, &moments.weights);
        } else if shift <= tolerance {
            run.status = KMeansStatus::Converged;
            return;
        }
    }
}

/// Moves each centroid to the mean of its points; returns the sum of squared shifts.
fn move_centroids<const D: usize>(centroids: &mut [[f64; D]], moments: &Moments<D>) -> f64 {
    let mut shift = 0.0;
    for (centroid, (sum, &weight)) in centroids.iter_mut().zip(moments.sums.iter().zip(&moments.weights)) {
        if weight > 0.0 {
            let mean = sum.map(|x| x / weight);
            shift += squared_distance(centroid, &mean);
            *centroid = mean;
        }
    }
    shift
}

/// Moves the centroid of each empty cluster to a point that is farthest from its nearest centroid.
fn repair<const D: usize>(tree: &Tree<D>, run: &mut Run<D>, weights: &[f64]) {
    for empty in (0..weights.len()).filter(|&j| weights[j] == 0.0) {
        assign(tree, &run.centroids, &mut run.labels);
        let distance = |i: usize| squared_distance(&tree.points[i], &run.centroids[run.labels[i] as usize]);
        let farthest = (0..tree.points.len()).fold((0, 0.0), |best, i| {
            let squared = distance(i);
            if squared > best.1 { (i, squared) } else { best }
        });
        run.centroids[empty] = tree.points[farthest.0];
    }
}

/// Makes the invariant hold that every cluster has a member: repairs what the last move emptied, and drops clusters that
/// cannot be filled because all points rest on centroids already.
fn settle<const D: usize>(tree: &Tree<D>, run: &mut Run<D>) {
    // Each repair lowers the inertia, so this ends; k rounds suffice but for pathological rounding, after which clusters are dropped.
    for _ in 0..=run.centroids.len() {
        let counts = counts(run);
        if !counts.contains(&0.0) {
            return;
        }
        if run.inertia <= 0.0 {
            break;
        }
        repair(tree, run, &counts);
        run.inertia = assign(tree, &run.centroids, &mut run.labels);
    }
    let counts = counts(run);
    let mut position = 0;
    run.centroids.retain(|_| {
        position += 1;
        counts[position - 1] > 0.0
    });
    run.inertia = assign(tree, &run.centroids, &mut run.labels);
}

fn counts<const D: usize>(run: &Run<D>) -> Vec<f64> {
    let mut counts = vec![0.0; run.centroids.len()];
    for &label in &run.labels {
        counts[label as usize] += 1.0;
    }
    counts
}
