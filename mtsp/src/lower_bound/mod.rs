//! Certified lower bounds: values that no solution of the same problem can be below.
//!
//! They hold for distances that obey the triangle inequality, symmetric or not, with service costs, and are computed for the
//! instance at hand. `S` is the sum of all service costs, `m` the number of vehicles, `n` the number of targets.
//!
//! | variant | bound | why |
//! |---|---|---|
//! | any, makespan | [`radius`]: max over targets of the least single-target route | the vehicle that serves the target flies there and to its end; detours do not shorten this (triangle inequality) |
//! | interchangeable vehicles, makespan | [`pigeonhole`]: least two-target route among any m + 1 targets | two of them share a route |
//! | any, total | [`forest`] with at most m routes | routes without their last legs connect all targets to the depots; see there |
//! | interchangeable vehicles, n >= m, makespan | ([`forest`] with exactly m routes) / m | splitting a route in two lengthens neither (triangle inequality), so some best solution uses all vehicles; the longest is at least the mean |
//! | other vehicles, makespan | ([`forest`] with at most m routes) / m | the longest is at least the mean over all m |
//! | limits, forbidden and required pairs | those of the problem without them, except that [`radius`] looks at allowed vehicles only | a restriction never improves the best |
//! | closed routes from one depot, total and m makespans | [`tour`]: Held-Karp bound of the tour through the depot and all targets | all routes one after the other are a closed walk; leaving out the visits to the depot between them does not lengthen it (triangle inequality) |
//! | closed routes from one depot, makespan | `columns` (feature `columns`): prizes that no route up to a length collects more than 1 of, and that sum to more than m | m routes up to that length would collect all prizes between them |
//! | several depots | legs to and from the nearest depot | a relaxation: each route's own depot is no nearer |
//! | open routes | last legs cost 0 | exact |
//! | asymmetric distances | the shorter direction between targets | a relaxation |
//!
//! Values are rounded down by a bound on the rounding error of their sums. Without the triangle inequality nothing is claimed.

mod ascent;
#[cfg(feature = "columns")]
mod columns;
mod quick;
mod tour;

pub use ascent::{NumRoutes, forest};
#[cfg(feature = "columns")]
pub use columns::columns;
pub use quick::{pigeonhole, radius};
pub use tour::tour;

use crate::problem::Problem;
use christofides::Metric;

/// Lower bounds of both objectives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LowerBounds {
    /// No solution's longest route is shorter.
    pub makespan: f64,
    /// No solution's routes sum to less.
    pub total_cost: f64,
}

/// The best lower bounds known here for both objectives, with as many ascent iterations as suit the size.
///
/// # Complexity
/// O(n^2) an iteration, 300 iterations up to 500 targets, fewer beyond, so that it takes about a second at most up to 3 000 targets;
/// beyond, with closed routes from one depot, O(n log n) an iteration for points ([`tour`]).
#[must_use]
pub fn both<M: Metric>(problem: &Problem<'_, M>) -> LowerBounds {
    let n = problem.targets().len();
    if n <= DENSE || problem.closed_depot().is_none() {
        return with_iterations(problem, suitable_iterations(n));
    }
    // Too many for dense trees: the sparse ascent on tours sees the depot once, but gets far more iterations.
    let total_cost = tour(problem, SPARSE_ITERATIONS).max(radius(problem));
    let mut makespan = (total_cost / problem.vehicles() as f64).max(radius(problem));
    if problem.is_homogeneous() {
        makespan = makespan.max(pigeonhole(problem));
    }
    LowerBounds { makespan, total_cost }
}

/// Up to this many targets trees are found on the complete graph; beyond, iterations on candidate edges.
const DENSE: usize = 3000;
const SPARSE_ITERATIONS: usize = 60;

/// Lower bounds without the ascent: radius, pigeonhole and one spanning tree. O(n (n + m)).
#[must_use]
pub fn quick<M: Metric>(problem: &Problem<'_, M>) -> LowerBounds {
    with_iterations(problem, 0)
}

/// Lower bounds with the given number of ascent iterations.
#[must_use]
pub fn with_iterations<M: Metric>(problem: &Problem<'_, M>, iterations: usize) -> LowerBounds {
    let total_cost = forest(problem, NumRoutes::AtMost, iterations);
    let exact = problem.is_homogeneous() && problem.targets().len() >= problem.vehicles();
    let all_used = if exact { forest(problem, NumRoutes::Exactly, iterations) } else { total_cost };
    let mut makespan = (all_used / problem.vehicles() as f64).max(radius(problem));
    if problem.is_homogeneous() {
        makespan = makespan.max(pigeonhole(problem));
    }
    LowerBounds { makespan, total_cost: total_cost.max(radius(problem)) }
}

fn suitable_iterations(n: usize) -> usize {
    const WORK: usize = 75_000_000;
    (WORK / (n * n).max(1)).clamp(4, 300)
}

/// `value` less a bound on the error of a sum of `terms` numbers with absolute sum `magnitude`, but not below 0.
fn rounded_down(value: f64, terms: usize, magnitude: f64) -> f64 {
    (value - (terms as f64 + 8.0) * f64::EPSILON * magnitude).max(0.0)
}
