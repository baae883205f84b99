//! A polygon of waypoints per circle, with the camera held on the target: PX4, which refuses a mission with `LOITER_TURNS` or
//! `DO_ORBIT`, and ArduCopter where circles must not be cut to whole metres.
//!
//! The corners lie on the circle that is circumscribed about the
//! polygon's own circle, so that straight sides touch the planned circle and never cut into it.

use super::{CircleTask, Item, Place, VehicleMission, speed_item};
use crate::input::Autopilot;
use crate::words;
use std::f64::consts::TAU;

/// Corners of a full turn.
const CORNERS: f64 = 16.0;
/// How near a waypoint counts as reached (m), at most.
const ACCEPTANCE: f64 = 0.5;

pub(super) fn items(
    vehicle: &VehicleMission,
    autopilot: Autopilot,
    place: &Place<'_>,
) -> (Vec<Item>, Vec<String>) {
    let Some(first) = vehicle.circles.first() else { return (Vec::new(), Vec::new()) };
    let pad = place.geographic(vehicle.pad);
    let mut items = vec![Item::take_off(pad, first.height)];
    let mut speed = None;
    for task in &vehicle.circles {
        polygon(&mut items, &mut speed, task, place);
    }
    speed_item(&mut items, &mut speed, vehicle.return_speed);
    let last = vehicle.circles.last().map_or(first.height, |task| task.height);
    items.push(Item::waypoint(pad, last, ACCEPTANCE));
    items.push(Item::land(pad));
    (items, notes(&vehicle.circles, autopilot))
}

/// Fly to the entry; look at the target and go at the circle's speed around it; look ahead again.
fn polygon(items: &mut Vec<Item>, speed: &mut Option<f64>, task: &CircleTask, place: &Place<'_>) {
    let sides = (CORNERS * task.sweep / TAU - 1e-9).ceil().max(3.0);
    let step = f64::from(words::sign(task.direction)) * task.sweep / sides;
    let radius = task.radius / (step / 2.0).abs().cos();
    let acceptance = (0.15 * task.radius).min(ACCEPTANCE);
    let corner = |index: f64| {
        let angle = task.entry_angle + index * step;
        place.geographic([task.centre[0] + radius * angle.cos(), task.centre[1] + radius * angle.sin()])
    };
    speed_item(items, speed, task.transit_speed);
    items.push(Item::waypoint(corner(0.0), task.height, acceptance));
    items.push(Item::look_at(place.geographic(task.centre), 0.0));
    speed_item(items, speed, task.speed);
    for index in 1..=sides as usize {
        items.push(Item::waypoint(corner(index as f64), task.height, acceptance));
    }
    items.push(Item::look_ahead());
}

fn notes(tasks: &[CircleTask], autopilot: Autopilot) -> Vec<String> {
    let widest = tasks.iter().map(|task| task.radius).fold(0.0, f64::max);
    let outside = widest * (1.0 / (TAU / (2.0 * CORNERS)).cos() - 1.0);
    let shape = format!(
        "a polygon of {CORNERS} corners, up to {outside:.2} m outside the planned circle, with a slower and uneven speed"
    );
    vec![match autopilot {
        Autopilot::Px4 => format!(
            "PX4 flies no circles in a mission: each is {shape}; streaming the trajectory in OFFBOARD mode flies the plan as it is"
        ),
        Autopilot::ArduPilot => {
            format!("each circle is {shape}; streaming the trajectory in GUIDED mode flies the plan as it is")
        }
    }]
}
