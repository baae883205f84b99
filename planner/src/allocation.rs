//! Who circles what, and in which order (the paper's Algorithm 2, or routes optimised for the objective).

use crate::bound::{Drift, LegTimes};
use crate::circles::Orbit;
use crate::error::Error;
use crate::leg_model::LegModel;
use crate::legs::Airspace;
use crate::mission::{Mission, Objective, Pipeline};
use crate::options::Options;
use crate::plan::{Plan, VehiclePlan};
use crate::threads::both;
use mtsp::{Problem, Solution, assign};
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
    pub(crate) fn new(airspace: &Airspace<'a>, options: &Options<'a>) -> Self {
        let Airspace { mission, orbits, .. } = *airspace;
        let (legs, service) = match mission.pipeline {
            Pipeline::Paper => lengths(mission, orbits),
            Pipeline::Optimised => times(airspace),
        };
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
            Pipeline::Optimised => self.searched(&problem)?,
        };
        Ok(solution.routes.into_iter().map(to_circles).collect())
    }

    /// The better routes of two searches side by side, which share the iterations.
    fn searched(&self, problem: &Problem<LegTimes>) -> Result<Solution, mtsp::Error> {
        let search = |seed: u64| {
            let options =
                self.search.clone().with_iterations(self.search.iterations.div_ceil(2)).with_seed(seed);
            let goes_on =
                |_: &mtsp::Progress| !self.watch.should_stop.is_some_and(|should_stop| should_stop());
            mtsp::solve_with(problem, &options, &mut { goes_on })
        };
        let seed = self.mission.seed;
        let (one, other) = both(|| search(seed), || search(seed.wrapping_add(1)));
        let (one, other) = (one?, other?);
        let is_better = other.value(self.search.objective) < one.value(self.search.objective);
        Ok(if is_better { other } else { one })
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

/// The places of depot (node 0) and circles (node `i + 1` for circle `i`).
fn nodes(mission: &Mission, orbits: &[Orbit]) -> Vec<Vector2<f64>> {
    let centres = orbits.iter().map(|orbit| orbit.circle.centre);
    std::iter::once(mission.depot).chain(centres).map(Vector2::from).collect()
}

/// What each node's loiter costs; the depot's nothing.
fn service(orbits: &[Orbit], around: impl Fn(&Orbit) -> f64) -> Vec<f64> {
    std::iter::once(0.0).chain(orbits.iter().map(around)).collect()
}

/// Legs and loiters by length (m), as the paper counts them.
fn lengths(mission: &Mission, orbits: &[Orbit]) -> (LegTimes, Vec<f64>) {
    let nodes = nodes(mission, orbits);
    let legs = LegTimes::new(nodes.len(), |i, j| (nodes[j] - nodes[i]).norm());
    (legs, service(orbits, |orbit| orbit.loiter.length()))
}

/// Legs and loiters by time (s), a leg by the [`LegModel`] of its distance; in wind of its direction too, and then no bound of
/// Christofides' is claimed.
fn times(airspace: &Airspace) -> (LegTimes, Vec<f64>) {
    let Airspace { mission, orbits, ref envelope, .. } = *airspace;
    let nodes = nodes(mission, orbits);
    let slowest = orbits.iter().map(|orbit| orbit.circle.speed).fold(f64::INFINITY, f64::min);
    let drift = mission.environment.is_windy().then(|| Drift::new(envelope, slowest, slowest));
    let least = |i: usize, j: usize| {
        let offset = nodes[j] - nodes[i];
        match &drift {
            Some(drift) => drift.least_time(offset, 0.0),
            None => envelope.least_time(offset.norm(), slowest, slowest),
        }
    };
    let model = LegModel::calibrated(airspace, least);
    let legs = LegTimes::new(nodes.len(), |i, j| model.time(least(i, j), i == 0 || j == 0));
    (legs, service(orbits, |orbit| orbit.loiter.duration()))
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::circles::orbits;
    use crate::mission::{Model, Target};
    use crate::options::Watch;
    use crate::planning::envelope;
    use crate::transition::Pilot;
    use christofides::Metric;
    use quad_dynamics::{Vehicle, VehicleParameters};

    /// What Christofides' bound needs, and that the times are near those of legs that are flown.
    #[test]
    fn leg_times_in_still_air_are_a_metric() {
        let positions =
            [[40.0, 10.0], [33.0, -25.0], [-30.0, -14.0], [20.0, 30.0], [-12.0, 30.0], [8.0, 15.0]];
        let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
        let mut mission = Mission::new(vehicle, 2, positions.map(Target::at).to_vec());
        mission.transition.model = Model::PointMass;
        mission.transition.segments = 20;
        let orbits = orbits(&mission).unwrap();
        let airspace = Airspace {
            mission: &mission,
            orbits: &orbits,
            pilot: Pilot::new(&mission, &orbits),
            envelope: envelope(&mission, &orbits),
            watch: Watch::new(Options::default(), 0),
        };
        let (times, _) = times(&airspace);
        let n = times.len();
        for (i, j, time) in times.pairs() {
            assert!((time - times.distance(j, i)).abs() < 1e-12);
            for k in (0..n).filter(|k| ![i, j].contains(k)) {
                assert!(time <= times.distance(i, k) + times.distance(k, j) + 1e-12, "{i} {k} {j}");
            }
        }
        let pad = mission.pads()[0];
        let flown = airspace.fly(0, pad, &[0, 1, 2]).unwrap();
        let modelled = [(0, 1), (1, 2), (2, 3), (3, 0)].map(|(i, j)| times.distance(i, j));
        for (leg, modelled) in flown.iter().zip(modelled) {
            let time = leg.transition.duration;
            assert!((time - modelled).abs() < 0.2 * time, "{time} {modelled}");
        }
    }
}
