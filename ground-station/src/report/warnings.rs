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
