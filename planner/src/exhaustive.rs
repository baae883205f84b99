//! Certificates against all plans of small missions: every split, order, direction and entry, each leg solved.

use crate::airs::Airs;
use crate::entry;
use crate::legs::Airspace;
use crate::mission::{Entries, Mission, Model, Objective, Target};
use crate::options::Options;
use crate::plan::{Entry, VehiclePlan};
use crate::planning::plan;
use quad_dynamics::{Motion, Vehicle, VehicleParameters};

/// Times of all legs (s), infinite where the solver finds none.
pub(crate) struct Times {
    n_entries: usize,
    loiters: Vec<f64>,
    /// Straight home with nothing circled, by vehicle; 0 for one on its pad.
    idle: Vec<f64>,
    /// By vehicle, circle and entry.
    out: Vec<Vec<Vec<f64>>>,
    home: Vec<Vec<Vec<f64>>>,
    /// By circle and entry, and by the next circle and entry.
    between: Vec<Vec<Vec<Vec<f64>>>>,
}

impl Times {
    fn of(mission: &Mission) -> Self {
        let pads = mission.pads();
        let airs = Airs::new(&plan(mission, &Options::default()).unwrap(), mission);
        let airspace = Airspace::of(airs.at(0.0));
        let circles: Vec<usize> = (0..airspace.orbits.len()).collect();
        Self::from(&airspace, &circles, &pads.iter().map(|&pad| (None, pad)).collect::<Vec<_>>())
    }

    /// Of vehicles that go on from a motion, or on their pads, round some circles.
    pub(crate) fn from(
        airspace: &Airspace,
        circles: &[usize],
        vehicles: &[(Option<Motion>, [f64; 3])],
    ) -> Self {
        let entries = entry::sampled(airspace.mission.transition.entries);
        let to = |here: &Motion, circle: usize, entry: Entry| {
            let (transition, found, _) = airspace.reach(here, &airspace.orbits[circle], entry);
            transition.filter(|_| found == entry).map_or(f64::INFINITY, |transition| transition.duration)
        };
        let to_all = |here: &Motion, circle: usize| -> Vec<f64> {
            entries.iter().map(|&entry| to(here, circle, entry)).collect()
        };
        let exit = |circle: usize, entry: Entry| airspace.orbits[circle].exit(entry);
        let back = |here: &Motion, pad: [f64; 3]| {
            airspace.to_pad(here, pad).0.map_or(f64::INFINITY, |transition| transition.duration)
        };
        let onwards = |circle: usize, entry: Entry| {
            let next = |&next: &usize| match next == circle {
                true => Vec::new(),
                false => to_all(&exit(circle, entry), next),
            };
            circles.iter().map(next).collect()
        };
        let out = |&(here, pad): &(Option<Motion>, [f64; 3])| {
            let from = |circle: usize| here.unwrap_or_else(|| airspace.take_off(pad, &[circle]));
            circles.iter().map(|&circle| to_all(&from(circle), circle)).collect()
        };
        let home = |&(_, pad): &(Option<Motion>, [f64; 3])| {
            let from =
                |&circle: &usize| entries.iter().map(|&entry| back(&exit(circle, entry), pad)).collect();
            circles.iter().map(from).collect()
        };
        Self {
            n_entries: entries.len(),
            loiters: circles.iter().map(|&circle| airspace.orbits[circle].circle.duration).collect(),
            idle: vehicles.iter().map(|(here, pad)| here.map_or(0.0, |here| back(&here, *pad))).collect(),
            out: vehicles.iter().map(out).collect(),
            home: vehicles.iter().map(home).collect(),
            between: circles
                .iter()
                .map(|&circle| entries.iter().map(|&entry| onwards(circle, entry)).collect())
                .collect(),
        }
    }

    /// The least time of a route over all entries (s).
    fn route(&self, vehicle: usize, route: &[usize]) -> f64 {
        let Some((&first, rest)) = route.split_first() else { return self.idle[vehicle] };
        let from = |entry: usize| self.out[vehicle][first][entry] + self.rest(vehicle, (first, entry), rest);
        (0..self.n_entries).map(from).fold(f64::INFINITY, f64::min)
    }

    /// The same from a circle and its entry on.
    fn rest(&self, vehicle: usize, (circle, entry): (usize, usize), rest: &[usize]) -> f64 {
        let then = match rest.split_first() {
            None => self.home[vehicle][circle][entry],
            Some((&next, rest)) => (0..self.n_entries)
                .map(|there| {
                    self.between[circle][entry][next][there] + self.rest(vehicle, (next, there), rest)
                })
                .fold(f64::INFINITY, f64::min),
        };
        self.loiters[circle] + then
    }

    /// The least makespan and the least total over all splits and orders for one or two vehicles that begin at given times (s).
    pub(crate) fn best(&self, begin: &[f64]) -> [f64; 2] {
        let mut best = [f64::INFINITY; 2];
        let end = |vehicle: usize, time: f64| if time > 0.0 { begin[vehicle] + time } else { 0.0 };
        for order in orders(self.loiters.len()) {
            let cuts = if self.out.len() == 1 { order.len()..=order.len() } else { 0..=order.len() };
            for cut in cuts {
                let first = self.route(0, &order[..cut]);
                let second = if self.out.len() > 1 { self.route(1, &order[cut..]) } else { 0.0 };
                let makespan =
                    if self.out.len() > 1 { end(0, first).max(end(1, second)) } else { end(0, first) };
                best = [best[0].min(makespan), best[1].min(first + second)];
            }
        }
        best
    }
}

/// All orders of so many things.
fn orders(n: usize) -> Vec<Vec<usize>> {
    let Some(last) = n.checked_sub(1) else { return vec![Vec::new()] };
    let put = |order: Vec<usize>| {
        (0..n).map(move |place| {
            let mut longer = order.clone();
            longer.insert(place, last);
            longer
        })
    };
    orders(last).into_iter().flat_map(put).collect()
}

/// A plan's legs and those of this search are solved from different guesses to the solver's tolerance.
const TOLERANCE: f64 = 5e-3;

#[test]
fn no_plan_of_a_small_mission_beats_the_certificate_and_no_plan_beats_them_all() {
    let near = [[9.0, 4.0], [14.0, -6.0], [-8.0, 9.0]];
    let far = [[40.0, 10.0], [33.0, -25.0], [60.0, -4.0]];
    for (positions, n_vehicles, n_entries, model, wind) in [
        (&near[..], 1, 2, Model::ThrustRate, [0.0; 2]),
        (&near[..], 2, 2, Model::ThrustRate, [0.0; 2]),
        (&far[..], 2, 2, Model::PointMass, [0.0; 2]),
        (&far[..2], 2, 4, Model::ThrustRate, [0.0; 2]),
        (&far[..2], 1, 3, Model::PointMass, [4.0, -3.0]),
    ] {
        let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
        let targets = positions.iter().map(|&position| Target::at(position)).collect();
        let mut mission = Mission::new(vehicle, n_vehicles, targets);
        mission.transition.model = model;
        mission.transition.segments = 20;
        mission.transition.entries = Entries::Sampled(n_entries);
        mission.environment.wind = wind;
        let [makespan, total] = Times::of(&mission).best(&vec![0.0; n_vehicles]);
        assert!(makespan.is_finite() && total.is_finite());
        for objective in [Objective::Makespan, Objective::Total] {
            mission.objective = objective;
            let plan = plan(&mission, &Options::default()).unwrap();
            let found = plan.certificate;
            println!(
                "{} targets, {n_vehicles} vehicles, {objective:?}: makespan {:.3} >= {makespan:.3} >= {:.3}, total {:.3} >= {total:.3} >= {:.3}",
                positions.len(),
                found.makespan,
                found.makespan_lower_bound,
                found.total,
                found.total_lower_bound
            );
            assert!(found.makespan_lower_bound <= makespan, "{found:?} but {makespan}");
            assert!(found.total_lower_bound <= total, "{found:?} but {total}");
            let longest = plan.vehicles.iter().map(VehiclePlan::duration).fold(0.0, f64::max);
            assert!(longest >= makespan * (1.0 - TOLERANCE), "{longest} but {makespan}");
            assert!(found.total >= total * (1.0 - TOLERANCE), "{found:?} but {total}");
            // The bounds mean something: they are not far below.
            assert!(found.total_lower_bound > 0.5 * total && found.makespan_lower_bound > 0.5 * makespan);
        }
    }
}
