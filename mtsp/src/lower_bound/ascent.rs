//! The Lagrangian bound: a spanning tree, last legs, and multipliers on degrees.
//!
//! Contract all depots to one node 0 with `s_i` the least first leg to target i and `e_i` the least last leg (0 for open
//! routes). A solution with k routes is a spanning tree over 0 and the targets (the routes without their last legs) plus k last legs from
//! k different targets. In it the tree degree of a target plus its last leg is 2, and the tree degree of the depot is k. Hence
//! for all multipliers p
//!
//! ```text
//! total >= MST(s_i + p_i + p_0, d_ij + p_i + p_j) + min over k of [k least of e_i + p_i - p_0] - 2 sum p_i + sum service
//! ```
//!
//! with k = m for exactly m routes, 1 <= k <= m for at most m. Doubled edges 0-i-0 are allowed (tree edge and last leg). This is the
//! 1-tree bound (Held and Karp 1970, doi:10.1287/opre.18.6.1138) with the depot's degree in the relaxation; multipliers by subgradient
//! steps. Every tree is minimal on the complete graph (dense Prim), so every iterate is a valid bound and the best is returned.

use super::rounded_down;
use crate::problem::{End, Problem};
use christofides::Metric;

/// How many vehicles leave the depot, in [`forest`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NumRoutes {
    /// Between one and all of them: the tightest that holds for min-sum.
    AtMost,
    /// All of them: no bound for solutions in which a vehicle stays at home.
    Exactly,
}

/// A lower bound on the total cost (service included) of all solutions with the given number of routes.
///
/// The formula and its proof are at the top of this page's source: a spanning tree of the targets and the depot, plus the cheapest
/// last legs, maximised over multipliers on the degrees.
///
/// # Arguments
/// * `iterations`: subgradient steps; 0 gives the bound with all multipliers 0.
///
/// # Returns
/// The bound, rounded down; 0 without targets, or for [`NumRoutes::Exactly`] with fewer targets than vehicles (no such solution).
///
/// # Complexity
/// O(n^2) time an iteration, O(n^2) memory up to 1500 targets, O(n) beyond.
#[must_use]
pub fn forest<M: Metric>(problem: &Problem<'_, M>, routes: NumRoutes, iterations: usize) -> f64 {
    let n = problem.targets().len();
    if n == 0 || (routes == NumRoutes::Exactly && n < problem.vehicles()) {
        return 0.0;
    }
    let service: f64 = problem.targets().iter().map(|&t| problem.service()[t]).sum();
    let mut ascent = Ascent::new(problem, routes);
    let mut best = ascent.evaluate();
    // First step: a quarter of the mean edge; geometric decay to a thousandth of it. Measured within 0.1 % of slower
    // schedules on the instances of the literature.
    let mut step = 0.25 * best.0.abs() / n as f64;
    let decay = 0.001_f64.powf(1.0 / iterations.max(1) as f64);
    for _ in 0..iterations {
        if !ascent.advance(step) {
            break; // all degrees are right: the relaxation is a solution and the bound is its value
        }
        step *= decay;
        let bound = ascent.evaluate();
        if bound.0 > best.0 {
            best = bound;
        }
    }
    rounded_down(best.0 + service, 2 * n, best.1 + service)
}

/// Multipliers and the state of one evaluation; vertex `n` is the depot.
struct Ascent<'a, M: Metric> {
    problem: &'a Problem<'a, M>,
    first_leg: Vec<f64>,
    last_leg: Vec<f64>,
    /// Distances between targets by rows, empty if there are too many.
    matrix: Vec<f64>,
    /// Number of routes: least and greatest.
    k: (usize, usize),
    multiplier: Vec<f64>,
    /// Degree minus the degree wanted, of this and of the last evaluation.
    excess: Vec<f64>,
    last_excess: Vec<f64>,
    key: Vec<f64>,
    parent: Vec<usize>,
    outside: Vec<usize>,
    legs: Vec<(f64, usize)>,
}

/// Up to this many targets distances are stored: 18 MB.
const STORED: usize = 1500;

impl<'a, M: Metric> Ascent<'a, M> {
    fn new(problem: &'a Problem<'a, M>, routes: NumRoutes) -> Self {
        let (metric, targets, m) = (problem.metric(), problem.targets(), problem.vehicles());
        let n = targets.len();
        let vehicles = if problem.is_homogeneous() { 1 } else { m };
        let least = |leg: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            targets.iter().map(|&t| (0..vehicles).map(|v| leg(v, t)).fold(f64::INFINITY, f64::min)).collect()
        };
        let first_leg = least(&|v, t| metric.distance(problem.start(v), t));
        let last_leg = least(&|v, t| match problem.end(v) {
            End::At(node) => metric.distance(t, node),
            End::Open => 0.0,
        });
        let mut matrix = Vec::new();
        if n <= STORED {
            matrix.reserve(n * n);
            for &a in targets {
                matrix.extend(targets.iter().map(|&b| either_way(metric, a, b)));
            }
        }
        let k = if routes == NumRoutes::Exactly { (m, m) } else { (1, m.min(n)) };
        let zeros = vec![0.0; n + 1];
        Self {
            problem,
            first_leg,
            last_leg,
            matrix,
            k,
            multiplier: zeros.clone(),
            excess: zeros.clone(),
            last_excess: zeros,
            key: vec![0.0; n],
            parent: vec![0; n],
            outside: Vec::with_capacity(n),
            legs: Vec::with_capacity(n),
        }
    }

    /// The bound without service at the current multipliers, and the absolute sum of its terms; sets the excess degrees.
    fn evaluate(&mut self) -> (f64, f64) {
        let n = self.first_leg.len();
        std::mem::swap(&mut self.excess, &mut self.last_excess);
        self.excess[..n].fill(-2.0);
        self.excess[n] = 0.0;
        let (tree, tree_magnitude) = self.spanning_tree();
        let (legs, legs_magnitude) = self.last_legs();
        let (mut twice, mut magnitude) = (0.0, tree_magnitude + legs_magnitude);
        for p in &self.multiplier[..n] {
            twice += 2.0 * p;
            magnitude += 2.0 * p.abs();
        }
        (tree + legs - twice, magnitude)
    }

    /// Dense Prim from the depot.
    fn spanning_tree(&mut self) -> (f64, f64) {
        let n = self.first_leg.len();
        let (mut sum, mut magnitude) = (0.0, 0.0);
        for i in 0..n {
            self.key[i] = self.first_leg[i] + self.multiplier[i] + self.multiplier[n];
            self.parent[i] = n;
        }
        self.outside.clear();
        self.outside.extend(0..n);
        let mut nearest = position_of_least(&self.key, &self.outside);
        while let Some(position) = nearest {
            let vertex = self.outside.swap_remove(position);
            sum += self.key[vertex];
            magnitude += self.key[vertex].abs();
            self.excess[vertex] += 1.0;
            self.excess[self.parent[vertex]] += 1.0;
            nearest = self.relax(vertex);
        }
        (sum, magnitude)
    }

    /// Lowers the keys of the vertices outside the tree by edges to `vertex`; returns the position of the least key.
    fn relax(&mut self, vertex: usize) -> Option<usize> {
        let n = self.first_leg.len();
        let (targets, metric) = (self.problem.targets(), self.problem.metric());
        let row = self.matrix.get(vertex * n..(vertex + 1) * n);
        let shift = self.multiplier[vertex];
        let mut least = (f64::INFINITY, None);
        for (position, &i) in self.outside.iter().enumerate() {
            let distance = match row {
                Some(row) => row[i],
                None => either_way(metric, targets[vertex], targets[i]),
            };
            let cost = distance + shift + self.multiplier[i];
            if cost < self.key[i] {
                self.key[i] = cost;
                self.parent[i] = vertex;
            }
            if self.key[i] < least.0 || least.1.is_none() {
                least = (self.key[i], Some(position));
            }
        }
        least.1
    }

    /// The cheapest last legs, of different targets.
    fn last_legs(&mut self) -> (f64, f64) {
        let n = self.first_leg.len();
        let depot = self.multiplier[n];
        self.legs.clear();
        self.legs.extend((0..n).map(|i| (self.last_leg[i] + self.multiplier[i] - depot, i)));
        let (fewest, most) = self.k;
        if most < n {
            self.legs.select_nth_unstable_by(most, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        }
        self.legs.truncate(most);
        self.legs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let (mut sum, mut magnitude) = (0.0, 0.0);
        for (count, &(cost, target)) in self.legs.iter().enumerate() {
            if count >= fewest && cost >= 0.0 {
                break;
            }
            sum += cost;
            magnitude += cost.abs();
            self.excess[target] += 1.0;
            self.excess[n] -= 1.0;
        }
        (sum, magnitude)
    }

    /// A step along the subgradient, damped by the last one (Volgenant and Jonker 1982); false if it is zero.
    fn advance(&mut self, step: f64) -> bool {
        let mut any = false;
        for i in 0..self.excess.len() {
            any |= self.excess[i] != 0.0;
            self.multiplier[i] += step * (0.6 * self.excess[i] + 0.4 * self.last_excess[i]);
        }
        any
    }
}

/// The shorter of the two directions, so that the bound holds for asymmetric distances too.
fn either_way(metric: &impl Metric, a: usize, b: usize) -> f64 {
    metric.distance(a, b).min(metric.distance(b, a))
}

fn position_of_least(key: &[f64], outside: &[usize]) -> Option<usize> {
    (0..outside.len()).min_by(|&a, &b| key[outside[a]].total_cmp(&key[outside[b]]))
}
