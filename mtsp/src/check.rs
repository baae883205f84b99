//! An independent checker of routes: shares no code with the search that made them.

use crate::error::{Error, List};
use crate::problem::{End, Problem, expect_length};
use christofides::Metric;

/// What a check has measured.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Measured {
    /// The length of each route.
    pub lengths: Vec<f64>,
    /// The greatest of them.
    pub makespan: f64,
    /// Their sum.
    pub total_cost: f64,
}

/// Relative excess over a limit that is rounding, not a violation.
pub const LIMIT_TOLERANCE: f64 = 1e-9;

/// Checks that every target is visited once, by a vehicle that may visit it, within the vehicle's limit, and measures
/// the routes from the metric alone.
///
/// # Errors
/// [`Error::WrongLength`], [`Error::UnknownNode`], [`Error::DepotInRoute`], [`Error::TargetRepeated`], [`Error::TargetMissing`],
/// [`Error::PairForbidden`], [`Error::LimitExceeded`], [`Error::InvalidDistance`].
pub fn check<M: Metric>(problem: &Problem<'_, M>, routes: &[Vec<usize>]) -> Result<Measured, Error> {
    expect_length(List::Routes, problem.vehicles(), routes.len())?;
    let nodes = problem.metric().len();
    let mut is_target = vec![false; nodes];
    for &target in problem.targets() {
        is_target[target] = true;
    }
    let mut seen = vec![false; nodes];
    let mut lengths = Vec::with_capacity(routes.len());
    for (vehicle, route) in routes.iter().enumerate() {
        for &node in route {
            if node >= nodes {
                return Err(Error::UnknownNode { node, nodes });
            }
            if !is_target[node] {
                return Err(Error::DepotInRoute { vehicle, node });
            }
            if std::mem::replace(&mut seen[node], true) {
                return Err(Error::TargetRepeated { target: node, vehicle });
            }
            if !problem.allows(vehicle, node) {
                return Err(Error::PairForbidden { vehicle, target: node });
            }
        }
        let length = measure(problem, vehicle, route)?;
        let limit = problem.limit(vehicle);
        if length > limit * (1.0 + LIMIT_TOLERANCE) {
            return Err(Error::LimitExceeded { vehicle, length, limit });
        }
        lengths.push(length);
    }
    if let Some(&target) = problem.targets().iter().find(|&&t| !seen[t]) {
        return Err(Error::TargetMissing { target });
    }
    let makespan = lengths.iter().copied().fold(0.0, f64::max);
    let total_cost = lengths.iter().sum();
    Ok(Measured { lengths, makespan, total_cost })
}

/// The length of a route, node by node.
fn measure<M: Metric>(problem: &Problem<'_, M>, vehicle: usize, route: &[usize]) -> Result<f64, Error> {
    if route.is_empty() {
        return Ok(0.0);
    }
    let mut here = problem.start(vehicle);
    let mut length = 0.0;
    for &node in route {
        length += problem.leg(here, node)? + problem.service()[node];
        here = node;
    }
    if let End::At(end) = problem.end(vehicle) {
        length += problem.leg(here, end)?;
    }
    Ok(length)
}
