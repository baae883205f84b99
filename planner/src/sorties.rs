//! Several flights of one vehicle, a battery swapped in between: the sorties of a mission that is too long for its batteries.

use crate::allocation::{self, Routing};
use crate::circles::Orbit;
use crate::mission::Mission;
use crate::plan::{Plan, VehiclePlan, Warning};
use crate::separation::DELAY_STEP;

/// A flight before it is flown.
#[derive(Debug, Clone)]
pub(crate) struct Flight {
    /// Who flies it.
    pub vehicle: usize,
    pub pad: [f64; 3],
    pub route: Vec<usize>,
}

/// One flight for every vehicle, by the routes of their pads.
pub(crate) fn one_each(pads: &[[f64; 3]], routes: Vec<Vec<usize>>) -> Vec<Flight> {
    let flight = |(vehicle, route)| Flight { vehicle, pad: pads[vehicle], route };
    routes.into_iter().enumerate().map(flight).collect()
}

/// The greatest share of its flights that a plan's vehicles can fly with a full battery and within the endurance; at least 1 if all.
pub(crate) fn share_in_reach(plan: &Plan) -> f64 {
    let shares = plan.warnings.iter().filter_map(|warning| match *warning {
        Warning::Endurance { duration, endurance, .. } => Some(endurance / duration),
        Warning::Battery { energy, usable, .. } => Some(usable / energy),
        _ => None,
    });
    shares.fold(1.0, f64::min)
}

/// Routes that cost at most `limit` each, as few as were found, shared out over the fleet: the longest first, each to the vehicle
/// that has least to fly (Graham 1969: at most 4/3 of the best makespan, swaps not counted). The first flight of every vehicle comes
/// first, then the second ones; `None` if there are no such routes.
pub(crate) fn share_out(
    mission: &Mission,
    orbits: &[Orbit],
    routing: &Routing,
    limit: f64,
) -> Option<Vec<Flight>> {
    let mut routes = routing.fewest_routes(limit)?;
    routes.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    let pads = mission.pads();
    let mut loads = vec![0.0_f64; pads.len()];
    let mut sorties: Vec<Vec<Vec<usize>>> = vec![Vec::new(); pads.len()];
    for (route, cost) in routes {
        let least = (0..loads.len()).min_by(|&a, &b| loads[a].total_cmp(&loads[b]))?;
        loads[least] += cost;
        sorties[least].push(route);
    }
    // Vehicles fan out on their first sorties.
    let firsts = sorties.iter().filter_map(|sorties| sorties.first().cloned()).collect();
    let by_pad = allocation::to_pads(firsts, &pads, orbits, mission.depot);
    let mut flights = one_each(&pads, by_pad);
    let mut next = Vec::new();
    for Flight { vehicle, pad, route } in &flights {
        let same = |sorties: &&Vec<Vec<usize>>| !route.is_empty() && sorties.first() == Some(route);
        let later = sorties.iter().find(same).map_or(&[][..], |sorties| &sorties[1..]);
        let flight = |(i, route): (usize, &Vec<usize>)| {
            (i, Flight { vehicle: *vehicle, pad: *pad, route: route.clone() })
        };
        next.extend(later.iter().enumerate().map(flight));
    }
    next.sort_by_key(|&(sortie, _)| sortie);
    flights.extend(next.into_iter().map(|(_, flight)| flight));
    Some(flights)
}

impl Plan {
    /// For each flight the one of the same vehicle before it; none for what stays on its pad.
    pub(crate) fn flights_before(&self) -> Vec<Option<usize>> {
        let before = |flight: usize| {
            let is_flown = |other: &usize| {
                self.vehicles[*other].vehicle == self.vehicles[flight].vehicle
                    && !self.vehicles[*other].legs.is_empty()
            };
            let stays = self.vehicles[flight].legs.is_empty();
            (0..flight).rev().find(is_flown).filter(|_| !stays)
        };
        (0..self.vehicles.len()).map(before).collect()
    }

    /// Lets every flight begin later that would begin before a battery can have been swapped since the flight before it; returns
    /// which.
    pub(crate) fn keep_swaps(&mut self, swap_time: f64) -> Vec<usize> {
        let mut later = Vec::new();
        for (flight, before) in self.flights_before().into_iter().enumerate() {
            let Some(before) = before else { continue };
            let earliest = self.vehicles[before].end_time() + pause(swap_time);
            let wait = earliest - self.vehicles[flight].start_time();
            if wait > 0.0 && self.vehicles[flight].lost_at.is_none() && !self.vehicles[flight].legs.is_empty()
            {
                self.vehicles[flight].shift(wait);
                later.push(flight);
            }
        }
        later
    }
}

impl VehiclePlan {
    /// The whole flight later (s).
    pub(crate) fn shift(&mut self, delay: f64) {
        for leg in &mut self.legs {
            leg.start_time += delay;
        }
    }
}

/// Between a landing and the next start on the same pad (s): flights that touch in time would be too close.
pub(crate) fn pause(swap_time: f64) -> f64 {
    swap_time.max(DELAY_STEP)
}
