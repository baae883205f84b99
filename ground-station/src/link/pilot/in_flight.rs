//! In the air: to the start, along the plan, down again, and what can go wrong.

use super::{NEAR, Orbits, Outcome, PATIENCE, Phase, Pilot, SLOW};
use crate::execution::Way;
use crate::link::command::{Answer, Order};
use crate::link::modes::Mode;
use crate::link::settings::SafeAction;
use mavlink::dialects::common::MavMessage;

/// A speed at which a take-off is over (m/s).
const STILL: f64 = 0.1;
/// After this time a heartbeat knows of what was commanded before (s).
const SETTLED: f64 = 2.0;

impl Pilot {
    /// Up, to the start of the plan, and there until the fleet starts.
    pub(super) fn gather(&mut self, start: Option<f64>, now: f64) {
        let Some([east, north, up]) = self.position() else { return };
        let wanted = self.task.track.at(self.task.track.start()).position;
        let away = (east - wanted[0]).hypot(north - wanted[1]).hypot(up - wanted[2]);
        match self.phase {
            // Height above the pad counts from its own ground.
            Phase::Climbing if self.task.way == Way::LiveOrbit => {
                let is_up = up > self.task.pad[2] - NEAR && self.is_in(Mode::Hold);
                if is_up && self.state.speed < STILL {
                    let orbits = Orbits::new(&self.task.circles, self.task.pad, now);
                    self.go(Phase::Orbiting(Box::new(orbits)), now);
                } else if now - self.since > PATIENCE {
                    self.make_safe(SafeAction::Land, "does not climb to its height", now);
                }
            }
            Phase::Climbing if up > self.task.pad[2] - NEAR / 2.0 && self.state.speed < STILL => {
                self.go(Phase::Placing, now)
            }
            Phase::Placing if away < NEAR && self.state.speed < SLOW => {
                self.say("is at the start of its plan");
                self.go(Phase::Waiting, now);
            }
            Phase::Waiting if start.is_some_and(|start| now >= start) => {
                self.say("flies its plan");
                self.go(Phase::Flying, now);
            }
            Phase::Climbing | Phase::Placing if now - self.since > PATIENCE => {
                self.make_safe(SafeAction::Land, "does not get to the start of its plan", now);
            }
            _ => {}
        }
    }

    pub(super) fn fly(&mut self, start: Option<f64>, now: f64) {
        /// How long the last hover is held before the landing (s).
        const LAST_HOVER: f64 = 2.0;
        if self.flight_mode() == Mode::Mission {
            // Its mission ends with a landing, after which it disarms by itself.
            if self.state.is_disarmed_after(self.since + SETTLED) {
                self.say("landed");
                self.go(Phase::Over(Outcome::Done), now);
            }
            return;
        }
        if start.is_some_and(|start| now - start > self.task.track.end() + LAST_HOVER) {
            self.say("has flown its plan; lands");
            let order = self.mode_order(Mode::Land, now);
            self.go(Phase::Landing(Box::new(order)), now);
        }
    }

    pub(super) fn land(&mut self, mut order: Order, outgoing: &mut Vec<MavMessage>, now: f64) {
        if self.is_in(Mode::Land) {
            order.is_seen_done();
        }
        outgoing.extend(order.poll(now));
        if self.state.is_disarmed_after(self.since) {
            self.say("landed");
            self.go(Phase::Over(Outcome::Done), now);
        } else if let Answer::Failed(why) = order.answer().clone() {
            self.make_safe(SafeAction::Return, &why, now);
        } else if !self.is_out_of_hand(Mode::Land, &order, now) {
            self.phase = Phase::Landing(Box::new(order));
        }
    }

    /// Repeats the command until the vehicle shows that it obeys; on the ground its part is over.
    pub(super) fn stay_safe(
        &mut self,
        action: SafeAction,
        mut order: Order,
        outgoing: &mut Vec<MavMessage>,
        now: f64,
    ) {
        let has_link = self.state.silence(now) < self.settings.link_timeout;
        if self.is_in(action.mode()) && has_link {
            if !std::mem::replace(&mut self.has_obeyed, true) {
                self.say(format!("obeys: {}", action.mode().name(self.task.autopilot)));
            }
            order.is_seen_done();
        } else if matches!(order.answer(), Answer::Failed(_)) {
            order = self.mode_order(action.mode(), now);
        }
        if has_link && self.is_out_of_hand(action.mode(), &order, now) {
            return;
        }
        outgoing.extend(order.poll(now));
        self.phase = Phase::Safe(action, Box::new(order));
        let waited = now - self.since;
        if self.state.is_disarmed_after(self.since + SETTLED) {
            self.say("is on the ground");
            self.go(Phase::Over(Outcome::CutShort), now);
        } else if action == SafeAction::Hold && waited > self.settings.hold_patience {
            self.make_safe(SafeAction::Return, "has held long enough", now);
        } else if !has_link && waited > self.settings.hold_patience + PATIENCE {
            self.fail("the link did not come back; the vehicle was last told to stop".to_owned(), now);
        }
    }

    /// Whether someone else changed a mode that had been taken; then the link lets go.
    fn is_out_of_hand(&mut self, mode: Mode, order: &Order, now: f64) -> bool {
        /// Longer than a few heartbeats can be lost (s).
        const GRACE: f64 = 4.0;
        if self.is_in(mode) || order.answer() != &Answer::Accepted {
            self.stray_since = None;
            return false;
        }
        let since = *self.stray_since.get_or_insert(now);
        let is_stray = now - since > GRACE;
        if is_stray {
            self.fail("someone else changed its mode: hands off".to_owned(), now);
        }
        is_stray
    }

    /// What can go wrong in the air.
    pub(super) fn watch(&mut self, start: Option<f64>, now: f64) {
        let is_safe = matches!(self.phase, Phase::Safe(..));
        let silence = self.state.silence(now);
        if silence > self.settings.link_timeout {
            if !is_safe {
                let why = format!("link lost for {silence:.1} s");
                self.make_safe(self.settings.on_link_loss, &why, now);
            }
            return;
        }
        if is_safe || matches!(self.phase, Phase::Landing(_)) {
            return;
        }
        if let Some(left) = self.state.battery.filter(|&left| left < self.settings.return_battery) {
            self.make_safe(SafeAction::Return, &format!("battery at {left} %"), now);
            return;
        }
        self.watch_mode(now);
        self.watch_deviation(start, now);
    }

    /// Another hand on the vehicle: a pilot with a remote control, or its own failsafe. It has the last word.
    pub(super) fn watch_mode(&mut self, now: f64) {
        const GRACE: f64 = 1.5;
        if self.is_in(self.flight_mode()) && self.state.is_armed || now - self.since < GRACE {
            self.stray_since = None;
            return;
        }
        // A mission that has landed disarms; that is seen elsewhere.
        if self.flight_mode() == Mode::Mission && !self.state.is_armed {
            return;
        }
        let since = *self.stray_since.get_or_insert(now);
        if now - since > GRACE {
            let what =
                if self.state.is_armed { "someone else changed its mode" } else { "it disarmed in flight" };
            self.fail(format!("{what}: hands off"), now);
        }
    }

    pub(super) fn watch_deviation(&mut self, start: Option<f64>, now: f64) {
        /// What a vehicle and the link may be late (s).
        const WINDOW: f64 = 1.0;
        let (Phase::Flying, Mode::Setpoints) = (&self.phase, self.flight_mode()) else { return };
        let (Some(start), Some(position), Some((at, _))) = (start, self.position(), self.state.local) else {
            return;
        };
        let away = self.task.track.deviation(position, at - start, WINDOW);
        if away > self.settings.deviation {
            self.make_safe(self.settings.on_deviation, &format!("{away:.1} m from its plan"), now);
        }
    }
}
