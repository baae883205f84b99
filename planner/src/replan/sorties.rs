//! Flights of vehicles that swap batteries while a mission changes.

use super::settled::Settled;
use crate::mission::Mission;
use crate::plan::{Plan, VehiclePlan};
use crate::sorties::pause;

/// One more flight, without a route yet, for every usable vehicle that has none to spare; only where batteries are swapped.
pub(super) fn add_sorties(
    plan: &mut Plan,
    team: &mut Vec<Settled>,
    mission: &Mission,
    usable: &[bool],
    from: f64,
) {
    if mission.swap_time.is_none() {
        return;
    }
    for vehicle in (0..usable.len()).filter(|&vehicle| usable[vehicle]) {
        let mut own = (0..team.len()).filter(|&flight| plan.vehicles[flight].vehicle == vehicle);
        let is_spare = |&flight: &usize| {
            !team[flight].landed && team[flight].here.is_none() && team[flight].open.is_empty()
        };
        // One that is spare but comes before others is not the last flight of its vehicle; it will do all the same.
        if own.any(|flight| is_spare(&flight)) {
            continue;
        }
        let pad = plan.vehicles[vehicle].pad;
        let (route, legs) = (Vec::new(), Vec::new());
        plan.vehicles.push(VehiclePlan {
            vehicle,
            pad,
            heading: 0.0,
            route,
            legs,
            leg_by_leg: 0.0,
            lost_at: None,
        });
        team.push(Settled {
            legs: Vec::new(),
            broken_off: None,
            here: None,
            time: from,
            open: Vec::new(),
            landed: false,
        });
    }
}

/// Forgets flights after the first `known` ones that found no use.
pub(super) fn drop_unused(plan: &mut Plan, team: &mut Vec<Settled>, known: usize) {
    for flight in (known..team.len()).rev().filter(|&flight| team[flight].open.is_empty()).collect::<Vec<_>>()
    {
        team.remove(flight);
        plan.vehicles.remove(flight);
    }
}

/// Flights begin by as much sooner as the flight before them ends sooner than it did (`ends`, s), but not before `from` (s), and
/// later where a battery must be swapped first. Returns which.
pub(super) fn follow_on(plan: &mut Plan, ends: &[f64], from: f64, swap_time: f64) -> Vec<usize> {
    let mut moved = Vec::new();
    for (flight, before) in plan.flights_before().into_iter().enumerate() {
        let Some(before) = before else { continue };
        let end = plan.vehicles[before].end_time();
        let gained = ends.get(before).map_or(0.0, |was| was - end);
        let start = plan.vehicles[flight].start_time();
        let sooner = gained.min(start - (end + pause(swap_time)).max(from));
        if sooner > 0.0 && start > from {
            plan.vehicles[flight].shift(-sooner);
            moved.push(flight);
        }
    }
    moved.extend(plan.keep_swaps(swap_time));
    moved
}
