//! The fewest vehicles that keep their limit.

use crate::error::Error;
use crate::improve::{Options, solve_from, solve_with};
use crate::lower_bound;
use crate::objective::Objective;
use crate::problem::Problem;
use crate::solution::Solution;
use christofides::Metric;

/// What [`least_fleet`] found.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct LeastFleet {
    /// Routes in which as few vehicles as found possible leave the depot; the others have empty routes at the end.
    pub solution: Solution,
    /// The number of vehicles that leave the depot.
    pub vehicles: usize,
    /// No fewer vehicles can keep the limit: proven. The number is the least if it equals `vehicles`.
    pub at_least: usize,
}

/// Routes within the limit for as few of the problem's vehicles as possible, then as good as the budget allows for that many.
///
/// Twice as many vehicles as are proven necessary are tried first, and all if those do not suffice; then fewer by bisection. Each
/// attempt minimises the makespan and stops once the limit is kept; the routes of the last success are improved for the objective of
/// `options`.
///
/// # Arguments
/// * `problem`: interchangeable vehicles, at most as many as wanted; as many as targets never is too few.
/// * `options`: the budget of each attempt.
///
/// # Guarantee
/// The limit is kept. `at_least` is proven by lower bounds: of the total cost over the limit, and of the makespan of the fleets tried.
/// An attempt that fails without such a proof leaves `at_least < vehicles`.
///
/// # Errors
/// [`Error::VehiclesDiffer`]; those of [`solve`](crate::solve) if even all vehicles are too few.
///
/// # Complexity
/// O(log m) searches.
///
/// # Examples
/// ```
/// use christofides::Points;
/// use mtsp::{Options, Problem, least_fleet};
///
/// let nodes = [[0.0, 0.0], [5.0, 1.0], [5.0, -1.0], [-5.0, 1.0], [-5.0, -1.0]];
/// let metric = Points(&nodes);
/// let problem = Problem::new(&metric, 4)?.with_limits(vec![13.0; 4])?;
/// let fleet = least_fleet(&problem, &Options::default().with_iterations(1000))?;
/// assert_eq!((fleet.vehicles, fleet.at_least), (2, 2));
/// # Ok::<(), mtsp::Error>(())
/// ```
pub fn least_fleet<M: Metric>(problem: &Problem<'_, M>, options: &Options) -> Result<LeastFleet, Error> {
    if !problem.is_homogeneous() {
        return Err(Error::VehiclesDiffer);
    }
    let mut at_least = proven(problem);
    // No search with fewer than this has succeeded: proven up to `at_least`, believed from there.
    let mut low = at_least;
    let likely = at_least.saturating_mul(2).min(problem.vehicles());
    let mut routes = match within_limit(&problem.with_first_vehicles(likely), options) {
        Err(Error::LimitsTooSmall { .. } | Error::LimitsNotMet { .. }) if likely < problem.vehicles() => {
            low = likely + 1;
            within_limit(problem, options)?
        }
        found => found?,
    };
    // rounding in the sum of the lengths must not prove more than was found
    at_least = at_least.min(routes.len());
    while low < routes.len() {
        let tried = low.midpoint(routes.len());
        let fewer = problem.with_first_vehicles(tried);
        match within_limit(&fewer, options) {
            Ok(found) => routes = found,
            Err(Error::LimitsTooSmall { .. } | Error::LimitsNotMet { .. }) => {
                low = tried + 1;
                if lower_bound::both(&fewer).makespan > fewer.limit(0) {
                    at_least = low;
                }
            }
            Err(error) => return Err(error),
        }
    }
    let vehicles = routes.len();
    if vehicles > 0 {
        routes = solve_from(&problem.with_first_vehicles(vehicles), routes, options, &mut |_| true)?.routes;
    }
    routes.resize(problem.vehicles(), vec![]);
    let solution = Solution::of(problem, routes)?;
    Ok(LeastFleet { solution, vehicles, at_least })
}

/// Routes that keep the limit, those of vehicles that stay at home left out.
fn within_limit<M: Metric>(problem: &Problem<'_, M>, options: &Options) -> Result<Vec<Vec<usize>>, Error> {
    let limit = problem.limit(0);
    let options = options.clone().with_objective(Objective::Makespan);
    let found = solve_with(problem, &options, &mut |progress| progress.makespan > limit)?;
    Ok(found.routes.into_iter().filter(|route| !route.is_empty()).collect())
}

/// A number of vehicles below which the total cost does not fit the limits; at least one for any target.
fn proven<M: Metric>(problem: &Problem<'_, M>) -> usize {
    let vehicles = problem.vehicles().min(problem.targets().len());
    let (total, limit) = (lower_bound::both(problem).total_cost, problem.limit(0));
    (1.min(vehicles)..vehicles).find(|&k| total <= k as f64 * limit).unwrap_or(vehicles)
}
