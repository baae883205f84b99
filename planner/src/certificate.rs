//! How good a plan can be said to be: bounds that hold over every allocation, order, entry, direction and admissible motion.
//!
//! Between the end of one loiter and the start of the next a vehicle covers at least the gap between the two circles, from
//! and to at most the loiter speeds. No motion does that in less than [`Envelope::least_time`]; loiter times are fixed by
//! the mission. So every plan's times are at least those of some routes under these leg times, and no routes beat the
//! lower bounds of `mtsp`. Nothing is fitted or calibrated.
//!
//! In a steady wind a leg takes longer one way than the other, and the bounds of `mtsp` for asymmetric distances would count
//! the shorter way of each. Every route is closed, so `pi . (x_j - x_i)` with one vector `pi` may be added to every leg from `x_i`
//! to `x_j` without changing the time of any route: chosen along the wind, it takes the difference away to first order.

use crate::bound::{Drift, Envelope, LegTimes};
use crate::circles::Orbit;
use crate::error::Error;
use crate::mission::Mission;
use crate::plan::{Certificate, VehiclePlan};
use christofides::Metric;
use mtsp::Problem;
use mtsp::lower_bound::{self, LowerBounds};
use nalgebra::Vector2;

/// Least leg times between depot (node 0, standing for every pad) and circles (node `i + 1` for circle `i`).
pub(crate) struct LeastTimes<'a> {
    pub orbits: &'a [Orbit],
    pub pads: &'a [[f64; 3]],
    pub envelope: &'a Envelope,
}

impl Metric for LeastTimes<'_> {
    fn len(&self) -> usize {
        self.orbits.len() + 1
    }

    fn distance(&self, i: usize, j: usize) -> f64 {
        let (i, j) = (i.min(j), i.max(j));
        if i == j {
            return 0.0;
        }
        let there = &self.orbits[j - 1].circle;
        if i == 0 {
            let to_pad = |pad: &[f64; 3]| (pad[0] - there.centre[0]).hypot(pad[1] - there.centre[1]);
            let closest = self.pads.iter().map(to_pad).fold(f64::INFINITY, f64::min);
            // Leaving a hover is the slower half of either direction of flight; braking with drag is the faster one.
            let gap = (closest - there.radius).abs();
            return self.envelope.least_time(gap, 0.0, there.speed).min(self.envelope.least_time(
                gap,
                there.speed,
                0.0,
            ));
        }
        let here = &self.orbits[i - 1].circle;
        let between = (here.centre[0] - there.centre[0]).hypot(here.centre[1] - there.centre[1]);
        let gap = (between - here.radius - there.radius).max(0.0);
        let (slow, fast) = (here.speed.min(there.speed), here.speed.max(there.speed));
        self.envelope.least_time(gap, slow, fast).min(self.envelope.least_time(gap, fast, slow))
    }
}

/// Least leg times and loiter times in a steady wind, with the potential added to the legs.
fn in_wind(orbits: &[Orbit], pads: &[[f64; 3]], envelope: &Envelope) -> (LegTimes, Vec<f64>) {
    let fastest = orbits.iter().map(|orbit| orbit.circle.speed).fold(0.0, f64::max);
    let [between, leaving, landing] =
        [[fastest, fastest], [0.0, fastest], [fastest, 0.0]].map(|[from, to]| Drift::new(envelope, from, to));
    let places = |node: usize| -> Vec<(Vector2<f64>, f64)> {
        match node.checked_sub(1).map(|circle| &orbits[circle].circle) {
            None => pads.iter().map(|pad| (Vector2::new(pad[0], pad[1]), 0.0)).collect(),
            Some(circle) => vec![(circle.centre.into(), circle.radius)],
        }
    };
    let legs = |potential: Vector2<f64>| {
        LegTimes::new(orbits.len() + 1, |i, j| {
            let drift = if i == 0 {
                &leaving
            } else if j == 0 {
                &landing
            } else {
                &between
            };
            let (from, to) = (places(i), places(j));
            let pairs = from.iter().flat_map(|a| to.iter().map(move |b| (b.0 - a.0, a.1 + b.1)));
            let times = pairs.map(|(offset, slack)| drift.least_time(offset, slack) + potential.dot(&offset));
            times.reduce(f64::min).unwrap_or(0.0)
        })
    };
    let service = std::iter::once(0.0).chain(orbits.iter().map(|orbit| orbit.circle.duration)).collect();
    let (legs, service, _) = levelled(envelope, legs, service);
    (legs, service)
}

/// Leg times to which the potential along the wind has been added, loiter times by node (0 for depots), and the potential (s/m).
///
/// Where that would leave a leg less than nothing, a part `delta` of every loiter's time is counted with the legs that lead to and
/// from it, half with each: no route notices. Without a `delta` that would do there is no potential.
pub(crate) fn levelled(
    envelope: &Envelope,
    legs: impl Fn(Vector2<f64>) -> LegTimes,
    service: Vec<f64>,
) -> (LegTimes, Vec<f64>, Vector2<f64>) {
    let wind = envelope.wind();
    let squares = envelope.level_flight()[1].powi(2) - wind.norm_squared();
    if wind == Vector2::zeros() || squares <= 0.0 {
        return (legs(Vector2::zeros()), service, Vector2::zeros());
    }
    let potential = wind / squares;
    let shares = |i: usize, j: usize| {
        0.5 * (f64::from(u8::from(service[i] > 0.0)) + f64::from(u8::from(service[j] > 0.0)))
    };
    let shifted = legs(potential);
    let visited = shifted.pairs().filter(|&(i, j, _)| shares(i, j) > 0.0);
    let delta = visited.map(|(i, j, time)| -time / shares(i, j)).fold(0.0, f64::max);
    if delta >= service.iter().copied().filter(|time| *time > 0.0).fold(f64::INFINITY, f64::min) {
        return (legs(Vector2::zeros()), service, Vector2::zeros());
    }
    let times = shifted.map(|i, j, time| (time + delta * shares(i, j)).max(0.0));
    let service = service.into_iter().map(|time| if time > 0.0 { time - delta } else { 0.0 }).collect();
    (times, service, potential)
}

/// What no plan of a mission can be below.
pub(crate) fn bounds(mission: &Mission, orbits: &[Orbit], envelope: &Envelope) -> Result<LowerBounds, Error> {
    let pads = mission.pads();
    let n_vehicles = mission.fleet.vehicles;
    Ok(if mission.environment.is_windy() {
        let (legs, service) = in_wind(orbits, &pads, envelope);
        lower_bound::both(&Problem::new(&legs, n_vehicles)?.with_service(service)?)
    } else {
        let legs = LeastTimes { orbits, pads: &pads, envelope };
        let service = std::iter::once(0.0).chain(orbits.iter().map(|orbit| orbit.circle.duration)).collect();
        lower_bound::both(&Problem::new(&legs, n_vehicles)?.with_service(service)?)
    })
}

/// The certificate of a finished plan.
pub(crate) fn certificate(bounds: &LowerBounds, vehicles: &[VehiclePlan]) -> Certificate {
    let durations = || vehicles.iter().map(VehiclePlan::duration);
    Certificate {
        makespan: durations().fold(0.0, f64::max),
        makespan_lower_bound: bounds.makespan,
        total: durations().sum(),
        total_lower_bound: bounds.total_cost,
    }
}
