//! What of a vehicle's flight is settled at a moment.

use super::{Changes, Replanner, Skies};
use crate::plan::{Leg, Transition, VehiclePlan};
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
    /// The flight of a vehicle as it is settled at `time`.
    pub(super) fn at(skies: &Skies, planned: &VehiclePlan, time: f64, changes: &Changes) -> Self {
        let VehiclePlan { legs, route, .. } = planned;
        let untouched = |time: f64| Self {
            legs: Vec::new(),
            broken_off: None,
            here: None,
            time,
            open: route.clone(),
            landed: false,
        };
        let Some(first) = legs.first() else { return untouched(skies.airs.from(time)) };
        if first.start_time > time {
            return untouched(first.start_time);
        }
        let Some(k) = legs.iter().position(|leg| time < leg.end_time()) else {
            let time = planned.end_time();
            return Self { legs: legs.clone(), open: Vec::new(), landed: true, ..untouched(time) };
        };
        let leg = &legs[k];
        let air = skies.airs.at(leg.start_time);
        let circle = leg.loiter.map(|loiter| loiter.circle);
        let in_transition = time < leg.arrival_time();
        let must_turn = || {
            circle.is_some_and(|circle| changes.gone.contains(&circle)) || enters(skies, planned, k, changes)
        };
        // In a new wind the way home is flown to its end.
        let may_turn = circle.is_none() && !changes.wind;
        if in_transition && (may_turn || must_turn()) {
            let earliest = time + Replanner::REACTION - leg.start_time;
            let knot = leg.transition.knots.partition_point(|&knot| knot < earliest);
            if knot + 1 < leg.transition.knots.len()
                && let Some(path) = air.pilot.path(&leg.transition)
            {
                let here = path(leg.transition.knots[knot]);
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
        Self {
            legs: legs[..=k].to_vec(),
            time: leg.end_time(),
            here: air.exit(leg),
            open: route[(k + 1).min(route.len())..].to_vec(),
            landed: circle.is_none(),
            broken_off: None,
        }
    }
}

/// Whether a leg enters a safe distance that was not there when it was planned.
pub(super) fn enters(skies: &Skies, planned: &VehiclePlan, leg: usize, changes: &Changes) -> bool {
    let Leg { transition, start_time, .. } = &planned.legs[leg];
    let air = skies.airs.at(*start_time);
    let comes_near = |&target: &usize| {
        let mission = &air.mission;
        least_distance(transition, mission.targets[target].position) < mission.safe_distance(target)
    };
    if !changes.keep_outs.iter().any(comes_near) {
        return false;
    }
    let before = leg.checked_sub(1).map(|before| &planned.legs[before]);
    let start = skies.start(planned, before, *start_time);
    let seen = air.pilot.examine(transition, &start);
    // What the plan was made with may have been grazed.
    seen.is_some_and(|seen| seen.clearance < -0.02)
}

/// A lower bound on the horizontal distance between a transition and a point (m): from one knot to the next neither end can
/// be farther away than its own way to the nearest place. Minus infinity if a state holds no position.
fn least_distance(transition: &Transition, [x, y]: [f64; 2]) -> f64 {
    let distance = |state: &[f64]| match *state {
        [east, north, ..] => (east - x).hypot(north - y),
        _ => f64::NEG_INFINITY,
    };
    let ends = transition.states.windows(2).map(|pair| distance(&pair[0]) + distance(&pair[1]));
    let times = transition.knots.windows(2).map(|pair| pair[1] - pair[0]);
    ends.zip(times)
        .map(|(ends, time)| 0.5 * (ends - transition.max_speed * time))
        .fold(f64::INFINITY, f64::min)
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
