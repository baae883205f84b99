//! Who circles what, and in which order (the paper's Algorithm 2, or routes optimised for the objective).

use crate::bound::{Drift, Envelope, LegTimes};
use crate::circles::Orbit;
use crate::error::Error;
use crate::mission::{Mission, Objective, Pipeline};
use crate::options::Options;
use crate::plan::{Plan, VehiclePlan};
use mtsp::{Problem, assign};
use nalgebra::Vector2;

/// Restarts of k-means, scikit-learn's long-standing default.
const RESTARTS: usize = 10;

/// Iterations of the optimising allocation for each target: a tenth of a second at 100 targets. `mtsp`'s example `routes` tells
/// what longer runs gain.
const ITERATIONS_PER_TARGET: u64 = 1000;

/// The routing problem of a mission, and how long to search.
pub(crate) struct Routing<'a> {
    mission: &'a Mission,
    orbits: &'a [Orbit],
    legs: LegTimes,
    service: Vec<f64>,
    search: mtsp::Options,
    watch: Options<'a>,
}

impl<'a> Routing<'a> {
    pub(crate) fn new(
        mission: &'a Mission,
        orbits: &'a [Orbit],
        envelope: &Envelope,
        options: &Options<'a>,
    ) -> Self {
        let (legs, service) = legs(mission, orbits, envelope);
        let objective = match mission.objective {
            Objective::Makespan => mtsp::Objective::Makespan,
            Objective::Total => mtsp::Objective::Total,
        };
        let default = ITERATIONS_PER_TARGET * orbits.len() as u64;
        let search = mtsp::Options::default()
            .with_objective(objective)
            .with_seed(mission.seed)
            .with_iterations(options.search_iterations.unwrap_or(default));
        Self { mission, orbits, legs, service, search, watch: *options }
    }

    fn problem(&self, n_vehicles: usize) -> Result<Problem<'_, LegTimes>, mtsp::Error> {
        Problem::new(&self.legs, n_vehicles)?.with_service(self.service.clone())
    }

    /// The circles of each vehicle in the order of their visits; spare vehicles get none.
    pub(crate) fn routes(&self) -> Result<Vec<Vec<usize>>, Error> {
        let Self { mission, orbits, .. } = *self;
        let problem = self.problem(mission.fleet.vehicles)?;
        let solution = match mission.pipeline {
            Pipeline::Paper => {
                let clusters = mission.fleet.vehicles.min(orbits.len());
                let centres: Vec<[f64; 2]> = orbits.iter().map(|orbit| orbit.circle.centre).collect();
                let labels = match self.watch.clustering {
                    Some(clustering) => clustering(&centres, clusters),
                    None => {
                        let options = cluster::KMeansOptions::default();
                        let options = options.with_seed(mission.seed).with_n_init(RESTARTS);
                        cluster::kmeans(&centres, clusters, &options)?.labels
                    }
                };
                assign(&problem, &labels)?
            }
            Pipeline::Optimised => {
                let goes_on =
                    |_: &mtsp::Progress| !self.watch.should_stop.is_some_and(|should_stop| should_stop());
                mtsp::solve_with(&problem, &self.search, &mut { goes_on })?
            }
        };
        Ok(solution.routes.into_iter().map(to_circles).collect())
    }

    /// The cost of a plan's longest route.
    pub(crate) fn longest(&self, plan: &Plan) -> Option<f64> {
        let problem = self.problem(self.orbits.len()).ok()?;
        let nodes = |planned: &VehiclePlan| planned.route.iter().map(|circle| circle + 1).collect::<Vec<_>>();
        let costs = plan.vehicles.iter().map(nodes).map(|route| problem.route_length(0, &route));
        Some(costs.fold(0.0, f64::max))
    }

    /// How many routes that cost at most `limit` are enough, by a search of a tenth of the iterations; `None` if there are none.
    pub(crate) fn enough_routes(&self, limit: f64) -> Option<usize> {
        let search = self.search.clone().with_iterations(self.search.iterations / 10);
        Some(self.least_fleet(limit, &search)?.1.vehicles)
    }

    fn least_fleet(
        &self,
        limit: f64,
        search: &mtsp::Options,
    ) -> Option<(Problem<'_, LegTimes>, mtsp::LeastFleet)> {
        let n = self.orbits.len();
        let problem = self.problem(n).ok()?.with_limits(vec![limit; n]).ok()?;
        let found = mtsp::least_fleet(&problem, search).ok()?;
        Some((problem, found))
    }

    /// Routes that cost at most `limit`, as few as were found, with their costs; `None` if there are none.
    pub(crate) fn fewest_routes(&self, limit: f64) -> Option<Vec<(Vec<usize>, f64)>> {
        let (problem, found) = self.least_fleet(limit, &self.search)?;
        let routes = found.solution.routes.into_iter().take(found.vehicles);
        let priced = |route: Vec<usize>| {
            let cost = problem.route_length(0, &route);
            (to_circles(route), cost)
        };
        Some(routes.map(priced).collect())
    }
}

fn to_circles(route: Vec<usize>) -> Vec<usize> {
    route.into_iter().map(|node| node - 1).collect()
}

/// What legs between depot (node 0) and circles (node `i + 1` for circle `i`) and what loiters cost.
///
/// The paper's pipeline measures routes by length, as the paper does; the optimising one by time, a leg between two circles
/// counted as the least time for its length from loiter speed to loiter speed. In still air that time is an increasing, concave
/// function of a metric and 0 at 0, so a metric; in wind it depends on the direction of travel, and no bound of Christofides' is
/// claimed.
///
/// Solved legs scatter around any function of the distance alone, since entries and exits move them: example `leg_times`, 92 legs of
/// 2.2 to 2.3 s among 100 targets in 300 m x 300 m, is off by 0.26 s (root mean square) and at most 0.63 s where every leg is the fastest
/// by itself, by 0.09 s and at most 0.49 s where entries are chosen for whole routes.
fn legs(mission: &Mission, orbits: &[Orbit], envelope: &Envelope) -> (LegTimes, Vec<f64>) {
    let nodes: Vec<Vector2<f64>> = std::iter::once(mission.depot)
        .chain(orbits.iter().map(|orbit| orbit.circle.centre))
        .map(Vector2::from)
        .collect();
    let slowest = orbits.iter().map(|orbit| orbit.circle.speed).fold(f64::INFINITY, f64::min);
    let by_length = mission.pipeline == Pipeline::Paper;
    let drift = mission.environment.is_windy().then(|| Drift::new(envelope, slowest, slowest));
    let legs = LegTimes::new(nodes.len(), |i, j| {
        let offset = nodes[j] - nodes[i];
        match &drift {
            _ if by_length => offset.x.hypot(offset.y),
            Some(drift) => drift.least_time(offset, 0.0),
            None => envelope.least_time(offset.x.hypot(offset.y), slowest, slowest),
        }
    });
    let around = |orbit: &Orbit| if by_length { orbit.loiter.length() } else { orbit.loiter.duration() };
    (legs, std::iter::once(0.0).chain(orbits.iter().map(around)).collect())
}

/// Which route takes off from which pad: routes in the order of the bearings of their first circles, turned so that the sum of
/// distances from pads to first circles is least, so that vehicles fan out and need not cross. Spare vehicles take the
/// pads that are left over. Returns the routes by vehicle.
pub(crate) fn to_pads(
    routes: Vec<Vec<usize>>,
    pads: &[[f64; 3]],
    orbits: &[Orbit],
    depot: [f64; 2],
) -> Vec<Vec<usize>> {
    let first = |route: &[usize]| route.first().map(|&circle| orbits[circle].circle.centre);
    let mut flying: Vec<(f64, Vec<usize>)> = routes
        .into_iter()
        .filter_map(|route| {
            let [x, y] = first(&route)?;
            Some(((y - depot[1]).atan2(x - depot[0]).rem_euclid(std::f64::consts::TAU), route))
        })
        .collect();
    flying.sort_by(|a, b| a.0.total_cmp(&b.0));
    let n = pads.len();
    let distance = |pad: usize, route: &[usize]| {
        first(route).map_or(0.0, |[x, y]| (x - pads[pad][0]).hypot(y - pads[pad][1]))
    };
    let spread = |k: usize| k * n / flying.len().max(1);
    let total = |turn: usize| -> f64 {
        flying.iter().enumerate().map(|(k, (_, route))| distance((spread(k) + turn) % n, route)).sum()
    };
    let turn = (0..n).min_by(|&a, &b| total(a).total_cmp(&total(b))).unwrap_or(0);
    let mut by_pad = vec![Vec::new(); n];
    let places: Vec<usize> = (0..flying.len()).map(|k| (spread(k) + turn) % n).collect();
    for ((_, route), place) in flying.into_iter().zip(places) {
        by_pad[place] = route;
    }
    by_pad
}
