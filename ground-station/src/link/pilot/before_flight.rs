//! On the ground: checks, the mission up and back, the commands that lead into the air.

use super::{Command, Effect, Outcome, Phase, Pilot};
use crate::execution::Way;
use crate::input::Autopilot;
use crate::link::command::{Answer, Order};
use crate::link::item::{MissionItem, difference};
use crate::link::mission::{ReadBack, Transfer, Upload};
use crate::link::modes::Mode;
use crate::link::settings::{Reach, SafeAction};
use mavlink::dialects::common::{MavCmd, MavMessage};
use std::collections::VecDeque;

/// `PX4` wants setpoints before the mode that follows them (s).
const LEAD: f64 = 1.5;

impl Pilot {
    /// Asks for what is needed, and goes on as soon as nothing speaks against it.
    pub(super) fn check(&mut self, outgoing: &mut Vec<MavMessage>, now: f64) {
        let silence = self.state.silence(now);
        if now >= self.next_request && silence.is_finite() {
            self.next_request = now + 2.0;
            outgoing.extend(self.requests(now));
        }
        let [east, north, _] = self.task.pad;
        let problems = match silence.is_finite() {
            true => self.state.problems(
                self.task.autopilot,
                &self.origin,
                [east, north],
                self.settings.least_battery,
                now,
            ),
            false => vec!["nothing heard of it".to_owned()],
        };
        if problems.is_empty() {
            self.frame = self.state.local_frame(&self.origin);
            self.ground = self.state.altitude;
            self.say(format!("checks pass{}", self.notes()));
            let next = match self.settings.reach {
                Reach::Check => Phase::Over(Outcome::Done),
                _ if self.task.items.is_empty() => Phase::Ready,
                _ => Phase::Uploading(Box::new(Upload::new(self.target(), self.task.items.clone(), now))),
            };
            self.go(next, now);
        } else if now - self.since > self.settings.check_patience {
            self.fail(problems.join("; "), now);
        }
    }

    pub(super) fn notes(&self) -> String {
        let battery =
            self.state.battery.map_or("battery unknown".to_owned(), |left| format!("battery {left} %"));
        let fence = if self.state.fence.is_some() { "geofence on" } else { "geofence off" };
        format!(" ({battery}, {fence})")
    }

    /// Position and battery several times a second, home once.
    pub(super) fn requests(&self, now: f64) -> Vec<MavMessage> {
        const LOCAL_POSITION: f32 = 32.0;
        const GLOBAL_POSITION: f32 = 33.0;
        const SYSTEM_STATUS: f32 = 1.0;
        const HOME: f32 = 242.0;
        let every = |message: f32, microseconds: f32| {
            let parameters = [message, microseconds, 0.0, 0.0, 0.0, 0.0, 0.0];
            Order::new(self.target(), MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, parameters, now).poll(now)
        };
        let once = |message: f32| {
            let parameters = [message, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            Order::new(self.target(), MavCmd::MAV_CMD_REQUEST_MESSAGE, parameters, now).poll(now)
        };
        let wanted =
            [every(LOCAL_POSITION, 1e5), every(GLOBAL_POSITION, 2e5), every(SYSTEM_STATUS, 1e6), once(HOME)];
        wanted.into_iter().flatten().collect()
    }

    pub(super) fn upload(&mut self, mut upload: Upload, outgoing: &mut Vec<MavMessage>, now: f64) {
        outgoing.extend(upload.poll(now));
        match upload.state().clone() {
            Transfer::Going => self.phase = Phase::Uploading(Box::new(upload)),
            Transfer::Failed(why) => self.fail(why, now),
            Transfer::Done(()) => {
                self.say(format!("took its mission of {} items", self.task.items.len()));
                self.go(Phase::ReadingBack(Box::new(ReadBack::new(self.target(), now))), now);
            }
        }
    }

    pub(super) fn read_back(&mut self, mut read_back: ReadBack, outgoing: &mut Vec<MavMessage>, now: f64) {
        outgoing.extend(read_back.poll(now));
        match read_back.state().clone() {
            Transfer::Going => self.phase = Phase::ReadingBack(Box::new(read_back)),
            Transfer::Failed(why) => self.fail(why, now),
            Transfer::Done(kept) => self.compare(&kept, now),
        }
    }

    /// What the vehicle kept must be what was sent; what it changed is said.
    pub(super) fn compare(&mut self, kept: &[MissionItem], now: f64) {
        let sent = self.task.items.clone();
        if kept.len() != sent.len() {
            self.fail(format!("keeps {} items of {}", kept.len(), sent.len()), now);
            return;
        }
        // ArduPilot puts its own home over item 0.
        let first = usize::from(self.task.autopilot == Autopilot::ArduPilot);
        let differences: Vec<String> = (sent.iter().zip(kept).enumerate().skip(first))
            .filter_map(|(number, (sent, kept))| difference(number, sent, kept))
            .collect();
        let grave = differences.iter().any(|text| text.contains("place") || text.contains("command"));
        self.events.extend(differences.iter().cloned());
        if grave {
            self.fail("the mission read back is another than the one sent".to_owned(), now);
            return;
        }
        self.say("mission read back and compared");
        self.go(
            if self.settings.reach >= Reach::Fly { Phase::Ready } else { Phase::Over(Outcome::Done) },
            now,
        );
    }

    pub(super) fn prepare(
        &mut self,
        mut commands: VecDeque<Command>,
        order: Option<Box<Order>>,
        outgoing: &mut Vec<MavMessage>,
        now: f64,
    ) {
        let lead = if self.streams_before_take_off() { LEAD } else { 0.0 };
        if now - self.since < lead {
            return;
        }
        let Some(first) = commands.front() else {
            let next = if self.flight_mode() == Mode::Mission { Phase::Flying } else { Phase::Climbing };
            self.say(if next == Phase::Flying { "flies its mission" } else { "takes off" });
            self.go(next, now);
            return;
        };
        let new = || Box::new(Order::new(self.target(), first.command, first.parameters, now));
        let mut order = order.unwrap_or_else(new);
        outgoing.extend(order.poll(now));
        let is_seen = match first.effect {
            Effect::Mode(mode) => self.state.mode == mode,
            Effect::Armed => self.state.is_armed,
            Effect::None => false,
        };
        if is_seen {
            order.is_seen_done();
        }
        match order.answer().clone() {
            Answer::Open => self.phase = Phase::Preparing(commands, Some(order)),
            Answer::Accepted => {
                commands.pop_front();
                self.phase = Phase::Preparing(commands, None);
            }
            Answer::Failed(why) if self.state.is_armed => self.make_safe(SafeAction::Land, &why, now),
            Answer::Failed(why) => self.fail(why, now),
        }
    }

    pub(super) fn commands(&self) -> VecDeque<Command> {
        let autopilot = self.task.autopilot;
        let mode = |mode: Mode| Command {
            command: MavCmd::MAV_CMD_DO_SET_MODE,
            parameters: mode.parameters(autopilot),
            effect: Effect::Mode(mode.number(autopilot)),
        };
        let arm = Command {
            command: MavCmd::MAV_CMD_COMPONENT_ARM_DISARM,
            parameters: [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            effect: Effect::Armed,
        };
        let height = self.task.pad[2] as f32;
        let take_off = Command {
            command: MavCmd::MAV_CMD_NAV_TAKEOFF,
            parameters: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, height],
            effect: Effect::None,
        };
        let start = Command {
            command: MavCmd::MAV_CMD_MISSION_START,
            parameters: [0.0; 7],
            effect: Effect::Mode(Mode::Mission.number(autopilot)),
        };
        // PX4 counts heights from the sea, and takes what is not a number for "here".
        let up = Command {
            parameters: [
                -1.0,
                0.0,
                0.0,
                f32::NAN,
                f32::NAN,
                f32::NAN,
                (self.ground.unwrap_or(0.0) + self.task.pad[2]) as f32,
            ],
            ..take_off.clone()
        };
        match (autopilot, self.flight_mode()) {
            (Autopilot::Px4, _) if self.task.way == Way::LiveOrbit => vec![mode(Mode::Hold), arm, up].into(),
            (Autopilot::ArduPilot, Mode::Mission) => vec![mode(Mode::Setpoints), arm, start].into(),
            (Autopilot::ArduPilot, _) => vec![mode(Mode::Setpoints), arm, take_off].into(),
            // In OFFBOARD it climbs to the setpoint that is being streamed.
            (Autopilot::Px4, flown) => vec![mode(flown), arm].into(),
        }
    }
}
