//! Targets from missions of other programs: QGroundControl `.plan` and `QGC WPL 110` (`.waypoints`).
//!
//! What is circled or looked at is a target: loiters, and places of regions of interest. In a mission without any of those
//! every waypoint is one, but for home.

use super::targets::{Frame, Listed, Place, Wrong, all_listed};
use crate::problem::abridged;
use planner::Target;
use serde_json::Value;

const WAYPOINT: u64 = 16;
const SPLINE_WAYPOINT: u64 = 82;
/// Loiters for ever, for turns, for a time; region of interest, old and new.
const AROUND: [u64; 5] = [17, 18, 19, 195, 201];
const TURNS: u64 = 18;

/// An item of a mission: command, the third parameter, place, and what it is called in its file.
struct Item {
    command: u64,
    third: f64,
    latitude: f64,
    longitude: f64,
    key: String,
}

/// Reads the targets of a `.plan`; what is wrong goes to `wrong`.
pub fn read(file: &str, text: &str, frame: Frame, wrong: Wrong<'_>) -> Vec<Listed> {
    let document: Value = match serde_json::from_str(text) {
        Ok(document) => document,
        Err(error) => {
            wrong(Some(error.line()), "", format!("not JSON: {error}: give a QGroundControl plan"));
            return Vec::new();
        }
    };
    if document.get("fileType").and_then(Value::as_str) != Some("Plan") {
        wrong(None, "fileType", "fileType is not \"Plan\": give a QGroundControl plan".to_owned());
        return Vec::new();
    }
    let mut items = Vec::new();
    if let Some(list) = document.pointer("/mission/items").and_then(Value::as_array) {
        collect(list, "mission.items", &mut items);
    }
    all_listed(places(&items), file, frame, wrong)
}

/// Items, and those that complex items hold.
fn collect(list: &[Value], path: &str, items: &mut Vec<Item>) {
    for (index, item) in list.iter().enumerate() {
        let key = format!("{path}[{index}]");
        if let Some(inner) = item.pointer("/TransectStyleComplexItem/Items").and_then(Value::as_array) {
            collect(inner, &key, items);
        }
        let Some(parameters) = item.get("params").and_then(Value::as_array) else { continue };
        let number = |index: usize| parameters.get(index).and_then(Value::as_f64).unwrap_or(0.0);
        let command = item.get("command").and_then(Value::as_u64).unwrap_or(0);
        items.push(Item { command, third: number(2), latitude: number(4), longitude: number(5), key });
    }
}

/// Reads the targets of a `.waypoints`; what is wrong goes to `wrong`.
pub fn read_waypoints(file: &str, text: &str, frame: Frame, wrong: Wrong<'_>) -> Vec<Listed> {
    let mut lines = text.lines().enumerate();
    if lines.next().is_none_or(|(_, line)| line.trim() != "QGC WPL 110") {
        wrong(Some(1), "", "the first line is not QGC WPL 110: give such a file".to_owned());
        return Vec::new();
    }
    let mut items = Vec::new();
    for (index, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
        let cells: Vec<f64> = line.split('\t').map_while(|cell| cell.trim().parse().ok()).collect();
        match cells.as_slice() {
            // Item 0 is home.
            &[number, _, _, command, _, _, third, _, latitude, longitude, _, _] => {
                if number > 0.0 {
                    items.push(Item {
                        command: command as u64,
                        third,
                        latitude,
                        longitude,
                        key: format!("line {}", index + 1),
                    });
                }
            }
            _ => {
                let message =
                    format!("{} is no item: give twelve numbers with tabs between them", abridged(line));
                wrong(Some(index + 1), "", message);
            }
        }
    }
    all_listed(places(&items), file, frame, wrong)
}

fn places(items: &[Item]) -> Vec<Place> {
    let with_place = || items.iter().filter(|item| (item.latitude, item.longitude) != (0.0, 0.0));
    let has_targets = with_place().any(|item| AROUND.contains(&item.command));
    // The way home ends where the mission begins.
    let start = items.first().map(|item| (item.latitude, item.longitude));
    let is_target = |item: &&Item| match has_targets {
        true => AROUND.contains(&item.command),
        false => {
            [WAYPOINT, SPLINE_WAYPOINT].contains(&item.command)
                && Some((item.latitude, item.longitude)) != start
        }
    };
    let place = |item: &Item| {
        let radius = Some(item.third.abs())
            .filter(|&radius| item.command == TURNS && radius > 0.0 && radius.is_finite());
        let target = Target { radius, ..Target::default() };
        Place { latitude: item.latitude, longitude: item.longitude, target, key: item.key.clone() }
    };
    with_place().filter(is_target).map(place).collect()
}
