//! Plans in the formats of maps and other ground stations.
//!
//! | format | files |
//! |---|---|
//! | [`Format::Plan`] | `vehicle-<i>.plan`: QGroundControl |
//! | [`Format::Waypoints`] | `vehicle-<i>.waypoints`: `QGC WPL 110`, for Mission Planner and MAVProxy |
//! | [`Format::Kml`] | `mission.kml`: targets, circles, and the flights as tracks in time with a tour |
//! | [`Format::GeoJson`] | `mission.geojson`: targets, circles, flights with times, keep-out circles |
//! | [`Format::Csv`] | `vehicle-<i>.csv`: trajectories; `targets.csv` |

mod geojson;
mod kml;
mod scene;

use super::folder::OutputFile;
use super::qgc::{qgc_mission, vehicle_mission};
use super::trajectory_csv;
use crate::command::sampled;
use crate::execution::{Way, execution};
use crate::failure::Failure;
use crate::geodesy::Origin;
use crate::input::{Autopilot, MissionFile};
use crate::link::item::MissionItem;
use crate::words;
use planner::Plan;
use scene::Scene;

/// A format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// QGroundControl plans.
    Plan,
    /// `QGC WPL 110`.
    Waypoints,
    /// KML with times.
    Kml,
    /// GeoJSON.
    GeoJson,
    /// Tables.
    Csv,
}

/// What is exported, and how it will be flown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Export {
    /// How circles are flown; `None` for what the autopilot's missions can do.
    pub way: Option<Way>,
    /// Samples per second of flights (Hz).
    pub rate: f64,
}

/// The files of a plan in some formats, and what the vehicles will do otherwise than planned.
///
/// # Errors
///
/// [`Failure::Refused`] without an origin, or for a way that the autopilot does not know; [`Failure::Sampling`] if the
/// plan belongs to another mission.
pub fn fleet_files(
    file: &MissionFile,
    plan: &Plan,
    formats: &[Format],
    export: Export,
) -> Result<(Vec<OutputFile>, Vec<String>), Failure> {
    const NO_ORIGIN: &str =
        "the mission has no origin: add origin = { latitude = .., longitude = .., altitude = .. }";
    let origin = file.origin.ok_or_else(|| Failure::Refused(NO_ORIGIN.to_owned()))?;
    let is_mission = formats.iter().any(|format| matches!(format, Format::Plan | Format::Waypoints));
    let way = match (export.way, is_mission) {
        (Some(way), _) => way,
        (None, true) => Way::of_missions(file.autopilot),
        (None, false) => Way::Stream,
    };
    if is_mission && matches!(way, Way::Stream | Way::LiveOrbit) {
        return Err(Failure::Refused(
            "a mission file holds loiter-items or a polygon, nothing that is live".to_owned(),
        ));
    }
    if let Some(why) = way.refusal(file.autopilot) {
        return Err(Failure::Refused(why.to_owned()));
    }
    let scene = Scene::new(file, plan, &origin, export.rate)?;
    let mut files = Vec::new();
    for &format in formats {
        files.extend(match format {
            Format::Plan | Format::Waypoints => missions(file, plan, &origin, way, format)?,
            Format::Kml => vec![OutputFile { name: "mission.kml".into(), content: kml::text(&scene)? }],
            Format::GeoJson => {
                vec![OutputFile { name: "mission.geojson".into(), content: geojson::text(&scene)? }]
            }
            Format::Csv => tables(file, plan, &scene, export.rate)?,
        });
    }
    Ok((files, warnings(file, plan, way, export.rate)?))
}

fn missions(
    file: &MissionFile,
    plan: &Plan,
    origin: &Origin,
    way: Way,
    format: Format,
) -> Result<Vec<OutputFile>, Failure> {
    let mut files = Vec::new();
    for (index, vehicle) in plan.vehicles.iter().enumerate().filter(|(_, vehicle)| !vehicle.legs.is_empty()) {
        let mission = qgc_mission(&vehicle_mission(file, plan, vehicle), file.autopilot, way, origin).plan;
        let (end, content) = match format {
            Format::Plan => ("plan", mission.to_text().map_err(|source| Failure::Format { source })?),
            _ => ("waypoints", waypoints(&MissionItem::of_plan(&mission, file.autopilot), file.autopilot)),
        };
        files.push(OutputFile {
            name: format!("{}.{end}", words::flight_file("vehicle", plan, index)),
            content,
        });
    }
    Ok(files)
}

/// `QGC WPL 110`: item 0 is home. PX4 has none, but the readers of this format take the first line for it.
fn waypoints(items: &[MissionItem], autopilot: Autopilot) -> String {
    let home = items.first().filter(|_| autopilot == Autopilot::Px4).map(|first| MissionItem {
        command: crate::link::item::NAV_WAYPOINT,
        parameters: [0.0; 4],
        height: 0.0,
        ..*first
    });
    let items: Vec<MissionItem> = home.into_iter().chain(items.iter().copied()).collect();
    let lines = items.iter().enumerate().map(|(number, item)| item.line(number) + "\n");
    format!("QGC WPL 110\n{}", lines.collect::<String>())
}

fn tables(file: &MissionFile, plan: &Plan, scene: &Scene, rate: f64) -> Result<Vec<OutputFile>, Failure> {
    let mut files = vec![OutputFile { name: "targets.csv".into(), content: scene.table() }];
    for index in 0..plan.vehicles.len() {
        let samples = sampled(file, plan, index, rate)?;
        let content = trajectory_csv(&samples, &plan.circles);
        files.push(OutputFile {
            name: format!("{}.csv", words::flight_file("vehicle", plan, index)),
            content,
        });
    }
    Ok(files)
}

/// Samples per second at which accelerations are looked at.
const LOOK: f64 = 50.0;

fn warnings(file: &MissionFile, plan: &Plan, way: Way, rate: f64) -> Result<Vec<String>, Failure> {
    let mut lines = Vec::new();
    for (index, vehicle) in plan.vehicles.iter().enumerate() {
        let samples = sampled(file, plan, index, rate.max(LOOK))?;
        let outcome = execution(
            way,
            file.autopilot,
            &vehicle_mission(file, plan, vehicle),
            vehicle.duration(),
            &samples,
        );
        let name = words::flight(plan, index);
        lines.extend(outcome.warnings.iter().map(|warning| format!("vehicle {name}: {warning}")));
    }
    Ok(lines)
}
