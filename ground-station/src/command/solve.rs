//! `routes` and `tour`: the solvers on files of points.

use crate::failure::{Failure, reason};
use crate::nodes::Nodes;
use crate::problem::Problem;
use planner::christofides::{self, Metric};
use planner::mtsp::{self, Objective};
use serde_json::json;
use std::path::{Path, PathBuf};

/// What is asked of `routes` and `tour`.
#[derive(Debug, Clone, PartialEq)]
pub struct SolveRequest {
    /// A TSPLIB file or a table of points; for routes the first node is the depot.
    pub file: PathBuf,
    /// Distances rounded to whole numbers, as TSPLIB does.
    pub is_rounded: bool,
    /// Seed of the search.
    pub seed: u64,
    /// Iterations of the search.
    pub iterations: u64,
    /// JSON instead of lines.
    pub json: bool,
}

fn nodes(request: &SolveRequest) -> Result<Nodes, Failure> {
    let file = request.file.display().to_string();
    let read = |path: &Path| std::fs::read_to_string(path);
    let text = read(&request.file).map_err(|error| {
        let message = format!("cannot be read ({}): give a TSPLIB file or a table of points", reason(&error));
        Failure::Input(vec![Problem { file: file.clone(), line: None, key: String::new(), message }])
    })?;
    Nodes::read(&file, &text, request.is_rounded).map_err(|problem| Failure::Input(vec![problem]))
}

/// A short tour through all nodes, with its lower bound.
///
/// # Errors
///
/// [`Failure::Input`] for a file that cannot be used.
pub fn tour(request: &SolveRequest) -> Result<String, Failure> {
    let nodes = nodes(request)?;
    let metric = nodes.metric();
    let kicks = usize::try_from(request.iterations).unwrap_or(usize::MAX);
    let options = christofides::Options::default().with_seed(request.seed).with_kicks(kicks);
    let tour = christofides::solve(&metric, &options, &mut || false)
        .map_err(|error| Failure::Refused(format!("{}: {error}", request.file.display())))?;
    let whole = |bound: f64| if metric.are_whole() { (bound - 1e-6).ceil() } else { bound };
    let bound = tour.lower_bound().map(whole);
    let gap = bound.filter(|&bound| bound > 0.0).map(|bound| (tour.cost() / bound - 1.0).max(0.0));
    let order: Vec<usize> = tour.order().iter().map(|node| node + 1).collect();
    if request.json {
        return Ok(format!(
            "{}\n",
            json!({"nodes": metric.len(), "length": tour.cost(), "lower_bound": bound, "gap": gap, "tour": order})
        ));
    }
    let order: Vec<String> = order.iter().map(ToString::to_string).collect();
    Ok(format!(
        "nodes        {}\nlength       {:.3}\nlower bound  {:.3}\ngap          {:.3} %\ntour         {}\n",
        metric.len(),
        tour.cost(),
        bound.unwrap_or(0.0),
        100.0 * gap.unwrap_or(0.0),
        order.join(" ")
    ))
}

/// Routes of several vehicles from the first node through all others, with their lower bound.
///
/// # Errors
///
/// [`Failure::Input`] for a file that cannot be used, [`Failure::Refused`] for a problem that has no solution.
pub fn routes(
    request: &SolveRequest,
    vehicles: usize,
    objective: Objective,
    is_open: bool,
) -> Result<String, Failure> {
    let nodes = nodes(request)?;
    let metric = nodes.metric();
    let refused = |error: mtsp::Error| Failure::Refused(format!("{}: {error}", request.file.display()));
    let mut problem = mtsp::Problem::new(&metric, vehicles).map_err(refused)?;
    if is_open {
        problem = problem.with_open_routes();
    }
    let options = mtsp::Options::default()
        .with_objective(objective)
        .with_seed(request.seed)
        .with_iterations(request.iterations);
    let solution = mtsp::solve(&problem, &options).map_err(refused)?;
    let routes: Vec<Vec<usize>> =
        solution.routes.iter().map(|route| route.iter().map(|node| node + 1).collect()).collect();
    let (value, bound, gap) =
        (solution.value(objective), solution.lower_bound(objective), solution.gap(objective));
    if request.json {
        return Ok(format!(
            "{}\n",
            json!({
                "nodes": metric.len(), "vehicles": vehicles, "value": value, "lower_bound": bound, "gap": gap,
                "makespan": solution.makespan, "total": solution.total_cost, "lengths": solution.lengths, "routes": routes,
            })
        ));
    }
    let mut text = String::new();
    for (index, (route, length)) in routes.iter().zip(&solution.lengths).enumerate() {
        let nodes: Vec<String> = route.iter().map(ToString::to_string).collect();
        text.push_str(&format!("vehicle {}: length {length:.3}: {}\n", index + 1, nodes.join(" ")));
    }
    text.push_str(&format!("makespan {:.3}, total {:.3}\n", solution.makespan, solution.total_cost));
    text.push_str(&format!("value {value:.3}, lower bound {bound:.3}, gap {:.2} %\n", 100.0 * gap));
    Ok(text)
}
