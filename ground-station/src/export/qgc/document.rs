//! The parts of a `.plan` file (QGroundControl, plan format 1, mission format 2).

use serde::{Deserialize, Serialize};

/// `MAV_AUTOPILOT_ARDUPILOTMEGA`.
pub(super) const FIRMWARE_ARDUPILOT: u32 = 3;
/// `MAV_AUTOPILOT_PX4`.
pub(super) const FIRMWARE_PX4: u32 = 12;
/// `MAV_TYPE_QUADROTOR`.
const QUADROTOR: u32 = 2;
/// Altitudes relative to home, in QGroundControl's counting.
const RELATIVE: u32 = 1;

/// Commands of MAVLink's common set.
const NAV_WAYPOINT: u32 = 16;
const NAV_LOITER_TURNS: u32 = 18;
const NAV_LAND: u32 = 21;
const NAV_TAKEOFF: u32 = 22;
const DO_CHANGE_SPEED: u32 = 178;
const DO_SET_ROI_LOCATION: u32 = 195;
const DO_SET_ROI_NONE: u32 = 197;

/// `MAV_FRAME_GLOBAL_RELATIVE_ALT`: latitude, longitude, height above home.
const FRAME_RELATIVE: u32 = 3;
/// `MAV_FRAME_MISSION`: no place.
const FRAME_NONE: u32 = 2;

/// The file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct PlanFile {
    /// `"Plan"`.
    pub file_type: String,
    /// Keep-out circles. Always there, since one importer fails without it.
    pub geo_fence: Fence,
    /// Who wrote the file.
    pub ground_station: String,
    /// What is flown.
    pub mission: Mission,
    /// Rally points, none. Always there, since one importer fails without it.
    pub rally_points: Rally,
    /// 1.
    pub version: u32,
}

/// What is flown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Mission {
    /// For time estimates (m/s).
    pub cruise_speed: f64,
    /// `MAV_AUTOPILOT`.
    pub firmware_type: u32,
    /// 1: relative to home.
    pub global_plan_altitude_mode: u32,
    /// For time estimates (m/s).
    pub hover_speed: f64,
    /// The items; home is not among them.
    pub items: Vec<Item>,
    /// Latitude, longitude (degrees), altitude above mean sea level (m).
    pub planned_home_position: [f64; 3],
    /// `MAV_TYPE`.
    pub vehicle_type: u32,
    /// 2.
    pub version: u32,
}

/// An item of a mission.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Item {
    /// `"SimpleItem"`.
    #[serde(rename = "type")]
    pub kind: String,
    /// `MAV_CMD`.
    pub command: u32,
    /// `MAV_FRAME`.
    pub frame: u32,
    /// Exactly seven; `None` is written as null and read as not-a-number.
    pub params: [Option<f64>; 7],
    /// Whether the next item follows by itself.
    #[serde(rename = "autoContinue")]
    pub auto_continue: bool,
    /// Number, from 1.
    #[serde(rename = "doJumpId")]
    pub do_jump_id: u32,
    /// What the user is shown (m).
    #[serde(rename = "Altitude", skip_serializing_if = "Option::is_none", default)]
    pub altitude: Option<f64>,
    /// What the altitude is relative to; 1 is home.
    #[serde(rename = "AltitudeMode", skip_serializing_if = "Option::is_none", default)]
    pub altitude_mode: Option<u32>,
}

/// The geofence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fence {
    /// Circles to stay outside.
    pub circles: Vec<FenceCircle>,
    /// None.
    pub polygons: Vec<serde_json::Value>,
    /// 2.
    pub version: u32,
}

/// A circle of the fence.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FenceCircle {
    /// Where.
    pub circle: CircleFence,
    /// `false`: keep out.
    pub inclusion: bool,
    /// 1.
    pub version: u32,
}

/// Middle and radius of a circle of the fence.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CircleFence {
    /// Latitude, longitude (degrees).
    pub center: [f64; 2],
    /// Metres.
    pub radius: f64,
}

/// Rally points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Rally {
    /// None.
    pub points: Vec<serde_json::Value>,
    /// 2.
    pub version: u32,
}

impl PlanFile {
    pub(super) fn new(mission: Mission, geo_fence: Fence) -> Self {
        Self {
            file_type: "Plan".to_owned(),
            geo_fence,
            ground_station: env!("CARGO_PKG_NAME").to_owned(),
            mission,
            rally_points: Rally { points: Vec::new(), version: 2 },
            version: 1,
        }
    }

    /// The text of the file.
    ///
    /// # Errors
    ///
    /// Those of serialisation; a plan file has none.
    pub fn to_text(&self) -> serde_json::Result<String> {
        crate::export::json::to_text(self)
    }
}

impl Mission {
    pub(super) fn new(firmware_type: u32, home: [f64; 3], speed: f64, items: Vec<Item>) -> Self {
        Self {
            cruise_speed: speed,
            firmware_type,
            global_plan_altitude_mode: RELATIVE,
            hover_speed: speed,
            items,
            planned_home_position: home,
            vehicle_type: QUADROTOR,
            version: 2,
        }
    }
}

impl Fence {
    pub(super) fn new(circles: Vec<FenceCircle>) -> Self {
        Self { circles, polygons: Vec::new(), version: 2 }
    }
}

impl Item {
    /// An item without a place.
    fn action(command: u32, parameters: [f64; 4]) -> Self {
        let [a, b, c, d] = parameters.map(Some);
        let params = [a, b, c, d, Some(0.0), Some(0.0), Some(0.0)];
        Self::new(command, FRAME_NONE, params, None)
    }

    /// An item at a latitude and longitude, `height` above home.
    fn at(command: u32, parameters: [Option<f64>; 4], [latitude, longitude]: [f64; 2], height: f64) -> Self {
        let [a, b, c, d] = parameters;
        let params = [a, b, c, d, Some(latitude), Some(longitude), Some(height)];
        Self::new(command, FRAME_RELATIVE, params, Some(height))
    }

    fn new(command: u32, frame: u32, params: [Option<f64>; 7], altitude: Option<f64>) -> Self {
        Self {
            kind: "SimpleItem".to_owned(),
            command,
            frame,
            params,
            auto_continue: true,
            do_jump_id: 0,
            altitude,
            altitude_mode: altitude.map(|_| RELATIVE),
        }
    }

    pub(super) fn number(&mut self, number: u32) {
        self.do_jump_id = number;
    }

    pub(super) fn take_off(place: [f64; 2], height: f64) -> Self {
        Self::at(NAV_TAKEOFF, [Some(0.0), Some(0.0), Some(0.0), None], place, height)
    }

    /// A point to fly through; the yaw is left to the autopilot.
    pub(super) fn waypoint(place: [f64; 2], height: f64, acceptance: f64) -> Self {
        Self::at(NAV_WAYPOINT, [Some(0.0), Some(acceptance), Some(0.0), None], place, height)
    }

    /// Turns around a place; the radius is positive for clockwise.
    pub(super) fn loiter_turns(place: [f64; 2], height: f64, turns: f64, radius: f64) -> Self {
        Self::at(NAV_LOITER_TURNS, [Some(turns), Some(0.0), Some(radius), Some(0.0)], place, height)
    }

    pub(super) fn land(place: [f64; 2]) -> Self {
        Self::at(NAV_LAND, [Some(0.0), Some(0.0), Some(0.0), None], place, 0.0)
    }

    /// The ground speed from here on (m/s), throttle unchanged.
    pub(super) fn change_speed(speed: f64) -> Self {
        Self::action(DO_CHANGE_SPEED, [1.0, speed, -1.0, 0.0])
    }

    pub(super) fn look_at(place: [f64; 2], height: f64) -> Self {
        Self::at(DO_SET_ROI_LOCATION, [Some(0.0); 4], place, height)
    }

    pub(super) fn look_ahead() -> Self {
        Self::action(DO_SET_ROI_NONE, [0.0; 4])
    }
}
