//! Bounds from one or two targets.

use super::rounded_down;
use crate::problem::{End, Problem};
use christofides::Metric;

/// The greatest, over all targets, of the least length of a route that serves this target alone.
///
/// With one depot and closed routes this is twice the radius, plus service. O(n m) distances.
#[must_use]
pub fn radius<M: Metric>(problem: &Problem<'_, M>) -> f64 {
    let mut greatest = 0.0_f64;
    for &target in problem.targets() {
        greatest = greatest.max(alone(problem, target));
    }
    rounded_down(greatest, 3, greatest)
}

/// The least length of a route that serves one target, over the vehicles allowed.
pub(crate) fn alone<M: Metric>(problem: &Problem<'_, M>, target: usize) -> f64 {
    let vehicles = if problem.is_homogeneous() { 1 } else { problem.vehicles() };
    (0..vehicles)
        .filter(|&v| problem.allows(v, target))
        .map(|v| problem.route_length(v, &[target]))
        .fold(f64::INFINITY, f64::min)
}

/// The least length of a route through two targets, over a set of m + 1 targets chosen to make it great.
///
/// Two of any m + 1 targets are served by the same vehicle (or fewer than m + 1 targets exist, and the bound is 0). The set is
/// grown greedily from the farthest target, each time by the target whose least two-target route with those chosen
/// is greatest. For interchangeable vehicles only. O(n m) distances.
#[must_use]
pub fn pigeonhole<M: Metric>(problem: &Problem<'_, M>) -> f64 {
    let targets = problem.targets();
    if !problem.is_homogeneous() || targets.len() <= problem.vehicles() {
        return 0.0;
    }
    let farthest = |key: &dyn Fn(usize) -> f64| {
        (0..targets.len()).fold((0, f64::NEG_INFINITY), |best, i| {
            let value = key(i);
            if value > best.1 { (i, value) } else { best }
        })
    };
    let first = farthest(&|i| alone(problem, targets[i])).0;
    let mut least: Vec<f64> = targets.iter().map(|&t| pair(problem, targets[first], t)).collect();
    least[first] = f64::NEG_INFINITY;
    let mut bound = f64::INFINITY;
    for _ in 0..problem.vehicles() {
        let (next, value) = farthest(&|i| least[i]);
        bound = bound.min(value);
        for (i, &target) in targets.iter().enumerate() {
            least[i] = least[i].min(pair(problem, targets[next], target));
        }
        least[next] = f64::NEG_INFINITY;
    }
    rounded_down(bound, 5, bound)
}

/// The least length of a route through both targets, in either order.
fn pair<M: Metric>(problem: &Problem<'_, M>, a: usize, b: usize) -> f64 {
    let metric = problem.metric();
    let start = problem.start(0);
    let service = problem.service()[a] + problem.service()[b];
    let (end_a, end_b) = match problem.end(0) {
        End::At(node) => (metric.distance(a, node), metric.distance(b, node)),
        End::Open => (0.0, 0.0),
    };
    let forward = metric.distance(start, a) + metric.distance(a, b) + end_b;
    let backward = metric.distance(start, b) + metric.distance(b, a) + end_a;
    service + forward.min(backward)
}
