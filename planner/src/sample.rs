//! Where every vehicle is at any moment of a plan.

use crate::airs::Airs;
use crate::mission::Mission;
use crate::plan::{Leg, Phase, Plan, Sample};
use crate::transition::Path;
use quad_dynamics::Motion;
use quad_dynamics::frames::to_wxyz;
use std::sync::OnceLock;

/// A plan ready to be asked for many moments: every transition is integrated once, when it is first asked for.
///
/// # Examples
/// ```
/// use planner::quad_dynamics::{Vehicle, VehicleParameters};
/// use planner::{Entries, Mission, Options, Target, plan};
///
/// let mut mission = Mission::new(Vehicle::new(VehicleParameters::survey_450())?, 1, vec![Target::at([15.0, 5.0])]);
/// mission.transition.entries = Entries::Sampled(2);
/// let plan = plan(&mission, &Options::default())?;
/// let sampler = plan.sampler(&mission).ok_or("another mission's plan")?;
/// let highest = sampler.samples(0, 0.02).map(|sample| sample.position[2]).fold(0.0, f64::max);
/// assert!(highest < mission.transition.heights[1]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Sampler<'a> {
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

    /// Where a vehicle is `time` seconds after the mission's start; on its pad before and after its flight. `None` if there is no such
    /// vehicle.
    ///
    /// # Complexity
    /// The first moment of a transition integrates it; any other takes the logarithm of the numbers of legs and segments.
    #[must_use]
    pub fn sample(&self, vehicle: usize, time: f64) -> Option<Sample> {
        (vehicle < self.plan.vehicles.len()).then(|| self.moment(vehicle, time))
    }

    /// A vehicle's flight every `step` seconds, its last moment included; nothing for a spare vehicle, for one that there is not, or
    /// for a step that is not positive.
    pub fn samples(&self, vehicle: usize, step: f64) -> impl Iterator<Item = Sample> + '_ {
        let planned = self.plan.vehicles.get(vehicle).filter(|planned| !planned.legs.is_empty());
        let flight = planned.filter(|_| step > 0.0 && step.is_finite());
        let [start, end] = flight.map_or([0.0; 2], |planned| [planned.start_time(), planned.end_time()]);
        let n = flight.map_or(0, |_| (((end - start) / step).ceil() as usize).saturating_add(1));
        (0..n).map(move |i| self.moment(vehicle, (start + i as f64 * step).min(end)))
    }

    /// A vehicle's flight at `rate` (Hz, above 0), its last moment included; empty for a spare vehicle.
    ///
    /// `None` if there is no such vehicle, if the rate is not positive or asks for more than 2^24 moments (9 hours at 500 Hz).
    #[must_use]
    pub fn at_rate(&self, vehicle: usize, rate: f64) -> Option<Vec<Sample>> {
        let duration = self.plan.vehicles.get(vehicle)?.duration();
        (rate > 0.0 && duration * rate < MOST_MOMENTS).then(|| self.samples(vehicle, 1.0 / rate).collect())
    }

    /// Electrical energy of a vehicle's flight (J), by momentum theory ([`Vehicle::power`](quad_dynamics::Vehicle::power)) with the
    /// velocity against the air, summed up by the trapezoidal rule; 0 for a spare vehicle, `None` if there is no such vehicle.
    #[must_use]
    pub fn energy(&self, vehicle: usize) -> Option<f64> {
        let planned = self.plan.vehicles.get(vehicle)?;
        if planned.legs.is_empty() {
            return Some(0.0);
        }
        let steps = (planned.duration() / ENERGY_STEP).ceil().max(1.0);
        let step = planned.duration() / steps;
        let power = |i: usize| self.power(vehicle, planned.start_time() + i as f64 * step);
        let powers: Vec<f64> = (0..=steps as usize).map(power).collect();
        Some(step * powers.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).sum::<f64>())
    }

    fn moment(&self, vehicle: usize, time: f64) -> Sample {
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

    /// Electrical power in the wind of the leg that is being flown (W).
    fn power(&self, vehicle: usize, time: f64) -> f64 {
        let planned = &self.plan.vehicles[vehicle];
        let started = planned.legs.iter().rev().map(|leg| leg.start_time).find(|start| *start <= time);
        let wind = self.airs.at(started.unwrap_or(time)).mission.environment.air();
        self.mission.fleet.vehicle.motion_power(&self.motion(vehicle, time).0, &wind)
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

/// So many moments are kept in memory at most, which take about 4 GB.
pub(crate) const MOST_MOMENTS: f64 = (1_u32 << 24) as f64;

/// Step with which the power of a flight is summed up (s).
const ENERGY_STEP: f64 = 0.1;

impl Plan {
    /// Electrical energy of a vehicle's flight (J): [`Sampler::energy`].
    ///
    /// `None` if there is no such vehicle, or if `mission` is not the one that was planned.
    #[must_use]
    pub fn energy(&self, mission: &Mission, vehicle: usize) -> Option<f64> {
        self.sampler(mission)?.energy(vehicle)
    }

    /// The plan ready to be asked for many moments. `None` if `mission` is not the one that was planned.
    #[must_use]
    pub fn sampler<'a>(&'a self, mission: &'a Mission) -> Option<Sampler<'a>> {
        Sampler::new(self, mission)
    }

    /// Where a vehicle is `time` seconds after the mission's start; on its pad before and after its flight.
    ///
    /// For one moment; many are asked of a [`Sampler`]. `None` if there is no such vehicle, or if `mission` is not the one that was
    /// planned.
    #[must_use]
    pub fn sample(&self, mission: &Mission, vehicle: usize, time: f64) -> Option<Sample> {
        self.sampler(mission)?.sample(vehicle, time)
    }

    /// A vehicle's flight at `rate` (Hz): [`Sampler::at_rate`]. `None` as there, and if `mission` is not the one that was planned.
    #[must_use]
    pub fn samples(&self, mission: &Mission, vehicle: usize, rate: f64) -> Option<Vec<Sample>> {
        self.sampler(mission)?.at_rate(vehicle, rate)
    }
}
