//! One vehicle of a session, from silence to the ground: a machine without sockets or clocks.

mod before_flight;
mod changes;
mod in_flight;
mod orbits;

pub use orbits::Orbits;

use super::command::Order;
use super::item::MissionItem;
use super::mission::{ReadBack, Target, Upload};
use super::modes::Mode;
use super::settings::{SafeAction, Settings};
use super::track::{LocalFrame, Moment, Track};
use super::vehicle::VehicleState;
use crate::execution::Way;
use crate::export::qgc::CircleTask;
use crate::geodesy::Origin;
use crate::input::Autopilot;
use mavlink::dialects::common::{MavCmd, MavMessage};
use std::collections::VecDeque;

/// What a vehicle is to do.
#[derive(Debug, Clone, PartialEq)]
pub struct Task {
    /// Its number in the plan, from 1.
    pub number: usize,
    /// Its system id.
    pub system: u8,
    /// Its firmware.
    pub autopilot: Autopilot,
    /// How the plan is flown: streamed, or as a mission.
    pub way: Way,
    /// Where it starts and ends: east, north, and the height of the first and last hover (m).
    pub pad: [f64; 3],
    /// What to stream.
    pub track: Track,
    /// What to upload; empty when streaming.
    pub items: Vec<MissionItem>,
    /// What to circle by live commands; empty otherwise.
    pub circles: Vec<CircleTask>,
}

/// What a vehicle is about.
#[derive(Debug, Clone, PartialEq)]
pub enum Phase {
    /// Nothing heard yet, or its checks do not pass yet.
    Checking,
    /// Its mission is on the way.
    Uploading(Box<Upload>),
    /// Its mission is on the way back.
    ReadingBack(Box<ReadBack>),
    /// Ready to fly.
    Ready,
    /// Commands before the take-off.
    Preparing(VecDeque<Command>, Option<Box<Order>>),
    /// On its way up.
    Climbing,
    /// On its way to the start of its plan.
    Placing,
    /// Waits for the others.
    Waiting,
    /// Flies its plan.
    Flying,
    /// Circles its targets by live commands.
    Orbiting(Box<Orbits>),
    /// On its way down.
    Landing(Box<Order>),
    /// Holds, returns or lands, since something went wrong.
    Safe(SafeAction, Box<Order>),
    /// Nothing more to do.
    Over(Outcome),
}

/// How a vehicle's part ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// As asked.
    Done,
    /// On the ground again, but not as planned.
    CutShort,
    /// Not at all, and why.
    Failed(String),
}

/// A command and how its effect shows.
#[derive(Debug, Clone, PartialEq)]
pub struct Command {
    command: MavCmd,
    parameters: [f32; 7],
    effect: Effect,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Effect {
    Mode(u32),
    Armed,
    None,
}

/// A vehicle and what it is about.
#[derive(Debug, Clone)]
pub struct Pilot {
    task: Task,
    settings: Settings,
    origin: Origin,
    state: VehicleState,
    phase: Phase,
    /// When the phase began (s).
    since: f64,
    frame: Option<LocalFrame>,
    /// Height of its pad above mean sea level (m), by its own estimate.
    ground: Option<f64>,
    next_setpoint: f64,
    next_request: f64,
    /// Since when it is in a mode that nobody commanded (s).
    stray_since: Option<f64>,
    /// Whether it has shown that it does what it was told last.
    has_obeyed: bool,
    events: Vec<String>,
}

/// How near the start of the plan counts as there (m, m/s).
const NEAR: f64 = 0.5;
const SLOW: f64 = 0.3;
/// How long the phases before the start may take (s).
const PATIENCE: f64 = 90.0;
/// The autopilot among a vehicle's components.
const AUTOPILOT: u8 = 1;

impl Pilot {
    /// A vehicle that nothing was heard of yet.
    #[must_use]
    pub fn new(task: Task, origin: Origin, settings: Settings, now: f64) -> Self {
        Self {
            task,
            settings,
            origin,
            state: VehicleState::default(),
            phase: Phase::Checking,
            since: now,
            frame: None,
            ground: None,
            next_setpoint: now,
            next_request: now,
            stray_since: None,
            has_obeyed: false,
            events: Vec::new(),
        }
    }

    /// What it is to do.
    #[must_use]
    pub fn task(&self) -> &Task {
        &self.task
    }

    /// What it is about.
    #[must_use]
    pub fn phase(&self) -> &Phase {
        &self.phase
    }

    /// What it has said.
    #[must_use]
    pub fn state(&self) -> &VehicleState {
        &self.state
    }

    /// Whether it is, or may be, in the air.
    #[must_use]
    pub fn is_airborne(&self) -> bool {
        use Phase::{Climbing, Flying, Landing, Orbiting, Placing, Safe, Waiting};
        matches!(self.phase, Climbing | Placing | Waiting | Flying | Orbiting(_) | Landing(_) | Safe(..))
    }

    /// What is to be told, since it was last asked.
    pub fn take_events(&mut self) -> Vec<String> {
        std::mem::take(&mut self.events)
    }

    /// Position in the plan's frame (m), once it is known.
    #[must_use]
    pub fn position(&self) -> Option<[f64; 3]> {
        self.frame.zip(self.state.local).map(|(frame, (_, local))| frame.plan_position(local))
    }

    fn target(&self) -> Target {
        (self.task.system, AUTOPILOT)
    }

    fn say(&mut self, text: impl Into<String>) {
        self.events.push(text.into());
    }

    fn go(&mut self, phase: Phase, now: f64) {
        self.phase = phase;
        self.since = now;
        self.stray_since = None;
        self.has_obeyed = false;
    }

    fn fail(&mut self, why: String, now: f64) {
        self.say(format!("failed: {why}"));
        self.go(Phase::Over(Outcome::Failed(why)), now);
    }

    /// Takes a message of the vehicle.
    pub fn receive(&mut self, component: u8, message: &MavMessage, now: f64) {
        if component != AUTOPILOT {
            return;
        }
        self.state.receive(message, now);
        if let MavMessage::STATUSTEXT(text) = message {
            let text: String =
                text.text.iter().take_while(|&&byte| byte != 0).map(|&byte| char::from(byte)).collect();
            self.say(format!("says: {text}"));
        }
        match &mut self.phase {
            Phase::Uploading(upload) => upload.receive(message, now),
            Phase::ReadingBack(read_back) => read_back.receive(message),
            Phase::Preparing(_, Some(order)) | Phase::Landing(order) | Phase::Safe(_, order) => {
                order.receive(message, now);
            }
            Phase::Orbiting(orbits) => orbits.receive(message, now),
            _ => {}
        }
    }

    /// Begins to fly, if it is ready.
    pub fn launch(&mut self, now: f64) {
        if self.phase == Phase::Ready {
            let commands = self.commands();
            self.say("prepares for take-off");
            self.go(Phase::Preparing(commands, None), now);
        }
    }

    /// Stops what it does in the air and does something safe instead.
    pub fn make_safe(&mut self, action: SafeAction, why: &str, now: f64) {
        if matches!(self.phase, Phase::Over(_))
            || matches!(&self.phase, Phase::Safe(other, _) if *other == action)
        {
            return;
        }
        let may_fly = self.is_airborne() || matches!(self.phase, Phase::Preparing(..));
        if !may_fly {
            self.fail(format!("not started: {why}"), now);
            return;
        }
        let mode = action.mode();
        self.say(format!("{why}: commands {}", mode.name(self.task.autopilot)));
        let order = self.mode_order(mode, now);
        self.go(Phase::Safe(action, Box::new(order)), now);
    }

    fn mode_order(&self, mode: Mode, now: f64) -> Order {
        Order::new(self.target(), MavCmd::MAV_CMD_DO_SET_MODE, mode.parameters(self.task.autopilot), now)
    }

    fn is_in(&self, mode: Mode) -> bool {
        self.state.mode == mode.number(self.task.autopilot)
    }

    /// The mode in which the plan is flown.
    fn flight_mode(&self) -> Mode {
        match (self.task.way, &self.phase) {
            (Way::Stream, _) => Mode::Setpoints,
            (Way::LiveOrbit, Phase::Orbiting(_)) if self.is_in(Mode::Orbit) => Mode::Orbit,
            (Way::LiveOrbit, Phase::Climbing) if self.is_in(Mode::TakeOff) => Mode::TakeOff,
            (Way::LiveOrbit, _) => Mode::Hold,
            (Way::LoiterItems | Way::Polygon, _) => Mode::Mission,
        }
    }

    /// What to send at `now`; `start` is when the fleet's plan starts (s), once that is settled.
    pub fn poll(&mut self, start: Option<f64>, now: f64) -> Vec<MavMessage> {
        let mut outgoing = Vec::new();
        if self.is_airborne() {
            self.watch(start, now);
        }
        match self.phase.clone() {
            Phase::Checking => self.check(&mut outgoing, now),
            Phase::Uploading(upload) => self.upload(*upload, &mut outgoing, now),
            Phase::ReadingBack(read_back) => self.read_back(*read_back, &mut outgoing, now),
            Phase::Preparing(commands, order) => self.prepare(commands, order, &mut outgoing, now),
            Phase::Climbing | Phase::Placing | Phase::Waiting => self.gather(start, now),
            Phase::Flying => self.fly(start, now),
            Phase::Orbiting(orbits) => self.orbit(*orbits, &mut outgoing, now),
            Phase::Landing(order) => self.land(*order, &mut outgoing, now),
            Phase::Safe(action, order) => self.stay_safe(action, *order, &mut outgoing, now),
            Phase::Ready | Phase::Over(_) => {}
        }
        self.stream(start, &mut outgoing, now);
        outgoing
    }

    fn streams_before_take_off(&self) -> bool {
        self.task.autopilot == Autopilot::Px4 && self.flight_mode() == Mode::Setpoints
    }

    /// The setpoint of this moment, if one is due.
    fn stream(&mut self, start: Option<f64>, outgoing: &mut Vec<MavMessage>, now: f64) {
        let (Some(frame), Mode::Setpoints) = (self.frame, self.flight_mode()) else { return };
        let pad = self.task.track.at(self.task.track.start());
        let (moment, whole): (Moment, bool) = match self.phase {
            // ArduCopter would break off its take-off for a setpoint.
            Phase::Preparing(..) | Phase::Climbing if self.streams_before_take_off() => (pad, false),
            Phase::Placing | Phase::Waiting => (pad, false),
            Phase::Flying => (self.task.track.at(now - start.unwrap_or(now)), true),
            _ => return,
        };
        if now < self.next_setpoint {
            return;
        }
        let period = 1.0 / self.settings.rate;
        self.next_setpoint =
            if now - self.next_setpoint > period { now + period } else { self.next_setpoint + period };
        outgoing.push(frame.setpoint(self.target(), (now * 1000.0) as u32, &moment, whole));
    }
}
