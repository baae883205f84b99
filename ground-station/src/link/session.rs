//! A fleet in the air: every vehicle by itself, and what they have to know of each other.
//!
//! The rules between vehicles: the plan starts when all are at its start; missions, which keep no times, are flown one
//! after the other; when one vehicle stays in the field, the separations that the plan proved no longer hold, and all
//! stay; a vehicle that returns climbs out of the plan's height first, and the others go on.

use super::frames::Received;
use super::pilot::{Outcome, Phase, Pilot, Task};
use super::settings::{Reach, SafeAction, Settings};
use crate::execution::Way;
use crate::geodesy::Origin;
use mavlink::dialects::common::{HEARTBEAT_DATA, MavAutopilot, MavMessage, MavModeFlag, MavState, MavType};

/// Something to be told.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// When (s after the session's start).
    pub time: f64,
    /// The vehicle's number in the plan; `None` for the fleet.
    pub vehicle: Option<usize>,
    /// What.
    pub text: String,
}

/// What an operator may ask for at any time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Request {
    /// The vehicle's number in the plan; `None` for all.
    pub vehicle: Option<usize>,
    /// What it shall do.
    pub action: SafeAction,
}

/// A session.
#[derive(Debug)]
pub struct Session {
    pilots: Vec<Pilot>,
    settings: Settings,
    start: Option<f64>,
    next_heartbeat: f64,
    events: Vec<Event>,
    launched: Option<f64>,
}

/// From the decision to the start of the plan (s): long enough for every link's delay.
const COUNTDOWN: f64 = 1.0;

impl Session {
    /// A session with these vehicles, `now` (s) being its start.
    #[must_use]
    pub fn new(tasks: Vec<Task>, origin: Origin, settings: Settings, now: f64) -> Self {
        let pilots = tasks.into_iter().map(|task| Pilot::new(task, origin, settings, now)).collect();
        Self { pilots, settings, start: None, next_heartbeat: now, events: Vec::new(), launched: None }
    }

    /// The vehicles.
    #[must_use]
    pub fn pilots(&self) -> &[Pilot] {
        &self.pilots
    }

    /// When the plan starts or started (s), once that is settled.
    #[must_use]
    pub fn start(&self) -> Option<f64> {
        self.start
    }

    /// When the flights began (s): streamed, all at the plan's start; missions, with the first take-off. `None` before.
    #[must_use]
    pub fn begun(&self) -> Option<f64> {
        if self.keeps_times() { self.start } else { self.launched }
    }

    fn keeps_times(&self) -> bool {
        self.pilots.iter().all(|pilot| pilot.task().way == Way::Stream)
    }

    /// Gives a vehicle another task; whether it was in time for that.
    pub fn renew(&mut self, task: &Task, now: f64) -> bool {
        let of_task = |pilot: &&mut Pilot| pilot.task().number == task.number;
        self.pilots.iter_mut().find(of_task).is_some_and(|pilot| pilot.renew(task, now))
    }

    /// Lets a vehicle stay on its pad, or land on it, that has nothing left to do.
    pub fn dismiss(&mut self, number: usize, now: f64) {
        let of_number = |pilot: &&mut Pilot| pilot.task().number == number;
        self.pilots.iter_mut().filter(|pilot| of_number(pilot)).for_each(|pilot| pilot.dismiss(now));
    }

    /// Takes a message of a vehicle.
    pub fn receive(&mut self, received: &Received, now: f64) {
        let of_vehicle = |pilot: &&mut Pilot| pilot.task().system == received.system;
        if let Some(pilot) = self.pilots.iter_mut().find(of_vehicle) {
            pilot.receive(received.component, &received.message, now);
        }
    }

    /// Does what an operator asks.
    pub fn ask(&mut self, request: Request, now: f64) {
        for pilot in &mut self.pilots {
            if request.vehicle.is_none_or(|number| number == pilot.task().number) {
                pilot.make_safe(request.action, "the operator asks for it", now);
            }
        }
    }

    /// What to send at `now` (s): the system and the message.
    pub fn poll(&mut self, now: f64) -> Vec<(u8, MavMessage)> {
        self.launch(now);
        self.settle_start(now);
        self.stay_together(now);
        let mut outgoing = Vec::new();
        if now >= self.next_heartbeat {
            self.next_heartbeat = now + 1.0;
            outgoing.extend(self.pilots.iter().map(|pilot| (pilot.task().system, heartbeat())));
        }
        for pilot in &mut self.pilots {
            let system = pilot.task().system;
            outgoing.extend(pilot.poll(self.start, now).into_iter().map(|message| (system, message)));
            let number = Some(pilot.task().number);
            let events = pilot.take_events().into_iter();
            self.events.extend(events.map(|text| Event { time: now, vehicle: number, text }));
        }
        outgoing
    }

    /// What is to be told, since it was last asked.
    pub fn take_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.events)
    }

    /// Whether nothing more will happen.
    #[must_use]
    pub fn is_over(&self) -> bool {
        let is_done = |pilot: &Pilot| match pilot.phase() {
            Phase::Over(_) => true,
            // Without leave to fly, being ready is the end.
            Phase::Ready => self.settings.reach < Reach::Fly,
            _ => false,
        };
        self.pilots.iter().all(is_done)
    }

    /// Why the session did not do what was asked; empty if it did.
    #[must_use]
    pub fn failures(&self) -> Vec<String> {
        let failure = |pilot: &Pilot| {
            let number = pilot.task().number;
            match pilot.phase() {
                Phase::Over(Outcome::Failed(why)) => Some(format!("vehicle {number}: {why}")),
                Phase::Over(Outcome::CutShort) => Some(format!("vehicle {number}: its flight was cut short")),
                _ => None,
            }
        };
        self.pilots.iter().filter_map(failure).collect()
    }

    /// Has something told about the fleet.
    pub fn say(&mut self, text: &str, now: f64) {
        self.events.push(Event { time: now, vehicle: None, text: text.to_owned() });
    }

    /// Nobody takes off before all are ready, and nobody at all if one has failed.
    fn launch(&mut self, now: f64) {
        if self.settings.reach < Reach::Fly {
            return;
        }
        let failed = |pilot: &Pilot| matches!(pilot.phase(), Phase::Over(Outcome::Failed(_)));
        if self.launched.is_none() {
            if self.pilots.iter().any(failed) {
                self.pilots
                    .iter_mut()
                    .for_each(|pilot| pilot.make_safe(SafeAction::Land, "another vehicle failed", now));
            } else if self.pilots.iter().all(|pilot| *pilot.phase() == Phase::Ready) {
                self.launched = Some(now);
                self.say("all vehicles are ready", now);
            }
        }
        if self.launched.is_none() {
            return;
        }
        let keeps_times = self.keeps_times();
        for pilot in &mut self.pilots {
            pilot.launch(now);
            if !keeps_times && !matches!(pilot.phase(), Phase::Over(_)) {
                break;
            }
        }
    }

    fn settle_start(&mut self, now: f64) {
        let waits = |pilot: &Pilot| *pilot.phase() == Phase::Waiting;
        if self.start.is_none() && !self.pilots.is_empty() && self.pilots.iter().all(waits) {
            self.start = Some(now + COUNTDOWN);
            self.say("all vehicles are at their starts; the plan begins", now);
        }
    }

    fn stay_together(&mut self, now: f64) {
        if self.launched.is_none() {
            return;
        }
        let any = |is: fn(&Pilot) -> bool| self.pilots.iter().any(is);
        let (why, action) = if self.start.is_none()
            && any(|pilot| is_gone(pilot) || matches!(pilot.phase(), Phase::Safe(..)))
        {
            ("another vehicle is in trouble before the start", SafeAction::Land)
        } else if any(holds) {
            ("another vehicle holds", SafeAction::Hold)
        } else if any(is_gone) {
            ("another vehicle is out of control of this link", SafeAction::Hold)
        } else {
            return;
        };
        for pilot in &mut self.pilots {
            if !is_safe(pilot.phase())
                && (pilot.is_airborne() || matches!(pilot.phase(), Phase::Preparing(..) | Phase::Ready))
            {
                pilot.make_safe(action, why, now);
            }
        }
    }
}

fn holds(pilot: &Pilot) -> bool {
    matches!(pilot.phase(), Phase::Safe(SafeAction::Hold, _))
}

/// Nobody knows what it does, or where.
fn is_gone(pilot: &Pilot) -> bool {
    matches!(pilot.phase(), Phase::Over(Outcome::Failed(_)))
}

fn is_safe(phase: &Phase) -> bool {
    matches!(phase, Phase::Safe(..) | Phase::Landing(_))
}

/// A ground station is there.
fn heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(HEARTBEAT_DATA {
        custom_mode: 0,
        mavtype: MavType::MAV_TYPE_GCS,
        autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
        base_mode: MavModeFlag::empty(),
        system_status: MavState::MAV_STATE_ACTIVE,
        mavlink_version: 3,
    })
}
