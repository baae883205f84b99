//! Whether limits can be kept at all, and what would suffice where they cannot.

use crate::error::{Error, Remedy};
use crate::improve::Options;
use crate::initial::tour_order;
use crate::lower_bound::{self, LowerBounds};
use crate::objective::Objective;
use crate::problem::Problem;
use crate::split::fewest_routes;
use christofides::Metric;

/// Iterations at most of the search for a limit that would suffice: some 20 ms for 100 targets.
const ITERATIONS: u64 = 20_000;

/// Lower bounds, refused where they show that the limits cannot be met.
pub(crate) fn feasible_bounds<M: Metric>(
    problem: &Problem<'_, M>,
    options: &Options,
) -> Result<LowerBounds, Error> {
    if problem.has_limits() {
        for &target in problem.targets() {
            let alone = |v: usize| problem.route_length(v, &[target]);
            let allowed = || (0..problem.vehicles()).filter(|&v| problem.allows(v, target));
            if !allowed().any(|v| alone(v) <= problem.limit(v)) {
                let needed = allowed().map(alone).fold(f64::INFINITY, f64::min);
                let remedy = remedy(problem, limit_found(problem, options)?);
                return Err(Error::TargetOutOfReach { target, needed, remedy });
            }
        }
    }
    let bounds = lower_bound::both(problem);
    let available: f64 = (0..problem.vehicles()).map(|v| problem.limit(v)).sum();
    if bounds.total_cost > available {
        let remedy = remedy(problem, limit_found(problem, options)?);
        return Err(Error::LimitsTooSmall { needed: bounds.total_cost, available, remedy });
    }
    Ok(bounds)
}

/// The remedy, given the makespan of some routes.
pub(crate) fn remedy<M: Metric>(problem: &Problem<'_, M>, makespan: f64) -> Remedy {
    // An asymmetric metric has no tour to cut.
    let order = if problem.is_homogeneous() { tour_order(problem).ok() } else { None };
    Remedy { limit: makespan, vehicles: order.and_then(|order| fewest_routes(problem, &order)) }
}

/// The makespan of routes found without regard to limits.
fn limit_found<M: Metric>(problem: &Problem<'_, M>, options: &Options) -> Result<f64, Error> {
    let free = problem.clone().with_limits(vec![f64::INFINITY; problem.vehicles()])?;
    let mut quick = options.clone().with_objective(Objective::Makespan);
    quick = quick.with_iterations(options.iterations.min(ITERATIONS)).with_horizon(ITERATIONS);
    Ok(crate::improve::solve(&free, &quick)?.makespan)
}
