//! Entries and directions chosen for a whole route at once.
//!
//! Where a circle is entered decides where the next leg starts, so the fastest entry of every single leg need not make the
//! fastest route. A shortest path over the layers (circle, entry, direction), with leg times by a calibrated model, proposes
//! another sequence; it is solved, and flown if it is faster than the one found leg by leg.

use crate::circles::Orbit;
use crate::entry;
use crate::error::Error;
use crate::legs::Airspace;
use crate::plan::{Entry, Leg, Outcome};
use crate::time_model::TimeModel;
use crate::transition::hover;
use quad_dynamics::Motion;

/// A route with the legs found so far.
pub(crate) struct Flown<'a> {
    pub vehicle: usize,
    pub pad: [f64; 3],
    pub route: &'a [usize],
    pub legs: Vec<Leg>,
}

impl Airspace<'_> {
    /// All transitions that were solved along a route, to the end or nearly: from, to, time (s).
    pub(crate) fn solved(&self, pad: [f64; 3], route: &[usize], legs: &[Leg]) -> Vec<(Motion, Motion, f64)> {
        let mut solved = Vec::new();
        let mut here = self.take_off(pad, route);
        for leg in legs {
            let Some(loiter) = leg.loiter else { break };
            let orbit = &self.orbits[loiter.circle];
            for candidate in &leg.candidates {
                let Some(entry) = candidate.entry else { continue };
                if let Outcome::Solved { duration } | Outcome::Slower { duration } = candidate.outcome {
                    solved.push((here, orbit.at(entry), duration));
                }
            }
            here = orbit.exit(loiter.entry);
        }
        solved
    }

    /// The legs of a route with the entries that are best for it as a whole, if the model proposes any that turn out faster.
    pub(crate) fn reconsider(&self, flown: &Flown, model: &TimeModel) -> Result<Vec<Leg>, Error> {
        let &Flown { vehicle, pad, route, ref legs } = flown;
        let (entries, _) = self.shortest_path(pad, route, model);
        let same = |leg: &Leg, entry: &Entry| leg.loiter.is_some_and(|loiter| loiter.entry == *entry);
        if legs.iter().zip(&entries).all(|(leg, entry)| same(leg, entry)) {
            return Ok(legs.clone());
        }
        match self.fly_entries(vehicle, pad, route, &entries, legs) {
            Ok(proposed) if time(&proposed) < time(legs) => Ok(proposed),
            Err(Error::Stopped) => Err(Error::Stopped),
            _ => Ok(legs.clone()),
        }
    }

    /// The time model before any transition is solved.
    pub(crate) fn time_model(&self) -> TimeModel {
        let [acceleration, speed] = self.envelope.level_flight();
        TimeModel::new(acceleration, speed).in_wind(self.mission.environment.air().xy())
    }

    /// A route in the direction in which its modelled legs take less time.
    pub(crate) fn directed(&self, pad: [f64; 3], mut route: Vec<usize>, model: &TimeModel) -> Vec<usize> {
        let (_, forwards) = self.shortest_path(pad, &route, model);
        route.reverse();
        let (_, backwards) = self.shortest_path(pad, &route, model);
        if forwards <= backwards {
            route.reverse();
        }
        route
    }

    /// The entries of a route with the least sum of modelled leg times, and that (s); the loiters take as long from any entry.
    pub(crate) fn shortest_path(
        &self,
        pad: [f64; 3],
        route: &[usize],
        model: &TimeModel,
    ) -> (Vec<Entry>, f64) {
        let entries = entry::sampled(self.mission.transition.entries);
        let orbits: Vec<&Orbit> = route.iter().map(|&circle| &self.orbits[circle]).collect();
        let Some(first) = orbits.first() else { return (Vec::new(), 0.0) };
        let start = self.take_off(pad, route);
        let mut times: Vec<f64> = entries.iter().map(|&entry| model.time(&start, &first.at(entry))).collect();
        let mut origins: Vec<Vec<usize>> = Vec::new();
        for pair in orbits.windows(2) {
            let exits: Vec<Motion> = entries.iter().map(|&entry| pair[0].exit(entry)).collect();
            let best_into = |&entry: &Entry| {
                let there = pair[1].at(entry);
                let via = |i: usize| times[i] + model.time(&exits[i], &there);
                let times: Vec<f64> = (0..entries.len()).map(via).collect();
                least(&times)
            };
            let reached: Vec<(usize, f64)> = entries.iter().map(best_into).collect();
            origins.push(reached.iter().map(|&(origin, _)| origin).collect());
            times = reached.iter().map(|&(_, time)| time).collect();
        }
        let home = self.landing(pad);
        let totals: Vec<f64> = entries
            .iter()
            .zip(&times)
            .map(|(&entry, time)| time + model.time(&orbits[orbits.len() - 1].exit(entry), &home))
            .collect();
        let (mut at, total) = least(&totals);
        let mut path = vec![entries[at]];
        for origin in origins.iter().rev() {
            at = origin[at];
            path.push(entries[at]);
        }
        path.reverse();
        (path, total)
    }

    /// The direction from a pad to the first circle of a route (rad, from east, counter-clockwise).
    pub(crate) fn heading(&self, pad: [f64; 3], route: &[usize]) -> f64 {
        route.first().map_or(0.0, |&circle| {
            let [x, y] = self.orbits[circle].circle.centre;
            (y - pad[1]).atan2(x - pad[0])
        })
    }

    /// The hover from which a route starts.
    pub(crate) fn take_off(&self, pad: [f64; 3], route: &[usize]) -> Motion {
        hover(self.mission, pad, self.heading(pad, route))
    }

    /// The hover in which a route ends, with any yaw.
    pub(crate) fn landing(&self, pad: [f64; 3]) -> Motion {
        hover(self.mission, pad, 0.0)
    }
}

/// Time in the air of consecutive legs (s).
fn time(legs: &[Leg]) -> f64 {
    legs.last().map_or(0.0, Leg::end_time)
}

/// The first of the least values, and it.
fn least(times: &[f64]) -> (usize, f64) {
    times
        .iter()
        .copied()
        .enumerate()
        .fold((0, f64::INFINITY), |best, (i, time)| if time < best.1 { (i, time) } else { best })
}
