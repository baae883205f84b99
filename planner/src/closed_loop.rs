//! A plan flown by a simulated team: controller, rotors with lag, noisy estimates, wind.

use crate::mission::Mission;
use crate::plan::Plan;
use crate::sample::MOST_MOMENTS;
use quad_dynamics::Motion;
use quad_dynamics::simulation::{Flight, SimulationOptions, Tracking};

/// What came of a simulated flight of one vehicle.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Flown {
    /// The vehicle, from 0.
    pub vehicle: usize,
    /// When it took off (s after the mission's start).
    pub start_time: f64,
    /// Planned against flown.
    pub tracking: Tracking,
    /// Least horizontal distance to a target minus its safe distance (m), at the recorded states, each target from the moment on at
    /// which it is known ([`Plan::known_since`]); infinite without targets.
    pub clearance: f64,
    /// The recorded flight.
    pub flight: Flight,
}

impl Plan {
    /// The flight of one vehicle as motions every `step` seconds, its last moment included; empty for a spare vehicle.
    ///
    /// `None` if there is no such vehicle, if the step is not positive or asks for more than 2^24 motions (9 hours at 500 Hz), or if
    /// `mission` is not the one that was planned.
    #[must_use]
    pub fn motions(&self, mission: &Mission, vehicle: usize, step: f64) -> Option<Vec<Motion>> {
        let planned = self.vehicles.get(vehicle)?;
        if !(step > 0.0 && step.is_finite() && planned.duration() / step < MOST_MOMENTS) {
            return None;
        }
        let sampler = self.sampler(mission)?;
        if planned.legs.is_empty() {
            return Some(Vec::new());
        }
        let steps = (planned.duration() / step).ceil() as usize;
        let time = |i: usize| (planned.start_time() + i as f64 * step).min(planned.end_time());
        Some((0..=steps).map(|i| sampler.motion(vehicle, time(i)).0).collect())
    }

    /// Lets a simulated team fly the plan: one [`Flown`] per vehicle with a route. Equal plan, options and seed give equal
    /// flights, to the bit; every vehicle meets its own gusts and noise.
    ///
    /// `None` if `mission` is not the one that was planned.
    #[must_use]
    pub fn fly(&self, mission: &Mission, options: &SimulationOptions, seed: u64) -> Option<Vec<Flown>> {
        let mut team = Vec::new();
        for (vehicle, planned) in
            self.vehicles.iter().enumerate().filter(|(_, planned)| !planned.legs.is_empty())
        {
            let motions = self.motions(mission, vehicle, options.step)?;
            let own = seed.wrapping_mul(self.vehicles.len() as u64).wrapping_add(vehicle as u64);
            let flight = quad_dynamics::simulation::simulate(&mission.fleet.vehicle, &motions, options, own)?;
            team.push(Flown {
                vehicle,
                start_time: planned.start_time(),
                tracking: flight.tracking,
                clearance: self.clearance(mission, &flight, planned.start_time()),
                flight,
            });
        }
        Some(team)
    }

    fn clearance(&self, mission: &Mission, flight: &Flight, start_time: f64) -> f64 {
        let to_target = |i: usize| {
            let [east, north] = mission.targets[i].position;
            let since = self.known_since.iter().find(|&&(target, _)| target == i);
            let unknown = since.map_or(0.0, |&(_, since)| (since - start_time) / flight.interval);
            let known = flight.states.iter().skip(unknown.ceil().max(0.0) as usize);
            let distances = known.map(|state| (state[0] - east).hypot(state[1] - north));
            distances.fold(f64::INFINITY, f64::min) - mission.safe_distance(i)
        };
        (0..mission.targets.len()).map(to_target).fold(f64::INFINITY, f64::min)
    }
}
