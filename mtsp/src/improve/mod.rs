//! Improvement of routes.

mod anneal;
mod arcs;
mod energy;
mod options;
mod random;
mod recreate;
mod ruin;
mod state;

pub use anneal::Progress;
pub use options::Options;

use crate::check::check;
use crate::error::Error;
use crate::lower_bound;
use crate::problem::Problem;
use crate::solution::Solution;
use anneal::Annealing;
use arcs::{Arcs, Computed, Neighbours, STORED, Stored};
use christofides::Metric;
use recreate::Places;
use state::State;

/// Neighbours kept for the choice of strings, and tried for a place.
const NEAR: usize = 64;
const WIDTH: usize = 16;

/// Routes for all vehicles, as good as the budget allows.
pub fn solve<M: Metric>(problem: &Problem<'_, M>, options: &Options) -> Result<Solution, Error> {
    let routes = crate::initial::routes(problem)?;
    solve_from(problem, routes, options, &mut |_| true)
}

/// [`solve`] from given routes, never worse than them.
pub fn solve_from<M: Metric>(
    problem: &Problem<'_, M>,
    routes: Vec<Vec<usize>>,
    options: &Options,
    proceed: &mut dyn FnMut(&Progress) -> bool,
) -> Result<Solution, Error> {
    let bounds = lower_bound::both(problem);
    let vertices = problem.targets().len() + problem.vehicles();
    if problem.targets().is_empty() {
        return Solution::with_bounds(problem, routes, bounds);
    }
    let bound = match options.objective {
        crate::Objective::Total => bounds.total_cost,
        crate::Objective::Makespan => bounds.makespan,
    };
    let target = bound * (1.0 + options.gap);
    let routes = if vertices <= STORED {
        improve(problem, &Stored::new(problem), &routes, options, target, proceed)
    } else {
        improve(problem, &Computed::new(problem), &routes, options, target, proceed)
    };
    check(problem, &routes)?;
    Solution::with_bounds(problem, routes, bounds)
}

fn improve<M: Metric>(
    problem: &Problem<'_, M>,
    arcs: &impl Arcs,
    routes: &[Vec<usize>],
    options: &Options,
    target: f64,
    proceed: &mut dyn FnMut(&Progress) -> bool,
) -> Vec<Vec<usize>> {
    let targets = problem.targets();
    let mut position = vec![0u32; problem.metric().len()];
    for (i, &t) in targets.iter().enumerate() {
        position[t] = i as u32;
    }
    let lists: Vec<Vec<u32>> = routes.iter().map(|r| r.iter().map(|&t| position[t]).collect()).collect();
    let near = Neighbours::new(problem, NEAR);
    let mut state = State::new(targets.len(), &lists, arcs);
    let annealing = Annealing {
        arcs,
        near: &near,
        places: Places { near: &near, width: energy::env("WIDTH",16.0) as usize, allowed: vec![], alike: problem.is_homogeneous() },
        objective: options.objective,
        limits: (0..problem.vehicles()).map(|v| problem.limit(v)).collect(),
        target,
    };
    annealing.run(&mut state, options, proceed);
    state.lists().into_iter().map(|list| list.into_iter().map(|i| targets[i as usize]).collect()).collect()
}
