//! A plan that follows events while vehicles fly it.
//!
//! A streamed fleet flies on while the new plan is found, on a thread of its own: the plan is changed from a moment a little ahead
//! of now, and taken over before that moment comes. Missions keep no times, and a vehicle in the air keeps the one it has: what
//! changes is uploaded to those that are still on the ground.

use super::fly::task;
use super::follow::{apply, outcome};
use crate::events::{TimedEvent, words};
use crate::execution::Way;
use crate::failure::Failure;
use crate::input::MissionFile;
use crate::link::pilot::{Outcome, Phase, Pilot, Task};
use crate::link::session::{Request, Session};
use crate::link::settings::SafeAction;
use planner::{Event, Plan, Replanner};
use std::collections::VecDeque;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// How far ahead of now a plan is changed (s): a hundred targets are re-planned in a fifth of it.
const LEAD: f64 = 1.0;
/// Twice the time again and again, so often at most.
const MOST_LATE: u32 = 3;

/// A plan under way and the events that it has yet to follow.
pub struct LivePlan {
    file: MissionFile,
    way: Way,
    systems: Vec<u8>,
    replanner: Replanner,
    events: VecDeque<TimedEvent>,
    work: Option<Work>,
    /// Vehicles that fly no further, by their number in the plan.
    lost: Vec<usize>,
    flies_on: bool,
}

/// A plan that is being changed.
struct Work {
    event: Event,
    /// When the change begins (s after the plan's start).
    time: f64,
    lead: f64,
    found: Receiver<Found>,
}

/// What came of an event; `Err` says why nothing did.
type Found = Result<Change, String>;

struct Change {
    replanner: Replanner,
    tasks: Vec<Task>,
    /// Vehicles that have nothing left to do, by their number in the plan.
    idle: Vec<usize>,
    text: String,
}

impl LivePlan {
    /// A plan about to be flown by `tasks`. With `flies_on` the fleet flies on while a plan is found; without, time stands still
    /// meanwhile, as in a simulation.
    ///
    /// # Errors
    ///
    /// [`Failure`] if the plan cannot follow events: it is not the mission's.
    pub fn new(
        file: &MissionFile,
        plan: Plan,
        tasks: &[Task],
        listed: Vec<TimedEvent>,
        flies_on: bool,
    ) -> Result<Self, Failure> {
        let wrong = |source| Failure::of_planner(&file.file, source);
        let mut mission = file.mission.clone();
        // Nobody swaps batteries by this link: each vehicle flies once.
        mission.swap_time = None;
        let mut replanner = Replanner::new(mission, plan).map_err(wrong)?;
        // A vehicle that has nothing to do was not made ready, and cannot help.
        for vehicle in 0..replanner.plan().vehicles.len() {
            if tasks.iter().all(|task| task.number != vehicle + 1) {
                replanner.apply(0.0, &Event::VehicleFails(vehicle)).map_err(wrong)?;
            }
        }
        let mut systems = vec![0; replanner.plan().vehicles.len()];
        tasks.iter().for_each(|task| systems[task.number - 1] = task.system);
        Ok(Self {
            file: file.clone(),
            way: tasks.first().map_or(Way::Stream, |task| task.way),
            systems,
            replanner,
            events: listed.into(),
            work: None,
            lost: Vec::new(),
            flies_on,
        })
    }

    /// The plan as it stands.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        self.replanner.plan()
    }

    /// Takes an event; one whose time is over happens at once.
    pub fn push(&mut self, event: TimedEvent) {
        let place = self.events.partition_point(|other| other.time <= event.time);
        self.events.insert(place, event);
    }

    /// Follows what is due at `now` (s after the session's start); the vehicles concerned get new flights.
    pub fn poll(&mut self, session: &mut Session, now: f64) {
        let Some(begin) = session.begun() else { return };
        self.note_losses(session.pilots());
        self.take_over(session, now - begin, now);
        let is_due = self.events.front().is_some_and(|timed| timed.time <= now - begin);
        if is_due
            && self.work.is_none()
            && let Some(timed) = self.events.pop_front()
        {
            if let Event::VehicleFails(vehicle) = timed.event {
                self.lost.push(vehicle);
                session.ask(Request { vehicle: Some(vehicle + 1), action: SafeAction::Return }, now);
            }
            self.begin(session.pilots(), timed.event, now - begin, LEAD);
            self.take_over(session, now - begin, now);
        }
    }

    /// A vehicle that returns or has dropped out leaves its targets to the others.
    fn note_losses(&mut self, pilots: &[Pilot]) {
        // When the whole fleet returns, nobody is left who could take anything over.
        let has_others = pilots
            .iter()
            .any(|pilot| !matches!(pilot.phase(), Phase::Safe(..) | Phase::Landing(_) | Phase::Over(_)));
        for pilot in pilots {
            let vehicle = pilot.task().number - 1;
            let is_lost = matches!(
                pilot.phase(),
                Phase::Safe(SafeAction::Return | SafeAction::Land, _) | Phase::Over(Outcome::CutShort)
            );
            if is_lost && !self.lost.contains(&vehicle) {
                self.lost.push(vehicle);
                if has_others {
                    self.push(TimedEvent { time: 0.0, event: Event::VehicleFails(vehicle) });
                }
            }
        }
    }

    fn begin(&mut self, pilots: &[Pilot], event: Event, plan_time: f64, lead: f64) {
        let (sender, found) = channel();
        let time = if self.way == Way::Stream { plan_time + lead } else { 0.0 };
        let gone = match self.way {
            Way::Stream => Vec::new(),
            _ => gone(pilots),
        };
        let (replanner, file, systems) = (self.replanner.clone(), self.file.clone(), self.systems.clone());
        let (way, asked) = (self.way, event.clone());
        let find = move || {
            let _ = sender.send(change(replanner, file, (way, &systems), &gone, (time, &asked)));
        };
        if self.flies_on {
            std::thread::spawn(find);
        } else {
            find();
        }
        self.work = Some(Work { event, time, lead, found });
    }

    /// Hands out what has been found, if it is not too late for that.
    fn take_over(&mut self, session: &mut Session, plan_time: f64, now: f64) {
        let Some(work) = &self.work else { return };
        let found = match work.found.try_recv() {
            Ok(found) => found,
            Err(TryRecvError::Empty) => return,
            Err(TryRecvError::Disconnected) => Err("refused: the planner broke off".to_owned()),
        };
        let Some(Work { event, time, lead, .. }) = self.work.take() else { return };
        let what = words(&event, self.replanner.mission().targets.len());
        let is_late = self.way == Way::Stream && plan_time > time + Replanner::REACTION;
        match found {
            Ok(_) if is_late && lead < LEAD * f64::from(1 << MOST_LATE) => {
                self.begin(session.pilots(), event, plan_time, 2.0 * lead);
            }
            Ok(_) if is_late => {
                session.say(&format!("{what}: refused: a new plan takes too long; the plan stays"), now);
            }
            Ok(Change { replanner, tasks, idle, text }) => {
                idle.into_iter().for_each(|vehicle| session.dismiss(vehicle + 1, now));
                let late: Vec<String> = tasks
                    .into_iter()
                    .filter_map(|task| (!session.renew(&task, now)).then(|| task.number.to_string()))
                    .collect();
                self.replanner = replanner;
                session.say(&format!("{what}: {text}"), now);
                if !late.is_empty() {
                    session.say(&format!("too late for vehicle {}", late.join(", ")), now);
                }
            }
            Err(why) => session.say(&format!("{what}: {why}"), now),
        }
    }
}

/// Vehicles that have flown their missions, or are flying them.
fn gone(pilots: &[Pilot]) -> Vec<usize> {
    let is_gone = |pilot: &&Pilot| {
        pilot.is_airborne() || matches!(pilot.phase(), Phase::Over(_) | Phase::Preparing(..))
    };
    pilots.iter().filter(is_gone).map(|pilot| pilot.task().number - 1).collect()
}

/// The plan after an event, with new tasks for the vehicles concerned; `gone` vehicles keep theirs.
fn change(
    mut replanner: Replanner,
    mut file: MissionFile,
    (way, systems): (Way, &[u8]),
    gone: &[usize],
    (time, event): (f64, &Event),
) -> Found {
    let refused = |why: &dyn std::fmt::Display| format!("refused: {why}; the plan stays");
    for &vehicle in gone.iter().filter(|&&vehicle| *event != Event::VehicleFails(vehicle)) {
        let route = replanner.plan().vehicles[vehicle].route.clone();
        let done = route.into_iter().map(Event::TargetVanishes).chain([Event::VehicleFails(vehicle)]);
        for event in done {
            replanner.apply(time, &event).map_err(|error| refused(&error))?;
        }
    }
    let update = apply(&mut replanner, time, event)?;
    if let Some(near) = update.conflict {
        let [a, b] = near.vehicles.map(|vehicle| vehicle + 1);
        let why = format!("vehicles {a} and {b} would come within {:.1} m of each other", near.distance);
        return Err(refused(&why));
    }
    file.mission = replanner.mission().clone();
    let (mut tasks, mut idle) = (Vec::new(), Vec::new());
    for &vehicle in update.vehicles.iter().filter(|vehicle| !gone.contains(vehicle)) {
        let task = task(&file, replanner.plan(), vehicle, way, systems[vehicle]);
        match task.map_err(|error| refused(&error))?.0 {
            Some(task) => tasks.push(task),
            None => idle.push(vehicle),
        }
    }
    Ok(Change { text: outcome(&update), replanner, tasks, idle })
}
