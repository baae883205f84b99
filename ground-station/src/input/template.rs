//! Mission files written for people to change.

use super::{Autopilot, Listed};
use crate::geodesy::Origin;
use crate::words;
use std::fmt::Write;

/// What goes into a fresh mission file.
#[derive(Debug, Clone, PartialEq)]
pub struct Template {
    /// The mission's name.
    pub name: String,
    /// Where east and north are zero, and where the depot is.
    pub origin: Origin,
    /// The firmware.
    pub autopilot: Autopilot,
    /// How many vehicles there are.
    pub vehicles: usize,
    /// Targets with longitude and latitude (degrees) as positions; none for two examples.
    pub targets: Vec<Listed>,
}

/// The text of a commented mission file.
#[must_use]
pub fn template(content: &Template) -> String {
    let Origin { latitude, longitude, altitude } = content.origin;
    let values = [
        ("{name}", quoted(&content.name)),
        ("{latitude}", format!("{latitude:?}")),
        ("{longitude}", format!("{longitude:?}")),
        ("{altitude}", format!("{altitude:?}")),
        ("{autopilot}", words::word(&words::AUTOPILOTS, &content.autopilot).to_owned()),
        ("{vehicles}", content.vehicles.to_string()),
        // Last, so that nothing in a target's name is taken for a place.
        ("{targets}", targets(&content.targets)),
    ];
    let frame = include_str!("template.toml").to_owned();
    let text = values.iter().fold(frame, |text, (place, value)| text.replacen(place, value, 2));
    text.trim_end().to_owned() + "\n"
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

fn targets(targets: &[Listed]) -> String {
    if targets.is_empty() {
        return "[[target]]\nposition = [20.0, 10.0]               # east, north of the origin (m)\n\n\
                [[target]]\nname = \"oak\"\nposition = [-15.0, 25.0]\nradius = 4.0                          # of its circle (m), instead of loiter.radius\n"
            .to_owned();
    }
    let mut text = String::new();
    for target in targets.iter().map(|listed| &listed.target) {
        let [longitude, latitude] = target.position;
        let _ = writeln!(text, "[[target]]");
        if !target.name.is_empty() {
            let _ = writeln!(text, "name = {}", quoted(&target.name));
        }
        let _ = writeln!(text, "latitude = {latitude:?}\nlongitude = {longitude:?}");
        let optional =
            [("radius", target.radius), ("height", target.height), ("safe_distance", target.safe_distance)];
        for (key, value) in optional.iter().filter_map(|(key, value)| Some((key, (*value)?))) {
            let _ = writeln!(text, "{key} = {value:?}");
        }
        text.push('\n');
    }
    text
}
