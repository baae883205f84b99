//! A vehicle's mission as a QGroundControl `.plan` file, for the autopilot that will fly it.
//!
//! ArduPilot gets one `LOITER_TURNS` item per circle, with what that item can say; PX4 refuses such items, and gets a polygon
//! of waypoints around the target with the camera held on it. Neither flies the plan as planned: what the autopilot will do
//! instead is said in plain words in [`QgcMission::notes`].

mod document;
mod from_plan;
mod loiter_items;
mod polygon;

pub use document::{CircleFence, Fence, FenceCircle, Item, Mission, PlanFile, Rally};
pub use from_plan::vehicle_mission;

use crate::execution::Way;
use crate::geodesy::Origin;
use crate::input::Autopilot;
use planner::Direction;

/// A vehicle's mission, with heights above its own pad.
#[derive(Debug, Clone, PartialEq)]
pub struct VehicleMission {
    /// Where it starts and lands: east, north (m).
    pub pad: [f64; 2],
    /// Its circles in the order of its route.
    pub circles: Vec<CircleTask>,
    /// Greatest speed on the way back (m/s).
    pub return_speed: f64,
    /// What every vehicle keeps away from.
    pub keep_out: Vec<KeepOut>,
}

/// A flight to a circle and the circle.
#[derive(Debug, Clone, PartialEq)]
pub struct CircleTask {
    /// The targets in it, for people: "3" or "3+5".
    pub name: String,
    /// Middle: east, north (m).
    pub centre: [f64; 2],
    /// Radius (m).
    pub radius: f64,
    /// Height (m).
    pub height: f64,
    /// Angle to fly (rad).
    pub sweep: f64,
    /// Where it is entered (rad, from east, counter-clockwise).
    pub entry_angle: f64,
    /// Turning sense.
    pub direction: Direction,
    /// Speed on the circle (m/s).
    pub speed: f64,
    /// Greatest speed on the way to it (m/s).
    pub transit_speed: f64,
}

/// A circle that nobody may enter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KeepOut {
    /// Middle: east, north (m).
    pub centre: [f64; 2],
    /// Radius (m).
    pub radius: f64,
    /// Distance from its rim to the nearest circle that is flown (m).
    pub room: f64,
}

/// A `.plan` file and what to know about it.
#[derive(Debug, Clone, PartialEq)]
pub struct QgcMission {
    /// The file.
    pub plan: PlanFile,
    /// What the autopilot will do otherwise than planned, in plain words.
    pub notes: Vec<String>,
}

/// The mission of one vehicle for its autopilot: with loiter items where the way says so, else with polygons.
#[must_use]
pub fn qgc_mission(vehicle: &VehicleMission, autopilot: Autopilot, way: Way, origin: &Origin) -> QgcMission {
    let place = Place { origin };
    let (items, mut notes) = match way {
        Way::LoiterItems => loiter_items::items(vehicle, &place),
        _ => polygon::items(vehicle, autopilot, &place),
    };
    let firmware = match autopilot {
        Autopilot::ArduPilot => document::FIRMWARE_ARDUPILOT,
        Autopilot::Px4 => document::FIRMWARE_PX4,
    };
    let (fence, left_out) = fence(vehicle, &place);
    if left_out > 0 {
        notes.push(format!(
            "{left_out} keep-out circle(s) are not in the geofence: a circle is flown within {LEAST_ROOM} m of them, and \
             the noise of a satellite position would set off the fence"
        ));
    }
    let [latitude, longitude] = place.geographic(vehicle.pad);
    let speed = vehicle.circles.iter().map(|task| task.transit_speed).fold(vehicle.return_speed, f64::max);
    let mission =
        Mission::new(firmware, [latitude, longitude, origin.altitude], tenths(speed), numbered(items));
    QgcMission { plan: PlanFile::new(mission, fence), notes }
}

/// A keep-out circle becomes a fence only where the vehicle passes at least this far outside (m).
const LEAST_ROOM: f64 = 1.0;

fn fence(vehicle: &VehicleMission, place: &Place<'_>) -> (Fence, usize) {
    let kept = vehicle.keep_out.iter().filter(|circle| circle.radius > 0.0);
    let (inside, outside): (Vec<&KeepOut>, Vec<&KeepOut>) = kept.partition(|circle| circle.room < LEAST_ROOM);
    let circles = outside.iter().map(|keep_out| FenceCircle {
        circle: CircleFence { center: place.geographic(keep_out.centre), radius: keep_out.radius },
        inclusion: false,
        version: 1,
    });
    (Fence::new(circles.collect()), inside.len())
}

/// Turns places of the plane into items.
struct Place<'a> {
    origin: &'a Origin,
}

impl Place<'_> {
    /// Latitude and longitude to 1e-9 degrees, a tenth of a millimetre: files stay short and equal.
    fn geographic(&self, position: [f64; 2]) -> [f64; 2] {
        self.origin.geographic(position).map(|degrees| (degrees * 1e9).round() / 1e9)
    }
}

fn numbered(mut items: Vec<Item>) -> Vec<Item> {
    for (number, item) in (1..).zip(&mut items) {
        item.number(number);
    }
    items
}

/// Rounded to a tenth.
fn tenths(value: f64) -> f64 {
    (10.0 * value).round() / 10.0
}

/// An item that changes the ground speed, unless it is already the one wanted.
fn speed_item(items: &mut Vec<Item>, current: &mut Option<f64>, speed: f64) {
    let speed = tenths(speed).max(0.1);
    if *current != Some(speed) {
        items.push(Item::change_speed(speed));
        *current = Some(speed);
    }
}

#[cfg(test)]
mod tests;
