//! The makespan bound by column generation: no `m` routes of at most a given length cover the targets, not even in fractions.
//!
//! If all routes are at most `L` long, then some routes `r`, each taken once, visit every target. Allow fractions of routes: with `a_ir` the visits of
//! route r to target i, the least number of routes is the linear program and its dual
//!
//! ```text
//! min sum x_r,  sum_r a_ir x_r >= 1,  x >= 0     =     max sum p_i,  sum_i a_ir p_i <= 1 for all routes r of length <= L,  p >= 0
//! ```
//!
//! Prizes `p` that no route of length at most `L` collects more than 1 of, and that sum to more than `m`, prove that every solution has a route longer
//! than `L`. Prizes come from the program over the routes known so far, and routes that collect too much from [`price`]. Routes may there revisit a
//! target once they have been away from its neighbourhood (ng-routes: Baldacci, Mingozzi, Roberti 2011, doi:10.1287/opre.1110.0975), which only
//! weakens the bound. Cuts tighten the program, at a charge to the routes in them. The greatest `L` that is refuted is found by bisection, without
//! cuts first.

mod completion;
mod cuts;
mod master;
mod pricing;

use super::both;
use crate::check::check;
use crate::error::Error;
use crate::problem::Problem;
use christofides::Metric;
use cuts::{CUTS, Triple, violated};
use master::{Prices, master};
use pricing::{Effort, price};

/// Targets at most: the memory of a route is a bit set.
pub(super) const TARGETS: usize = 128;

/// The bisection ends when the interval is this part of the bound.
const PRECISION: f64 = 1e-3;

/// The sum of prizes must exceed the number of vehicles by this part: far above the rounding of a hundred sums.
const MARGIN: f64 = 1e-7;

/// Rounds of pricing a limit is given before it counts as not refuted.
const ROUNDS: usize = 400;

/// The share of the best prizes so far in those that are priced (Wentges 1997, doi:10.1016/S0969-6016(97)00004-2).
const SMOOTHING: f64 = 0.7;

/// Routes kept, and the slack beyond which they are dropped when there are more.
const KEPT: usize = 4000;
const FAR: f64 = 0.1;

/// A cut with a smaller charge does nothing.
const IDLE: f64 = 1e-6;

/// A lower bound on the makespan, far tighter than that of [`both`] where routes are short, by column generation.
///
/// # Arguments
/// * `routes`: some solution; the better it is, the faster. The bound is below its makespan.
/// * `max_cuts`: cuts at most, no more than 192 are used; 0 for the plain program, which is faster.
/// * `proceed`: asked before every pricing; false ends the search with the bound proven by then.
///
/// # Returns
/// The bound, at least that of [`both`], and no more than this for other variants: it takes closed routes from one depot, without limits and forbidden
/// pairs, symmetric distances, at most 128 targets. Deterministic as long as `proceed` is.
///
/// # Errors
/// Those of [`check`](crate::check()) for the routes given.
///
/// # Complexity
/// Exponential at worst; some 10 s for 100 targets and 8 vehicles, minutes with cuts. Where routes have
/// dozens of targets, single pricings take seconds.
///
/// # Examples
/// ```
/// use christofides::Points;
/// use mtsp::{Options, Problem, lower_bound, solve};
///
/// // Two vehicles, three groups of two targets on a circle: one vehicle has two groups.
/// let nodes = [[0.0, 0.0], [10.0, 1.0], [10.0, -1.0], [-5.0, 8.0], [-6.0, 7.0], [-5.0, -8.0], [-6.0, -7.0]];
/// let metric = Points(&nodes);
/// let problem = Problem::new(&metric, 2)?;
/// let solution = solve(&problem, &Options::default().with_iterations(1000))?;
/// let bound = lower_bound::columns(&problem, &solution.routes, 0, &mut || true)?;
/// assert!(bound > solution.lower_bounds.makespan && bound <= solution.makespan);
/// # Ok::<(), mtsp::Error>(())
/// ```
pub fn columns<M: Metric>(
    problem: &Problem<'_, M>,
    routes: &[Vec<usize>],
    max_cuts: usize,
    proceed: &mut dyn FnMut() -> bool,
) -> Result<f64, Error> {
    let makespan = check(problem, routes)?.makespan;
    let mut low = both(problem).makespan;
    let Some(graph) = Graph::new(problem) else { return Ok(low) };
    let mut cover = Cover::new(&graph, routes, problem);
    for max_cuts in [0, max_cuts.min(CUTS)] {
        let mut high = makespan;
        while high - low > PRECISION * high {
            // The bound is mostly above the middle, with cuts not so far.
            let limit = low + if max_cuts == 0 { 0.75 } else { 0.5 } * (high - low);
            match cover.refutes(limit, max_cuts, proceed) {
                Outcome::Refuted => low = limit,
                Outcome::Standing => high = limit,
                Outcome::Stopped => return Ok(low),
            }
        }
        if max_cuts > 0 || makespan - low <= PRECISION * makespan {
            break;
        }
    }
    Ok(low)
}

/// Distances with half of each service cost at either end, node 0 the depot, nodes 1.. the targets.
pub(super) struct Graph {
    pub nodes: usize,
    vehicles: usize,
    legs: Vec<f64>,
    /// For each target the others by distance.
    pub near: Vec<Vec<usize>>,
}

impl Graph {
    fn new<M: Metric>(problem: &Problem<'_, M>) -> Option<Self> {
        let depot = problem.basic_depot()?;
        let targets = problem.targets();
        if targets.is_empty() || targets.len() > TARGETS {
            return None;
        }
        let mut places = vec![depot];
        places.extend(targets);
        let nodes = places.len();
        let half = |i: usize| if i == 0 { 0.0 } else { 0.5 * problem.service()[places[i]] };
        let mut legs = vec![0.0; nodes * nodes];
        for i in 0..nodes {
            for j in (0..nodes).filter(|&j| j != i) {
                let leg = problem.leg(places[i], places[j]).ok()?;
                if leg != problem.metric().distance(places[j], places[i]) {
                    return None;
                }
                // The sum of halves first: the same both ways.
                legs[i * nodes + j] = leg + (half(i) + half(j));
            }
        }
        let mut graph = Self { nodes, vehicles: problem.vehicles(), legs, near: vec![vec![]; nodes] };
        for i in 1..nodes {
            let mut others: Vec<usize> = (1..nodes).filter(|&j| j != i).collect();
            others.sort_by(|&a, &b| graph.leg(i, a).total_cmp(&graph.leg(i, b)));
            graph.near[i] = others;
        }
        Some(graph)
    }

    #[inline]
    pub fn leg(&self, i: usize, j: usize) -> f64 {
        self.legs[i * self.nodes + j]
    }

    fn length(&self, route: &[usize]) -> f64 {
        let (Some(&first), Some(&last)) = (route.first(), route.last()) else { return 0.0 };
        let inner: f64 = route.windows(2).map(|leg| self.leg(leg[0], leg[1])).sum();
        self.leg(0, first) + inner + self.leg(last, 0)
    }
}

enum Outcome {
    /// There is no fractional cover with this limit: proven.
    Refuted,
    /// There is one, or neither was found with the effort that a limit is given.
    Standing,
    /// The caller wants no more.
    Stopped,
}

/// The routes known so far, with their lengths, and cuts; limits share them.
struct Cover<'a> {
    graph: &'a Graph,
    routes: Vec<(f64, Vec<usize>)>,
    cuts: Vec<Triple>,
}

impl<'a> Cover<'a> {
    fn new<M: Metric>(graph: &'a Graph, routes: &[Vec<usize>], problem: &Problem<'_, M>) -> Self {
        let mut cover = Self { graph, routes: vec![], cuts: vec![] };
        let position = |target: &usize| problem.targets().binary_search(target).map_or(0, |i| i + 1);
        let given = routes.iter().map(|route| route.iter().map(position).collect::<Vec<usize>>());
        // Routes to single targets keep the program bounded.
        cover.add(given.chain((1..graph.nodes).map(|i| vec![i])).collect());
        cover
    }

    fn add(&mut self, routes: Vec<Vec<usize>>) {
        let graph = self.graph;
        self.routes.extend(routes.into_iter().map(|route| (graph.length(&route), route)));
    }

    fn refutes(&mut self, limit: f64, max_cuts: usize, proceed: &mut dyn FnMut() -> bool) -> Outcome {
        let vehicles = self.graph.vehicles as f64;
        let (mut centre, mut smoothing, mut effort) = (None::<Prices>, SMOOTHING, Effort::Quick);
        for _ in 0..ROUNDS {
            let Some((prices, shares)) = self.prices(limit) else { return Outcome::Standing };
            if prices.sum() <= vehicles {
                if !self.cut(limit, &prices, &shares, max_cuts) {
                    return Outcome::Standing;
                }
                (centre, smoothing, effort) = (None, SMOOTHING, Effort::Quick);
                continue;
            }
            let mixed = centre.as_ref().unwrap_or(&prices).mixed(smoothing, &prices);
            if !proceed() {
                return Outcome::Stopped;
            }
            let Some(found) = price(self.graph, &mixed, &self.cuts, limit, effort) else {
                return Outcome::Standing;
            };
            let mixed = mixed.divided_by(found.most);
            if effort == Effort::Exact && mixed.sum() > vehicles * (1.0 + MARGIN) {
                return Outcome::Refuted;
            }
            if found.routes.is_empty() {
                match effort {
                    Effort::Quick => effort = Effort::Exact,
                    // Nothing collects too much even at prices that are hardly mixed: the program is solved.
                    Effort::Exact if smoothing < 0.05 => return Outcome::Standing,
                    Effort::Exact => smoothing *= 0.5,
                }
            }
            self.add(found.routes);
            centre = Some(mixed);
        }
        Outcome::Standing
    }

    fn within(&self, limit: f64) -> Vec<&[usize]> {
        self.routes.iter().filter(|r| r.0 <= limit).map(|r| r.1.as_slice()).collect()
    }

    /// The best prices for the routes within the limit, and the shares of these routes.
    fn prices(&mut self, limit: f64) -> Option<(Prices, Vec<f64>)> {
        if self.routes.len() > KEPT {
            let (prices, _) = master(self.graph.nodes, &self.within(limit), &self.cuts)?;
            let cuts = &self.cuts;
            // Routes far from collecting 1 are dropped, those beyond the limit with them.
            self.routes
                .retain(|r| r.1.len() == 1 || (r.0 <= limit && prices.collected(&r.1, cuts) > 1.0 - FAR));
        }
        master(self.graph.nodes, &self.within(limit), &self.cuts)
    }

    /// Adds cuts that the shares violate, in the place of those without a charge; whether there are any.
    fn cut(&mut self, limit: f64, prices: &Prices, shares: &[f64], max_cuts: usize) -> bool {
        if max_cuts == 0 {
            return false;
        }
        let found = violated(self.graph.nodes, &self.within(limit), shares);
        let mut charges = prices.charges.iter();
        if self.cuts.len() + found.len() > max_cuts {
            self.cuts.retain(|_| charges.next().is_some_and(|&charge| charge > IDLE));
        }
        let before = self.cuts.len();
        for triple in found {
            if self.cuts.len() < max_cuts && !self.cuts.contains(&triple) {
                self.cuts.push(triple);
            }
        }
        self.cuts.len() > before
    }
}
