//! The planner's warnings in plain words.

use crate::words;
use planner::{Plan, Warning};

/// One line per warning.
#[must_use]
pub fn warning_lines(plan: &Plan) -> Vec<String> {
    plan.warnings.iter().map(|warning| line(plan, warning)).collect()
}

fn line(plan: &Plan, warning: &Warning) -> String {
    match warning {
        Warning::Endurance { vehicle, duration, endurance } => format!(
            "vehicle {} flies {duration:.0} s, longer than the endurance of {endurance:.0} s: use more vehicles or fewer targets",
            words::flight(plan, *vehicle)
        ),
        Warning::Battery { vehicle, energy, usable } => format!(
            "vehicle {} needs {:.0} kJ, more than the {:.0} kJ that its battery can give: use more vehicles or fewer targets",
            words::flight(plan, *vehicle),
            1e-3 * energy,
            1e-3 * usable
        ),
        Warning::MoreVehicles { needed } => {
            format!("the mission needs about {needed} vehicles, or flights with a fresh battery each")
        }
        Warning::Sorties { flights } => {
            format!(
                "one flight each is too long for endurance or battery: {flights} flights, with batteries swapped on the pads"
            )
        }
        Warning::OutOfView { target, share } => format!(
            "target {} is in the picture for {:.0} % of its circle, less than any other: turn the nose to the target, or mount the camera for it",
            target + 1,
            100.0 * share
        ),
        Warning::Spare { vehicles } => {
            format!("{vehicles} vehicle(s) stay at the depot: there are more vehicles than routes")
        }
        Warning::FailedCandidates { vehicle, leg, candidates } => format!(
            "vehicle {} leg {}: {candidates} candidate entries could not be solved, so a faster one may have been missed",
            words::flight(plan, *vehicle),
            leg + 1
        ),
        other => format!("{other:?}"),
    }
}
