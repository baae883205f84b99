//! Vehicles for tests: what ArduCopter 4.6 and PX4 do with missions, commands and setpoints, good and bad.

use crate::follower::{Follower, Setpoint};
use crate::wire::{Fields, f32_at, frame, i32_at, read, u16_at};

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Firmware {
    ArduCopter,
    Px4,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    pub command: u16,
    pub frame: u8,
    pub parameters: [f64; 4],
    pub place: [i32; 2],
    pub height: f64,
}

/// What a test lets go wrong.
#[derive(Clone, Debug, Default)]
pub struct Trouble {
    /// Reboots once when this item arrives.
    pub reboot_at_item: Option<u16>,
    /// Acknowledges the mission after this item, as if it were the last.
    pub early_ack_at_item: Option<u16>,
    /// Denies to arm.
    pub denies_arming: bool,
    /// Denies to circle.
    pub denies_orbits: bool,
    /// Says nothing from this time on, until that one (s).
    pub mute: Option<(f64, f64)>,
    /// Battery falls to 10 % at this time (s).
    pub battery_low_at: Option<f64>,
    /// A gust carries it away from this time on (s).
    pub gust_at: Option<f64>,
    /// A pilot takes over at this time (s).
    pub taken_over_at: Option<f64>,
}

pub struct Peer {
    pub system: u8,
    pub firmware: Firmware,
    pub trouble: Trouble,
    pub mission: Vec<Item>,
    pub armed: bool,
    pub mode: u32,
    pub follower: Follower,
    /// Where it has been while armed, with the time: north, east, down in its own frame.
    pub path: Vec<(f64, [f64; 3])>,
    pub modes_seen: Vec<u32>,
    pub setpoints: usize,
    /// What a real vehicle would not have forgiven.
    pub faults: Vec<String>,
    pub completed_uploads: usize,
    /// Latitude and longitude (degrees) of its local frame's origin, and metres per degree there.
    origin: [f64; 2],
    scale: [f64; 2],
    time: f64,
    upload: Option<(u16, Vec<Item>)>,
    asked_at: f64,
    setpoint: Option<(f64, Setpoint)>,
    hold: Setpoint,
    climb_to: Option<f64>,
    /// North, east and down of the centre, radius (positive: clockwise), speed.
    orbit: ([f64; 3], f64, f64),
    rebooted_until: f64,
    sequence: u8,
    outbox: Vec<Vec<u8>>,
    next: [f64; 3],
}

const GUIDED: u32 = 4;
const AUTO: u32 = 3;
const BRAKE: u32 = 17;
const RTL: u32 = 6;
const LAND: u32 = 9;
const OFFBOARD: u32 = 6 << 16;
const PX4_MISSION: u32 = 4 << 16 | 4 << 24;
const PX4_TAKEOFF: u32 = 4 << 16 | 2 << 24;
const PX4_ORBIT: u32 = 3 << 16 | 1 << 24;
const PX4_HOLD: u32 = 4 << 16 | 3 << 24;
const PX4_RTL: u32 = 4 << 16 | 5 << 24;
const PX4_LAND: u32 = 4 << 16 | 6 << 24;

impl Peer {
    /// A vehicle on the ground at a latitude and longitude (degrees); its frame's origin lies some metres away.
    pub fn new(system: u8, firmware: Firmware, [latitude, longitude]: [f64; 2]) -> Self {
        let scale = [111_083.0, 111_320.0 * latitude.to_radians().cos()];
        let start = [1.5, -2.5, 0.3];
        Self {
            system,
            firmware,
            trouble: Trouble::default(),
            mission: Vec::new(),
            armed: false,
            mode: 0,
            follower: Follower::new(start),
            path: Vec::new(),
            modes_seen: Vec::new(),
            setpoints: 0,
            faults: Vec::new(),
            completed_uploads: 0,
            origin: [latitude - start[0] / scale[0], longitude - start[1] / scale[1]],
            scale,
            time: 0.0,
            upload: None,
            asked_at: 0.0,
            setpoint: None,
            hold: Setpoint { position: start, ..Setpoint::default() },
            climb_to: None,
            orbit: ([0.0; 3], 1.0, 0.0),
            rebooted_until: 0.0,
            sequence: 0,
            outbox: Vec::new(),
            next: [0.0; 3],
        }
    }

    fn send(&mut self, number: u32, fields: Fields) {
        self.sequence = self.sequence.wrapping_add(1);
        self.outbox.push(frame(self.system, self.sequence, number, &fields.0));
    }

    fn is_mute(&self) -> bool {
        self.time < self.rebooted_until
            || self.trouble.mute.is_some_and(|(from, to)| self.time >= from && self.time < to)
    }

    /// What it sends since the last call.
    pub fn take(&mut self) -> Vec<Vec<u8>> {
        let frames = std::mem::take(&mut self.outbox);
        if self.is_mute() { Vec::new() } else { frames }
    }

    pub fn ground(&self) -> f64 {
        0.3
    }

    /// Moves on to `time` (s).
    pub fn advance(&mut self, time: f64) {
        while self.time < time {
            self.time += 0.01;
            self.fly(0.01);
        }
        self.trouble_in_the_air();
        if self.time >= self.next[0] {
            self.next[0] = self.time + 1.0;
            self.say_status();
        }
        if self.time >= self.next[1] {
            self.next[1] = self.time + 0.1;
            self.say_position();
        }
        // A request that was not answered is repeated.
        if self.upload.is_some() && self.time - self.asked_at > 0.7 {
            self.ask();
        }
    }

    fn set_mode(&mut self, mode: u32) {
        self.mode = mode;
        self.modes_seen.push(mode);
        self.hold = Setpoint { position: self.follower.position, ..Setpoint::default() };
    }

    fn trouble_in_the_air(&mut self) {
        if self.trouble.taken_over_at.is_some_and(|at| self.time >= at) {
            self.trouble.taken_over_at = None;
            self.set_mode(5);
        }
        if self.trouble.gust_at.is_some_and(|at| self.time >= at && self.time < at + 2.0) {
            self.follower.position[0] += 0.2;
        }
    }

    fn fly(&mut self, dt: f64) {
        if !self.armed {
            return;
        }
        self.path.push((self.time, self.follower.position));
        let ground = self.ground();
        let mut wanted = self.hold;
        match self.mode {
            GUIDED | OFFBOARD => {
                if let Some(height) = self.climb_to {
                    wanted.position[2] = ground - height;
                    if self.follower.position[2] < wanted.position[2] + 0.1 {
                        self.climb_to = None;
                        self.hold = wanted;
                    }
                } else if let Some((at, setpoint)) = self.setpoint {
                    let patience = if self.firmware == Firmware::ArduCopter { 3.0 } else { 0.5 };
                    if self.time - at <= patience {
                        wanted = setpoint;
                    } else {
                        self.setpoint = None;
                        self.hold = Setpoint { position: self.follower.position, ..Setpoint::default() };
                        if self.firmware == Firmware::Px4 {
                            self.set_mode(PX4_HOLD);
                        }
                    }
                }
            }
            PX4_TAKEOFF => {
                wanted.position[2] = ground - self.climb_to.unwrap_or(0.0);
                if self.follower.position[2] < wanted.position[2] + 0.1 {
                    self.climb_to = None;
                    self.set_mode(PX4_HOLD);
                    self.hold = wanted;
                }
            }
            PX4_ORBIT => wanted = self.on_orbit(),
            AUTO | PX4_MISSION | RTL | PX4_RTL | LAND | PX4_LAND => {
                wanted.position[2] = ground + 1.0;
                if self.follower.position[2] >= ground - 0.05 {
                    self.armed = false;
                    self.follower.velocity = [0.0; 3];
                }
            }
            _ => {}
        }
        self.follower.step(&wanted, dt);
        self.follower.position[2] = self.follower.position[2].min(ground);
    }

    fn say_status(&mut self) {
        let (autopilot, armed) = if self.firmware == Firmware::ArduCopter { (3, 128) } else { (12, 128) };
        let base = 1 | if self.armed { armed } else { 0 };
        self.send(0, Fields::default().u32s(&[self.mode]).u8s(&[2, autopilot, base, 4, 3]));
        let low = self.trouble.battery_low_at.is_some_and(|at| self.time >= at);
        let battery = if low { 10 } else { 90 };
        self.send(
            1,
            Fields::default()
                .u32s(&[0x1000_0000, 0, 0x1000_0000])
                .u16s(&[0, 12000, 0, 0, 0, 0, 0, 0, 0])
                .u8s(&[battery]),
        );
    }

    fn say_position(&mut self) {
        let milliseconds = (self.time * 1000.0) as u32;
        let (position, velocity) = (self.follower.position, self.follower.velocity);
        self.send(32, Fields::default().u32s(&[milliseconds]).f32s(&position).f32s(&velocity));
        let degrees =
            [0, 1].map(|axis| ((self.origin[axis] + position[axis] / self.scale[axis]) * 1e7).round() as i32);
        self.send(
            33,
            Fields::default().u32s(&[milliseconds]).i32s(&[degrees[0], degrees[1], 290_000, 0]).u16s(&[0; 4]),
        );
    }

    /// Takes a frame from the ground station.
    pub fn receive(&mut self, bytes: &[u8]) {
        if self.is_mute() {
            return;
        }
        let Some((number, payload)) = read(bytes) else {
            self.faults.push(format!("not a frame that this vehicle knows: {bytes:?}"));
            return;
        };
        match number {
            43 => self.send_count(),
            44 => self.begin_upload(u16_at(&payload, 0)),
            47 => {}
            51 => self.send_item(u16_at(&payload, 0)),
            73 => self.take_item(&payload),
            75 => self.command_at_a_place(&payload),
            76 => self.command(&payload),
            84 => self.take_setpoint(&payload),
            _ => {}
        }
    }

    fn begin_upload(&mut self, count: u16) {
        self.upload = Some((count, Vec::new()));
        self.ask();
    }

    fn ask(&mut self) {
        let Some((_, items)) = &self.upload else { return };
        self.asked_at = self.time;
        // ArduCopter asks by the old name.
        let number = if self.firmware == Firmware::ArduCopter { 40 } else { 51 };
        let next = items.len() as u16;
        self.send(number, Fields::default().u16s(&[next]).u8s(&[255, 190]));
    }

    fn acknowledge(&mut self, result: u8) {
        self.send(47, Fields::default().u8s(&[255, 190, result]));
    }

    fn take_item(&mut self, payload: &[u8]) {
        let number = u16_at(payload, 28);
        if self.trouble.reboot_at_item == Some(number) {
            self.trouble.reboot_at_item = None;
            self.upload = None;
            self.rebooted_until = self.time + 3.0;
            return;
        }
        let Some((_, items)) = &mut self.upload else { return };
        if usize::from(number) != items.len() {
            return;
        }
        let item = Item {
            command: u16_at(payload, 30),
            frame: payload[34],
            parameters: [0, 4, 8, 12].map(|place| f32_at(payload, place)),
            place: [i32_at(payload, 16), i32_at(payload, 20)],
            height: f32_at(payload, 24),
        };
        if self.firmware == Firmware::Px4 && [18, 34].contains(&item.command) {
            self.upload = None;
            self.acknowledge(3);
            return;
        }
        items.push(stored(self.firmware, &item));
        if self.trouble.early_ack_at_item == Some(number) {
            self.trouble.early_ack_at_item = None;
            self.acknowledge(0);
        }
        let Some((_, items)) = self.upload.take_if(|(count, items)| items.len() == usize::from(*count))
        else {
            self.ask();
            return;
        };
        self.mission = items;
        self.completed_uploads += 1;
        if self.firmware == Firmware::ArduCopter {
            self.mission[0].place = [1, 2];
        }
        self.acknowledge(0);
    }

    fn send_count(&mut self) {
        let count = self.mission.len() as u16;
        self.send(44, Fields::default().u16s(&[count]).u8s(&[255, 190]));
    }

    fn send_item(&mut self, number: u16) {
        let Some(item) = self.mission.get(usize::from(number)).cloned() else { return };
        let fields = Fields::default().f32s(&item.parameters).i32s(&item.place).f32s(&[item.height]);
        self.send(73, fields.u16s(&[number, item.command]).u8s(&[255, 190, item.frame, 0, 1]));
    }

    fn command(&mut self, payload: &[u8]) {
        let command = u16_at(payload, 28);
        let parameter = |index: usize| f32_at(payload, 4 * index);
        let result = match command {
            176 => self.change_mode(parameter(1) as u32, parameter(2) as u32),
            400 if self.trouble.denies_arming => 4,
            400 => {
                self.armed = true;
                self.hold = Setpoint { position: self.follower.position, ..Setpoint::default() };
                0
            }
            22 if !self.armed => 4,
            22 if self.firmware == Firmware::Px4 => {
                self.set_mode(PX4_TAKEOFF);
                self.climb_to = Some(parameter(6) - 290.0);
                0
            }
            22 => {
                self.climb_to = Some(parameter(6));
                0
            }
            300 => {
                self.set_mode(if self.firmware == Firmware::ArduCopter { AUTO } else { PX4_MISSION });
                // Its mission is flown in no time at all: up, and on its way down.
                self.follower.position[2] = self.ground() - 2.0;
                0
            }
            511 => 0,
            512 => {
                self.send(242, Fields::default().i32s(&[1, 1, 0]).f32s(&[0.0; 10]));
                0
            }
            _ => 3,
        };
        self.send(77, Fields::default().u16s(&[command]).u8s(&[result]));
    }

    /// A command with a place, heights above the sea; only PX4 knows these.
    fn command_at_a_place(&mut self, payload: &[u8]) {
        let (command, frame) = (u16_at(payload, 28), payload[32]);
        let degrees = [16, 20].map(|place| f64::from(i32_at(payload, place)) / 1e7);
        let [north, east] = [0, 1].map(|axis| (degrees[axis] - self.origin[axis]) * self.scale[axis]);
        let place = [north, east, self.ground() - (f32_at(payload, 24) - 290.0)];
        let result = match command {
            _ if self.firmware != Firmware::Px4 || frame != 0 => 3,
            192 if self.armed => {
                self.set_mode(PX4_HOLD);
                self.hold = Setpoint { position: place, ..Setpoint::default() };
                0
            }
            34 if self.armed && !self.trouble.denies_orbits && f32_at(payload, 0).abs() >= 1.0 => {
                self.set_mode(PX4_ORBIT);
                self.orbit = (place, f32_at(payload, 0), f32_at(payload, 4));
                0
            }
            34 | 192 => 2,
            _ => 3,
        };
        self.send(77, Fields::default().u16s(&[command]).u8s(&[result]));
    }

    /// A moment a little ahead on the circle.
    fn on_orbit(&self) -> Setpoint {
        let (centre, radius, speed) = self.orbit;
        let [north, east] = [0, 1].map(|axis| self.follower.position[axis] - centre[axis]);
        let rate = speed.min((2.0 * radius.abs()).sqrt()) / radius;
        let (sin, cos) = (east.atan2(north) + 0.1 * rate).sin_cos();
        let r = radius.abs();
        Setpoint {
            position: [centre[0] + r * cos, centre[1] + r * sin, centre[2]],
            velocity: [-r * rate * sin, r * rate * cos, 0.0],
            acceleration: [-r * rate * rate * cos, -r * rate * rate * sin, 0.0],
        }
    }

    fn change_mode(&mut self, main: u32, sub: u32) -> u8 {
        let mode = if self.firmware == Firmware::Px4 { main << 16 | sub << 24 } else { main };
        let known: &[u32] = match self.firmware {
            Firmware::ArduCopter => &[GUIDED, AUTO, BRAKE, RTL, LAND],
            Firmware::Px4 => &[OFFBOARD, PX4_MISSION, PX4_HOLD, PX4_RTL, PX4_LAND],
        };
        // PX4 wants setpoints before it follows them.
        let hears_setpoints = self.setpoint.is_some_and(|(at, _)| self.time - at < 0.5);
        if !known.contains(&mode) || mode == OFFBOARD && !hears_setpoints {
            return 2;
        }
        self.set_mode(mode);
        if mode == PX4_MISSION {
            self.follower.position[2] = self.ground() - 2.0;
        }
        0
    }

    fn take_setpoint(&mut self, payload: &[u8]) {
        let mask = u16_at(payload, 48);
        let three = |place: usize| [0, 4, 8].map(|next| f32_at(payload, place + next));
        let mut setpoint = Setpoint { position: three(4), velocity: three(16), acceleration: three(28) };
        match mask {
            2048 => {}
            2552 => (setpoint.velocity, setpoint.acceleration) = ([0.0; 3], [0.0; 3]),
            other => self.faults.push(format!("type mask {other}")),
        }
        let Setpoint { position, velocity, acceleration } = setpoint;
        if [position, velocity, acceleration].iter().flatten().any(|value| !value.is_finite()) {
            self.faults.push(format!("a setpoint that is none: {setpoint:?}"));
        }
        if payload[52] != 1 {
            self.faults.push(format!("frame {}", payload[52]));
        }
        if self.climb_to.is_some() && self.firmware == Firmware::ArduCopter {
            self.faults.push("a setpoint breaks off the take-off".to_owned());
        }
        self.setpoints += 1;
        self.setpoint = Some((self.time, setpoint));
    }
}

/// What the firmware makes of an item: ArduCopter has one byte for a radius and one for turns.
fn stored(firmware: Firmware, item: &Item) -> Item {
    let mut kept = item.clone();
    if firmware == Firmware::ArduCopter {
        kept.parameters = kept.parameters.map(|value| if value.is_nan() { 0.0 } else { value });
        if item.command == 18 {
            let turns = item.parameters[0];
            kept.parameters[0] = if turns < 1.0 { (turns * 256.0).floor() / 256.0 } else { turns.trunc() };
            kept.parameters[2] = item.parameters[2].trunc();
        }
    }
    kept
}
