//! What a vehicle has said of itself, and what is wrong with it before a flight.

use crate::geodesy::Origin;
use crate::input::Autopilot;
use mavlink::dialects::common::{
    GLOBAL_POSITION_INT_DATA, MavAutopilot, MavMessage, MavModeFlag, MavSysStatusSensor, SYS_STATUS_DATA,
};

use super::track::LocalFrame;

/// The latest of everything that matters, with the time at which it came (s).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct VehicleState {
    /// When the last heartbeat came; `None` before the first.
    pub heartbeat: Option<f64>,
    /// When the last message of any kind came.
    pub heard: Option<f64>,
    /// Whose firmware it is.
    pub autopilot: Option<Autopilot>,
    /// `custom_mode`.
    pub mode: u32,
    /// Whether its motors may turn.
    pub is_armed: bool,
    /// North, east, down in its own frame (m).
    pub local: Option<(f64, [f64; 3])>,
    /// Its speed in that frame (m/s).
    pub speed: f64,
    /// Latitude, longitude (degrees).
    pub global: Option<(f64, [f64; 2])>,
    /// Height above mean sea level (m), as it says.
    pub altitude: Option<f64>,
    /// Whether it knows its home.
    pub has_home: bool,
    /// Percent left, where it says so.
    pub battery: Option<u8>,
    /// Whether its own checks before arming pass, where it says so.
    pub prearm: Option<bool>,
    /// Whether a geofence is on, and whole, where it says so.
    pub fence: Option<bool>,
    /// Whether it says that the fence is broken.
    pub is_fence_broken: bool,
    /// The item that it flies to.
    pub item: Option<u16>,
}

/// What a position report may be late (s).
const FRESH: f64 = 3.0;

impl VehicleState {
    /// Takes a message of the vehicle that arrived at `now` (s).
    pub fn receive(&mut self, message: &MavMessage, now: f64) {
        self.heard = Some(now);
        match message {
            MavMessage::HEARTBEAT(heartbeat) => {
                self.heartbeat = Some(now);
                self.autopilot = match heartbeat.autopilot {
                    MavAutopilot::MAV_AUTOPILOT_ARDUPILOTMEGA => Some(Autopilot::ArduPilot),
                    MavAutopilot::MAV_AUTOPILOT_PX4 => Some(Autopilot::Px4),
                    _ => None,
                };
                self.mode = heartbeat.custom_mode;
                self.is_armed = heartbeat.base_mode.contains(MavModeFlag::MAV_MODE_FLAG_SAFETY_ARMED);
            }
            MavMessage::LOCAL_POSITION_NED(local) => {
                let place = [local.x, local.y, local.z].map(f64::from);
                let speed = [local.vx, local.vy, local.vz].map(f64::from);
                if place.iter().chain(&speed).all(|value| value.is_finite()) {
                    self.local = Some((now, place));
                    self.speed = speed.iter().map(|part| part * part).sum::<f64>().sqrt();
                }
            }
            MavMessage::GLOBAL_POSITION_INT(GLOBAL_POSITION_INT_DATA { lat, lon, alt, .. })
                if (*lat, *lon) != (0, 0) =>
            {
                self.global = Some((now, [*lat, *lon].map(|degrees| f64::from(degrees) / 1e7)));
                self.altitude = Some(f64::from(*alt) / 1e3);
            }
            MavMessage::HOME_POSITION(_) => self.has_home = true,
            MavMessage::SYS_STATUS(status) => self.system_status(status),
            MavMessage::FENCE_STATUS(fence) => self.is_fence_broken = fence.breach_status != 0,
            MavMessage::MISSION_CURRENT(current) => self.item = Some(current.seq),
            _ => {}
        }
    }

    fn system_status(&mut self, status: &SYS_STATUS_DATA) {
        self.battery = u8::try_from(status.battery_remaining).ok();
        let says = |sensor: MavSysStatusSensor, known: MavSysStatusSensor| {
            known.contains(sensor).then(|| status.onboard_control_sensors_health.contains(sensor))
        };
        self.prearm =
            says(MavSysStatusSensor::MAV_SYS_STATUS_PREARM_CHECK, status.onboard_control_sensors_present);
        self.fence =
            says(MavSysStatusSensor::MAV_SYS_STATUS_GEOFENCE, status.onboard_control_sensors_enabled);
    }

    /// How long nothing was heard (s); infinite before the first heartbeat.
    #[must_use]
    pub fn silence(&self, now: f64) -> f64 {
        self.heartbeat.and(self.heard).map_or(f64::INFINITY, |heard| now - heard)
    }

    /// Whether a heartbeat from after `time` (s) says that the motors cannot turn.
    #[must_use]
    pub fn is_disarmed_after(&self, time: f64) -> bool {
        !self.is_armed && self.heartbeat.is_some_and(|heard| heard > time)
    }

    /// Where its local frame lies, from both its positions; it must stand on the ground.
    #[must_use]
    pub fn local_frame(&self, origin: &Origin) -> Option<LocalFrame> {
        let ([north, east, down], [latitude, longitude]) = (self.local?.1, self.global?.1);
        let [plan_east, plan_north] = origin.local(latitude, longitude);
        Some(LocalFrame { origin: [plan_east - east, plan_north - north], ground: down })
    }

    /// All that speaks against a flight from `pad` (east, north in m).
    #[must_use]
    pub fn problems(
        &self,
        wanted: Autopilot,
        origin: &Origin,
        pad: [f64; 2],
        least_battery: u8,
        now: f64,
    ) -> Vec<String> {
        /// A vehicle this far from its pad is another vehicle, or stands elsewhere (m).
        const REACH: f64 = 5.0;
        let mut problems = Vec::new();
        let mut wrong = |holds: bool, text: &str| {
            if holds {
                problems.push(text.to_owned());
            }
        };
        wrong(self.autopilot != Some(wanted), "another autopilot than the mission file says");
        wrong(self.is_armed, "is armed already: disarm it first");
        let fresh = |at: Option<f64>| at.is_some_and(|at| now - at <= FRESH);
        wrong(!fresh(self.local.map(|local| local.0)), "no local position estimate: wait for a fix");
        wrong(!fresh(self.global.map(|global| global.0)), "no global position: wait for a fix");
        wrong(!self.has_home, "knows no home");
        wrong(self.prearm == Some(false), "its own checks before arming fail: see its messages");
        wrong(self.is_fence_broken || self.fence == Some(false), "its geofence is broken");
        if let Some(left) = self.battery.filter(|&left| left < least_battery) {
            problems.push(format!("battery at {left} %, below {least_battery} %"));
        }
        if let Some((_, [latitude, longitude])) = self.global {
            let [east, north] = origin.local(latitude, longitude);
            let away = (east - pad[0]).hypot(north - pad[1]);
            if away > REACH {
                problems.push(format!(
                    "stands {away:.1} m from its pad at {:.1} m east, {:.1} m north",
                    pad[0], pad[1]
                ));
            }
        }
        problems
    }
}
