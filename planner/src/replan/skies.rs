//! Where vehicles fly while they are replanned: one airspace for each wind that their legs were planned for.

use crate::airs::Airs;
use crate::legs::Airspace;
use crate::plan::{Leg, VehiclePlan};
use quad_dynamics::Motion;

pub(super) struct Skies<'a> {
    pub airs: &'a Airs<'a>,
    airspaces: Vec<Airspace<'a>>,
}

impl<'a> Skies<'a> {
    pub(super) fn new(airs: &'a Airs<'a>) -> Self {
        Self { airs, airspaces: airs.iter().map(Airspace::of).collect() }
    }

    /// The airspace of a leg that starts at a time (s).
    pub(super) fn at(&self, start_time: f64) -> &Airspace<'a> {
        &self.airspaces[self.airs.index(start_time)]
    }

    /// The airspace that legs are planned in from now on.
    pub(super) fn now(&self) -> &Airspace<'a> {
        self.at(f64::INFINITY)
    }

    /// The motion in which a leg starts, after the leg before it or from the pad.
    pub(super) fn start(&self, planned: &VehiclePlan, before: Option<&Leg>, start_time: f64) -> Motion {
        let left = before.and_then(|leg| self.airs.at(leg.start_time).exit(leg));
        left.unwrap_or_else(|| self.airs.at(start_time).hover(planned.pad, planned.heading))
    }
}
