//! The settings of a mission: `[depot]`, `[fleet]`, `[camera]`, `[loiter]` and `[transition]`.

use super::range::Range;
use super::reader::{Reader, Section};
use super::targets::{Frame, position};
use super::vehicle;
use crate::words::{MODELS, TRANSCRIPTIONS};
use planner::quad_dynamics::Camera;
use planner::{
    CameraSettings, Entries, Environment, Fleet, LoiterSettings, LoiterYaw, ShapingLimits, TransitionSettings,
};

/// Words for [`LoiterYaw`].
const YAWS: [(&str, LoiterYaw); 2] =
    [("along-track", LoiterYaw::AlongTrack), ("at-target", LoiterYaw::AtTarget)];
/// More vehicles than this are a slip of the keyboard.
const MOST_VEHICLES: u64 = 1000;
/// Ten turns (degrees): more overlap than any camera wants.
const MOST_SWEEP: f64 = 3600.0;

/// `[depot]`; where it is must be said.
pub fn depot(root: &Section<'_, '_>, frame: Frame) -> Option<[f64; 2]> {
    let section = root.section("depot");
    let place = position(&section, frame);
    section.finish();
    place
}

/// `[fleet]` and `[vehicle]`, and the time to swap a battery; how many vehicles there are must be said.
pub fn fleet(root: &Section<'_, '_>, reader: &Reader<'_>) -> Option<(Fleet, Option<f64>)> {
    let section = root.section("fleet");
    let swap_time = section.number("swap_time", Range::NOT_NEGATIVE);
    let vehicles = section.count("vehicles", 1, MOST_VEHICLES);
    if !section.has("vehicles") {
        section.missing("vehicles", "give the number of vehicles, at least 1");
    }
    let preset = section.item("preset");
    let vehicle = vehicle::read(root, reader, preset.as_ref());
    let fleet = vehicle.map(|vehicle| Fleet {
        vehicles: vehicles.and_then(|vehicles| usize::try_from(vehicles).ok()).unwrap_or(1),
        vehicle,
        separation: section.number("separation", Range::NOT_NEGATIVE).unwrap_or(3.0),
        endurance: section.number("endurance", Range::POSITIVE).unwrap_or(f64::INFINITY),
    });
    section.finish();
    fleet.map(|fleet| (fleet, swap_time))
}

/// `[camera]`; angles in degrees. Nothing without the table.
pub fn camera(root: &Section<'_, '_>) -> Option<CameraSettings> {
    const VIEWS: Range = Range::between(1.0, 179.0);
    const ANGLES: Range = Range::between(-180.0, 180.0);
    const MOUNTS: [(&str, bool); 2] = [("fixed", false), ("gimbal", true)];
    let section = root.section("camera");
    let angle = |key, range| section.number(key, range).map(f64::to_radians);
    let views = ["horizontal_view", "vertical_view"].map(|key| {
        if section.is_present() && !section.has(key) {
            section.missing(key, "give the whole angles of view across and up and down, in degrees");
        }
        angle(key, VIEWS)
    });
    let [yaw, pitch] = ["mount_yaw", "mount_pitch"].map(|key| angle(key, ANGLES).unwrap_or(0.0));
    let is_stabilised = section.choice("mount", &MOUNTS).unwrap_or(false);
    let target_height = section.number("target_height", Range::NOT_NEGATIVE).unwrap_or(0.0);
    section.finish();
    let [across, up] = views;
    // What the ranges above let through is a camera.
    let camera = Camera::new(across?, up?).ok()?.with_mount(yaw, pitch).with_stabilised(is_stabilised);
    Some(CameraSettings { camera, target_height })
}

/// `[environment]`: the steady wind that is planned for.
pub fn environment(root: &Section<'_, '_>) -> Environment {
    // A hurricane; what the vehicle can fly in is the planner's business.
    const WINDS: Range = Range::between(-100.0, 100.0);
    let section = root.section("environment");
    let wind = section.item("wind").and_then(|item| item.numbers::<2>(WINDS));
    section.finish();
    let mut environment = Environment::default();
    environment.wind = wind.unwrap_or(environment.wind);
    environment
}

/// What circles overlap their end by where an autopilot is named (degrees): it is late, and sees less than it flies.
const OVERLAP: f64 = 20.0;

/// `[loiter]`; angles in degrees.
pub fn loiter(root: &Section<'_, '_>) -> LoiterSettings {
    let mut default = LoiterSettings::default();
    if root.has("autopilot") {
        default.sweep += OVERLAP.to_radians();
    }
    let section = root.section("loiter");
    let settings = LoiterSettings {
        radius: section.number("radius", Range::POSITIVE).unwrap_or(default.radius),
        height: section.number("height", Range::POSITIVE).unwrap_or(default.height),
        sweep: section
            .number("sweep", Range::above_to(0.0, MOST_SWEEP))
            .map_or(default.sweep, f64::to_radians),
        thrust_budget: section.number("thrust_budget", Range::SHARE).unwrap_or(default.thrust_budget),
        yaw: section.choice("yaw", &YAWS).unwrap_or(default.yaw),
        speed_limit: section.number("speed_limit", Range::POSITIVE).unwrap_or(default.speed_limit),
        acceleration_limit: section
            .number("acceleration_limit", Range::POSITIVE)
            .unwrap_or(default.acceleration_limit),
    };
    section.finish();
    settings
}

/// `[transition]` and `[transition.shaping]`.
pub fn transition(root: &Section<'_, '_>) -> TransitionSettings {
    let default = TransitionSettings::default();
    let section = root.section("transition");
    let settings = TransitionSettings {
        model: section.choice("model", &MODELS).unwrap_or(default.model),
        entries: entries(&section).unwrap_or(default.entries),
        segments: section.count("segments", 4, 2000).map_or(default.segments, |segments| segments as usize),
        transcription: section.choice("transcription", &TRANSCRIPTIONS).unwrap_or(default.transcription),
        thrust_budget: section.number("thrust_budget", Range::SHARE).unwrap_or(default.thrust_budget),
        safe_distance: section.number("safe_distance", Range::NOT_NEGATIVE).unwrap_or(default.safe_distance),
        heights: heights(&section).unwrap_or(default.heights),
        shaping: shaping(&section, default.shaping),
    };
    section.finish();
    settings
}

fn entries(section: &Section<'_, '_>) -> Option<Entries> {
    const MOST_ENTRIES: u64 = 360;
    let item = section.item("entries")?;
    if item.is_text() {
        return item.choice(&[("free", Entries::Free)]);
    }
    item.count(1, MOST_ENTRIES).map(|entries| Entries::Sampled(entries as usize))
}

fn heights(section: &Section<'_, '_>) -> Option<[f64; 2]> {
    let item = section.item("heights")?;
    let [low, high] = item.numbers::<2>(Range::NOT_NEGATIVE)?;
    if low >= high {
        item.wrong("is upside down", "give [least, greatest] height in metres");
        return None;
    }
    Some([low, high])
}

fn shaping(transition: &Section<'_, '_>, default: ShapingLimits) -> ShapingLimits {
    let section = transition.section("shaping");
    let mut limits = default;
    let keys = [
        ("speed", &mut limits.speed),
        ("acceleration", &mut limits.acceleration),
        ("jerk", &mut limits.jerk),
        ("climb_speed", &mut limits.climb_speed),
        ("descent_speed", &mut limits.descent_speed),
        ("vertical_acceleration", &mut limits.vertical_acceleration),
        ("vertical_jerk", &mut limits.vertical_jerk),
    ];
    for (key, limit) in keys {
        *limit = section.number(key, Range::POSITIVE).unwrap_or(*limit);
    }
    section.finish();
    limits
}
