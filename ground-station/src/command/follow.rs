//! A plan that follows events, from the first to the last.

use crate::events::{Arrivals, Chance, TimedEvent, words};
use crate::failure::Failure;
use crate::input::MissionFile;
use planner::{Event, Mission, Plan, Replanner, Update};

/// What has become of a mission after its events.
pub(super) struct Followed {
    /// With the targets that have appeared and moved.
    pub mission: Mission,
    /// All that was flown, changes included.
    pub plan: Plan,
    /// What happened (s after the mission's start), and what came of it.
    pub log: Vec<(f64, String)>,
}

impl Followed {
    /// A mission without events.
    pub fn nothing(file: &MissionFile, plan: Plan) -> Self {
        Self { mission: file.mission.clone(), plan, log: Vec::new() }
    }
}

/// Takes in the events of a file, then those of chance until the last vehicle is back; what the planner refuses is logged, and
/// the plan stays as it was.
///
/// # Errors
///
/// [`Failure`] if the plan cannot follow events at all.
pub(super) fn follow(
    file: &MissionFile,
    plan: Plan,
    listed: Vec<TimedEvent>,
    arrivals: Arrivals,
) -> Result<Followed, Failure> {
    let wrong = |source| Failure::of_planner(&file.file, source);
    let mut replanner = Replanner::new(file.mission.clone(), plan).map_err(wrong)?;
    let mut log = Vec::new();
    for timed in listed {
        take_in(&mut replanner, &timed, &mut log);
    }
    let mut chance = Chance::new(arrivals);
    while let Some(timed) = chance.next(replanner.mission(), end(replanner.plan())) {
        take_in(&mut replanner, &timed, &mut log);
    }
    Ok(Followed { mission: replanner.mission().clone(), plan: replanner.plan().clone(), log })
}

fn end(plan: &Plan) -> f64 {
    plan.vehicles.iter().map(planner::VehiclePlan::end_time).fold(0.0, f64::max)
}

fn take_in(replanner: &mut Replanner, timed: &TimedEvent, log: &mut Vec<(f64, String)>) {
    let what = words(&timed.event, replanner.mission().targets.len());
    let came = match apply(replanner, timed.time, &timed.event) {
        Ok(update) => outcome(&update),
        Err(why) => why,
    };
    log.push((timed.time, format!("{what}: {came}")));
}

/// Lets a plan follow an event from `time` (s) on; what is refused is said with its reason, and the plan stays.
pub(super) fn apply(replanner: &mut Replanner, time: f64, event: &Event) -> Result<Update, String> {
    match unknown(replanner, event) {
        Some(who) => Err(format!("refused: there is no {who}")),
        None => replanner.apply(time, event).map_err(|error| format!("refused: {error}")),
    }
}

/// Numbers from 1 here, as people wrote them.
fn unknown(replanner: &Replanner, event: &Event) -> Option<String> {
    let (what, index, count) = match *event {
        Event::TargetVanishes(target) | Event::TargetMoves(target, _) => {
            ("target", target, replanner.mission().targets.len())
        }
        Event::VehicleFails(vehicle) | Event::VehicleReturns(vehicle) => {
            ("vehicle", vehicle, replanner.plan().vehicles.len())
        }
        _ => return None,
    };
    (index >= count).then(|| format!("{what} {}: there are {count}", index + 1))
}

/// What an event has changed, in words.
pub(super) fn outcome(update: &Update) -> String {
    let list = |indices: &[usize]| {
        indices.iter().map(|index| (index + 1).to_string()).collect::<Vec<_>>().join(", ")
    };
    let mut text = match update.vehicles.is_empty() {
        true => "no flight changes".to_owned(),
        false => format!("new flights for vehicle {}", list(&update.vehicles)),
    };
    if !update.waiting.is_empty() {
        text.push_str(&format!("; no vehicle is left for target {}", list(&update.waiting)));
    }
    if let Some(near) = update.conflict {
        text.push_str(&format!(
            "; vehicles {} and {} come within {:.2} m at {:.2} s: decide",
            near.vehicles[0] + 1,
            near.vehicles[1] + 1,
            near.distance,
            near.time
        ));
    }
    text
}
