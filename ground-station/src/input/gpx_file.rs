//! Targets from GPX: every waypoint.

use super::targets::{Frame, Listed, Place, Wrong, all_listed};
use crate::problem::abridged;
use gpx::Waypoint;
use planner::Target;

/// Reads the targets; what is wrong goes to `wrong`.
pub fn read(file: &str, text: &str, frame: Frame, wrong: Wrong<'_>) -> Vec<Listed> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    match gpx::read(text.as_bytes()) {
        Ok(document) => {
            let places =
                document.waypoints.iter().enumerate().map(|(index, waypoint)| place(waypoint, index));
            all_listed(places.collect(), file, frame, wrong)
        }
        Err(error) => {
            wrong(
                None,
                "",
                format!("not GPX ({}): give a GPX file with waypoints", abridged(&error.to_string())),
            );
            Vec::new()
        }
    }
}

fn place(waypoint: &Waypoint, index: usize) -> Place {
    let point = waypoint.point();
    let target = Target { name: waypoint.name.clone().unwrap_or_default(), ..Target::default() };
    Place { latitude: point.y(), longitude: point.x(), target, key: format!("wpt[{index}]") }
}
