//! The targets of a mission: listed in place, as tables of their own, or in a file beside the mission.

use super::range::Range;
use super::reader::{Reader, Section};
use super::{geojson_file, table_file};
use crate::geodesy::Origin;
use planner::Target;
use std::path::Path;

/// Farther than this from the origin (m), latitude and longitude have most likely been swapped.
const FARTHEST: f64 = 50_000.0;

/// A target and where it was read, for messages about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Listed {
    /// The target.
    pub target: Target,
    /// The file in which it stands.
    pub file: String,
    /// The line in that file, where there is one.
    pub line: Option<usize>,
    /// What it is called there: `targets.positions[3]`, `features[7]`.
    pub key: String,
}

/// What turns geographic coordinates into local ones; absent if the mission has no usable origin.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    /// The origin, if the mission has one.
    pub origin: Option<Origin>,
}

impl Frame {
    /// East and north of a latitude and longitude, or what is wrong with them and what to do about it.
    pub fn place(&self, latitude: f64, longitude: f64) -> Result<[f64; 2], (String, &'static str)> {
        let Some(origin) = self.origin else {
            return Err((
                "is geographic, but the mission has no usable origin".to_owned(),
                "add origin = { latitude = .., longitude = .., altitude = .. } to the mission",
            ));
        };
        let position = origin.local(latitude, longitude);
        let distance = position[0].hypot(position[1]);
        if distance <= FARTHEST {
            return Ok(position);
        }
        Err((
            format!("is {:.0} km from the origin", distance / 1e3),
            "check the origin, and that latitude and longitude are not swapped",
        ))
    }
}

/// Reads `[targets]` and every `[[target]]`, in this order: `positions`, `file`, `[[target]]`.
pub fn read(root: &Section<'_, '_>, reader: &Reader<'_>, frame: Frame, folder: &Path) -> (Vec<Listed>, f64) {
    let section = root.section("targets");
    let merge_within = section.number("merge_within", Range::NOT_NEGATIVE).unwrap_or(0.0);
    let mut listed = positions(&section, reader);
    if let Some(item) = section.item("file")
        && let Some(name) = item.text()
    {
        let path = folder.join(&name);
        match std::fs::read_to_string(&path) {
            Ok(text) => listed.extend(from_file(&path, &text, reader, frame)),
            Err(error) => item.wrong(
                &format!("cannot be read ({}: {})", path.display(), crate::failure::reason(&error)),
                "give the name of a GeoJSON or CSV file, relative to the mission file",
            ),
        }
    }
    section.finish();
    listed.extend(tables(root, reader, frame));
    (listed, merge_within)
}

fn positions(section: &Section<'_, '_>, reader: &Reader<'_>) -> Vec<Listed> {
    let items = section.item("positions").and_then(|item| item.items("a list of [east, north] pairs"));
    let mut listed = Vec::new();
    for item in items.unwrap_or_default() {
        if let Some(position) = item.numbers::<2>(Range::between(-FARTHEST, FARTHEST)) {
            listed.push(Listed {
                target: Target::at(position),
                file: reader.file().to_owned(),
                line: Some(item.line()),
                key: item.path.clone(),
            });
        }
    }
    listed
}

fn tables(root: &Section<'_, '_>, reader: &Reader<'_>, frame: Frame) -> Vec<Listed> {
    let items = root.item("target").and_then(|item| item.items("tables: [[target]]"));
    let mut listed = Vec::new();
    for item in items.unwrap_or_default() {
        let (line, key) = (item.line(), item.path.clone());
        let section = item.into_section();
        let name = section.text("name").unwrap_or_default();
        let position = position(&section, frame);
        let target = Target {
            name,
            position: position.unwrap_or_default(),
            radius: section.number("radius", Range::POSITIVE),
            height: section.number("height", Range::POSITIVE),
            safe_distance: section.number("safe_distance", Range::NOT_NEGATIVE),
        };
        section.finish();
        if position.is_some() {
            listed.push(Listed { target, file: reader.file().to_owned(), line: Some(line), key });
        }
    }
    listed
}

/// The place of a table: `position = [east, north]`, or `latitude` and `longitude`. What is wrong is recorded.
pub fn position(section: &Section<'_, '_>, frame: Frame) -> Option<[f64; 2]> {
    const REMEDY: &str = "give position = [east, north] in metres, or latitude and longitude in degrees";
    let local = section.item("position");
    let latitude = section.item("latitude");
    let longitude = section.item("longitude");
    if let Some(local) = local {
        if let Some(extra) = latitude.as_ref().or(longitude.as_ref()) {
            extra.wrong("stands beside a position", "keep only one of the two");
        }
        return local.numbers::<2>(Range::between(-FARTHEST, FARTHEST));
    }
    let (latitude, longitude) = match (latitude, longitude) {
        (Some(latitude), Some(longitude)) => (latitude, longitude),
        (Some(_), None) => return missing(section, "longitude", REMEDY),
        (None, Some(_)) => return missing(section, "latitude", REMEDY),
        (None, None) => return missing(section, "position", REMEDY),
    };
    let (north, east) = (latitude.number(LATITUDES), longitude.number(LONGITUDES));
    match frame.place(north?, east?) {
        Ok(position) => Some(position),
        Err((what, remedy)) => {
            latitude.wrong(&what, remedy);
            None
        }
    }
}

/// Latitudes (degrees).
pub const LATITUDES: Range = Range::between(-90.0, 90.0);
/// Longitudes (degrees).
pub const LONGITUDES: Range = Range::between(-180.0, 180.0);

fn missing<T>(section: &Section<'_, '_>, key: &str, remedy: &str) -> Option<T> {
    section.missing(key, remedy);
    None
}

fn from_file(path: &Path, text: &str, reader: &Reader<'_>, frame: Frame) -> Vec<Listed> {
    let file = path.display().to_string();
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    let mut wrong =
        |line: Option<usize>, key: &str, message: String| reader.add_elsewhere(&file, line, key, message);
    match extension.to_ascii_lowercase().as_str() {
        "geojson" | "json" => geojson_file::read(&file, text, frame, &mut wrong),
        "csv" => table_file::read(&file, text, frame, &mut wrong),
        _ => {
            wrong(
                None,
                "targets.file",
                "targets.file is of an unknown kind: give a .geojson, .json or .csv file".into(),
            );
            Vec::new()
        }
    }
}
