//! From a plan to the plain data that is drawn.

use super::{Band, Limit, MapCircle, MapScene, MapTarget, MapVehicle, Panel, Profile};
use crate::export::members;
use crate::input::MissionFile;
use crate::words;
use planner::quad_dynamics::GRAVITY;
use planner::{Model, Plan, Sample};

/// The map of a plan; `tracks` holds the samples of every vehicle.
#[must_use]
pub fn map_scene(file: &MissionFile, plan: &Plan, tracks: &[Vec<Sample>]) -> MapScene {
    let mission = &file.mission;
    let targets = mission.targets.iter().enumerate().map(|(index, target)| MapTarget {
        label: (index + 1).to_string(),
        position: target.position,
        safe_distance: target.safe_distance.unwrap_or(mission.transition.safe_distance),
    });
    let vehicles = plan.vehicles.iter().zip(tracks).enumerate().map(|(index, (vehicle, track))| {
        let loiters = vehicle.legs.iter().filter_map(|leg| leg.loiter);
        let circles = loiters.filter_map(|loiter| {
            let circle = plan.circles.get(loiter.circle)?;
            let (direction, entry) = (words::sign(loiter.entry.direction), loiter.entry.angle);
            Some(MapCircle { centre: circle.centre, radius: circle.radius, direction, entry })
        });
        let caption = match (vehicle.lost_at, vehicle.legs.is_empty()) {
            (Some(time), _) => format!("vehicle {}: lost at {time:.1} s", words::flight(plan, index)),
            (_, true) => format!("vehicle {}: at the depot", words::flight(plan, index)),
            (_, false) => format!(
                "vehicle {}: {:.1} s, {:.0} m",
                words::flight(plan, index),
                vehicle.duration(),
                vehicle.length()
            ),
        };
        let track = track.iter().map(|sample| [sample.position[0], sample.position[1]]).collect();
        MapVehicle { pad: [vehicle.pad[0], vehicle.pad[1]], circles: circles.collect(), track, caption }
    });
    let title = format!("{}: makespan {:.1} s", title_of(file), plan.certificate.makespan);
    MapScene { title, depot: mission.depot, targets: targets.collect(), vehicles: vehicles.collect() }
}

/// Speed, tilt and thrust of one vehicle over its flight.
#[must_use]
pub fn vehicle_profile(file: &MissionFile, plan: &Plan, vehicle: usize, samples: &[Sample]) -> Profile {
    let legs = plan.vehicles.get(vehicle).map(|vehicle| vehicle.legs.as_slice()).unwrap_or_default();
    let bands = legs.iter().filter_map(|leg| {
        let circle = plan.circles.get(leg.loiter?.circle)?;
        Some(Band { span: [leg.arrival_time(), leg.end_time()], label: members(circle) })
    });
    let column = |of: fn(&Sample) -> f64| samples.iter().map(of).collect();
    Profile {
        title: format!("{}: vehicle {}", title_of(file), words::flight(plan, vehicle)),
        vehicle,
        times: column(|sample| sample.time),
        panels: vec![
            Panel { title: "speed (m/s)".into(), values: column(speed), limits: speed_limits(file) },
            Panel {
                title: "tilt (deg)".into(),
                values: column(|sample| tilt(sample).to_degrees()),
                limits: tilt_limits(file),
            },
            Panel {
                title: "thrust (N)".into(),
                values: column(|sample| sample.collective_thrust),
                limits: thrust_limits(file),
            },
        ],
        loiters: bands.collect(),
    }
}

fn title_of(file: &MissionFile) -> &str {
    if file.mission.name.is_empty() { "mission" } else { &file.mission.name }
}

/// Speed over the ground and upwards (m/s).
#[must_use]
pub fn speed(sample: &Sample) -> f64 {
    sample.velocity.iter().map(|component| component * component).sum::<f64>().sqrt()
}

/// Angle between the thrust axis and the vertical (rad).
#[must_use]
pub fn tilt(sample: &Sample) -> f64 {
    let [_, x, y, _] = sample.attitude;
    (1.0 - 2.0 * (x * x + y * y)).clamp(-1.0, 1.0).acos()
}

fn speed_limits(file: &MissionFile) -> Vec<Limit> {
    let mission = &file.mission;
    let on_circles = Limit { name: "limit on circles".into(), value: mission.loiter.speed_limit };
    let on_the_way = match mission.transition.model {
        Model::JerkLimited => Limit { name: "shaping".into(), value: mission.transition.shaping.speed },
        _ => Limit { name: "level top speed".into(), value: level_top_speed(file) },
    };
    vec![on_circles, on_the_way]
}

/// The speed at which drag uses up what the transition's thrust budget leaves beside the weight.
fn level_top_speed(file: &MissionFile) -> f64 {
    let vehicle = &file.mission.fleet.vehicle;
    let [thrust, weight] = [transition_thrust(file), vehicle.weight()];
    let sideways = (thrust * thrust - weight * weight).max(0.0).sqrt();
    (2.0 * sideways / vehicle.drag_coefficient()).sqrt()
}

fn tilt_limits(file: &MissionFile) -> Vec<Limit> {
    let limit = match file.mission.transition.model {
        Model::JerkLimited => {
            let tilt = file.mission.transition.shaping.acceleration.atan2(GRAVITY);
            Limit { name: "shaping, no drag".into(), value: tilt.to_degrees() }
        }
        _ => {
            let tilt = (file.mission.fleet.vehicle.weight() / transition_thrust(file)).min(1.0).acos();
            Limit { name: "greatest level tilt".into(), value: tilt.to_degrees() }
        }
    };
    vec![limit]
}

fn thrust_limits(file: &MissionFile) -> Vec<Limit> {
    let vehicle = &file.mission.fleet.vehicle;
    let limit = |name: &str, value: f64| Limit { name: name.to_owned(), value };
    vec![
        limit("transition budget", transition_thrust(file)),
        limit("loiter budget", file.mission.loiter.thrust_budget * vehicle.max_thrust()),
        limit("least thrust", vehicle.min_thrust()),
    ]
}

fn transition_thrust(file: &MissionFile) -> f64 {
    file.mission.transition.thrust_budget * file.mission.fleet.vehicle.max_thrust()
}
