//! Reading mission files (TOML) and the lists of targets that they name.
//!
//! A file is read whole: every wrong type, unknown key and number out of range is collected with its line, then all that
//! the planner finds wrong with the mission as far as it could be read.

mod geojson_file;
mod gpx_file;
mod kml_file;
mod plan_file;
mod range;
mod reader;
mod settings;
mod suggest;
mod table_file;
mod targets;
mod template;
mod vehicle;

pub use targets::Listed;
pub use template::{Template, template};

use crate::failure::{Failure, reason};
use crate::geodesy::Origin;
use crate::problem::Problem;
use crate::words;
use planner::Mission;
use range::Range;
use reader::{Reader, Section};
use std::path::Path;
use targets::Frame;

/// The field mission that is built into the program.
pub const FIELD: &str = include_str!("../../missions/field.toml");

/// The firmware that flies the vehicles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Autopilot {
    /// ArduPilot (ArduCopter).
    ArduPilot,
    /// PX4.
    Px4,
}

/// A mission as a file states it: what the planner needs, and what the files written afterwards need.
#[derive(Debug, Clone)]
pub struct MissionFile {
    /// The file, as the user named it.
    pub file: String,
    /// What is to be planned.
    pub mission: Mission,
    /// Where the local plane touches the earth, if the file says so.
    pub origin: Option<Origin>,
    /// The firmware that will fly it.
    pub autopilot: Autopilot,
}

/// Reads a mission file from disk.
///
/// # Errors
///
/// [`Failure::Input`] with all that is wrong with it.
pub fn read(path: &Path) -> Result<MissionFile, Failure> {
    let file = path.display().to_string();
    let source = std::fs::read_to_string(path).map_err(|error| {
        let message = format!("cannot be read ({}): give the name of a mission file (TOML)", reason(&error));
        Failure::Input(vec![Problem { file: file.clone(), line: None, key: String::new(), message }])
    })?;
    let folder = path.parent().unwrap_or(Path::new(""));
    parse(&file, &source, folder).map_err(Failure::Input)
}

/// The field mission that is built into the program.
///
/// # Errors
///
/// None as long as the built-in file is right, which a test checks.
pub fn built_in() -> Result<MissionFile, Failure> {
    parse("(built-in) field.toml", FIELD, Path::new("")).map_err(Failure::Input)
}

/// Targets of a file that stands by itself, with longitude and latitude (degrees) as positions.
///
/// # Errors
///
/// [`Failure::Input`] with all that is wrong with it.
pub fn read_targets(path: &Path) -> Result<Vec<Listed>, Failure> {
    let file = path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|error| {
        let message = format!("cannot be read ({}): give the name of a file with targets", reason(&error));
        Failure::Input(vec![Problem { file: file.clone(), line: None, key: String::new(), message }])
    })?;
    let mut problems = Vec::new();
    let mut wrong = |line: Option<usize>, key: &str, message: String| {
        problems.push(Problem { file: file.clone(), line, key: key.to_owned(), message });
    };
    let listed = targets::from_text(&file, &text, Frame::Degrees, &mut wrong);
    if problems.is_empty() { Ok(listed) } else { Err(Failure::Input(problems)) }
}

/// Reads a mission from its text; target files are looked for in `folder`.
///
/// # Errors
///
/// Everything that is wrong with it, never empty.
pub fn parse(file: &str, source: &str, folder: &Path) -> Result<MissionFile, Vec<Problem>> {
    let reader = Reader::new(file, source);
    let mut mission_file = None;
    if let Some(document) = reader.parse() {
        let root = Section::root(&reader, &document);
        let read = read_root(&root, &reader, folder);
        root.finish();
        if let Some((read, listed)) = read {
            add_planner_problems(&reader, &read.mission, &listed);
            mission_file = Some(read);
        }
    }
    let problems = reader.into_problems();
    match mission_file {
        Some(mission_file) if problems.is_empty() => Ok(mission_file),
        _ => Err(problems),
    }
}

fn read_root(
    root: &Section<'_, '_>,
    reader: &Reader<'_>,
    folder: &Path,
) -> Option<(MissionFile, Vec<Listed>)> {
    let name = root.text("name").unwrap_or_default();
    let origin = read_origin(root);
    let autopilot = root.choice("autopilot", &words::AUTOPILOTS);
    let frame = Frame::of(origin);
    let (listed, merge_within) = targets::read(root, reader, frame, folder);
    let (fleet, swap_time) = settings::fleet(root, reader)?;
    let targets = listed.iter().map(|listed| listed.target.clone()).collect();
    let mut mission = Mission::new(fleet.vehicle.clone(), fleet.vehicles, targets);
    mission.fleet = fleet;
    mission.swap_time = swap_time;
    mission.camera = settings::camera(root);
    mission.name = name;
    mission.merge_within = merge_within;
    mission.depot = settings::depot(root, frame).unwrap_or(mission.depot);
    mission.environment = settings::environment(root);
    mission.loiter = settings::loiter(root);
    mission.transition = settings::transition(root);
    mission.objective = root.choice("objective", &words::OBJECTIVES).unwrap_or(mission.objective);
    mission.pipeline = root.choice("pipeline", &words::PIPELINES).unwrap_or(mission.pipeline);
    mission.seed = root.count("seed", 0, i64::MAX as u64).unwrap_or(mission.seed);
    let file = reader.file().to_owned();
    let autopilot = autopilot.unwrap_or(Autopilot::ArduPilot);
    Some((MissionFile { file, mission, origin, autopilot }, listed))
}

/// `origin = { latitude, longitude, altitude }`; altitude is 0 if absent.
fn read_origin(root: &Section<'_, '_>) -> Option<Origin> {
    // Deeper than any lake bed and higher than any aircraft of this kind flies (m).
    const ALTITUDES: Range = Range::between(-500.0, 9000.0);
    let section = root.section("origin");
    let latitude = section.number("latitude", Range::between(-89.0, 89.0));
    let longitude = section.number("longitude", targets::LONGITUDES);
    let altitude = section.number("altitude", ALTITUDES);
    for key in ["latitude", "longitude"] {
        if section.is_present() && !section.has(key) {
            section.missing(key, "give both latitude and longitude in degrees");
        }
    }
    section.finish();
    Some(Origin { latitude: latitude?, longitude: longitude?, altitude: altitude.unwrap_or(0.0) })
}

/// What the planner finds wrong, at its place in the file; keys that are already known to be wrong are not repeated.
fn add_planner_problems(reader: &Reader<'_>, mission: &Mission, listed: &[Listed]) {
    for problem in mission.problems() {
        let key = problem.field();
        if reader.is_wrong(key) {
            continue;
        }
        match target_of(&problem).and_then(|target| listed.get(target)) {
            Some(at) => reader.add_elsewhere(&at.file, at.line, &at.key, problem.to_string()),
            None => reader.add(reader.line(key), key, problem.to_string()),
        }
    }
}

/// The target that a problem is about, if it is about one and not about a setting.
fn target_of(problem: &planner::Problem) -> Option<usize> {
    use planner::Problem::{OutOfRange, TargetsTooClose};
    match problem {
        TargetsTooClose { first, .. } => Some(*first),
        OutOfRange { field, .. } if field.starts_with("targets.") && field.ends_with(']') => {
            field.split(['[', ']']).nth(1).and_then(|index| index.parse().ok())
        }
        _ => None,
    }
}
