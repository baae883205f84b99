//! The targets of a mission: listed in place, as tables of their own, or in a file beside the mission.

use super::range::Range;
use super::reader::{Reader, Section};
use super::{geojson_file, gpx_file, kml_file, plan_file, table_file};
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

/// What turns geographic coordinates into those of a target.
#[derive(Debug, Clone, Copy)]
pub enum Frame {
    /// Nothing: the mission has no usable origin.
    Nowhere,
    /// East and north of an origin.
    Plane(Origin),
    /// Left as they are, longitude and latitude (degrees), for files that stand by themselves.
    Degrees,
}

impl Frame {
    /// The frame of a mission.
    pub const fn of(origin: Option<Origin>) -> Self {
        match origin {
            Some(origin) => Self::Plane(origin),
            None => Self::Nowhere,
        }
    }

    /// East and north of a latitude and longitude, or what is wrong with them and what to do about it.
    pub fn place(&self, latitude: f64, longitude: f64) -> Result<[f64; 2], (String, &'static str)> {
        let origin = match self {
            Self::Degrees => return Ok([longitude, latitude]),
            Self::Plane(origin) => origin,
            Self::Nowhere => {
                return Err((
                    "is geographic, but the mission has no usable origin".to_owned(),
                    "add origin = { latitude = .., longitude = .., altitude = .. } to the mission",
                ));
            }
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
                "give the name of a file with targets, relative to the mission file",
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
    let mut wrong =
        |line: Option<usize>, key: &str, message: String| reader.add_elsewhere(&file, line, key, message);
    from_text(&file, text, frame, &mut wrong)
}

/// Receives what is wrong: line, key, message.
pub type Wrong<'a> = &'a mut dyn FnMut(Option<usize>, &str, String);

type Read = fn(&str, &str, Frame, Wrong<'_>) -> Vec<Listed>;

/// Who reads which files, by the ends of their names.
const READERS: [(&str, Read); 7] = [
    ("geojson", geojson_file::read),
    ("json", geojson_file::read),
    ("csv", table_file::read),
    ("kml", kml_file::read),
    ("gpx", gpx_file::read),
    ("plan", plan_file::read),
    ("waypoints", plan_file::read_waypoints),
];

/// The targets of a file, its kind told by the end of its name.
pub fn from_text(file: &str, text: &str, frame: Frame, wrong: Wrong<'_>) -> Vec<Listed> {
    let end =
        Path::new(file).extension().and_then(|end| end.to_str()).unwrap_or_default().to_ascii_lowercase();
    match READERS.iter().find(|(known, _)| *known == end) {
        Some((_, read)) => read(file, text, frame, wrong),
        None => {
            let known: Vec<&str> = READERS.iter().map(|(end, _)| *end).collect();
            let message = format!(
                "targets.file is of an unknown kind: give a file that ends in .{}",
                known.join(", .")
            );
            wrong(None, "targets.file", message);
            Vec::new()
        }
    }
}

/// A geographic place of a file, not yet in the frame of a mission.
#[derive(Debug, Clone, Default)]
pub struct Place {
    /// Latitude (degrees).
    pub latitude: f64,
    /// Longitude (degrees).
    pub longitude: f64,
    /// All but its position.
    pub target: Target,
    /// What it is called in the file.
    pub key: String,
}

impl Place {
    /// The target, if the place is one on earth and in the frame.
    pub fn listed(self, file: &str, frame: Frame, wrong: Wrong<'_>) -> Option<Listed> {
        let Self { latitude, longitude, target, key } = self;
        for (what, value, range) in [("latitude", latitude, LATITUDES), ("longitude", longitude, LONGITUDES)]
        {
            if !range.contains(value) {
                wrong(None, &key, format!("{key}: {what} {value} is out of range: give a number {range}"));
                return None;
            }
        }
        match frame.place(latitude, longitude) {
            Ok(position) => {
                Some(Listed { target: Target { position, ..target }, file: file.to_owned(), line: None, key })
            }
            Err((what, remedy)) => {
                wrong(None, &key, format!("{key} {what}: {remedy}"));
                None
            }
        }
    }
}

/// The targets of all places; a file without any is wrong.
pub fn all_listed(places: Vec<Place>, file: &str, frame: Frame, wrong: Wrong<'_>) -> Vec<Listed> {
    if places.is_empty() {
        wrong(None, "file", "no target could be read: give a file with points".to_owned());
    }
    places.into_iter().filter_map(|place| place.listed(file, frame, wrong)).collect()
}
