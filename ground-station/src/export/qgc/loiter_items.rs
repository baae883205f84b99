//! ArduCopter: one `LOITER_TURNS` item per circle.
//!
//! What the item does (ArduCopter 4.6, source and simulation): the radius is cut to whole metres, above 255 m to tens; one turn
//! or more is cut to whole turns; the speed is the least of `CIRCLE_RATE` times the radius, the waypoint speed and
//! sqrt(0.5 a r); the vehicle stops at the nearest point of the circle before and after; about 20 degrees of view are lost.

use super::{CircleTask, Item, Place, VehicleMission, speed_item, tenths};
use crate::execution::LoiterItem;
use crate::execution::limits::LOST_BY_ITEMS;
use crate::words;

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
        let turns = LoiterItem::new(task.radius, task.sweep, tenths(task.transit_speed));
        let signed = -f64::from(words::sign(task.direction)) * turns.radius;
        items.push(Item::loiter_turns(place.geographic(task.centre), task.height, turns.turns, signed));
        notes.extend(radius_note(&turns, task));
        flown.push(turns);
    }
    speed_item(&mut items, &mut speed, vehicle.return_speed);
    let last = vehicle.circles.last().map_or(height, |task| task.height);
    items.push(Item::waypoint(pad, last, ACCEPTANCE));
    items.push(Item::land(pad));
    notes.extend(common_notes(&vehicle.circles, &flown, first.height));
    (items, notes)
}

fn radius_note(item: &LoiterItem, task: &CircleTask) -> Option<String> {
    let differs = (item.radius - task.radius).abs() > 1e-6;
    differs.then(|| {
        format!(
            "target {}: a LOITER_TURNS item takes whole metres (above 255 m tens of metres): the circle has {} m instead of {:.2} m",
            task.name, item.radius, task.radius
        )
    })
}

fn common_notes(tasks: &[CircleTask], flown: &[LoiterItem], first_height: f64) -> Vec<String> {
    let planned: f64 = tasks.iter().map(|task| task.sweep * task.radius / task.speed).sum();
    let expected: f64 = flown.iter().map(|turns| turns.duration).sum();
    let mut notes = vec![format!(
        "ArduCopter stops at every circle and turns at CIRCLE_RATE (20 deg/s unless changed): about {expected:.0} s on the \
         circles instead of the planned {planned:.0} s; streaming the trajectory in GUIDED mode flies the plan as it is"
    )];
    let short = tasks
        .iter()
        .zip(flown)
        .find(|(task, turns)| turns.seen.to_degrees() < task.sweep.to_degrees().min(360.0) - 0.5);
    if let Some((task, turns)) = short {
        notes.push(format!(
            "a LOITER_TURNS item of {:.2} turn(s) shows about {:.0} deg of a target, not the {:.0} deg planned: whole turns \
             only, and about {:.0} deg are lost at the end",
            turns.turns,
            turns.seen.to_degrees(),
            task.sweep.to_degrees(),
            LOST_BY_ITEMS.to_degrees()
        ));
    }
    if first_height < LEAST_TAKE_OFF {
        notes.push(format!("take-off goes to {LEAST_TAKE_OFF} m, the least that ArduCopter accepts, before {first_height:.1} m"));
    }
    notes
}
