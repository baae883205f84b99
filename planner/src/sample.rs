//! Where every vehicle is at any moment of a plan.

use crate::airs::Airs;
use crate::mission::Mission;
use crate::plan::{Leg, Phase, Plan, Sample};
use crate::transition::Path;
use quad_dynamics::Motion;
use quad_dynamics::frames::to_wxyz;
use std::sync::OnceLock;

/// A plan together with what its mission says of vehicle and circles, ready to be asked for moments.
pub(crate) struct Sampler<'a> {
    plan: &'a Plan,
    mission: &'a Mission,
    airs: Airs<'a>,
    /// The transition of every leg of every vehicle, integrated when it is first asked for.
    paths: Vec<Vec<OnceLock<Option<Path>>>>,
}

impl<'a> Sampler<'a> {
    /// `None` if the mission's circles cannot be flown, or are not the plan's.
    pub(crate) fn new(plan: &'a Plan, mission: &'a Mission) -> Option<Self> {
        let airs = Airs::new(plan, mission);
        if !airs.fit(plan) {
            return None;
        }
        let paths =
            plan.vehicles.iter().map(|planned| planned.legs.iter().map(|_| OnceLock::new()).collect());
        Some(Self { plan, mission, airs, paths: paths.collect() })
    }

    /// The moment `time` (s after the mission's start) of a vehicle; hover on its pad before and after its flight.
    pub(crate) fn sample(&self, vehicle: usize, time: f64) -> Sample {
        let (motion, phase, circle) = self.motion(vehicle, time);
        Sample {
            time,
            position: motion.position.into(),
            velocity: motion.velocity.into(),
            acceleration: motion.acceleration.into(),
            attitude: to_wxyz(&motion.attitude).into(),
            body_rates: motion.body_rates.into(),
            collective_thrust: motion.collective_thrust,
            phase,
            circle,
        }
    }

    /// The motion of a vehicle, what it is doing, and the circle that it flies to or around.
    pub(crate) fn motion(&self, vehicle: usize, time: f64) -> (Motion, Phase, Option<usize>) {
        let planned = &self.plan.vehicles[vehicle];
        let k = planned.legs.partition_point(|leg| leg.start_time <= time).saturating_sub(1);
        let flown = planned.legs.get(k).filter(|leg| time >= leg.start_time && time <= leg.end_time());
        flown
            .and_then(|leg| self.in_leg(leg, &self.paths[vehicle][k], time))
            .unwrap_or_else(|| (self.airs.at(time).hover(planned.pad, planned.heading), Phase::Pad, None))
    }

    /// Greatest speed over the ground on a leg (m/s).
    pub(crate) fn top_speed(&self, leg: &Leg) -> f64 {
        leg.transition.max_speed.max(self.airs.loiter_speed(leg))
    }

    /// Electrical energy of a vehicle's flight (J).
    pub(crate) fn energy(&self, vehicle: usize) -> f64 {
        let planned = &self.plan.vehicles[vehicle];
        let steps = (planned.duration() / ENERGY_STEP).ceil().max(1.0);
        let step = planned.duration() / steps;
        let time = |i: usize| planned.start_time() + i as f64 * step;
        let motions: Vec<Motion> = (0..=steps as usize).map(|i| self.motion(vehicle, time(i)).0).collect();
        self.mission.fleet.vehicle.flight_energy(&motions, step)
    }

    fn in_leg(
        &self,
        leg: &Leg,
        path: &OnceLock<Option<Path>>,
        time: f64,
    ) -> Option<(Motion, Phase, Option<usize>)> {
        let air = self.airs.at(leg.start_time);
        match leg.loiter {
            Some(loiter) if time >= leg.arrival_time() => {
                let motion = air.orbits.get(loiter.circle)?.after(loiter.entry, time - leg.arrival_time());
                Some((motion, Phase::Loiter, Some(loiter.circle)))
            }
            _ => {
                let path = path.get_or_init(|| air.pilot.path(&leg.transition)).as_ref()?;
                let motion = path(time - leg.start_time);
                Some((motion, Phase::Transition, leg.loiter.map(|loiter| loiter.circle)))
            }
        }
    }
}

/// Step with which the power of a flight is summed up (s).
const ENERGY_STEP: f64 = 0.1;

impl Plan {
    /// Electrical energy of a vehicle's flight (J), by momentum theory ([`Vehicle::power`](quad_dynamics::Vehicle::power)); 0 for a
    /// spare vehicle.
    ///
    /// `None` if there is no such vehicle, or if `mission` is not the one that was planned.
    #[must_use]
    pub fn energy(&self, mission: &Mission, vehicle: usize) -> Option<f64> {
        let planned = self.vehicles.get(vehicle)?;
        if planned.legs.is_empty() {
            return Some(0.0);
        }
        Some(Sampler::new(self, mission)?.energy(vehicle))
    }

    /// Where a vehicle is `time` seconds after the mission's start; on its pad before and after its flight.
    ///
    /// `None` if there is no such vehicle, or if `mission` is not the one that was planned.
    #[must_use]
    pub fn sample(&self, mission: &Mission, vehicle: usize, time: f64) -> Option<Sample> {
        (vehicle < self.vehicles.len()).then_some(())?;
        Some(Sampler::new(self, mission)?.sample(vehicle, time))
    }

    /// A vehicle's flight at `rate` (Hz, above 0), its last moment included; empty for a spare vehicle.
    ///
    /// `None` if there is no such vehicle, if the rate is not positive, or if `mission` is not the one that was planned.
    #[must_use]
    pub fn samples(&self, mission: &Mission, vehicle: usize, rate: f64) -> Option<Vec<Sample>> {
        let legs = &self.vehicles.get(vehicle)?.legs;
        if !(rate > 0.0 && rate.is_finite()) {
            return None;
        }
        let sampler = Sampler::new(self, mission)?;
        let (Some(first), Some(last)) = (legs.first(), legs.last()) else { return Some(Vec::new()) };
        let (start, end) = (first.start_time, last.end_time());
        let steps = ((end - start) * rate).ceil() as usize;
        Some((0..=steps).map(|i| sampler.sample(vehicle, (start + i as f64 / rate).min(end))).collect())
    }
}
