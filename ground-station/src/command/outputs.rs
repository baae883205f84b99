//! Everything that a plan is written as, in memory.

use crate::execution::Way;
use crate::export::folder::OutputFile;
use crate::export::plan_json::PlanDocument;
use crate::export::qgc::{qgc_mission, vehicle_mission};
use crate::export::trajectory_csv;
use crate::failure::Failure;
use crate::input::MissionFile;
use crate::plot::{map, map_scene, profile, vehicle_profile};
use crate::report::warning_lines;
use crate::words;
use planner::{Plan, Sample, VehiclePlan};
use rayon::prelude::*;

/// The files of a plan and what the operator should know.
#[derive(Debug, Clone, PartialEq)]
pub struct Outputs {
    /// The files, `plan.json` first.
    pub files: Vec<OutputFile>,
    /// What the operator should know, in plain words; also in `plan.json`.
    pub warnings: Vec<String>,
}

/// Samples per second of the pictures: switches of thrust should look like switches.
const PICTURE_RATE: f64 = 50.0;

/// All files of a plan, trajectories sampled at `rate` (Hz).
///
/// # Errors
///
/// [`Failure::Sampling`] if the plan belongs to another mission; [`Failure::Format`] if a file could not be put into its
/// format, which finite data never causes.
pub fn outputs(file: &MissionFile, plan: &Plan, rate: f64) -> Result<Outputs, Failure> {
    let mut warnings = warning_lines(plan);
    let mut notes = Notes::default();
    let drawn = drawn(file, plan, rate)?;
    let mut files = Vec::new();
    let mut tracks = Vec::new();
    for (index, Drawn { table, picture, track }) in drawn.into_iter().enumerate() {
        let named = |kind: &str, end: &str| format!("{}.{end}", words::flight_file(kind, plan, index));
        files.push(OutputFile { name: named("vehicle", "csv"), content: table });
        files.push(OutputFile { name: named("profile", "svg"), content: picture });
        files.extend(autopilot_mission(file, plan, index, &mut notes)?);
        tracks.push(track);
    }
    warnings.extend(notes.lines());
    if file.origin.is_none() {
        warnings.push(
            "no vehicle-<i>.plan was written: autopilot missions need latitude and longitude, and the mission has no \
             origin; add origin = { latitude = .., longitude = .., altitude = .. }"
                .to_owned(),
        );
    }
    let (document, map) = rayon::join(
        || PlanDocument::new(file, plan, &warnings).to_text(),
        || map(&map_scene(file, plan, &tracks)),
    );
    let document = document.map_err(|source| Failure::Format { source })?;
    files.insert(0, OutputFile { name: "plan.json".into(), content: document });
    files.insert(1, OutputFile { name: "map.svg".into(), content: map });
    Ok(Outputs { files, warnings })
}

/// What is drawn of one vehicle's flight.
struct Drawn {
    table: String,
    picture: String,
    track: Vec<Sample>,
}

/// Tables, sampled at `rate` (Hz), and pictures of all vehicles, side by side.
fn drawn(file: &MissionFile, plan: &Plan, rate: f64) -> Result<Vec<Drawn>, Failure> {
    let sampler = plan.sampler(&file.mission).ok_or(Failure::Sampling { vehicle: 0 })?;
    let vehicles = (0..plan.vehicles.len()).into_par_iter();
    let drawn = vehicles.map(|vehicle| {
        let sampled = |rate| sampler.at_rate(vehicle, rate).ok_or(Failure::Sampling { vehicle });
        let table = trajectory_csv(&sampled(rate)?, &plan.circles);
        let track = sampled(PICTURE_RATE)?;
        let picture = profile(&vehicle_profile(file, plan, vehicle, &track));
        Ok(Drawn { table, picture, track })
    });
    drawn.collect()
}

/// The `.plan` file of a vehicle; none without an origin, and none for a vehicle that stays at the depot.
fn autopilot_mission(
    file: &MissionFile,
    plan: &Plan,
    index: usize,
    notes: &mut Notes,
) -> Result<Option<OutputFile>, Failure> {
    let vehicle = plan.vehicles.get(index).filter(|vehicle| !vehicle.legs.is_empty());
    let Some((vehicle, origin)) = vehicle.zip(file.origin) else { return Ok(None) };
    let mission = qgc_mission(
        &vehicle_mission(file, plan, vehicle),
        file.autopilot,
        Way::of_missions(file.autopilot),
        &origin,
    );
    let name = format!("{}.plan", words::flight_file("vehicle", plan, index));
    notes.add(&name, mission.notes);
    if plan.vehicles.iter().filter(|vehicle| !vehicle.legs.is_empty()).count() > 1 {
        notes.add(&name, vec![TIMES_NOT_KEPT.to_owned()]);
    }
    let content = mission.plan.to_text().map_err(|source| Failure::Format { source })?;
    Ok(Some(OutputFile { name, content }))
}

/// What holds for every `.plan` file of a team.
const TIMES_NOT_KEPT: &str = "the file holds no times: flown as it is, neither the planned take-off times nor the separation \
                              of the vehicles is kept; let them fly one after the other, or stream the trajectories";

/// Notes on files, each said once with the files that it is about.
#[derive(Debug, Default)]
struct Notes {
    said: Vec<(String, Vec<String>)>,
}

impl Notes {
    fn add(&mut self, file: &str, notes: Vec<String>) {
        for note in notes {
            match self.said.iter_mut().find(|(said, _)| *said == note) {
                Some((_, files)) => files.push(file.to_owned()),
                None => self.said.push((note, vec![file.to_owned()])),
            }
        }
    }

    fn lines(&self) -> impl Iterator<Item = String> {
        self.said.iter().map(|(note, files)| format!("{}: {note}", files.join(", ")))
    }
}

/// A vehicle's flight at a rate (Hz).
///
/// # Errors
///
/// [`Failure::Sampling`] if the plan does not belong to the mission.
pub fn sampled(file: &MissionFile, plan: &Plan, vehicle: usize, rate: f64) -> Result<Vec<Sample>, Failure> {
    plan.samples(&file.mission, vehicle, rate).ok_or(Failure::Sampling { vehicle })
}

/// The greatest speed (m/s) and tilt (rad) of a flight.
#[must_use]
pub fn extremes(vehicle: &VehiclePlan, samples: &[Sample]) -> [f64; 2] {
    let speeds = samples.iter().map(crate::plot::speed);
    let tilts = samples.iter().map(crate::plot::tilt);
    let transitions = || vehicle.legs.iter().map(|leg| &leg.transition);
    [
        speeds.chain(transitions().map(|transition| transition.max_speed)).fold(0.0, f64::max),
        tilts.chain(transitions().map(|transition| transition.max_tilt)).fold(0.0, f64::max),
    ]
}
