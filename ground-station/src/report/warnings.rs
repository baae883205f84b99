//! The planner's warnings in plain words.

use planner::{Plan, Warning};

/// One line per warning.
#[must_use]
pub fn warning_lines(plan: &Plan) -> Vec<String> {
    plan.warnings.iter().map(line).collect()
}

fn line(warning: &Warning) -> String {
    match warning {
        Warning::Endurance { vehicle, duration, endurance } => format!(
            "vehicle {} flies {duration:.0} s, longer than the endurance of {endurance:.0} s: use more vehicles or fewer targets",
            vehicle + 1
        ),
        Warning::Battery { vehicle, energy, usable } => format!(
            "vehicle {} needs {:.0} kJ, more than the {:.0} kJ that its battery can give: use more vehicles or fewer targets",
            vehicle + 1,
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
        Warning::Spare { vehicles } => {
            format!("{vehicles} vehicle(s) stay at the depot: there are more vehicles than routes")
        }
        Warning::FailedCandidates { vehicle, leg, candidates } => format!(
            "vehicle {} leg {}: {candidates} candidate entries could not be solved, so a faster one may have been missed",
            vehicle + 1,
            leg + 1
        ),
        other => format!("{other:?}"),
    }
}
