//! Vehicles that would come too close after an event give way: they stay on their pads longer, or fly further turns of a loiter.

use crate::mission::Mission;
use crate::plan::{Approach, Leg, Plan};
use crate::separation::{Airborne, DELAY_STEP, closest_approach, closest_pair, in_the_air};
use std::f64::consts::TAU;

/// Further turns of one loiter that are tried.
const MOST_TURNS: u32 = 4;
/// Delays of a start that are tried.
const MOST_STEPS: u32 = 240;

/// What a vehicle does to let another pass.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Wait {
    vehicle: usize,
    /// The leg whose loiter is flown longer; `None` for a later start.
    leg: Option<usize>,
    /// By how long (s).
    delay: f64,
}

/// Lets vehicles give way from `time` (s) on, always by the shortest wait that leaves the waiting vehicle clear of all others,
/// as long as there is one. Returns who waits, and where airborne vehicles come closest then.
pub(super) fn give_way(plan: &mut Plan, mission: &Mission, time: f64) -> (Vec<usize>, Option<Approach>) {
    let mut vehicles = Vec::new();
    // Each round clears at least one pair; more rounds than pairs would go in circles.
    let mut rounds = plan.vehicles.len().pow(2);
    loop {
        let seen = in_the_air(plan, mission, |mut fleet| {
            for airborne in fleet.iter_mut().flatten() {
                airborne.flight[0] = airborne.flight[0].max(time);
            }
            let closest = closest_pair(&fleet)?;
            let is_close = closest.distance < mission.fleet.separation && rounds > 0;
            let wait = if is_close { shortest_wait(plan, mission, &fleet, &closest, time) } else { None };
            Some((closest, wait))
        });
        match seen.flatten() {
            Some((_, Some(wait))) => {
                wait.apply(plan);
                vehicles.push(wait.vehicle);
                vehicles.extend(plan.keep_swaps(mission.swap_time.unwrap_or(0.0)));
                rounds -= 1;
            }
            Some((closest, None)) => return (vehicles, Some(closest)),
            None => return (vehicles, None),
        }
    }
}

/// The shortest wait after `time` that clears a conflict; `None` if there is none.
fn shortest_wait(
    plan: &Plan,
    mission: &Mission,
    fleet: &[Option<Airborne>],
    conflict: &Approach,
    time: f64,
) -> Option<Wait> {
    let mut waits: Vec<Wait> = conflict
        .vehicles
        .into_iter()
        .flat_map(|vehicle| waits(plan, vehicle, [time, conflict.time]))
        .collect();
    waits.sort_by(|a, b| a.delay.total_cmp(&b.delay));
    waits.into_iter().find(|wait| {
        let Some(flight) = &fleet[wait.vehicle] else { return false };
        let waiting = wait.flown(plan, flight);
        let others = fleet.iter().enumerate().filter(|&(other, _)| other != wait.vehicle);
        others
            .filter_map(|(_, other)| other.as_ref())
            .all(|other| closest_approach(other, &waiting, mission.fleet.separation).is_none())
    })
}

/// What a vehicle can do between two times (s): nothing is changed of what lies before the first.
fn waits(plan: &Plan, vehicle: usize, [from, to]: [f64; 2]) -> Vec<Wait> {
    let legs = &plan.vehicles[vehicle].legs;
    let mut waits = Vec::new();
    if legs.first().is_some_and(|leg| leg.start_time > from) {
        let steps = (1..=MOST_STEPS).map(|step| f64::from(step) * DELAY_STEP);
        waits.extend(steps.map(|delay| Wait { vehicle, leg: None, delay }));
    }
    for (index, leg) in
        legs.iter().enumerate().filter(|(_, leg)| leg.end_time() > from && leg.end_time() <= to)
    {
        // After a full turn the vehicle is where it has been a turn before.
        if let Some(turn) = turn(plan, leg)
            && leg.end_time() - leg.arrival_time() >= turn * (1.0 - 1e-9)
        {
            let turns = (1..=MOST_TURNS).map(|turns| f64::from(turns) * turn);
            waits.extend(turns.map(|delay| Wait { vehicle, leg: Some(index), delay }));
        }
    }
    waits
}

/// Time for one full turn of a leg's loiter (s).
fn turn(plan: &Plan, leg: &Leg) -> Option<f64> {
    let loiter = leg.loiter?;
    Some(TAU * plan.circles.get(loiter.circle)?.radius * loiter.duration / loiter.length)
}

impl Wait {
    /// A flight with this wait in it.
    fn flown<'a>(&self, plan: &Plan, flight: &'a Airborne) -> Airborne<'a> {
        let delay = self.delay;
        let legs = &plan.vehicles[self.vehicle].legs;
        let leg = self.leg.map(|leg| &legs[leg]);
        let (left, turn) =
            (leg.map_or(f64::NEG_INFINITY, Leg::end_time), leg.and_then(|leg| turn(plan, leg)));
        let first = flight.flight[0] + if leg.is_none() { delay } else { 0.0 };
        Airborne {
            position: Box::new(move |time| {
                let planned = match turn {
                    Some(turn) if time >= left && time < left + delay => left - turn + (time - left) % turn,
                    _ if time < left => time,
                    _ => time - delay,
                };
                (flight.position)(planned)
            }),
            flight: [first, flight.flight[1] + delay],
            top_speed: flight.top_speed,
        }
    }

    fn apply(&self, plan: &mut Plan) {
        let from = self.leg.map_or(0, |leg| leg + 1);
        let legs = &mut plan.vehicles[self.vehicle].legs;
        if let Some(loiter) = self.leg.and_then(|leg| legs[leg].loiter.as_mut()) {
            loiter.length += self.delay * loiter.length / loiter.duration;
            loiter.duration += self.delay;
        }
        for leg in &mut legs[from..] {
            leg.start_time += self.delay;
        }
    }
}
