//! A check of a finished plan that does not trust the solver.

use crate::airs::{Air, Airs};
use crate::mission::Mission;
use crate::plan::{Approach, Certificate, Leg, Miss, Plan};
use crate::separation::{RESOLUTION, closest_pair, in_the_air};
use crate::transition::miss;
use quad_dynamics::Motion;

/// Tolerances of a verification. Defaults: 5 cm, 5 cm/s and 1 degree for the integrated miss.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Greatest integrated miss of a leg.
    pub miss: Miss,
    /// How far a bound on states or a safe distance may be overstepped between knots (m, m/s, rad/s).
    pub bound: f64,
}

impl Default for Tolerances {
    fn default() -> Self {
        Self { miss: Miss { position: 0.05, velocity: 0.05, attitude: 1f64.to_radians() }, bound: 0.01 }
    }
}

/// What a verification saw.
#[derive(Debug, Clone, Default)]
pub struct Verification {
    /// One line per leg.
    pub legs: Vec<LegCheck>,
    /// All that is out of tolerance; empty if the plan stands.
    pub failures: Vec<Failure>,
}

/// What was measured on one leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegCheck {
    /// The vehicle, from 0.
    pub vehicle: usize,
    /// The leg, from 0.
    pub leg: usize,
    /// End of the integrated controls against the loiter (or hover) state computed afresh.
    pub miss: Miss,
    /// Greatest overstepping of bounds on controls and states, between knots too (in the bound's own unit).
    pub bound_violation: f64,
    /// Least distance to a target's centre minus its safe distance (m), between knots too; infinite without targets.
    pub clearance: f64,
}

/// Something that is out of tolerance.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Failure {
    /// The integrated controls miss the wanted state.
    #[error(
        "vehicle {} leg {}: integrated miss {:.3} m, {:.3} m/s, {:.2} deg",
        vehicle + 1, leg + 1, miss.position, miss.velocity, miss.attitude.to_degrees()
    )]
    Miss {
        /// The vehicle, from 0.
        vehicle: usize,
        /// The leg, from 0.
        leg: usize,
        /// How far.
        miss: Miss,
    },
    /// A bound on a control or a state is overstepped.
    #[error("vehicle {} leg {}: a bound is overstepped by {violation:.4}", vehicle + 1, leg + 1)]
    Bound {
        /// The vehicle, from 0.
        vehicle: usize,
        /// The leg, from 0.
        leg: usize,
        /// By how much (in the bound's own unit).
        violation: f64,
    },
    /// A safe distance is broken.
    #[error("vehicle {} leg {}: {:.3} m inside a target's safe distance", vehicle + 1, leg + 1, -clearance)]
    Clearance {
        /// The vehicle, from 0.
        vehicle: usize,
        /// The leg, from 0.
        leg: usize,
        /// Negative distance (m).
        clearance: f64,
    },
    /// Legs do not join up in time, or a route does not match its legs.
    #[error("vehicle {} leg {}: the leg does not join the one before it", vehicle + 1, leg + 1)]
    Joint {
        /// The vehicle, from 0.
        vehicle: usize,
        /// The leg, from 0.
        leg: usize,
    },
    /// A target is circled by nobody or more than once.
    #[error("target {} is circled {times} times instead of once", target + 1)]
    Coverage {
        /// The target, from 0.
        target: usize,
        /// How often.
        times: usize,
    },
    /// Two vehicles come closer in the air than the mission's separation.
    #[error(
        "vehicles {} and {} come within {:.3} m of each other at {:.2} s",
        approach.vehicles[0] + 1, approach.vehicles[1] + 1, approach.distance, approach.time
    )]
    Separation {
        /// Where they come closest.
        approach: Approach,
    },
    /// A vehicle takes off again before its battery can have been swapped.
    #[error("flight {} of vehicle {} starts before its battery can have been swapped", flight + 1, vehicle + 1)]
    Swap {
        /// The vehicle, from 0.
        vehicle: usize,
        /// Its place in [`Plan::vehicles`].
        flight: usize,
    },
    /// A value found is below its lower bound: one of the two is wrong.
    #[error("the certificate contradicts itself: {value} s found below a lower bound of {lower_bound} s")]
    Certificate {
        /// The value (s).
        value: f64,
        /// The bound (s).
        lower_bound: f64,
    },
}

impl Verification {
    /// Whether everything is within tolerance.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.failures.is_empty()
    }

    /// The greatest miss over all legs, each component by itself.
    #[must_use]
    pub fn worst_miss(&self) -> Miss {
        self.legs.iter().fold(Miss::default(), |worst, leg| Miss {
            position: worst.position.max(leg.miss.position),
            velocity: worst.velocity.max(leg.miss.velocity),
            attitude: worst.attitude.max(leg.miss.attitude),
        })
    }
}

impl Plan {
    /// Checks the plan without trusting the solver that made it.
    ///
    /// Every transition's controls are integrated again by the adaptive integrator, from the state in which the vehicle
    /// really is: the loiter state (or hover) computed afresh from mission and entry. The end is compared with the next such
    /// state; bounds, heights and safe distances (of the targets known at that time) are looked at between knots too, each leg in the wind that it was planned for; every target must be circled exactly once;
    /// vehicles must keep their separation at every moment in the air, and batteries be swapped between sorties.
    #[must_use]
    pub fn verify(&self, mission: &Mission, tolerances: &Tolerances) -> Verification {
        let mut verification = Verification::default();
        let airs = Airs::new(self, mission);
        for (vehicle, planned) in self.vehicles.iter().enumerate() {
            let mut time = planned.start_time();
            let mut here = airs.at(time).hover(planned.pad, planned.heading);
            for (index, leg) in planned.legs.iter().enumerate() {
                let air = airs.at(leg.start_time);
                let pad = air.hover(planned.pad, planned.heading);
                let later: Vec<usize> = self
                    .known_since
                    .iter()
                    .filter(|&&(_, since)| since >= leg.arrival_time())
                    .map(|&(target, _)| target)
                    .collect();
                let check = check_leg(air, leg, (&here, &pad), &later).map(|seen| LegCheck {
                    vehicle,
                    leg: index,
                    ..seen
                });
                let joined = (leg.start_time - time).abs() < 1e-9
                    && leg.loiter.map(|loiter| loiter.circle) == planned.route.get(index).copied();
                verification.judge(vehicle, index, check, joined, tolerances);
                here = air.exit(leg).unwrap_or(pad);
                time = leg.end_time();
            }
            let home = usize::from(!planned.route.is_empty() && planned.lost_at.is_none());
            let complete = planned.route.len() + home;
            if planned.legs.len() != complete {
                verification.failures.push(Failure::Joint { vehicle, leg: planned.legs.len() });
            }
        }
        verification.count_targets(self, mission);
        verification.judge_swaps(self, mission);
        let approach = in_the_air(self, mission, |fleet| closest_pair(&fleet)).flatten();
        let least = mission.fleet.separation - 2.0 * RESOLUTION;
        let close = approach.filter(|approach| approach.distance < least);
        verification.failures.extend(close.map(|approach| Failure::Separation { approach }));
        let Certificate { makespan, makespan_lower_bound, total, total_lower_bound } = self.certificate;
        for (value, lower_bound) in [(makespan, makespan_lower_bound), (total, total_lower_bound)] {
            if value < lower_bound {
                verification.failures.push(Failure::Certificate { value, lower_bound });
            }
        }
        verification
    }
}

/// What an independent integration of one leg's controls shows; `None` if its arrays make no trajectory.
fn check_leg(
    air: &Air,
    leg: &Leg,
    (start, pad): (&Motion, &Motion),
    not_yet_known: &[usize],
) -> Option<LegCheck> {
    let goal = match leg.loiter {
        Some(loiter) => air.orbits.get(loiter.circle)?.at(loiter.entry),
        None => *pad,
    };
    let seen = air.pilot.examine_without(&leg.transition, start, not_yet_known)?;
    Some(LegCheck {
        vehicle: 0,
        leg: 0,
        miss: miss(leg.transition.model, &seen.end, &goal, leg.loiter.is_none()),
        bound_violation: seen.limit_violation.max(seen.height_violation),
        clearance: seen.clearance,
    })
}

impl Verification {
    fn judge(
        &mut self,
        vehicle: usize,
        leg: usize,
        check: Option<LegCheck>,
        joined: bool,
        tolerances: &Tolerances,
    ) {
        let Some(check) = check.filter(|_| joined) else {
            self.failures.push(Failure::Joint { vehicle, leg });
            return;
        };
        let LegCheck { miss, bound_violation, clearance, .. } = check;
        self.legs.push(check);
        let allowed = &tolerances.miss;
        // Comparisons that NaN fails.
        let hit = miss.position <= allowed.position
            && miss.velocity <= allowed.velocity
            && miss.attitude <= allowed.attitude;
        if !hit {
            self.failures.push(Failure::Miss { vehicle, leg, miss });
        }
        let bounded = bound_violation <= tolerances.bound;
        if !bounded {
            self.failures.push(Failure::Bound { vehicle, leg, violation: bound_violation });
        }
        let clear = clearance >= -tolerances.bound;
        if !clear {
            self.failures.push(Failure::Clearance { vehicle, leg, clearance });
        }
    }

    fn judge_swaps(&mut self, plan: &Plan, mission: &Mission) {
        for (flight, before) in plan.flights_before().into_iter().enumerate() {
            let (Some(before), planned) = (before, &plan.vehicles[flight]) else { continue };
            let earliest = plan.vehicles[before].end_time() + mission.swap_time.unwrap_or(0.0);
            let swapped = planned.start_time() >= earliest - 1e-9 && planned.pad == plan.vehicles[before].pad;
            if !swapped {
                self.failures.push(Failure::Swap { vehicle: planned.vehicle, flight });
            }
        }
    }

    fn count_targets(&mut self, plan: &Plan, mission: &Mission) {
        let mut times = vec![0; mission.targets.len()];
        let flown = plan.vehicles.iter().flat_map(|vehicle| &vehicle.legs).filter_map(|leg| leg.loiter);
        for circle in flown.filter_map(|loiter| plan.circles.get(loiter.circle)) {
            for &member in &circle.members {
                if let Some(count) = times.get_mut(member) {
                    *count += 1;
                }
            }
        }
        let wanted = |target: usize| usize::from(!plan.skipped.contains(&target));
        let wrong =
            times.into_iter().enumerate().filter(|&(target, times)| times != 1 && times != wanted(target));
        self.failures.extend(wrong.map(|(target, times)| Failure::Coverage { target, times }));
    }
}
