//! A session and its vehicles with a bad radio between them and time that only the test moves.

use crate::peer::{Firmware, Peer};
use crate::wire;
use ground_station::command::{LivePlan, tasks};
use ground_station::events;
use ground_station::execution::Way;
use ground_station::geodesy::Origin;
use ground_station::input::{self, MissionFile};
use ground_station::link::frames::{Decoder, frame};
use ground_station::link::pilot::Task;
use ground_station::link::session::{Event, Session};
use ground_station::link::settings::Settings;
use planner::{Options, Plan};
use std::path::Path;
use std::sync::OnceLock;

/// What the radio does to each frame.
#[derive(Clone, Copy, Default)]
pub struct Radio {
    /// Share of frames that are lost.
    pub loss: f64,
    /// Share of frames that arrive twice.
    pub twice: f64,
    /// Greatest delay (s); frames overtake each other.
    pub delay: f64,
    /// Frames that may be under way in each direction; more are lost.
    pub room: usize,
}

pub struct Air {
    pub session: Session,
    /// What follows events, where a test has some.
    pub live: Option<LivePlan>,
    pub peers: Vec<Peer>,
    pub events: Vec<Event>,
    pub time: f64,
    /// Share of the vehicles' frames whose content is rubbish, with a right checksum.
    pub rubbish: f64,
    radio: Radio,
    random: u64,
    up: Vec<(f64, u8, Vec<u8>)>,
    down: Vec<(f64, Vec<u8>)>,
    sequence: u8,
}

/// Three targets, three vehicles, inside ArduCopter's shaping limits.
pub fn mission_text(autopilot: &str) -> String {
    format!(
        r#"
        name = "three"
        origin = {{ latitude = 42.0308, longitude = -93.6319, altitude = 290.0 }}
        autopilot = "{autopilot}"
        [depot]
        position = [0.0, 0.0]
        [fleet]
        vehicles = 3
        preset = "survey-450"
        [loiter]
        radius = 2.5
        height = 2.0
        sweep = 380.0
        yaw = "at-target"
        acceleration_limit = 2.0
        [transition]
        model = "jerk-limited"
        entries = 2
        segments = 20
        [targets]
        positions = [[14.0, 6.0], [-9.0, 14.0], [3.0, -18.0]]
        "#
    )
}

/// The mission for an autopilot and its plan, planned once.
pub fn planned(firmware: Firmware) -> (MissionFile, &'static Plan) {
    static PLAN: OnceLock<Plan> = OnceLock::new();
    let word = if firmware == Firmware::ArduCopter { "ardupilot" } else { "px4" };
    let file = input::parse("three.toml", &mission_text(word), Path::new("")).expect("the mission is right");
    let plan =
        PLAN.get_or_init(|| planner::plan(&file.mission, &Options::default()).expect("it can be planned"));
    (file, plan)
}

pub fn tasks_of(firmware: Firmware, way: Way) -> (Vec<Task>, Origin) {
    let (file, plan) = planned(firmware);
    let tasks = tasks(&file, plan, way, &[], &mut |_| ()).expect("the plan belongs to the mission");
    (tasks, file.origin.expect("it has one"))
}

/// A vehicle on each pad.
pub fn peers_of(firmware: Firmware, tasks: &[Task], origin: &Origin) -> Vec<Peer> {
    let peer = |task: &Task| Peer::new(task.system, firmware, origin.geographic([task.pad[0], task.pad[1]]));
    tasks.iter().map(peer).collect()
}

impl Air {
    pub fn new(firmware: Firmware, way: Way, settings: Settings, radio: Radio, seed: u64) -> Self {
        let (tasks, origin) = tasks_of(firmware, way);
        Self {
            peers: peers_of(firmware, &tasks, &origin),
            session: Session::new(tasks, origin, settings, 0.0),
            live: None,
            events: Vec::new(),
            time: 0.0,
            rubbish: 0.0,
            radio,
            random: seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1,
            up: Vec::new(),
            down: Vec::new(),
            sequence: 0,
        }
    }

    /// The same with a plan that follows events: lines as an operator writes them.
    pub fn with_events(mut self, firmware: Firmware, events: &[&str]) -> Self {
        let (file, plan) = planned(firmware);
        let tasks: Vec<Task> = self.session.pilots().iter().map(|pilot| pilot.task().clone()).collect();
        let listed = events.iter().filter_map(|line| events::parse(line).expect("an event")).collect();
        self.live =
            Some(LivePlan::new(&file, plan.clone(), &tasks, listed, false).expect("it can follow events"));
        self
    }

    /// From 0 to 1 (xorshift).
    fn random(&mut self) -> f64 {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        (self.random >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A frame with other bytes, numbers that are none among them, and the checksum of those.
    fn damaged(&mut self, bytes: &[u8]) -> Vec<u8> {
        const STRANGE: [[u8; 4]; 5] =
            [[0, 0, 0xC0, 0x7F], [0, 0, 0x80, 0x7F], [0xFF; 4], [0xFF, 0xFF, 0x7F, 0x7F], [0, 0, 0, 0x80]];
        let (number, mut payload) = wire::read(bytes).expect("vehicles send frames");
        for _ in 0..=(3.0 * self.random()) as usize {
            let at = (self.random() * bytes.len() as f64) as usize;
            if self.random() < 0.5 {
                payload[at / 4 * 4..][..4].copy_from_slice(&STRANGE[(5.0 * self.random()) as usize]);
            } else {
                payload[at] = (256.0 * self.random()) as u8;
            }
        }
        let system = if self.random() < 0.9 { bytes[5] } else { (256.0 * self.random()) as u8 };
        wire::frame(system, bytes[4], number, &payload)
    }

    /// When copies of a frame arrive.
    fn arrivals(&mut self, under_way: usize) -> Vec<f64> {
        if self.random() < self.radio.loss || self.radio.room > 0 && under_way >= self.radio.room {
            return Vec::new();
        }
        let copies = if self.random() < self.radio.twice { 2 } else { 1 };
        (0..copies).map(|_| self.time + self.radio.delay * self.random()).collect()
    }

    /// Two hundredths of a second.
    pub fn tick(&mut self) {
        self.time += 0.02;
        if let Some(live) = &mut self.live {
            live.poll(&mut self.session, self.time);
        }
        for (system, message) in self.session.poll(self.time) {
            self.sequence = self.sequence.wrapping_add(1);
            let bytes = frame(255, 190, self.sequence, &message);
            for at in self.arrivals(self.up.len()) {
                self.up.push((at, system, bytes.clone()));
            }
        }
        self.events.extend(self.session.take_events());
        let due = self.up.extract_if(.., |(at, ..)| *at <= self.time).collect::<Vec<_>>();
        for (_, system, bytes) in due {
            self.peers.iter_mut().filter(|peer| peer.system == system).for_each(|peer| peer.receive(&bytes));
        }
        for index in 0..self.peers.len() {
            self.peers[index].advance(self.time);
            for mut bytes in self.peers[index].take() {
                if self.random() < self.rubbish {
                    bytes = self.damaged(&bytes);
                }
                for at in self.arrivals(self.down.len()) {
                    self.down.push((at, bytes.clone()));
                }
            }
        }
        let due = self.down.extract_if(.., |(at, _)| *at <= self.time).collect::<Vec<_>>();
        for (_, bytes) in due {
            for received in Decoder::default().push(&bytes) {
                self.session.receive(&received, self.time);
            }
        }
    }

    /// To the end of the session, or to `limit` (s).
    pub fn run(&mut self, limit: f64) {
        while self.time < limit && !self.session.is_over() {
            self.tick();
        }
        self.events.extend(self.session.take_events());
        assert!(self.session.is_over(), "not over after {limit} s:\n{}", self.told());
    }

    pub fn told(&self) -> String {
        let line = |event: &Event| format!("{:.2} {:?} {}\n", event.time, event.vehicle, event.text);
        self.events.iter().map(line).collect()
    }
}

/// The angle (rad, from -pi to pi) by which a bearing has turned since the last one.
pub fn turned(last: Option<f64>, bearing: f64) -> f64 {
    use std::f64::consts::TAU;
    last.map_or(0.0, |last| (bearing - last + 1.5 * TAU).rem_euclid(TAU) - 0.5 * TAU)
}
