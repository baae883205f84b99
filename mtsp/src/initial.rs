//! Routes to start from: the best of the paper's pipeline and of a split tour.

use crate::cluster_first::{Subset, cluster_routes, k_means_labels};
use crate::error::Error;
use crate::objective::Objective;
use crate::problem::Problem;
use crate::split::split;
use christofides::{Metric, christofides, improve};

/// The best of what needs no search; none if the metric is asymmetric, or only with restrictions that it breaks.
pub(crate) fn routes<M: Metric>(
    problem: &Problem<'_, M>,
    objective: Objective,
    seed: u64,
) -> Result<Option<Vec<Vec<usize>>>, Error> {
    let mut best: Option<(f64, Vec<Vec<usize>>)> = None;
    let mut candidates = vec![clustered(problem, seed)];
    match tour_order(problem) {
        Ok(order) => {
            candidates.push(split(problem, &order, objective).map(Some));
            // The flattest cuts keep a limit if any do.
            if objective == Objective::Total && problem.has_limits() {
                candidates.push(split(problem, &order, Objective::Makespan).map(Some));
            }
        }
        Err(error) => candidates.push(Err(error)),
    }
    for candidate in candidates {
        let routes = match candidate {
            Ok(Some(routes)) => routes,
            // An asymmetric distance is for the search, which needs no tour.
            Ok(None) | Err(Error::Tour(_)) => continue,
            Err(error) => return Err(error),
        };
        let Ok(measured) = crate::check::check(problem, &routes) else { continue };
        let value = match objective {
            Objective::Total => measured.total_cost,
            Objective::Makespan => measured.makespan,
        };
        if best.as_ref().is_none_or(|b| value < b.0) {
            best = Some((value, routes));
        }
    }
    Ok(best.map(|b| b.1))
}

/// The paper's pipeline, if the metric has coordinates.
fn clustered<M: Metric>(problem: &Problem<'_, M>, seed: u64) -> Result<Option<Vec<Vec<usize>>>, Error> {
    match k_means_labels(problem, seed) {
        Some(labels) => Ok(Some(cluster_routes(problem, &labels?)?)),
        None => Ok(None),
    }
}

/// The targets in the order of an improved Christofides tour from the first vehicle's start.
pub(crate) fn tour_order<M: Metric>(problem: &Problem<'_, M>) -> Result<Vec<usize>, Error> {
    let mut nodes = vec![problem.start(0)];
    nodes.extend(problem.targets());
    let mut order =
        if nodes.iter().enumerate().all(|(i, &node)| i == node) && nodes.len() == problem.metric().len() {
            // The whole metric keeps its coordinates, with which the tour takes O(n log n).
            improve(problem.metric(), christofides(problem.metric())?)?.into_order()
        } else {
            let subset = Subset { metric: problem.metric(), nodes: &nodes };
            improve(&subset, christofides(&subset)?)?.into_order()
        };
    let depot = order.iter().position(|&v| v == 0).unwrap_or(0);
    order.rotate_left(depot);
    Ok(order[1..].iter().map(|&v| nodes[v]).collect())
}
