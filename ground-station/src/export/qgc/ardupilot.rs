//! ArduCopter: one `LOITER_TURNS` item per circle.
//!
//! What the item does (ArduCopter 4.6, source and simulation): the radius is cut to whole metres, above 255 m to tens; one turn
//! or more is cut to whole turns; the speed is the least of `CIRCLE_RATE` times the radius, the waypoint speed and
//! sqrt(0.5 a r); the vehicle stops at the nearest point of the circle before and after; about 20 degrees of view are lost.

use super::{CircleTask, Item, Place, VehicleMission, speed_item, tenths};
use crate::words;
use std::f64::consts::TAU;

/// Default of `CIRCLE_RATE` (rad/s).
const CIRCLE_RATE: f64 = 20.0 * TAU / 360.0;
/// Default of `WPNAV_ACCEL` (m/s^2).
const ACCELERATION: f64 = 2.5;
/// What a turn loses of its view (degrees): the turn is counted by a point that the vehicle follows.
const LOST_VIEW: f64 = 20.0;
/// Radii up to this are stored as whole metres, larger ones as tens of metres.
const WHOLE_METRES: f64 = 255.0;
/// The largest radius that the item can hold (m).
const LARGEST_RADIUS: f64 = 2550.0;
/// The most turns that the item can hold.
const MOST_TURNS: f64 = 255.0;
/// Lowest height of a take-off that the firmware accepts (m).
const LEAST_TAKE_OFF: f64 = 1.0;
/// How near a waypoint counts as reached (m).
const ACCEPTANCE: f64 = 0.5;

pub(super) fn items(vehicle: &VehicleMission, place: &Place<'_>) -> (Vec<Item>, Vec<String>) {
    let Some(first) = vehicle.circles.first() else { return (Vec::new(), Vec::new()) };
    let pad = place.geographic(vehicle.pad);
    let height = first.height.max(LEAST_TAKE_OFF);
    let mut items = vec![Item::take_off(pad, height)];
    let mut notes = Vec::new();
    let mut speed = None;
    let mut flown = Vec::new();
    for task in &vehicle.circles {
        speed_item(&mut items, &mut speed, task.transit_speed);
        let turns = Turns::of(task, tenths(task.transit_speed));
        let signed = -f64::from(words::sign(task.direction)) * turns.radius;
        items.push(Item::loiter_turns(place.geographic(task.centre), task.height, turns.count, signed));
        notes.extend(turns.radius_note(task));
        flown.push(turns);
    }
    speed_item(&mut items, &mut speed, vehicle.return_speed);
    let last = vehicle.circles.last().map_or(height, |task| task.height);
    items.push(Item::waypoint(pad, last, ACCEPTANCE));
    items.push(Item::land(pad));
    notes.extend(common_notes(&vehicle.circles, &flown, first.height));
    (items, notes)
}

/// What the item will make of a circle.
struct Turns {
    count: f64,
    radius: f64,
    /// s
    duration: f64,
}

impl Turns {
    fn of(task: &CircleTask, waypoint_speed: f64) -> Self {
        // Rounded up, never down: a smaller circle could enter a safe distance.
        let step = if task.radius.ceil() > WHOLE_METRES { 10.0 } else { 1.0 };
        let radius = ((task.radius / step - 1e-6).ceil() * step).clamp(1.0, LARGEST_RADIUS);
        let asked = task.sweep / TAU;
        let count = if asked < 1.0 - 1e-9 { asked } else { (asked + 1e-9).floor().min(MOST_TURNS) };
        let speed = (CIRCLE_RATE * radius).min(waypoint_speed).min((0.5 * ACCELERATION * radius).sqrt());
        Self { count, radius, duration: count * TAU * radius / speed }
    }

    fn radius_note(&self, task: &CircleTask) -> Option<String> {
        let differs = (self.radius - task.radius).abs() > 1e-6;
        differs.then(|| {
            format!(
                "target {}: a LOITER_TURNS item takes whole metres (above 255 m tens of metres): the circle has {} m instead of {:.2} m",
                task.name, self.radius, task.radius
            )
        })
    }
}

fn common_notes(tasks: &[CircleTask], flown: &[Turns], first_height: f64) -> Vec<String> {
    let planned: f64 = tasks.iter().map(|task| task.sweep * task.radius / task.speed).sum();
    let expected: f64 = flown.iter().map(|turns| turns.duration).sum();
    let mut notes = vec![format!(
        "ArduCopter stops at every circle and turns at CIRCLE_RATE (20 deg/s unless changed): about {expected:.0} s on the \
         circles instead of the planned {planned:.0} s; streaming the trajectory in GUIDED mode flies the plan as it is"
    )];
    let short = tasks
        .iter()
        .zip(flown)
        .find(|(task, turns)| 360.0 * turns.count - LOST_VIEW < task.sweep.to_degrees().min(360.0) - 0.5);
    if let Some((task, turns)) = short {
        notes.push(format!(
            "a LOITER_TURNS item of {:.2} turn(s) shows about {:.0} deg of a target, not the {:.0} deg planned: whole turns \
             only, and about {LOST_VIEW:.0} deg are lost at the end",
            turns.count,
            360.0 * turns.count - LOST_VIEW,
            task.sweep.to_degrees()
        ));
    }
    if first_height < LEAST_TAKE_OFF {
        notes.push(format!("take-off goes to {LEAST_TAKE_OFF} m, the least that ArduCopter accepts, before {first_height:.1} m"));
    }
    notes
}
