//! From a plan to the missions of its vehicles.

use super::{CircleTask, KeepOut, VehicleMission};
use crate::export::members;
use crate::input::MissionFile;
use planner::{Plan, VehiclePlan};

/// The mission of a vehicle of a plan.
#[must_use]
pub fn vehicle_mission(file: &MissionFile, plan: &Plan, vehicle: &VehiclePlan) -> VehicleMission {
    let tasks = vehicle.legs.iter().filter_map(|leg| {
        let loiter = leg.loiter?;
        let circle = plan.circles.get(loiter.circle)?;
        Some(CircleTask {
            name: members(circle),
            centre: circle.centre,
            radius: circle.radius,
            height: circle.height,
            sweep: circle.sweep,
            entry_angle: loiter.entry.angle,
            direction: loiter.entry.direction,
            speed: circle.speed,
            transit_speed: leg.transition.max_speed,
        })
    });
    VehicleMission {
        pad: [vehicle.pad[0], vehicle.pad[1]],
        circles: tasks.collect(),
        return_speed: vehicle.legs.last().map_or(0.0, |leg| leg.transition.max_speed),
        keep_out: keep_out(file, plan),
    }
}

/// The safe distances of the targets, and how much room the circles leave around them.
fn keep_out(file: &MissionFile, plan: &Plan) -> Vec<KeepOut> {
    let common = file.mission.transition.safe_distance;
    let circle_of = |target: &planner::Target| {
        let radius = target.safe_distance.unwrap_or(common);
        let room = plan.circles.iter().map(|circle| {
            let distance =
                (circle.centre[0] - target.position[0]).hypot(circle.centre[1] - target.position[1]);
            (circle.radius - distance).abs() - radius
        });
        KeepOut { centre: target.position, radius, room: room.fold(f64::INFINITY, f64::min) }
    };
    file.mission.targets.iter().map(circle_of).collect()
}
