//! `fly`: from a mission file into the air.

use super::live::LivePlan;
use super::plan::{mission, search};
use super::sampled;
use crate::execution::{Way, execution};
use crate::export::qgc::{qgc_mission, vehicle_mission};
use crate::failure::Failure;
use crate::geodesy::Origin;
use crate::input::MissionFile;
use crate::link::address::Address;
use crate::link::item::MissionItem;
use crate::link::pilot::Task;
use crate::link::run::{Line, Surroundings, parse_line, run};
use crate::link::session::{Event, Session};
use crate::link::settings::{Reach, Settings};
use crate::link::tlog::TelemetryLog;
use crate::link::track::Track;
use crate::link::transport::Transport;
use planner::Plan;
use std::io::BufRead;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// What is asked of the command.
#[derive(Debug, Clone, PartialEq)]
pub struct FlyRequest {
    /// The mission file; the built-in field mission if there is none.
    pub file: Option<PathBuf>,
    /// How to reach the vehicles.
    pub address: Address,
    /// How the plan is flown.
    pub way: Way,
    /// System ids of the vehicles, in the plan's order; 1, 2, 3, .. if empty.
    pub systems: Vec<u8>,
    /// How far to go, limits, and what to do when they are passed.
    pub settings: Settings,
    /// Where every frame is noted.
    pub log: Option<PathBuf>,
    /// A file with an operator's lines, instead of the standard input.
    pub commands: Option<PathBuf>,
    /// A file of events while the fleet flies.
    pub arrivals: Option<PathBuf>,
    /// No progress bar.
    pub quiet: bool,
}

/// Samples per second of what is streamed: between them a cubic is followed.
const TRACK_RATE: f64 = 50.0;
/// How long the loop waits for a message (s): short against the time between two setpoints.
const PATIENCE: Duration = Duration::from_millis(4);

/// Plans, connects and does as asked; tells what happens as it happens.
///
/// # Errors
///
/// [`Failure`]: bad input, no connection, vehicles that did not do what was asked.
pub fn fly(request: &FlyRequest, tell: &mut dyn FnMut(&str)) -> Result<String, Failure> {
    let file = mission(request.file.as_deref())?;
    let origin = origin_of(&file)?;
    if let Some(why) = request.way.refusal(file.autopilot) {
        return Err(Failure::Refused(why.to_owned()));
    }
    let listed = request.arrivals.as_deref().map(crate::events::read).transpose()?.unwrap_or_default();
    let plan = search(&file, request.quiet)?;
    let tasks = tasks(&file, &plan, request.way, &request.systems, &mut |warning| {
        tell(&format!("warning: {warning}"))
    })?;
    let count = tasks.len();
    let transport = Transport::open(&request.address, PATIENCE)
        .map_err(|source| Failure::Link { address: request.address.to_string(), source })?;
    let log = request.log.as_deref().map(TelemetryLog::create).transpose()?;
    let lines = operator(request.commands.as_deref())?;
    let mut live = LivePlan::new(&file, plan, &tasks, listed, true);
    let begin = Instant::now();
    let mut session = Session::new(tasks, origin, request.settings, 0.0);
    let mut told = |event: &Event| tell(&event_line(event));
    let mut surroundings = Surroundings {
        transport,
        address: request.address.to_string(),
        log,
        clock: &|| begin.elapsed().as_secs_f64(),
        attend: &mut |session, now| {
            lines.try_iter().for_each(|line| take(line, session, &mut live, now));
            if let Ok(live) = &mut live {
                live.poll(session, now);
            }
        },
        tell: &mut told,
    };
    run(&mut session, &mut surroundings)?;
    Ok(match request.settings.reach {
        Reach::Check => format!("{count} vehicle(s) are ready; nothing was changed on them\n"),
        Reach::Upload => format!("{count} vehicle(s) are ready; --arm flies them\n"),
        Reach::Fly => format!("{count} vehicle(s) have flown\n"),
    })
}

fn origin_of(file: &MissionFile) -> Result<Origin, Failure> {
    const NO_ORIGIN: &str = "the mission has no origin: add origin = { latitude = .., longitude = .., altitude = .. }, or vehicles cannot be placed";
    file.origin.ok_or_else(|| Failure::Refused(NO_ORIGIN.to_owned()))
}

/// What each vehicle of a plan is to do; what it will do otherwise is said.
///
/// # Errors
///
/// [`Failure::Refused`] without an origin, or with other than one system id per vehicle; [`Failure::Sampling`] if the plan
/// belongs to another mission.
pub fn tasks(
    file: &MissionFile,
    plan: &Plan,
    way: Way,
    systems: &[u8],
    warn: &mut dyn FnMut(&str),
) -> Result<Vec<Task>, Failure> {
    if plan.vehicles.iter().enumerate().any(|(index, planned)| planned.vehicle != index) {
        return Err(Failure::Refused(
            "vehicles would fly several times, with batteries swapped by hand: plan with more vehicles or fewer targets to fly \
             by this link, or fly the exported missions one by one"
                .to_owned(),
        ));
    }
    let systems = system_ids(systems, plan.vehicles.len())?;
    let mut tasks = Vec::new();
    for (index, &system) in systems.iter().enumerate() {
        let (task, warnings) = task(file, plan, index, way, system)?;
        warnings.iter().for_each(|warning| warn(&format!("vehicle {}: {warning}", index + 1)));
        tasks.extend(task);
    }
    Ok(tasks)
}

/// What a vehicle of a plan is to do, and what it will do otherwise; nothing for one that stays on its pad.
pub(super) fn task(
    file: &MissionFile,
    plan: &Plan,
    index: usize,
    way: Way,
    system: u8,
) -> Result<(Option<Task>, Vec<String>), Failure> {
    let origin = origin_of(file)?;
    let vehicle = &plan.vehicles[index];
    let samples = sampled(file, plan, index, TRACK_RATE)?;
    let flown = vehicle_mission(file, plan, vehicle);
    let items = match way {
        Way::Stream | Way::LiveOrbit => Vec::new(),
        _ => MissionItem::of_plan(&qgc_mission(&flown, file.autopilot, way, &origin).plan, file.autopilot),
    };
    let warnings = execution(way, file.autopilot, &flown, vehicle.duration(), &samples).warnings;
    let (autopilot, pad, number) = (file.autopilot, vehicle.pad, index + 1);
    let circles = if way == Way::LiveOrbit { flown.circles } else { Vec::new() };
    let task =
        Track::new(&samples).map(|track| Task { number, system, autopilot, way, pad, track, items, circles });
    Ok((task, warnings))
}

fn system_ids(given: &[u8], vehicles: usize) -> Result<Vec<u8>, Failure> {
    if given.is_empty() {
        let ids: Option<Vec<u8>> =
            (1..=vehicles).map(|number| u8::try_from(number).ok().filter(|&id| id < 255)).collect();
        return ids.ok_or_else(|| Failure::Refused("one link holds at most 254 vehicles".to_owned()));
    }
    let is_distinct = given.iter().enumerate().all(|(index, id)| !given[..index].contains(id));
    match given.len() == vehicles && is_distinct {
        true => Ok(given.to_vec()),
        false => Err(Failure::Refused(format!(
            "--systems must name {vehicles} different system ids, one per vehicle"
        ))),
    }
}

fn event_line(event: &Event) -> String {
    let who = event.vehicle.map_or("fleet".to_owned(), |number| format!("vehicle {number}"));
    format!("{:8.2} s  {who}: {}", event.time, event.text)
}

/// Does what an operator says.
fn take(line: Line, session: &mut Session, live: &mut Result<LivePlan, Failure>, now: f64) {
    match (line, live) {
        (Line::Request(request), _) => session.ask(request, now),
        (Line::Event(event), Ok(live)) => live.push(event),
        (Line::Event(event), Err(why)) => {
            session.say(&format!("{:?} cannot be followed: {why}", event.event), now);
        }
    }
}

/// An operator's lines as they come, each from a file or from the standard input.
fn operator(path: Option<&Path>) -> Result<Receiver<Line>, Failure> {
    let (sender, receiver) = channel();
    let source: Box<dyn BufRead + Send> = match path {
        Some(path) => {
            let file = std::fs::File::open(path).map_err(|error| {
                Failure::Refused(format!("{}: {}", path.display(), crate::failure::reason(&error)))
            })?;
            Box::new(std::io::BufReader::new(file))
        }
        None => Box::new(std::io::BufReader::new(std::io::stdin())),
    };
    std::thread::spawn(move || {
        for line in source.lines().map_while(Result::ok) {
            match parse_line(&line) {
                Ok(Some(line)) => {
                    if sender.send(line).is_err() {
                        return;
                    }
                }
                Ok(None) => {}
                Err(problem) => eprintln!("{problem}"),
            }
        }
    });
    Ok(receiver)
}
