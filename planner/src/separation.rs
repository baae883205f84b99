//! How close vehicles come to each other, proved on the continuous trajectories, and start delays that keep them apart.

use crate::mission::Mission;
use crate::plan::{Approach, Plan};
use crate::sample::Sampler;

/// How far the distance found may be above the true least one (m).
pub(crate) const RESOLUTION: f64 = 1e-3;

/// A vehicle in the air: where it is, when it flies, and how fast at most.
pub(crate) struct Airborne<'a> {
    /// Position (m) at a time (s after the mission's start).
    pub position: Box<dyn Fn(f64) -> [f64; 3] + 'a>,
    /// First and last moment in the air (s).
    pub flight: [f64; 2],
    /// Speed that is never exceeded (m/s).
    pub top_speed: f64,
}

/// What `ask` answers about the vehicles of a plan in the air.
pub(crate) fn in_the_air<R>(
    plan: &Plan,
    mission: &Mission,
    ask: impl FnOnce(Vec<Option<Airborne>>) -> R,
) -> Option<R> {
    let sampler = Sampler::new(plan, mission)?;
    let airborne = |vehicle: usize| {
        let planned = &plan.vehicles[vehicle];
        let (first, last) = (planned.legs.first()?, planned.legs.last()?);
        let sampler = &sampler;
        let speeds = planned.legs.iter().map(|leg| sampler.top_speed(leg));
        Some(Airborne {
            position: Box::new(move |time| sampler.motion(vehicle, time).0.position.into()),
            flight: [first.start_time, last.end_time()],
            top_speed: speeds.fold(0.0, f64::max),
        })
    };
    let fleet: Vec<Option<Airborne>> = (0..plan.vehicles.len()).map(airborne).collect();
    Some(ask(fleet))
}

/// Time and least distance of two vehicles while both fly, to within [`RESOLUTION`]; `None` if they never fly together or never
/// come closer than `to_beat` (m).
pub(crate) fn closest_approach(first: &Airborne, second: &Airborne, to_beat: f64) -> Option<(f64, f64)> {
    closest([(first, 0.0), (second, 0.0)], to_beat, f64::NEG_INFINITY)
}

/// Time and least distance of two flights that start later by so many seconds, to within [`RESOLUTION`], or of an encounter
/// that is closer than `enough` (m); `None` if they never fly together or never come closer than `to_beat` (m).
///
/// The distance `d` of two points changes by at most `L = v_1 + v_2` per second, so over `[a, b]` it is at least
/// `(d(a) + d(b) - L (b - a))/2`. Intervals whose bound is within the resolution of the best distance seen are dropped,
/// the others are halved: no encounter can hide between samples.
fn closest(flights: [(&Airborne, f64); 2], to_beat: f64, enough: f64) -> Option<(f64, f64)> {
    let [(first, first_delay), (second, second_delay)] = flights;
    let start = (first.flight[0] + first_delay).max(second.flight[0] + second_delay);
    let end = (first.flight[1] + first_delay).min(second.flight[1] + second_delay);
    if start > end {
        return None;
    }
    let lipschitz = first.top_speed + second.top_speed;
    let distance = |time: f64| {
        let (a, b) = ((first.position)(time - first_delay), (second.position)(time - second_delay));
        (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
    };
    let (at_start, at_end) = (distance(start), distance(end));
    let mut best = (start, to_beat);
    for (time, distance) in [(start, at_start), (end, at_end)] {
        if distance < best.1 {
            best = (time, distance);
        }
    }
    let mut open = vec![([start, end], [at_start, at_end])];
    while let Some(([a, b], [at_a, at_b])) = open.pop()
        && best.1 >= enough
    {
        let lower_bound = 0.5 * (at_a + at_b - lipschitz * (b - a));
        if lower_bound >= best.1 - RESOLUTION {
            continue;
        }
        let middle = 0.5 * (a + b);
        let at_middle = distance(middle);
        if at_middle < best.1 {
            best = (middle, at_middle);
        }
        open.push(([middle, b], [at_middle, at_b]));
        open.push(([a, middle], [at_a, at_middle]));
    }
    (best.1 < to_beat).then_some(best)
}

/// The closest approach over all pairs, vehicles named by their index in `fleet`; `None` entries do not fly.
pub(crate) fn closest_pair(fleet: &[Option<Airborne>]) -> Option<Approach> {
    let mut closest: Option<Approach> = None;
    for (i, first) in fleet.iter().enumerate() {
        for (j, second) in fleet.iter().enumerate().skip(i + 1) {
            let (Some(first), Some(second)) = (first, second) else { continue };
            let to_beat = closest.map_or(f64::INFINITY, |best| best.distance);
            if let Some((time, distance)) = closest_approach(first, second, to_beat) {
                closest = Some(Approach { vehicles: [i, j], time, distance });
            }
        }
    }
    closest
}

/// Start delays (s) with which every two flights stay `separation` (m) apart while both are in the air, and each starts `swap_time` (s)
/// or more after the one `before` it, if there is one.
///
/// Flights are placed one after the other, the longest first, further sorties after all first ones; then whoever ends last because it
/// waits for others is placed before them, as long as that may help (prioritised planning with rescheduling, Bennewitz, Burgard and
/// Thrun 2002). The delays that end soonest are kept.
pub(crate) fn start_delays(
    fleet: &[Option<Airborne>],
    separation: f64,
    before: &[Option<usize>],
    swap_time: f64,
) -> Vec<f64> {
    let sortie = |i: usize| std::iter::successors(before[i], |&earlier| before[earlier]).count();
    let landing =
        |delays: &[f64], i: usize| fleet[i].as_ref().map_or(0.0, |flight| flight.flight[1] + delays[i]);
    let length = |i: usize| fleet[i].as_ref().map_or(0.0, |airborne| airborne.flight[1] - airborne.flight[0]);
    let mut order: Vec<usize> = (0..fleet.len()).filter(|&i| fleet[i].is_some()).collect();
    order.sort_by(|&a, &b| sortie(a).cmp(&sortie(b)).then(length(b).total_cmp(&length(a))));
    let mut best = (f64::INFINITY, vec![0.0; fleet.len()]);
    for _ in 0..=order.len() {
        let delays = delays_in_order(fleet, separation, &order, before, swap_time);
        let ends = order.iter().map(|&i| (landing(&delays, i), i));
        let Some((end, last)) = ends.max_by(|a, b| a.0.total_cmp(&b.0)) else { break };
        let waits = delays[last] > 0.0;
        if end < best.0 {
            best = (end, delays);
        }
        let first = order.iter().position(|&i| sortie(i) == sortie(last));
        let at = order.iter().position(|&i| i == last);
        match (first, at) {
            (Some(first), Some(at)) if waits && first < at => order[first..=at].rotate_right(1),
            _ => break,
        }
    }
    best.1
}

/// Start delays (s) of flights that are placed one after the other: each waits the fewest [`DELAY_STEP`]s that keep it apart from all
/// that were placed before it. There is always an end to the waiting: a vehicle on its pad counts for nothing.
fn delays_in_order(
    fleet: &[Option<Airborne>],
    separation: f64,
    order: &[usize],
    before: &[Option<usize>],
    swap_time: f64,
) -> Vec<f64> {
    let mut delays = vec![0.0; fleet.len()];
    for (place, &vehicle) in order.iter().enumerate() {
        let Some(flight) = &fleet[vehicle] else { continue };
        let apart = |delay: f64| {
            order[..place].iter().all(|&other| {
                fleet[other].as_ref().is_none_or(|placed| {
                    closest([(placed, delays[other]), (flight, delay)], separation, separation).is_none()
                })
            })
        };
        let landed = |earlier: usize| {
            fleet[earlier].as_ref().map_or(0.0, |airborne| airborne.flight[1] + delays[earlier] + swap_time)
        };
        let earliest = before[vehicle].map_or(0.0, landed);
        let waits = (0u32..).map(|step| earliest + f64::from(step) * DELAY_STEP);
        delays[vehicle] = waits.into_iter().find(|&delay| apart(delay)).unwrap_or(0.0);
    }
    delays
}

/// Granularity of start delays (s).
pub(crate) const DELAY_STEP: f64 = 0.25;

#[cfg(test)]
mod tests {
    use super::*;

    /// Two vehicles on crossing lines that meet for a hundredth of a second, far from any regular sampling time.
    #[test]
    fn a_grazing_encounter_is_found() {
        let meeting = 12.345_678_9;
        let first = |t: f64| [100.0 * (t - meeting), 0.0, 1.0];
        let second = |t: f64| [0.0, 100.0 * (t - meeting), 1.5];
        let airborne = |position: Box<dyn Fn(f64) -> [f64; 3]>| Airborne {
            position,
            flight: [0.0, 100.0],
            top_speed: 100.0,
        };
        let (first, second) = (airborne(Box::new(first)), airborne(Box::new(second)));
        let (time, distance) = closest_approach(&first, &second, f64::INFINITY).unwrap();
        assert!((time - meeting).abs() < 1e-4, "{time}");
        assert!((0.5 - distance).abs() <= RESOLUTION, "{distance}");
    }

    #[test]
    fn the_shorter_flight_waits_until_the_crossing_is_clear() {
        let first = |t: f64| [10.0 * (t - 5.0), 0.0, 1.0];
        let second = |t: f64| [0.0, 10.0 * (t - 4.5), 1.0];
        let fleet = [
            Some(Airborne { position: Box::new(second), flight: [0.0, 9.0], top_speed: 10.0 }),
            Some(Airborne { position: Box::new(first), flight: [0.0, 10.0], top_speed: 10.0 }),
        ];
        let delays = start_delays(&fleet, 3.0, &[None, None], 0.0);
        // Without a delay the crossings are half a second apart, 3.5 m; closing on each other halves the squares: 3.53 m.
        assert_eq!(delays, [0.0, 0.0]);
        let delays = start_delays(&fleet, 5.0, &[None, None], 0.0);
        assert_eq!(delays[1], 0.0);
        // With the crossings dt apart the least distance is 10 dt / sqrt 2: at least 5 m from 0.707 s on.
        assert_eq!(delays[0], 1.25);
    }

    /// The longer flight stands over the crossing for ten seconds; the shorter one would be over it just before.
    #[test]
    fn the_longer_flight_waits_where_all_land_sooner_for_it() {
        let first = |t: f64| [10.0 * ((t - 5.0).min(0.0) + (t - 15.0).max(0.0)), 0.0, 1.0];
        let second = |t: f64| [0.0, 10.0 * (t - 4.5), 1.0];
        let fleet = [
            Some(Airborne { position: Box::new(first), flight: [0.0, 20.0], top_speed: 10.0 }),
            Some(Airborne { position: Box::new(second), flight: [0.0, 18.0], top_speed: 10.0 }),
        ];
        assert_eq!(start_delays(&fleet, 5.0, &[None, None], 0.0), [0.25, 0.0]);
    }

    #[test]
    fn vehicles_that_never_fly_together_have_no_approach() {
        let still = |flight| Airborne { position: Box::new(|_| [0.0; 3]), flight, top_speed: 0.0 };
        let (first, second) = (still([0.0, 1.0]), still([2.0, 3.0]));
        assert_eq!(closest_approach(&first, &second, f64::INFINITY), None);
    }
}
