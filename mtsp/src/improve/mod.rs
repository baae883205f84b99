//! Improvement of routes: annealed ruin and recreate.

mod anneal;
mod arcs;
mod energy;
mod options;
mod population;
mod random;
mod recreate;
mod ruin;
mod state;

pub use anneal::Progress;
pub use options::Options;

use crate::check::check;
use crate::error::Error;
use crate::feasibility::{feasible_bounds, remedy};
use crate::initial;
use crate::lower_bound::LowerBounds;
use crate::objective::Objective;
use crate::problem::Problem;
use crate::solution::Solution;
use anneal::{Clock, Setting};
use arcs::{Arcs, Computed, Neighbours, STORED, Stored};
use christofides::Metric;
use energy::Energy;
use random::Random;
use recreate::Places;
use state::State;

/// Neighbours kept for the choice of strings, and how many of them are tried for a place.
const NEAR: usize = 64;
const WIDTH: usize = 16;

/// Routes for all vehicles, as good as the budget of `options` allows, with certified lower bounds.
///
/// Starts from the best of the paper's pipeline ([`assign`](crate::assign) after k-means, if the metric has coordinates) and a split
/// Christofides tour, and improves it by annealed ruin and recreate (Christiaens and Vanden Berghe 2020, doi:10.1287/trsc.2019.0914):
/// strings of targets are taken out of neighbouring routes and put back greedily. For the makespan the energy is a sum of
/// convex functions of the route lengths. Many short annealings make a population whose members exchange whole routes.
///
/// # Guarantee
/// Never worse than either start; with closed routes from one depot over a metric, hence at most 5/2 - 1/m times the least
/// makespan. What the solution is really worth its [`gap`](Solution::gap) says.
///
/// # Errors
/// [`Error::InvalidDistance`]; [`Error::TargetOutOfReach`] and [`Error::LimitsTooSmall`] if the limits cannot be met,
/// [`Error::LimitsNotMet`] if they were not.
///
/// # Complexity
/// O(n^2) to prepare (n^2 memory up to 3000 targets, linear beyond), then O(1) an iteration: about a microsecond.
///
/// # Examples
/// ```
/// use christofides::Points;
/// use mtsp::{Objective, Options, Problem, solve};
///
/// let nodes = [[0.0, 0.0], [5.0, 1.0], [5.0, -1.0], [-5.0, 1.0], [-5.0, -1.0]];
/// let metric = Points(&nodes);
/// let problem = Problem::new(&metric, 2)?;
/// let solution = solve(&problem, &Options::default().with_iterations(1000))?;
/// assert_eq!(solution.routes.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
/// assert!(solution.gap(Objective::Makespan) < 1e-9);
/// # Ok::<(), mtsp::Error>(())
/// ```
pub fn solve<M: Metric>(problem: &Problem<'_, M>, options: &Options) -> Result<Solution, Error> {
    solve_with(problem, options, &mut |_| true)
}

/// [`solve`], telling `proceed` of the progress every few iterations; it returns whether to go on.
///
/// # Errors
/// Those of [`solve`].
pub fn solve_with<M: Metric>(
    problem: &Problem<'_, M>,
    options: &Options,
    proceed: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Solution, Error> {
    check_distances(problem)?;
    let bounds = feasible_bounds(problem, options)?;
    let start = initial::routes(problem, options.objective, options.seed)?;
    run(problem, start, bounds, options, proceed)
}

/// [`solve_with`] from given routes: the solution is never worse than they are.
///
/// # Errors
/// Those of [`solve`], and those of [`check`] for the routes given.
pub fn solve_from<M: Metric>(
    problem: &Problem<'_, M>,
    routes: Vec<Vec<usize>>,
    options: &Options,
    proceed: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Solution, Error> {
    check_distances(problem)?;
    let given = check(problem, &routes)?;
    let bounds = feasible_bounds(problem, options)?;
    let found = run(problem, Some(routes.clone()), bounds, options, proceed)?;
    let before = match options.objective {
        Objective::Total => given.total_cost,
        Objective::Makespan => given.makespan,
    };
    // a search adds lengths up in another order, and may take a reversed route that is longer by rounding
    if found.value(options.objective) > before {
        Solution::with_bounds(problem, routes, bounds)
    } else {
        Ok(found)
    }
}

/// Refuses distances that are not finite or negative; only as many as will be stored are looked at.
fn check_distances<M: Metric>(problem: &Problem<'_, M>) -> Result<(), Error> {
    let n = problem.metric().len();
    if n > STORED {
        return Ok(());
    }
    for i in 0..n {
        for j in 0..n {
            problem.leg(i, j)?;
        }
    }
    Ok(())
}

fn run<M: Metric>(
    problem: &Problem<'_, M>,
    start: Option<Vec<Vec<usize>>>,
    bounds: LowerBounds,
    options: &Options,
    proceed: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Solution, Error> {
    if problem.targets().is_empty() {
        return Solution::with_bounds(problem, vec![vec![]; problem.vehicles()], bounds);
    }
    let routes = if problem.targets().len() + problem.vehicles() <= STORED {
        improve(problem, &Stored::new(problem), start, bounds, options, proceed)
    } else {
        improve(problem, &Computed::new(problem), start, bounds, options, proceed)
    };
    match Solution::with_bounds(problem, routes.clone(), bounds) {
        Err(Error::LimitExceeded { .. }) => {}
        other => return other,
    }
    let measured = check(&problem.without_restrictions(), &routes)?;
    let excesses = measured.lengths.iter().enumerate().map(|(v, length)| length - problem.limit(v));
    let excess = excesses.fold(f64::NEG_INFINITY, f64::max);
    Err(Error::LimitsNotMet { excess, remedy: remedy(problem, measured.makespan) })
}

fn improve<M: Metric>(
    problem: &Problem<'_, M>,
    arcs: &impl Arcs,
    start: Option<Vec<Vec<usize>>>,
    bounds: LowerBounds,
    options: &Options,
    proceed: &mut dyn FnMut(&Progress) -> bool,
) -> Vec<Vec<usize>> {
    let (targets, m) = (problem.targets(), problem.vehicles());
    let near = Neighbours::new(problem, NEAR);
    let places =
        Places { near: &near, width: WIDTH, allowed: allowed(problem), alike: problem.is_homogeneous() };
    let limits: Vec<f64> = (0..m).map(|v| problem.limit(v)).collect();
    let mut state = match start {
        Some(routes) => State::new(targets.len(), &positions(problem, &routes), arcs),
        None => {
            let mut state = State::new(targets.len(), &vec![vec![]; m], arcs);
            let mut energy = Energy::new(options.objective, limits.clone());
            let mut all: Vec<u32> = (0..targets.len() as u32).collect();
            places.recreate(&mut state, arcs, &mut energy, &mut all, &mut Random::new(options.seed));
            state.commit();
            state
        }
    };
    let bound = match options.objective {
        Objective::Total => bounds.total_cost,
        Objective::Makespan => bounds.makespan,
    };
    let target = bound * (1.0 + options.gap);
    let setting = Setting { arcs, near: &near, places, objective: options.objective, limits, target };
    let mut clock =
        Clock { iteration: 0, iterations: options.iterations, best: (0.0, 0.0), proceed, stopped: false };
    population::evolve(&setting, &mut state, options, &mut clock);
    state.lists().into_iter().map(|list| list.into_iter().map(|i| targets[i as usize]).collect()).collect()
}

/// Routes as positions in the list of targets.
fn positions<M: Metric>(problem: &Problem<'_, M>, routes: &[Vec<usize>]) -> Vec<Vec<u32>> {
    let mut position = vec![0u32; problem.metric().len()];
    for (i, &target) in problem.targets().iter().enumerate() {
        position[target] = i as u32;
    }
    routes.iter().map(|route| route.iter().map(|&t| position[t]).collect()).collect()
}

/// Which vehicle may serve which target, row by target; empty if all may.
fn allowed<M: Metric>(problem: &Problem<'_, M>) -> Vec<bool> {
    let m = problem.vehicles();
    let allowed: Vec<bool> =
        problem.targets().iter().flat_map(|&t| (0..m).map(move |v| problem.allows(v, t))).collect();
    if allowed.iter().all(|&a| a) { vec![] } else { allowed }
}
