//! Targets that no vehicle can circle with its endurance or its battery: proven, not estimated.
//!
//! *Time*: the certificate's bounds in still air, those of `envelope.rs` along the line from pad to target in wind.
//!
//! *Energy*: rotors give at least the mechanical power `thrust . v` over their efficiency, `v` through the air (momentum theory adds the
//! induced power to it). From hover to hover at the same place, what they give is what drag takes: `(c/2) |v|^3` at each moment. Flights out
//! and back over the distance `d` cover the way `L >= 2 d - |w| t` through the air in their time `t` together, so by Jensen's inequality,
//! with avionics of the power `a`,
//!
//! ```text
//!     E >= a t + (c / 2 eta) L^3 / t^2 + loiter,      t >= the least times,
//! ```
//!
//! which is convex in `t`. It is far below what a flight takes, because hovering counts for nothing: a target that it names cannot be
//! helped, and of others the plan's own warnings tell.

use crate::bound::Envelope;
use crate::certificate::LeastTimes;
use crate::circles::Orbit;
use crate::error::Problem;
use crate::mission::{Mission, Model};
use christofides::Metric;
use nalgebra::Vector2;

/// What a flight to one circle and back takes at least.
struct Flights<'a> {
    mission: &'a Mission,
    orbits: &'a [Orbit],
    pads: Vec<[f64; 3]>,
    envelope: Envelope,
}

/// Targets out of reach of every vehicle, ascending; `orbits` are the mission's.
pub(crate) fn problems(mission: &Mission, orbits: &[Orbit], envelope: Envelope) -> Vec<Problem> {
    let endurance = mission.fleet.endurance;
    let usable = mission.fleet.vehicle.parameters().battery.usable_energy();
    let flights = Flights { mission, orbits, pads: mission.pads(), envelope };
    let mut problems = Vec::new();
    for (circle, orbit) in orbits.iter().enumerate() {
        let target = orbit.circle.members[0];
        let legs = flights.least_time(circle);
        let least = legs + orbit.circle.duration;
        if least > endurance {
            problems.push(Problem::BeyondEndurance { target, least, endurance });
            continue;
        }
        let least = flights.least_energy(circle, legs);
        if least > usable {
            problems.push(Problem::BeyondBattery { target, least, usable });
        }
    }
    problems
}

impl Flights<'_> {
    /// No flight from a pad to a circle and from there to the pad takes less together (s).
    fn least_time(&self, circle: usize) -> f64 {
        let Self { orbits, ref pads, ref envelope, .. } = *self;
        if !self.mission.environment.is_windy() {
            return 2.0 * LeastTimes { orbits, pads, envelope }.distance(0, circle + 1);
        }
        let there = &orbits[circle].circle;
        let from = |pad: &[f64; 3]| {
            let offset = Vector2::from(there.centre) - Vector2::new(pad[0], pad[1]);
            envelope.least_time_along(offset, there.radius, [0.0, there.speed])
                + envelope.least_time_along(-offset, there.radius, [there.speed, 0.0])
        };
        self.pads.iter().map(from).fold(f64::INFINITY, f64::min)
    }

    /// No flight to a circle, around it and back takes less (J), of which `legs` (s) at least are on the way.
    fn least_energy(&self, circle: usize, legs: f64) -> f64 {
        let orbit = &self.orbits[circle];
        let parameters = self.mission.fleet.vehicle.parameters();
        let avionics = parameters.battery.avionics_power;
        let [x, y] = orbit.circle.centre;
        let to_pad = self.pads.iter().map(|pad| (pad[0] - x).hypot(pad[1] - y)).fold(f64::INFINITY, f64::min);
        let way = 2.0 * (to_pad - orbit.circle.radius).max(0.0);
        let wind = self.mission.environment.air().norm();
        // An autopilot's shaping is planned without drag.
        let drag = match self.mission.transition.model {
            Model::JerkLimited => 0.0,
            _ => self.mission.fleet.vehicle.drag_coefficient(),
        };
        let work = |time: f64| 0.5 * drag * (way - wind * time).max(0.0).powi(3) / (time * time);
        let energy = |time: f64| avionics * time + work(time) / parameters.propulsion.efficiency;
        orbit.loiter.least_energy(avionics) + least_of_convex(energy, legs.max(f64::MIN_POSITIVE))
    }
}

/// A lower bound on a convex function from `first` on, close to its least value; it must grow without limit, or be constant.
fn least_of_convex(f: impl Fn(f64) -> f64, first: f64) -> f64 {
    let (mut low, mut high) = (first, 2.0 * first);
    while f(high) < f(0.5 * high) && high < 1e12 {
        high *= 2.0;
    }
    for _ in 0..100 {
        let [a, b] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
        if f(a) <= f(b) { high = b } else { low = a }
    }
    // The search ends within rounding of the least value.
    f(low).min(f(high)) * (1.0 - 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_value_is_found_inside_and_at_the_first_argument() {
        let f = |t: f64| 8.0 * t + 5e6 / (t * t);
        let best = (2.0 * 5e6 / 8.0_f64).cbrt();
        assert!((least_of_convex(f, 1.0) / f(best) - 1.0).abs() < 1e-8);
        assert!((least_of_convex(f, 500.0) / f(500.0) - 1.0).abs() < 1e-8);
    }
}
