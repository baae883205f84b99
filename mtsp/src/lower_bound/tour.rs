//! The Held-Karp bound of one tour through everything.

use super::rounded_down;
use crate::cluster_first::Subset;
use crate::problem::Problem;
use christofides::{Metric, held_karp};

/// A lower bound on the total cost (service included) with closed routes from one depot: a tour through the depot and all targets.
///
/// All routes one after the other are a closed walk through every node, which shortcutting makes a tour without making it longer
/// (triangle inequality). The tour's bound is [`held_karp`] (1970). Limits and forbidden pairs only add to the cost.
///
/// # Arguments
/// * `iterations`: 1-trees of the ascent.
///
/// # Returns
/// The bound, rounded down; without one closed depot, or for asymmetric or invalid distances, the sum of the services.
///
/// # Complexity
/// O(n log n) an iteration for points and many targets, O(n^2) otherwise.
#[must_use]
pub fn tour<M: Metric>(problem: &Problem<'_, M>, iterations: usize) -> f64 {
    let targets = problem.targets();
    let service: f64 = targets.iter().map(|&t| problem.service()[t]).sum();
    let legs = problem.closed_depot().map_or(0.0, |depot| {
        let mut nodes = vec![depot];
        nodes.extend(targets);
        let subset = Subset { metric: problem.metric(), nodes: &nodes };
        let all = nodes.len() == problem.metric().len();
        // The whole metric keeps its coordinates, which the ascent on candidate edges needs.
        let bound =
            if all { held_karp(problem.metric(), iterations) } else { held_karp(&subset, iterations) };
        bound.map_or(0.0, |b| b.value())
    });
    rounded_down(legs + service, targets.len(), legs + service)
}
