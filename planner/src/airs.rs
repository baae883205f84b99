//! The winds that a plan's legs were planned for: a [`Replanner`](crate::Replanner) may have met several.

use crate::circles::{Orbit, orbits};
use crate::mission::Mission;
use crate::plan::{Leg, Plan};
use crate::transition::{Pilot, hover};
use quad_dynamics::Motion;
use std::borrow::Cow;

/// A mission in one wind.
pub(crate) struct Air<'a> {
    /// Legs that start by then (s after the mission's start), and later than the wind before, were planned for this wind.
    until: f64,
    pub mission: Cow<'a, Mission>,
    /// Empty if the circles cannot be flown.
    pub orbits: Vec<Orbit>,
    pub pilot: Pilot,
}

/// All winds of a plan, in the order in which they blow; never empty.
pub(crate) struct Airs<'a>(Vec<Air<'a>>);

impl<'a> Airs<'a> {
    pub(crate) fn new(plan: &Plan, mission: &'a Mission) -> Self {
        let air = |until: f64, mission: Cow<'a, Mission>| {
            let orbits = orbits(&mission).unwrap_or_default();
            Air { until, pilot: Pilot::new(&mission, &orbits), orbits, mission }
        };
        let earlier = plan.earlier_winds.iter().map(|&(until, wind)| {
            let mut earlier = mission.clone();
            earlier.environment.wind = wind;
            air(until, Cow::Owned(earlier))
        });
        let mut airs: Vec<Air> = earlier.collect();
        airs.push(air(f64::INFINITY, Cow::Borrowed(mission)));
        Self(airs)
    }

    /// The wind of a leg that starts at a time (s).
    pub(crate) fn at(&self, start_time: f64) -> &Air<'a> {
        &self.0[self.index(start_time)]
    }

    /// The first time from `time` on (s) at which a leg that starts is planned for the wind of now.
    pub(crate) fn from(&self, time: f64) -> f64 {
        if self.0.iter().any(|air| air.until == time) { time.next_up() } else { time }
    }

    /// The place of [`at`](Self::at) in the order of winds.
    pub(crate) fn index(&self, start_time: f64) -> usize {
        self.0.partition_point(|air| air.until < start_time).min(self.0.len() - 1)
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Air<'a>> {
        self.0.iter()
    }

    /// Whether every circle of a plan can be flown in every wind.
    pub(crate) fn fit(&self, plan: &Plan) -> bool {
        self.0.iter().all(|air| air.orbits.len() == plan.circles.len())
    }

    /// Speed of a leg's loiter over the ground (m/s); 0 if it has none.
    pub(crate) fn loiter_speed(&self, leg: &Leg) -> f64 {
        let orbit = leg.loiter.and_then(|loiter| self.at(leg.start_time).orbits.get(loiter.circle));
        orbit.map_or(0.0, |orbit| orbit.circle.speed)
    }
}

impl Air<'_> {
    /// The motion in which a leg's loiter ends; `None` if it has none.
    pub(crate) fn exit(&self, leg: &Leg) -> Option<Motion> {
        let loiter = leg.loiter?;
        Some(self.orbits.get(loiter.circle)?.exit(loiter.entry))
    }

    /// A hover with the nose in a direction (rad, from east, counter-clockwise).
    pub(crate) fn hover(&self, position: [f64; 3], heading: f64) -> Motion {
        hover(&self.mission, position, heading)
    }
}
