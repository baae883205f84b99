//! A given order of the targets cut into one route a vehicle.

use crate::check::check;
use crate::error::{Error, List};
use crate::objective::Objective;
use crate::problem::{End, Problem, expect_length};
use christofides::Metric;

/// The best cuts of a given order: vehicle 0 takes the first targets, vehicle 1 the next, and so on; some may stay at home.
///
/// Dynamic programming over vehicles and cut positions. For the makespan it uses that a route grows with
/// its targets and that the best value grows with the number of targets, and finds each cut by bisection.
///
/// # Arguments
/// * `order`: every target once.
///
/// # Guarantee
/// No other cuts of this order have a lower value, given the triangle inequality (for [`Objective::Total`] without it).
/// Limits and forbidden pairs are not looked at.
///
/// # Errors
/// [`Error::WrongLength`], [`Error::UnknownNode`], and those of [`check`](crate::check()) for an order that is not a permutation of
/// the targets.
///
/// # Complexity
/// O(m n log n) for the makespan, O(m n^2) for the total; O(m n) memory.
pub fn split<M: Metric>(
    problem: &Problem<'_, M>,
    order: &[usize],
    objective: Objective,
) -> Result<Vec<Vec<usize>>, Error> {
    expect_length(List::TourTargets, problem.targets().len(), order.len())?;
    let nodes = problem.metric().len();
    if let Some(&node) = order.iter().find(|&&node| node >= nodes) {
        return Err(Error::UnknownNode { node, nodes });
    }
    let along = Along::new(problem, order);
    let cuts = along.best_cuts(objective);
    let routes: Vec<Vec<usize>> = cuts.windows(2).map(|cut| order[cut[0]..cut[1]].to_vec()).collect();
    check(&problem.without_restrictions(), &routes)?;
    Ok(routes)
}

/// How many interchangeable vehicles can take an order one after the other, each as much as its limit allows; none if a target is out of reach.
pub(crate) fn fewest_routes<M: Metric>(problem: &Problem<'_, M>, order: &[usize]) -> Option<usize> {
    let along = Along::new(problem, order);
    let limit = problem.limit(0);
    let (mut vehicles, mut i) = (0, 0);
    while i < order.len() {
        let mut j = i;
        while j < order.len() && along.length(0, i, j + 1) <= limit {
            j += 1;
        }
        if j == i {
            return None;
        }
        (vehicles, i) = (vehicles + 1, j);
    }
    Some(vehicles)
}

/// Prefix sums along an order, so that the route through `i..j` is measured in constant time.
struct Along<'a, M: Metric> {
    problem: &'a Problem<'a, M>,
    order: &'a [usize],
    /// `path[i]`: service and legs from the first target up to arriving at target `i`.
    path: Vec<f64>,
}

impl<'a, M: Metric> Along<'a, M> {
    fn new(problem: &'a Problem<'a, M>, order: &'a [usize]) -> Self {
        let mut path = Vec::with_capacity(order.len());
        let mut sum = 0.0;
        for (i, &target) in order.iter().enumerate() {
            if i > 0 {
                sum += problem.service()[order[i - 1]] + problem.metric().distance(order[i - 1], target);
            }
            path.push(sum);
        }
        Self { problem, order, path }
    }

    /// The length of the route of `vehicle` through positions `i..j`.
    fn length(&self, vehicle: usize, i: usize, j: usize) -> f64 {
        if i >= j {
            return 0.0;
        }
        let (first, last) = (self.order[i], self.order[j - 1]);
        let metric = self.problem.metric();
        let home = match self.problem.end(vehicle) {
            End::At(node) => metric.distance(last, node),
            End::Open => 0.0,
        };
        let legs = self.path[j - 1] - self.path[i] + self.problem.service()[last];
        metric.distance(self.problem.start(vehicle), first) + legs + home
    }

    /// Positions `0 = c_0 <= c_1 <= .. <= c_m = n`.
    fn best_cuts(&self, objective: Objective) -> Vec<usize> {
        let (n, m) = (self.order.len(), self.problem.vehicles());
        let mut value: Vec<f64> = (0..=n).map(|j| self.length(0, 0, j)).collect();
        let mut from: Vec<Vec<usize>> = vec![vec![0; n + 1]];
        for vehicle in 1..m {
            let best: Vec<(f64, usize)> = (0..=n)
                .map(|j| match objective {
                    Objective::Total => self.cheapest_cut(&value, vehicle, j),
                    Objective::Makespan => self.flattest_cut(&value, vehicle, j),
                })
                .collect();
            value = best.iter().map(|b| b.0).collect();
            from.push(best.into_iter().map(|b| b.1).collect());
        }
        let mut cuts = vec![n];
        for vehicle in (0..m).rev() {
            let here = cuts[cuts.len() - 1];
            cuts.push(from[vehicle][here]);
        }
        cuts.reverse();
        cuts
    }

    fn cheapest_cut(&self, value: &[f64], vehicle: usize, j: usize) -> (f64, usize) {
        (0..=j).fold((f64::INFINITY, 0), |best, i| {
            let total = value[i] + self.length(vehicle, i, j);
            if total < best.0 { (total, i) } else { best }
        })
    }

    /// The first cut at which the vehicles before are no better off than this one, or the one before it.
    fn flattest_cut(&self, value: &[f64], vehicle: usize, j: usize) -> (f64, usize) {
        let (mut low, mut high) = (0, j);
        while low < high {
            let middle = (low + high) / 2;
            if value[middle] >= self.length(vehicle, middle, j) {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        let at = |i: usize| (value[i].max(self.length(vehicle, i, j)), i);
        let (after, before) = (at(low), at(low.saturating_sub(1)));
        if before.0 <= after.0 { before } else { after }
    }
}

/// Splits a tour through the depot into one closed route a vehicle, with a proven factor.
///
/// Frederickson, Hecht, Kim (1978), "Approximation algorithms for some routing problems", doi:10.1137/0207017, algorithm
/// k-SPLITOUR: with L the cost of the tour and c the greatest distance from the depot, route j ends at the last target that
/// the tour reaches within `c + (L - 2 c) j / m`. Service costs are put on the legs, half at each end, which keeps the triangle inequality.
///
/// # Arguments
/// * `order`: the targets in the order of a tour that starts and ends at the depot.
///
/// # Guarantee
/// The longest route is at most `(L - 2 c)/m + 2 c`, hence at most `e + 1 - 1/m` times the least makespan, where `e` is the factor of
/// the tour: 5/2 - 1/m after Christofides. For closed routes from one depot, a symmetric metric, no limits or forbidden pairs. [`split`] of
/// the same order is never worse.
///
/// # Errors
/// [`Error::NotTheBasicVariant`] and those of [`split`].
///
/// # Complexity
/// O(n).
pub fn k_splitour<M: Metric>(problem: &Problem<'_, M>, order: &[usize]) -> Result<Vec<Vec<usize>>, Error> {
    let depot = problem.basic_depot().ok_or(Error::NotTheBasicVariant)?;
    expect_length(List::TourTargets, problem.targets().len(), order.len())?;
    let nodes = problem.metric().len();
    if let Some(&node) = order.iter().find(|&&node| node >= nodes) {
        return Err(Error::UnknownNode { node, nodes });
    }
    let half = |node: usize| if node == depot { 0.0 } else { 0.5 * problem.service()[node] };
    let leg = |a: usize, b: usize| problem.metric().distance(a, b) + (half(a) + half(b));
    let m = problem.vehicles();
    let farthest = order.iter().map(|&t| leg(depot, t)).fold(0.0, f64::max);
    let mut reached = Vec::with_capacity(order.len());
    let (mut here, mut sum) = (depot, 0.0);
    for &target in order {
        sum += leg(here, target);
        reached.push(sum);
        here = target;
    }
    let tour = if order.is_empty() { 0.0 } else { sum + leg(here, depot) };
    let mut routes = Vec::with_capacity(m);
    let mut start = 0;
    for j in 1..=m {
        let limit = farthest + (tour - 2.0 * farthest) * j as f64 / m as f64;
        let end = if j == m { order.len() } else { reached.partition_point(|&r| r <= limit).max(start) };
        routes.push(order[start..end].to_vec());
        start = end;
    }
    check(problem, &routes)?;
    Ok(routes)
}
