//! One command to one vehicle, repeated until it is answered; without sockets or clocks.

use super::mission::Target;
use mavlink::dialects::common::{
    COMMAND_INT_DATA, COMMAND_LONG_DATA, MavCmd, MavFrame, MavMessage, MavResult,
};

/// Silence after which a command is sent again (s).
const PATIENCE: f64 = 1.0;
/// How often, before it is given up.
const RETRIES: u8 = 8;
/// How long a vehicle may be at work on it (s).
const WORK: f64 = 30.0;

/// How a command stands.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// No answer yet.
    Open,
    /// Accepted.
    Accepted,
    /// Refused or never answered, and why.
    Failed(String),
}

/// A command under way.
#[derive(Debug, Clone, PartialEq)]
pub struct Order {
    target: Target,
    command: MavCmd,
    parameters: [f32; 7],
    /// Latitude and longitude (1e-7 degrees) for those two of the parameters: a place needs whole numbers.
    place: Option<[i32; 2]>,
    sent: u8,
    send_at: f64,
    answer: Answer,
}

impl Order {
    /// A command to be sent from `now` (s) on.
    #[must_use]
    pub fn new(target: Target, command: MavCmd, parameters: [f32; 7], now: f64) -> Self {
        Self { target, command, parameters, place: None, sent: 0, send_at: now, answer: Answer::Open }
    }

    /// A command about a place: latitude and longitude (1e-7 degrees) and height above mean sea level (m).
    #[must_use]
    pub fn at(
        target: Target,
        command: MavCmd,
        [a, b, c, d]: [f32; 4],
        (place, height): ([i32; 2], f32),
        now: f64,
    ) -> Self {
        Self { place: Some(place), ..Self::new(target, command, [a, b, c, d, 0.0, 0.0, height], now) }
    }

    /// How it stands.
    #[must_use]
    pub fn answer(&self) -> &Answer {
        &self.answer
    }

    /// What to send at `now` (s), if anything.
    pub fn poll(&mut self, now: f64) -> Option<MavMessage> {
        if self.answer != Answer::Open || now < self.send_at {
            return None;
        }
        if self.sent > RETRIES {
            self.answer = Answer::Failed(format!("no answer to {:?} after {RETRIES} retries", self.command));
            return None;
        }
        let [param1, param2, param3, param4, param5, param6, param7] = self.parameters;
        let (target_system, target_component) = self.target;
        self.sent += 1;
        self.send_at = now + PATIENCE;
        if let Some([x, y]) = self.place {
            return Some(MavMessage::COMMAND_INT(COMMAND_INT_DATA {
                param1,
                param2,
                param3,
                param4,
                x,
                y,
                z: param7,
                command: self.command,
                target_system,
                target_component,
                frame: MavFrame::MAV_FRAME_GLOBAL,
                current: 0,
                autocontinue: 0,
            }));
        }
        Some(MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            param1,
            param2,
            param3,
            param4,
            param5,
            param6,
            param7,
            command: self.command,
            target_system,
            target_component,
            confirmation: self.sent - 1,
        }))
    }

    /// Takes a message of the vehicle; answers to other commands are not for us.
    pub fn receive(&mut self, message: &MavMessage, now: f64) {
        let MavMessage::COMMAND_ACK(ack) = message else { return };
        if ack.command != self.command || self.answer != Answer::Open || self.sent == 0 {
            return;
        }
        match ack.result {
            MavResult::MAV_RESULT_ACCEPTED => self.answer = Answer::Accepted,
            MavResult::MAV_RESULT_IN_PROGRESS => self.send_at = now + WORK,
            MavResult::MAV_RESULT_TEMPORARILY_REJECTED => {
                self.answer = match self.sent > RETRIES {
                    true => Answer::Failed(format!("{:?} is refused for the time being", self.command)),
                    false => Answer::Open,
                }
            }
            refusal => self.answer = Answer::Failed(format!("{:?} is refused: {refusal:?}", self.command)),
        }
    }

    /// The vehicle shows that it has done it: the answer must have been lost.
    pub fn is_seen_done(&mut self) {
        self.answer = Answer::Accepted;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mavlink::dialects::common::COMMAND_ACK_DATA;

    const ARM: MavCmd = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM;

    fn ack(command: MavCmd, result: MavResult) -> MavMessage {
        MavMessage::COMMAND_ACK(COMMAND_ACK_DATA { command, result })
    }

    #[test]
    fn silence_is_answered_with_retries_and_then_an_end() {
        let mut order = Order::new((1, 1), ARM, [1.0; 7], 0.0);
        let sent = (0..200).filter(|tick| order.poll(f64::from(*tick) * 0.1).is_some()).count();
        assert_eq!(sent, usize::from(RETRIES) + 1);
        assert!(matches!(order.answer(), Answer::Failed(why) if why.contains("no answer")));
    }

    #[test]
    fn only_its_own_answer_counts() {
        let mut order = Order::new((1, 1), ARM, [1.0; 7], 0.0);
        order.receive(&ack(ARM, MavResult::MAV_RESULT_ACCEPTED), 0.0);
        assert_eq!(order.answer(), &Answer::Open, "an answer before the question is a late one");
        assert!(order.poll(0.0).is_some() && order.poll(0.5).is_none());
        order.receive(&ack(MavCmd::MAV_CMD_NAV_TAKEOFF, MavResult::MAV_RESULT_DENIED), 0.1);
        order.receive(&ack(ARM, MavResult::MAV_RESULT_IN_PROGRESS), 0.1);
        assert!(order.poll(20.0).is_none(), "it is at work");
        order.receive(&ack(ARM, MavResult::MAV_RESULT_ACCEPTED), 20.0);
        assert_eq!(order.answer(), &Answer::Accepted);
    }
}
