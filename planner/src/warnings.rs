//! What an operator should know of a plan's flights.

use crate::mission::Mission;
use crate::plan::{Outcome, Plan, Warning};
use crate::threads::side_by_side;
use std::collections::BTreeSet;

/// Everything that is to be said of a plan's team and flights.
pub(crate) fn of(plan: &Plan, mission: &Mission) -> Vec<Warning> {
    let flights: Vec<usize> = (0..plan.vehicles.len()).collect();
    let mut warnings = of_team(plan, mission);
    warnings.extend(of_flights(plan, mission, &flights));
    warnings
}

/// Brings the warnings up to date after some flights have changed.
pub(crate) fn renew(plan: &mut Plan, mission: &Mission, changed: &[usize]) {
    let before = std::mem::take(&mut plan.warnings);
    let is_of_flight =
        |warning: &Warning| flight_of(warning).is_some_and(|flight| !changed.contains(&flight));
    let mut flights: Vec<Warning> = before.iter().filter(|warning| is_of_flight(warning)).cloned().collect();
    flights.extend(of_flights(plan, mission, changed));
    flights.sort_by_key(flight_of);
    let is_too_long =
        flights.iter().any(|warning| matches!(warning, Warning::Endurance { .. } | Warning::Battery { .. }));
    let mut warnings = of_team(plan, mission);
    warnings.extend(flights);
    if plan.vehicles.len() > mission.fleet.vehicles {
        warnings.push(Warning::Sorties { flights: plan.flights() });
    }
    // an estimate for the whole mission, which holds as long as there is need for it
    warnings.extend(
        before.into_iter().filter(|warning| is_too_long && matches!(warning, Warning::MoreVehicles { .. })),
    );
    plan.warnings = warnings;
}

/// The flight that a warning is about.
fn flight_of(warning: &Warning) -> Option<usize> {
    match *warning {
        Warning::Endurance { vehicle, .. }
        | Warning::Battery { vehicle, .. }
        | Warning::FailedCandidates { vehicle, .. } => Some(vehicle),
        Warning::MoreVehicles { .. }
        | Warning::Sorties { .. }
        | Warning::OutOfView { .. }
        | Warning::Spare { .. } => None,
    }
}

fn of_team(plan: &Plan, mission: &Mission) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let spare =
        plan.vehicles.iter().filter(|vehicle| vehicle.route.is_empty() && vehicle.lost_at.is_none()).count();
    if spare > 0 {
        warnings.push(Warning::Spare { vehicles: spare });
    }
    let shares = plan.shares_in_view(mission).unwrap_or_default();
    let legs = plan.vehicles.iter().flat_map(|vehicle| &vehicle.legs);
    let circles = legs.filter_map(|leg| plan.circles.get(leg.loiter?.circle));
    let circled: BTreeSet<usize> = circles.flat_map(|circle| circle.members.iter().copied()).collect();
    let shares = shares.into_iter().enumerate().filter(|(target, _)| circled.contains(target));
    let least = shares.min_by(|a, b| a.1.total_cmp(&b.1));
    let unseen = least.filter(|&(_, share)| share < 1.0);
    warnings.extend(unseen.map(|(target, share)| Warning::OutOfView { target, share }));
    warnings
}

fn of_flights(plan: &Plan, mission: &Mission, flights: &[usize]) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let sampler = plan.sampler(mission);
    let energies = side_by_side(flights, |&vehicle| sampler.as_ref()?.energy(vehicle));
    for (&vehicle, energy) in flights.iter().zip(energies) {
        let planned = &plan.vehicles[vehicle];
        let (duration, endurance) = (planned.duration(), mission.fleet.endurance);
        if duration > endurance {
            warnings.push(Warning::Endurance { vehicle, duration, endurance });
        }
        let usable = mission.fleet.vehicle.parameters().battery.usable_energy();
        if let Some(energy) = energy.filter(|&energy| energy > usable) {
            warnings.push(Warning::Battery { vehicle, energy, usable });
        }
        for (leg, planned) in planned.legs.iter().enumerate() {
            let is_failed = |outcome: &Outcome| matches!(outcome, Outcome::Failed { .. });
            let candidates =
                planned.candidates.iter().filter(|candidate| is_failed(&candidate.outcome)).count();
            if candidates > 0 {
                warnings.push(Warning::FailedCandidates { vehicle, leg, candidates });
            }
        }
    }
    warnings
}
