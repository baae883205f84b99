//! The legs of a changed route.

use super::settled::{Settled, enters};
use super::{Changes, Skies};
use crate::entry;
use crate::error::Error;
use crate::legs::Airspace;
use crate::plan::{Entry, Leg, Loiter, Transition, VehiclePlan};
use crate::time_model::TimeModel;
use quad_dynamics::Motion;

/// Flies a vehicle's open circles from where it is settled; `None` if nothing changes.
pub(super) fn fly(
    skies: &Skies,
    model: &TimeModel,
    vehicle: usize,
    planned: &VehiclePlan,
    settled: &Settled,
    changes: &Changes,
) -> Result<Option<Vec<Leg>>, Error> {
    if settled.landed || keeps_all(skies, planned, settled, changes) {
        return Ok(None);
    }
    let gone = &changes.gone;
    let Settled { mut legs, broken_off, here, mut time, open, .. } = settled.clone();
    let now = skies.now();
    let taken_off = here.is_some();
    if open.is_empty() && !taken_off {
        return Ok(Some(Vec::new()));
    }
    let mut here = here.unwrap_or_else(|| now.take_off(planned.pad, &open));
    let mut broken_off = broken_off;
    // A leg is planned for one wind: one that is broken off keeps its own.
    let mut airspace = broken_off.as_ref().map_or(now, |&(start, _)| skies.at(start));
    let entries = entries(now, model, planned, (&here, &open), gone);
    for (&circle, &entry) in open.iter().zip(&entries) {
        let orbit = &airspace.orbits[circle];
        let stays = broken_off.is_none() && !gone.contains(&circle);
        let kept = stays.then(|| unchanged(skies, planned, &here, (circle, entry), changes)).flatten();
        let (transition, entry, candidates) = match kept {
            Some(leg) => (leg.transition.clone(), entry, leg.candidates.clone()),
            None => {
                let (transition, found, candidates) = airspace.reach(&here, orbit, entry);
                let Some(transition) = transition else {
                    return Err(Error::Leg { vehicle, leg: legs.len(), circle: Some(circle), candidates });
                };
                (transition, found, candidates)
            }
        };
        let loiter = Loiter { circle, entry, duration: orbit.circle.duration, length: orbit.loiter.length() };
        let (start_time, transition) = joined(skies, planned, &legs, broken_off.take(), time, transition);
        legs.push(Leg { start_time, transition, loiter: Some(loiter), candidates });
        time = legs[legs.len() - 1].end_time();
        here = orbit.exit(entry);
        airspace = now;
    }
    let stays = broken_off.is_none();
    let kept = stays.then(|| unchanged_home(skies, planned, &here, time, changes)).flatten();
    let (transition, candidates) = match kept {
        Some(leg) => (Some(leg.transition.clone()), leg.candidates.clone()),
        None => airspace.to_pad(&here, planned.pad),
    };
    let Some(transition) = transition else {
        return Err(Error::Leg { vehicle, leg: legs.len(), circle: None, candidates });
    };
    let (start_time, transition) = joined(skies, planned, &legs, broken_off, time, transition);
    legs.push(Leg { start_time, transition, loiter: None, candidates });
    Ok(Some(legs))
}

/// Whether all that is ahead of a vehicle can be flown as planned.
fn keeps_all(skies: &Skies, planned: &VehiclePlan, settled: &Settled, changes: &Changes) -> bool {
    !changes.wind
        && !settled.open.iter().any(|circle| changes.gone.contains(circle))
        && planned.route.ends_with(&settled.open)
        && settled.legs.len() + settled.open.len() == planned.route.len()
        && (settled.legs.len()..planned.legs.len()).all(|leg| !enters(skies, planned, leg, changes))
}

/// The entries of the open circles: as planned where there is a plan, else the best between their neighbours.
fn entries(
    airspace: &Airspace,
    model: &TimeModel,
    planned: &VehiclePlan,
    (here, open): (&Motion, &[usize]),
    gone: &[usize],
) -> Vec<Entry> {
    let old = |circle: usize| {
        let mut loiters = planned.legs.iter().filter_map(|leg| leg.loiter);
        // A circle that has moved is entered anew.
        loiters.find(|loiter| loiter.circle == circle && !gone.contains(&circle)).map(|loiter| loiter.entry)
    };
    let sampled = entry::sampled(airspace.mission.transition.entries);
    let mut from = *here;
    let mut chosen = Vec::with_capacity(open.len());
    for (i, &circle) in open.iter().enumerate() {
        let orbit = &airspace.orbits[circle];
        let then = match open.get(i + 1) {
            Some(&next) => old(next).map(|entry| airspace.orbits[next].at(entry)),
            None => Some(airspace.landing(planned.pad)),
        };
        let cost = |entry: &Entry| {
            model.time(&from, &orbit.at(*entry))
                + then.map_or(0.0, |then| model.time(&orbit.exit(*entry), &then))
        };
        let best = || sampled.iter().min_by(|a, b| cost(a).total_cmp(&cost(b))).copied();
        let entry = old(circle).or_else(best).unwrap_or(sampled[0]);
        from = orbit.exit(entry);
        chosen.push(entry);
    }
    chosen
}

/// The planned leg from this very motion to this entry, unless it now enters a safe distance.
fn unchanged<'a>(
    skies: &Skies,
    planned: &'a VehiclePlan,
    here: &Motion,
    (circle, entry): (usize, Entry),
    changes: &Changes,
) -> Option<&'a Leg> {
    let index = planned
        .legs
        .iter()
        .position(|leg| leg.loiter.is_some_and(|loiter| loiter.circle == circle && loiter.entry == entry))?;
    let before = index.checked_sub(1).map(|before| &planned.legs[before]);
    let from = before.and_then(|leg| leg.loiter);
    if changes.wind || from.is_some_and(|loiter| changes.gone.contains(&loiter.circle)) {
        return None;
    }
    let start = skies.start(planned, before, planned.legs[index].start_time);
    (start == *here && !enters(skies, planned, index, changes)).then(|| &planned.legs[index])
}

/// The planned way home, if it starts in this very motion, unless it now enters a safe distance.
fn unchanged_home<'a>(
    skies: &Skies,
    planned: &'a VehiclePlan,
    here: &Motion,
    time: f64,
    changes: &Changes,
) -> Option<&'a Leg> {
    let [.., from, home] = &planned.legs[..] else { return None };
    let stays = from.loiter.is_some_and(|loiter| !changes.gone.contains(&loiter.circle));
    let same = stays && skies.start(planned, Some(from), time) == *here;
    let clear = || !enters(skies, planned, planned.legs.len() - 1, changes);
    (same && !changes.wind && home.loiter.is_none() && clear()).then_some(home)
}

/// A leg's start and its transition, with what was flown before it was broken off in front.
fn joined(
    skies: &Skies,
    planned: &VehiclePlan,
    legs: &[Leg],
    broken_off: Option<(f64, Transition)>,
    time: f64,
    rest: Transition,
) -> (f64, Transition) {
    let Some((start_time, mut whole)) = broken_off else { return (time, rest) };
    let elapsed = whole.duration;
    whole.knots.extend(rest.knots.iter().skip(1).map(|knot| knot + elapsed));
    whole.states.extend(rest.states.into_iter().skip(1));
    whole.controls.extend(rest.controls);
    whole.duration = elapsed + rest.duration;
    whole.iterations += rest.iterations;
    (whole.status, whole.miss) = (rest.status, rest.miss);
    whole.primal_residual = rest.primal_residual;
    whole.dual_residual = rest.dual_residual;
    let start = skies.start(planned, legs.last(), start_time);
    if let Some(seen) = skies.at(start_time).pilot.examine(&whole, &start) {
        (whole.length, whole.max_speed, whole.max_tilt) = (seen.length, seen.max_speed, seen.max_tilt);
    }
    (start_time, whole)
}
