//! From mission to plan.

use crate::allocation::{self, Routing};
use crate::bound::Envelope;
use crate::certificate;
use crate::circles::{Orbit, orbits};
use crate::error::{Error, Problem};
use crate::legs::Airspace;
use crate::mission::{Mission, Model, Pipeline};
use crate::options::{Options, Watch};
use crate::plan::{Leg, Plan, VehiclePlan, Warning};
use crate::separation::{closest_pair, in_the_air, start_delays};
use crate::sorties::{self, Flight, share_in_reach};
use crate::threads::{both, side_by_side};
use crate::time_model::TimeModel;
use crate::transition::Pilot;
use crate::warnings;
use crate::whole_route::Flown;
use mtsp::lower_bound::LowerBounds;

/// Plans a mission.
///
/// # Errors
/// [`Error::Mission`] with all that is wrong with the mission, before any work is done; [`Error::Leg`] if no candidate entry
/// of a leg can be solved; [`Error::Stopped`] if the caller asked for it.
///
/// # Complexity
/// Dominated by the transitions: for every target at most twice the number of entries, each an optimal control problem whose
/// solution takes time linear in the number of segments.
pub fn plan(mission: &Mission, options: &Options) -> Result<Plan, Error> {
    let problems = mission.problems();
    if !problems.is_empty() {
        return Err(Error::Mission { problems });
    }
    let orbits = orbits(mission)
        .map_err(|source| Error::Mission { problems: vec![Problem::Loiter { target: 0, source }] })?;
    let mut airspace = Airspace {
        mission,
        orbits: &orbits,
        pilot: Pilot::new(mission, &orbits).with_most_iterations(options.solver_iterations),
        envelope: envelope(mission, &orbits),
        watch: Watch::new(*options, 0),
    };
    let bounds = || certificate::bounds(mission, &orbits, &airspace.envelope);
    let (routed, bounds) = both(|| routed(&airspace, options), bounds);
    let ((routing, routes), bounds) = (routed?, bounds?);
    let pads = mission.pads();
    let routes = allocation::to_pads(routes, &pads, &orbits, mission.depot);
    let mut fly = |flights: Vec<Flight>| {
        let total = flights.iter().map(|flight| airspace.n_candidates(flight.route.len())).sum();
        airspace.watch = Watch::new(*options, total);
        planned(&airspace, flights, &bounds)
    };
    let mut plan = fly(sorties::one_each(&pads, routes))?;
    let mut share = share_in_reach(&plan);
    if share < 1.0 && mission.swap_time.is_some() {
        let mut limit = routing.longest(&plan).unwrap_or(0.0);
        // Solved flights scatter around the routes' costs: a limit that was too loose is tightened.
        for _ in 0..MOST_LIMITS {
            limit *= share;
            let Some(flights) = sorties::share_out(mission, &orbits, &routing, limit) else { break };
            plan = fly(flights)?;
            share = share_in_reach(&plan);
            if share >= 1.0 {
                break;
            }
        }
        plan.warnings.push(Warning::Sorties { flights: plan.flights() });
    }
    if share < 1.0 {
        plan.warnings.extend(more_vehicles(&plan, &routing, share));
    }
    Ok(plan)
}

/// The routing problem of a mission, and its routes.
fn routed<'a>(
    airspace: &Airspace<'a>,
    options: &Options<'a>,
) -> Result<(Routing<'a>, Vec<Vec<usize>>), Error> {
    let Airspace { mission, .. } = *airspace;
    let routing = Routing::new(airspace, options);
    let mut routes = routing.routes()?;
    // Routes cost as much either way in still air, but where legs enter circles they do not take as long.
    if mission.pipeline == Pipeline::Optimised && !mission.environment.is_windy() {
        let [x, y] = mission.depot;
        let depot = [x, y, mission.loiter.height];
        let model = airspace.time_model();
        routes = side_by_side(&routes, |route| airspace.directed(depot, route.clone(), &model));
    }
    Ok((routing, routes))
}

/// Limits on routes that are tried until every flight keeps endurance and battery.
const MOST_LIMITS: usize = 4;

/// The plan in which given flights are flown.
fn planned(airspace: &Airspace, flights: Vec<Flight>, bounds: &LowerBounds) -> Result<Plan, Error> {
    let Airspace { mission, orbits, .. } = *airspace;
    let legs = fly_all(airspace, &flights)?;
    let found_leg_by_leg: Vec<f64> = legs.iter().map(|legs| legs.last().map_or(0.0, Leg::end_time)).collect();
    let legs = match mission.pipeline {
        Pipeline::Paper => legs,
        Pipeline::Optimised => reconsider_all(airspace, &flights, legs)?,
    };
    let vehicles: Vec<VehiclePlan> = flights
        .into_iter()
        .zip(legs)
        .zip(found_leg_by_leg)
        .map(|((Flight { vehicle, pad, route }, legs), leg_by_leg)| {
            let heading = airspace.heading(pad, &route);
            VehiclePlan { vehicle, pad, heading, route, legs, leg_by_leg, lost_at: None }
        })
        .collect();
    let circles = orbits.iter().map(|orbit| orbit.circle.clone()).collect();
    let certificate = certificate::certificate(bounds, &vehicles);
    let mut plan = Plan {
        circles,
        vehicles,
        certificate,
        closest_approach: None,
        warnings: Vec::new(),
        skipped: Vec::new(),
        known_since: Vec::new(),
        earlier_winds: Vec::new(),
    };
    delay_starts(&mut plan, mission);
    plan.certificate.makespan = plan.vehicles.iter().map(VehiclePlan::end_time).fold(0.0, f64::max);
    plan.closest_approach = in_the_air(&plan, mission, |fleet| closest_pair(&fleet)).flatten();
    plan.warnings = warnings::of(&plan, mission);
    Ok(plan)
}

/// Lets vehicles wait on their pads so that none comes too close to another in the air.
fn delay_starts(plan: &mut Plan, mission: &Mission) {
    let (before, swap_time) = (plan.flights_before(), mission.swap_time.unwrap_or(0.0));
    let Some(delays) =
        in_the_air(plan, mission, |fleet| start_delays(&fleet, mission.fleet.separation, &before, swap_time))
    else {
        return;
    };
    for (vehicle, delay) in plan.vehicles.iter_mut().zip(delays) {
        for leg in &mut vehicle.legs {
            leg.start_time += delay;
        }
    }
}

/// How fast the mission's vehicles can possibly speed up and brake.
pub(crate) fn envelope(mission: &Mission, orbits: &[Orbit]) -> Envelope {
    let vehicle = &mission.fleet.vehicle;
    let (transition, shaping) = (&mission.transition, &mission.transition.shaping);
    let fastest = orbits.iter().map(|orbit| orbit.circle.speed).fold(0.0, f64::max);
    if transition.model == Model::JerkLimited {
        return Envelope::of_limits(shaping.speed.max(fastest), shaping.acceleration);
    }
    let share = transition.thrust_budget.max(mission.loiter.thrust_budget);
    let (mass, drag) = (vehicle.mass(), vehicle.drag_coefficient());
    let still =
        Envelope::of_thrust(share * vehicle.max_thrust(), mass, drag, quad_dynamics::GRAVITY, fastest);
    still.with_wind(mission.environment.air().xy(), fastest)
}

/// The legs of every route, each leg by itself the fastest.
fn fly_all(airspace: &Airspace, flights: &[Flight]) -> Result<Vec<Vec<Leg>>, Error> {
    let fly = |Flight { vehicle, pad, route }: &Flight| airspace.fly(*vehicle, *pad, route);
    side_by_side(flights, fly).into_iter().collect()
}

/// The legs of every route with entries chosen for the route as a whole where that is faster.
fn reconsider_all(
    airspace: &Airspace,
    flights: &[Flight],
    legs: Vec<Vec<Leg>>,
) -> Result<Vec<Vec<Leg>>, Error> {
    let flown: Vec<Flown> = legs
        .into_iter()
        .zip(flights)
        .map(|(legs, Flight { vehicle, pad, route })| Flown { vehicle: *vehicle, pad: *pad, route, legs })
        .collect();
    let model = calibrated(airspace, flown.iter().map(|flown| (flown.pad, flown.route, &flown.legs[..])));
    side_by_side(&flown, |flown| airspace.reconsider(flown, &model)).into_iter().collect()
}

/// The time model that fits the transitions solved for some flights: pad, route, legs.
pub(crate) fn calibrated<'a>(
    airspace: &Airspace,
    flights: impl Iterator<Item = ([f64; 3], &'a [usize], &'a [Leg])>,
) -> TimeModel {
    let solved: Vec<_> = flights.flat_map(|(pad, route, legs)| airspace.solved(pad, route, legs)).collect();
    airspace.time_model().calibrated(&solved)
}

/// How many vehicles are needed where some fly longer than they can.
fn more_vehicles(plan: &Plan, routing: &Routing, share: f64) -> Option<Warning> {
    let needed = routing.enough_routes(share * routing.longest(plan)?)?;
    // A longest route that is badly balanced may be too long although there are vehicles enough.
    Some(Warning::MoreVehicles { needed: needed.max(1) })
}
