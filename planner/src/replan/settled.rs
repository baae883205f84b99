//! What of a vehicle's flight is settled at a moment.

use super::Replanner;
use crate::legs::Airspace;
use crate::plan::{Leg, Transition, VehiclePlan};
use crate::transition::hover;
use quad_dynamics::Motion;

/// The part of a flight that stays, and what follows it.
#[derive(Debug, Clone)]
pub(super) struct Settled {
    /// Legs that stay as they are.
    pub legs: Vec<Leg>,
    /// A leg that is broken off: when it starts, and its transition up to there.
    pub broken_off: Option<(f64, Transition)>,
    /// Where and when the rest begins; no motion for a vehicle that has not taken off.
    pub here: Option<Motion>,
    pub time: f64,
    /// The circles still to be flown, in order.
    pub open: Vec<usize>,
    /// Whether anything can follow.
    pub landed: bool,
}

impl Settled {
    /// The flight of a vehicle as it is settled at `time`. Circles in `gone` are not flown to any longer.
    pub(super) fn at(airspace: &Airspace, planned: &VehiclePlan, time: f64, gone: &[usize]) -> Self {
        let VehiclePlan { legs, route, .. } = planned;
        let untouched = |time: f64| Self {
            legs: Vec::new(),
            broken_off: None,
            here: None,
            time,
            open: route.clone(),
            landed: false,
        };
        let Some(first) = legs.first() else { return untouched(time) };
        if first.start_time > time {
            return untouched(first.start_time);
        }
        let Some(k) = legs.iter().position(|leg| time < leg.end_time()) else {
            let time = planned.end_time();
            return Self { legs: legs.clone(), open: Vec::new(), landed: true, ..untouched(time) };
        };
        let leg = &legs[k];
        let circle = leg.loiter.map(|loiter| loiter.circle);
        let in_transition = time < leg.arrival_time();
        let must_turn =
            || circle.is_some_and(|circle| gone.contains(&circle)) || enters(airspace, planned, k);
        if in_transition && (circle.is_none() || must_turn()) {
            let earliest = time + Replanner::REACTION - leg.start_time;
            let knot = leg.transition.knots.partition_point(|&knot| knot < earliest);
            if knot + 1 < leg.transition.knots.len()
                && let Some(here) = airspace.pilot.motion(&leg.transition, leg.transition.knots[knot])
            {
                return Self {
                    legs: legs[..k].to_vec(),
                    time: leg.start_time + leg.transition.knots[knot],
                    broken_off: Some((leg.start_time, first_part(&leg.transition, knot))),
                    here: Some(here),
                    open: route[k..].to_vec(),
                    landed: false,
                };
            }
        }
        let here = leg.loiter.map(|loiter| airspace.orbits[loiter.circle].exit(loiter.entry));
        Self {
            legs: legs[..=k].to_vec(),
            time: leg.end_time(),
            here,
            open: route[(k + 1).min(route.len())..].to_vec(),
            landed: circle.is_none(),
            broken_off: None,
        }
    }
}

/// Whether a leg enters a safe distance, as targets lie now.
pub(super) fn enters(airspace: &Airspace, planned: &VehiclePlan, leg: usize) -> bool {
    let start = match leg.checked_sub(1).and_then(|before| planned.legs[before].loiter) {
        Some(loiter) => airspace.orbits[loiter.circle].exit(loiter.entry),
        None => hover(airspace.mission, planned.pad, planned.heading),
    };
    let seen = airspace.pilot.examine(&planned.legs[leg].transition, &start);
    // What the plan was made with may have been grazed.
    seen.is_some_and(|seen| seen.clearance < -0.02)
}

/// The segments of a transition before a knot.
fn first_part(transition: &Transition, knot: usize) -> Transition {
    let mut part = transition.clone();
    part.knots.truncate(knot + 1);
    part.states.truncate(knot + 1);
    part.controls.truncate(knot * transition.control_nodes);
    part.duration = transition.knots[knot];
    part
}
