//! How good a plan can be said to be: bounds that hold over every allocation, order, entry, direction and admissible motion.
//!
//! Between the end of one loiter and the start of the next a vehicle covers at least the gap between the two circles, from
//! and to at most the loiter speeds. No motion does that in less than [`Envelope::least_time`]; loiter times are fixed by
//! the mission. So every plan's times are at least those of some routes under these leg times, and no routes beat the
//! lower bounds of `mtsp`. Nothing is fitted or calibrated.

use crate::bound::Envelope;
use crate::circles::Orbit;
use crate::error::Error;
use crate::mission::Mission;
use crate::plan::{Certificate, VehiclePlan};
use christofides::Metric;
use mtsp::Problem;

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

/// The certificate of a finished plan.
pub(crate) fn certificate(
    mission: &Mission,
    orbits: &[Orbit],
    envelope: &Envelope,
    vehicles: &[VehiclePlan],
) -> Result<Certificate, Error> {
    let pads = mission.pads();
    let legs = LeastTimes { orbits, pads: &pads, envelope };
    let service = std::iter::once(0.0).chain(orbits.iter().map(|orbit| orbit.circle.duration)).collect();
    let problem = Problem::new(&legs, mission.fleet.vehicles)?.with_service(service)?;
    let bounds = mtsp::lower_bound::both(&problem);
    let durations = || vehicles.iter().map(VehiclePlan::duration);
    Ok(Certificate {
        makespan: durations().fold(0.0, f64::max),
        makespan_lower_bound: bounds.makespan,
        total: durations().sum(),
        total_lower_bound: bounds.total_cost,
    })
}
