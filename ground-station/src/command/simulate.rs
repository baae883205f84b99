//! `simulate`: a plan flown by a simulated team in wind and gusts, re-planned as targets come, go and move.

use super::follow::{Followed, follow};
use super::plan::{mission, search};
use crate::events::Arrivals;
use crate::export::folder::{self, OutputFile};
use crate::export::members;
use crate::failure::Failure;
use crate::input::MissionFile;
use crate::plot::{MapVehicle, map, map_scene};
use crate::report::Table;
use crate::words;
use planner::quad_dynamics::nalgebra::Vector3;
use planner::quad_dynamics::simulation::{SensorNoise, SimulationOptions};
use planner::{Flown, Plan, Tolerances, Verification};
use std::fmt::Write;
use std::path::PathBuf;

/// What is asked of the command.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulateRequest {
    /// The mission file; the built-in field mission if there is none.
    pub file: Option<PathBuf>,
    /// The folder into which the files go.
    pub out: PathBuf,
    /// Steady wind on top of the one that the mission is planned for: east, north (m/s).
    pub wind: [f64; 2],
    /// Wind speed at 20 ft that sets the strength of the gusts (m/s); 0 for none.
    pub gusts: f64,
    /// Errors of the estimates that the controllers see.
    pub noise: bool,
    /// A file of events while the team flies.
    pub arrivals: Option<PathBuf>,
    /// Events per minute by chance.
    pub arrival_rate: f64,
    /// Seed of gusts, errors and events by chance.
    pub seed: u64,
    /// Replaces files that are there.
    pub force: bool,
    /// No progress bar.
    pub quiet: bool,
}

/// Plans, flies and writes what was flown; returns the text to be printed.
///
/// # Errors
///
/// [`Failure`]; nothing is written then.
pub fn simulate(request: &SimulateRequest) -> Result<String, Failure> {
    let mut file = mission(request.file.as_deref())?;
    let listed = request.arrivals.as_deref().map(crate::events::read).transpose()?.unwrap_or_default();
    let arrivals = Arrivals { rate: request.arrival_rate, seed: request.seed };
    let is_eventful = request.arrivals.is_some() || request.arrival_rate > 0.0;
    let plan = search(&file, request.quiet)?;
    let Followed { mission, plan, log } =
        if is_eventful { follow(&file, plan, listed, arrivals)? } else { Followed::nothing(&file, plan) };
    file.mission = mission;
    let team = plan
        .fly(&file.mission, &options(request, &file), request.seed)
        .ok_or(Failure::Sampling { vehicle: 0 })?;
    let log = events(&plan, &team, log);
    let mut files = vec![OutputFile { name: "events.log".into(), content: log }];
    for flown in &team {
        let name = format!("{}.csv", words::flight_file("flown", &plan, flown.vehicle));
        files.push(OutputFile { name, content: flown_csv(&file, &plan, flown)? });
    }
    files.push(OutputFile { name: "flown.svg".into(), content: picture(&file, &plan, &team)? });
    folder::write_files(&request.out, &files, request.force)?;
    let mut text = table(&plan, &team).render();
    if is_eventful {
        text.push_str(&stands(&plan.verify(&file.mission, &Tolerances::default())));
    }
    for file in &files {
        let _ = writeln!(text, "wrote {}", request.out.join(&file.name).display());
    }
    Ok(text)
}

fn options(request: &SimulateRequest, file: &MissionFile) -> SimulationOptions {
    let planned = file.mission.environment.wind;
    let [east, north] = [0, 1].map(|axis| planned[axis] + request.wind[axis]);
    let mut options = SimulationOptions::default().with_wind(Vector3::new(east, north, 0.0));
    if request.gusts > 0.0 {
        options = options.with_gusts(request.gusts, file.mission.loiter.height);
    }
    if request.noise {
        options = options.with_noise(SensorNoise::typical());
    }
    options
}

fn stands(verification: &Verification) -> String {
    if verification.passed() {
        return "the plan with all its changes stands up to the independent check\n".to_owned();
    }
    let lines = verification.failures.iter().map(|failure| format!("  {failure}\n"));
    format!("the plan with its changes fails the independent check:\n{}", lines.collect::<String>())
}

fn table(plan: &Plan, team: &[Flown]) -> Table {
    let mut table = Table::new(&[
        "vehicle",
        "flown",
        "RMS error",
        "greatest error",
        "off the path",
        "late by",
        "least clearance",
    ]);
    for flown in team {
        let tracking = &flown.tracking;
        table.push(vec![
            words::flight(plan, flown.vehicle),
            format!("{:.0} %", 100.0 * tracking.completed),
            format!("{:.3} m", tracking.rms_error),
            format!("{:.3} m", tracking.max_error),
            format!("{:.3} m", tracking.max_cross_track),
            format!("{:.3} s", tracking.time_lag),
            if flown.clearance.is_finite() { format!("{:.3} m", flown.clearance) } else { "-".to_owned() },
        ]);
    }
    table
}

/// What happens in the order of time: events, take-offs, circles, landings, and safe distances that were broken.
fn events(plan: &Plan, team: &[Flown], mut events: Vec<(f64, String)>) -> String {
    for flown in team {
        let number = words::flight(plan, flown.vehicle);
        let vehicle = &plan.vehicles[flown.vehicle];
        events.push((vehicle.start_time(), format!("vehicle {number} takes off")));
        for leg in &vehicle.legs {
            let Some(circle) = leg.loiter.and_then(|loiter| plan.circles.get(loiter.circle)) else {
                continue;
            };
            let name = members(circle);
            events.push((leg.arrival_time(), format!("vehicle {number} begins its circle around {name}")));
            events.push((leg.end_time(), format!("vehicle {number} has circled {name}")));
        }
        let end = match (flown.tracking.completed < 1.0, vehicle.lost_at) {
            (true, _) => "breaks off: its simulation left all bounds",
            (_, Some(_)) => "is simulated no further: it drops out",
            _ => "is back at its pad",
        };
        events.push((vehicle.end_time(), format!("vehicle {number} {end}")));
        if flown.clearance < 0.0 {
            let text = format!("vehicle {number} has come {:.2} m inside a safe distance", -flown.clearance);
            events.push((vehicle.end_time(), text));
        }
    }
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    events.iter().map(|(time, text)| format!("{time:8.2} s  {text}\n")).collect()
}

/// Planned beside flown, at every recorded state.
fn flown_csv(file: &MissionFile, plan: &Plan, flown: &Flown) -> Result<String, Failure> {
    let flight = &flown.flight;
    let planned = plan
        .motions(&file.mission, flown.vehicle, flight.interval)
        .ok_or(Failure::Sampling { vehicle: flown.vehicle })?;
    let mut text =
        "time_s,planned_east_m,planned_north_m,planned_up_m,east_m,north_m,up_m,error_m\n".to_owned();
    for (index, (state, motion)) in flight.states.iter().zip(&planned).enumerate() {
        let time = flown.start_time + index as f64 * flight.interval;
        let (p, q) = (motion.position, state.fixed_rows::<3>(0));
        let error = (p - q).norm();
        let _ = writeln!(
            text,
            "{time:.3},{:.4},{:.4},{:.4},{:.4},{:.4},{:.4},{error:.4}",
            p[0], p[1], p[2], q[0], q[1], q[2]
        );
    }
    Ok(text)
}

/// The map with both tracks: the flown ones follow the planned ones like further vehicles, in further colours.
fn picture(file: &MissionFile, plan: &Plan, team: &[Flown]) -> Result<String, Failure> {
    const RATE: f64 = 20.0;
    let tracks = (0..plan.vehicles.len())
        .map(|vehicle| super::sampled(file, plan, vehicle, RATE))
        .collect::<Result<Vec<_>, _>>()?;
    let mut scene = map_scene(file, plan, &tracks);
    for flown in team {
        let track = flown.flight.states.iter().map(|state| [state[0], state[1]]).collect();
        let pad = plan.vehicles[flown.vehicle].pad;
        scene.vehicles.push(MapVehicle {
            pad: [pad[0], pad[1]],
            circles: Vec::new(),
            track,
            caption: format!(
                "vehicle {} as flown: at most {:.2} m off",
                words::flight(plan, flown.vehicle),
                flown.tracking.max_error
            ),
        });
    }
    Ok(map(&scene))
}
