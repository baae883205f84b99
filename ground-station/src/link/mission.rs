//! The mission protocol as two machines without sockets or clocks: [`Upload`] and [`ReadBack`].
//!
//! Both are asked with the time what to send now ([`poll`](Upload::poll)) and told what arrived. A message that does not
//! fit is ignored, so that duplicates and late ones do no harm; silence leads to retries, and those to an end.

use super::item::MissionItem;
use mavlink::dialects::common::{
    MISSION_ACK_DATA, MISSION_COUNT_DATA, MISSION_ITEM_INT_DATA, MISSION_REQUEST_INT_DATA,
    MISSION_REQUEST_LIST_DATA, MavCmd, MavFrame, MavMessage, MavMissionResult,
};
use std::collections::VecDeque;

/// Silence after which the last message is sent again (s).
const PATIENCE: f64 = 0.7;
/// How often, before an upload begins anew or reading back is given up.
const RETRIES: usize = 6;
const READ_RETRIES: usize = 12;
/// How often an upload begins: after a refusal that may pass, in a vehicle that forgot it, or whose last word was lost.
const ATTEMPTS: usize = 8;

/// How a transfer stands.
#[derive(Debug, Clone, PartialEq)]
pub enum Transfer<T> {
    /// Still going.
    Going,
    /// Done.
    Done(T),
    /// Given up, and why in plain words.
    Failed(String),
}

/// To whom: system and component.
pub type Target = (u8, u8);

/// Sends a mission: `COUNT`, then each item as it is asked for, until the vehicle acknowledges the whole.
#[derive(Debug, Clone, PartialEq)]
pub struct Upload {
    target: Target,
    items: Vec<MissionItem>,
    outgoing: VecDeque<MavMessage>,
    /// What silence repeats: `None` for the count.
    last_item: Option<u16>,
    deadline: f64,
    retries: usize,
    attempts: usize,
    state: Transfer<()>,
}

impl Upload {
    /// Begins an upload at `now` (s).
    #[must_use]
    pub fn new(target: Target, items: Vec<MissionItem>, now: f64) -> Self {
        let state = match u16::try_from(items.len()) {
            Ok(1..) => Transfer::Going,
            _ => Transfer::Failed(format!("a mission of {} items cannot be sent", items.len())),
        };
        let mut upload = Self {
            target,
            items,
            outgoing: VecDeque::new(),
            last_item: None,
            deadline: now,
            retries: 0,
            attempts: 0,
            state,
        };
        upload.begin(now);
        upload
    }

    /// How it stands.
    #[must_use]
    pub fn state(&self) -> &Transfer<()> {
        &self.state
    }

    /// The next message to send at `now` (s), if there is one.
    pub fn poll(&mut self, now: f64) -> Option<MavMessage> {
        if self.state != Transfer::Going {
            return None;
        }
        if self.outgoing.is_empty() && now >= self.deadline {
            self.repeat(now);
        }
        self.outgoing.pop_front()
    }

    /// Silence: the last message again; after some of those the whole upload again, since the vehicle may have forgotten it.
    fn repeat(&mut self, now: f64) {
        self.retries += 1;
        if self.retries <= RETRIES {
            self.deadline = now + PATIENCE;
            self.outgoing.push_back(self.last_item.map_or_else(|| self.count(), |item| self.item(item)));
        } else if self.attempts < ATTEMPTS {
            self.begin(now);
        } else {
            let what =
                self.last_item.map_or("the count of the mission".to_owned(), |item| format!("item {item}"));
            self.state = Transfer::Failed(format!(
                "no answer to {what}, in {ATTEMPTS} attempts with {RETRIES} retries each"
            ));
        }
    }

    /// Takes a message of the vehicle.
    pub fn receive(&mut self, message: &MavMessage, now: f64) {
        if self.state != Transfer::Going {
            return;
        }
        match message {
            MavMessage::MISSION_REQUEST_INT(request) => self.requested(request.seq, now),
            // Older ArduPilots ask by the old name and take the new answer.
            #[allow(deprecated)]
            MavMessage::MISSION_REQUEST(request) => self.requested(request.seq, now),
            MavMessage::MISSION_ACK(ack) => self.acknowledged(ack.mavtype, now),
            _ => {}
        }
    }

    fn requested(&mut self, number: u16, now: f64) {
        if usize::from(number) >= self.items.len() {
            return;
        }
        self.last_item = Some(number);
        self.heard(now);
        let item = self.item(number);
        self.outgoing.push_back(item);
    }

    fn acknowledged(&mut self, result: MavMissionResult, now: f64) {
        let all_asked = self.last_item.is_some_and(|item| usize::from(item) + 1 == self.items.len());
        match result {
            MavMissionResult::MAV_MISSION_ACCEPTED if all_asked => self.state = Transfer::Done(()),
            // An acknowledgement of something else, or of an upload that a reboot cut short.
            MavMissionResult::MAV_MISSION_ACCEPTED => {}
            // Left from an earlier transfer, or a busy vehicle: worth another attempt.
            MavMissionResult::MAV_MISSION_ERROR
            | MavMissionResult::MAV_MISSION_INVALID_SEQUENCE
            | MavMissionResult::MAV_MISSION_OPERATION_CANCELLED
            | MavMissionResult::MAV_MISSION_DENIED
                if self.attempts < ATTEMPTS =>
            {
                self.begin(now);
            }
            refusal => self.state = Transfer::Failed(self.refused(refusal)),
        }
    }

    fn refused(&self, result: MavMissionResult) -> String {
        let item = self.last_item.map_or(String::new(), |item| {
            let command = self.items.get(usize::from(item)).map_or(0, |item| item.command);
            format!(" at item {item} (command {command})")
        });
        format!("the vehicle refuses the mission{item}: {result:?}")
    }

    fn begin(&mut self, now: f64) {
        self.attempts += 1;
        self.last_item = None;
        self.outgoing.clear();
        let count = self.count();
        self.outgoing.push_back(count);
        self.heard(now);
    }

    fn heard(&mut self, now: f64) {
        self.retries = 0;
        self.deadline = now + PATIENCE;
    }

    fn count(&self) -> MavMessage {
        let (target_system, target_component) = self.target;
        // The constructor has checked the length.
        let count = self.items.len() as u16;
        MavMessage::MISSION_COUNT(MISSION_COUNT_DATA { count, target_system, target_component })
    }

    fn item(&self, number: u16) -> MavMessage {
        let (target_system, target_component) = self.target;
        let item = &self.items[usize::from(number)];
        let [param1, param2, param3, param4] = item.parameters;
        MavMessage::MISSION_ITEM_INT(MISSION_ITEM_INT_DATA {
            param1,
            param2,
            param3,
            param4,
            x: item.place[0],
            y: item.place[1],
            z: item.height,
            seq: number,
            command: command(item.command),
            target_system,
            target_component,
            frame: frame(item.frame),
            current: u8::from(number == 0),
            autocontinue: 1,
        })
    }
}

/// The commands that our missions hold.
fn command(number: u16) -> MavCmd {
    use MavCmd::{
        MAV_CMD_DO_CHANGE_SPEED, MAV_CMD_DO_SET_ROI_LOCATION, MAV_CMD_DO_SET_ROI_NONE, MAV_CMD_NAV_LAND,
        MAV_CMD_NAV_LOITER_TURNS, MAV_CMD_NAV_TAKEOFF, MAV_CMD_NAV_WAYPOINT,
    };
    let known = [
        MAV_CMD_NAV_LOITER_TURNS,
        MAV_CMD_NAV_LAND,
        MAV_CMD_NAV_TAKEOFF,
        MAV_CMD_DO_CHANGE_SPEED,
        MAV_CMD_DO_SET_ROI_LOCATION,
        MAV_CMD_DO_SET_ROI_NONE,
    ];
    known.into_iter().find(|&command| command as u16 == number).unwrap_or(MAV_CMD_NAV_WAYPOINT)
}

/// The frames that our missions have. They have newer names, but older autopilots know these only.
#[allow(deprecated)]
fn frame(number: u8) -> MavFrame {
    use MavFrame::{MAV_FRAME_GLOBAL_INT, MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, MAV_FRAME_MISSION};
    let known = [MAV_FRAME_MISSION, MAV_FRAME_GLOBAL_INT];
    known.into_iter().find(|&frame| frame as u8 == number).unwrap_or(MAV_FRAME_GLOBAL_RELATIVE_ALT_INT)
}

/// Asks a vehicle for its mission: `REQUEST_LIST`, then item after item, and acknowledges the whole.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadBack {
    target: Target,
    count: Option<u16>,
    items: Vec<MissionItem>,
    deadline: f64,
    retries: usize,
    ask_now: bool,
    acknowledge: bool,
    state: Transfer<Vec<MissionItem>>,
}

impl ReadBack {
    /// Begins at `now` (s).
    #[must_use]
    pub fn new(target: Target, now: f64) -> Self {
        Self {
            target,
            count: None,
            items: Vec::new(),
            deadline: now + PATIENCE,
            retries: 0,
            ask_now: true,
            acknowledge: false,
            state: Transfer::Going,
        }
    }

    /// How it stands; with the items once it is done.
    #[must_use]
    pub fn state(&self) -> &Transfer<Vec<MissionItem>> {
        &self.state
    }

    /// The next message to send at `now` (s), if there is one.
    pub fn poll(&mut self, now: f64) -> Option<MavMessage> {
        let (target_system, target_component) = self.target;
        if std::mem::take(&mut self.acknowledge) {
            let mavtype = MavMissionResult::MAV_MISSION_ACCEPTED;
            return Some(MavMessage::MISSION_ACK(MISSION_ACK_DATA {
                target_system,
                target_component,
                mavtype,
            }));
        }
        if self.state != Transfer::Going {
            return None;
        }
        if now >= self.deadline {
            self.retries += 1;
            self.ask_now = true;
            if self.retries > READ_RETRIES {
                self.state = Transfer::Failed(format!(
                    "the mission cannot be read back: silence after item {}",
                    self.items.len()
                ));
                return None;
            }
        }
        if !std::mem::take(&mut self.ask_now) {
            return None;
        }
        self.deadline = now + PATIENCE;
        Some(match self.count {
            None => MavMessage::MISSION_REQUEST_LIST(MISSION_REQUEST_LIST_DATA {
                target_system,
                target_component,
            }),
            Some(_) => {
                let seq = self.items.len() as u16;
                MavMessage::MISSION_REQUEST_INT(MISSION_REQUEST_INT_DATA {
                    seq,
                    target_system,
                    target_component,
                })
            }
        })
    }

    /// Takes a message of the vehicle.
    pub fn receive(&mut self, message: &MavMessage) {
        if self.state != Transfer::Going {
            return;
        }
        match (message, self.count) {
            (MavMessage::MISSION_COUNT(count), None) => {
                self.count = Some(count.count);
                self.heard();
            }
            (MavMessage::MISSION_ITEM_INT(item), Some(_)) if usize::from(item.seq) == self.items.len() => {
                self.items.push(MissionItem::of_message(item));
                self.heard();
            }
            _ => {}
        }
    }

    fn heard(&mut self) {
        self.retries = 0;
        self.ask_now = true;
        if self.count.is_some_and(|count| self.items.len() >= usize::from(count)) {
            self.ask_now = false;
            self.acknowledge = true;
            self.state = Transfer::Done(std::mem::take(&mut self.items));
        }
    }
}
