//! `plan`: from a mission file to a folder.

use super::outputs::{extremes, outputs};
use crate::execution::streamed;
use crate::export::folder;
use crate::export::members;
use crate::failure::Failure;
use crate::input::{self, MissionFile};
use crate::report::{self, VehicleRow, worst_of};
use crate::words;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use planner::{Miss, Options, Plan, Sampler, Tolerances, Transcription, VehiclePlan};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// What is asked of the command.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanRequest {
    /// The mission file; the built-in field mission if there is none.
    pub file: Option<PathBuf>,
    /// The folder that is written.
    pub out: PathBuf,
    /// Replaces a folder that is not ours.
    pub force: bool,
    /// Samples per second of the trajectory tables (Hz).
    pub rate: f64,
    /// Checks the plan with an independent integrator before anything is written.
    pub verify: bool,
    /// Instead of the mission's transcription.
    pub transcription: Option<Transcription>,
    /// Returns the content of `plan.json` instead of a text for people.
    pub json: bool,
    /// No progress bar.
    pub quiet: bool,
}

/// Plans, checks and writes; returns the text to be printed.
///
/// # Errors
///
/// [`Failure`]; nothing is written then.
pub fn plan(request: &PlanRequest) -> Result<String, Failure> {
    let mut file = mission(request.file.as_deref())?;
    if let Some(transcription) = request.transcription {
        file.mission.transition.transcription = transcription;
    }
    folder::check(&request.out, request.force)?;
    let plan = search(&file, request.quiet)?;
    let mut text = summary(&file, &plan)?;
    if request.verify {
        let verification = plan.verify(&file.mission, &Tolerances::default());
        text.push('\n');
        text.push_str(&report::verification_text(&verification, &|flight| words::flight(&plan, flight)));
        if !verification.passed() {
            return Err(Failure::Verification { report: text, failures: verification.failures });
        }
        text.push_str("verification passed\n");
    }
    let outputs = outputs(&file, &plan, request.rate)?;
    folder::write(&request.out, &outputs.files, request.force)?;
    if request.json {
        return Ok(outputs.files.into_iter().next().map(|file| file.content).unwrap_or_default());
    }
    if !outputs.warnings.is_empty() {
        text.push('\n');
    }
    for warning in &outputs.warnings {
        text.push_str(&format!("warning: {warning}\n"));
    }
    text.push_str(&format!("\nwrote {}:\n", request.out.display()));
    for file in &outputs.files {
        text.push_str(&format!("  {}\n", file.name));
    }
    Ok(text)
}

/// The mission of a file; without one, the built-in field mission.
pub(crate) fn mission(path: Option<&Path>) -> Result<MissionFile, Failure> {
    path.map_or_else(input::built_in, input::read)
}

/// Runs the planner behind a progress bar on the standard error, which hides itself where that is no terminal.
pub(crate) fn search(file: &MissionFile, quiet: bool) -> Result<Plan, Failure> {
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(Some(0), target);
    let template = "planning {bar:40} {pos}/{len} candidate transitions, {elapsed} gone, {eta} left";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    let progress = |progress: planner::Progress| {
        bar.set_length(progress.total as u64);
        bar.set_position(progress.done as u64);
    };
    let outcome = planner::plan(&file.mission, &Options::default().with_progress(&progress));
    bar.finish_and_clear();
    outcome.map_err(|source| Failure::of_planner(&file.file, source))
}

fn summary(file: &MissionFile, plan: &Plan) -> Result<String, Failure> {
    let mut text = report::vehicle_table(&rows(file, plan)?).render();
    text.push('\n');
    let executions: Vec<_> = plan.vehicles.iter().map(|vehicle| streamed(file, plan, vehicle)).collect();
    let lines = report::certificate_lines(plan).into_iter();
    for line in
        lines.chain(report::execution_line(&executions)).chain(report::camera_line(&file.mission, plan))
    {
        text.push_str(&format!("{line}\n"));
    }
    Ok(text)
}

/// The lines of the table of vehicles.
pub(crate) fn rows(file: &MissionFile, plan: &Plan) -> Result<Vec<VehicleRow>, Failure> {
    let sampler = plan.sampler(&file.mission).ok_or(Failure::Sampling { vehicle: 0 })?;
    let vehicles = plan.vehicles.par_iter().enumerate();
    vehicles.map(|(index, vehicle)| row(plan, &sampler, index, vehicle)).collect()
}

fn row(plan: &Plan, sampler: &Sampler, index: usize, vehicle: &VehiclePlan) -> Result<VehicleRow, Failure> {
    /// Often enough to see the greatest tilt on a circle.
    const RATE: f64 = 20.0;
    let unknown = || Failure::Sampling { vehicle: index };
    let [top_speed, top_tilt] = extremes(vehicle, &sampler.at_rate(index, RATE).ok_or_else(unknown)?);
    let circles = || vehicle.route.iter().filter_map(|&circle| plan.circles.get(circle));
    Ok(VehicleRow {
        name: words::flight(plan, index),
        targets: circles().map(members).collect::<Vec<_>>().join(" "),
        count: circles().map(|circle| circle.members.len()).sum(),
        length: vehicle.length(),
        start: vehicle.start_time(),
        transit: vehicle.transition_time(),
        loiters: vehicle.loiter_time(),
        total: vehicle.duration(),
        energy: sampler.energy(index).ok_or_else(unknown)?,
        top_speed,
        top_tilt,
        miss: vehicle.legs.iter().fold(Miss::default(), |worst, leg| worst_of(worst, leg.transition.miss)),
    })
}
