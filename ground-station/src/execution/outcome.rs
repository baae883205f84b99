//! What a vehicle will really do, by the limits of its autopilot.

use super::limits::{
    ACCELERATION, LOST_BY_STREAM, MISSION_JERK, ORBIT_ACCELERATION, ORBIT_RADIUS, SPEED, STREAM_JERK,
    rest_to_rest,
};
use super::{LoiterItem, Way};
use crate::export::qgc::{CircleTask, VehicleMission, vehicle_mission};
use crate::input::{Autopilot, MissionFile};
use crate::words;
use planner::{Plan, Sample, VehiclePlan};
use std::f64::consts::TAU;

/// What becomes of a vehicle's plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Execution {
    /// How it is flown.
    pub way: Way,
    /// Time from take-off to the return (s), by the limits of that way.
    pub duration: f64,
    /// Each circle of its route.
    pub circles: Vec<CircleOutcome>,
    /// Where the vehicle will not do what was asked, in plain words.
    pub warnings: Vec<String>,
}

/// What becomes of a circle.
#[derive(Debug, Clone, PartialEq)]
pub struct CircleOutcome {
    /// The targets in it.
    pub name: String,
    /// Radius flown (m).
    pub radius: f64,
    /// Time on it (s).
    pub duration: f64,
    /// Angle of view (rad), at most a full turn.
    pub seen: f64,
}

/// What a vehicle will do with its plan, of which `samples` are moments and `planned` is the time in the air (s).
#[must_use]
pub fn execution(
    way: Way,
    autopilot: Autopilot,
    mission: &VehicleMission,
    planned: f64,
    samples: &[Sample],
) -> Execution {
    let mut warnings: Vec<String> = way.refusal(autopilot).map(str::to_owned).into_iter().collect();
    let circles: Vec<CircleOutcome> = mission.circles.iter().map(|task| circle(way, task)).collect();
    warnings.extend(circle_warnings(mission.circles.iter().zip(&circles)));
    let duration = match way {
        Way::Stream => {
            warnings.extend(shaping_warning(autopilot, samples));
            planned
        }
        _ => {
            warnings.extend(straight_warnings(mission));
            circles.iter().map(|circle| circle.duration).sum::<f64>() + transits(mission)
        }
    };
    if way != Way::Stream && planned > 0.0 && duration > 1.1 * planned {
        warnings.push(format!(
            "by {} it flies about {duration:.0} s instead of the planned {planned:.0} s; streaming flies the plan as it is",
            words::word(&words::WAYS, &way)
        ));
    }
    Execution { way, duration, circles, warnings }
}

/// What becomes of a vehicle's plan that is streamed, which is the default; without a look at the autopilot's shaping, hence without
/// that warning.
#[must_use]
pub fn streamed(file: &MissionFile, plan: &Plan, vehicle: &VehiclePlan) -> Execution {
    let flown = vehicle_mission(file, plan, vehicle);
    execution(Way::Stream, file.autopilot, &flown, vehicle.duration(), &[])
}

fn circle(way: Way, task: &CircleTask) -> CircleOutcome {
    let planned = task.sweep * task.radius / task.speed;
    let (radius, duration, seen) = match way {
        Way::Stream => (task.radius, planned, task.sweep - LOST_BY_STREAM),
        Way::LoiterItems => {
            let item = LoiterItem::new(task.radius, task.sweep, task.transit_speed);
            (item.radius, item.duration, item.seen)
        }
        // An estimate, not a measurement: corners are taken at the speed at which the acceleration limit allows the circle.
        Way::Polygon => {
            let speed = task.speed.min((ACCELERATION * task.radius).sqrt());
            (task.radius, task.sweep * task.radius / speed + GETTING_ON, task.sweep)
        }
        Way::LiveOrbit => {
            let radius = task.radius.max(ORBIT_RADIUS);
            let speed = task.speed.min((ORBIT_ACCELERATION * radius).sqrt());
            (radius, task.sweep * radius / speed + GETTING_ON, task.sweep)
        }
    };
    CircleOutcome { name: task.name.clone(), radius, duration, seen: seen.clamp(0.0, TAU) }
}

/// Slowing to the first corner of a polygon and speeding up after the last, or getting onto an orbit from rest and off it (s).
const GETTING_ON: f64 = 2.0;

/// One line for all circles of which the same is to be said.
fn circle_warnings<'a>(circles: impl Iterator<Item = (&'a CircleTask, &'a CircleOutcome)>) -> Vec<String> {
    let mut said: Vec<(String, Vec<&str>)> = Vec::new();
    for (task, outcome) in circles {
        let Some(what) = circle_warning(task, outcome) else { continue };
        match said.iter_mut().find(|(other, _)| *other == what) {
            Some((_, names)) => names.push(&task.name),
            None => said.push((what, vec![&task.name])),
        }
    }
    said.iter().map(|(what, names)| format!("target {}: the vehicle will {what}", names.join(", "))).collect()
}

fn circle_warning(task: &CircleTask, outcome: &CircleOutcome) -> Option<String> {
    let planned = task.sweep * task.radius / task.speed;
    let mut parts = Vec::new();
    if (outcome.radius - task.radius).abs() > 1e-6 {
        parts.push(format!("fly {:.1} m, not {:.1} m", outcome.radius, task.radius));
    }
    if outcome.duration > 1.2 * planned + 1.0 {
        parts.push(format!("take {:.0} s, not {planned:.0} s", outcome.duration));
    }
    let asked = task.sweep.min(TAU);
    if outcome.seen < asked - 1f64.to_radians() {
        parts.push(format!("see {:.0} of {:.0} degrees", outcome.seen.to_degrees(), asked.to_degrees()));
    }
    (!parts.is_empty()).then(|| parts.join(" and "))
}

/// From rest to rest between the nearest points of the circles, as missions are flown.
fn transits(mission: &VehicleMission) -> f64 {
    let mut here = mission.pad;
    let mut sum = 0.0;
    let mut leg = |from: [f64; 2], to: [f64; 2], speed: f64, reach: f64| {
        let distance = ((to[0] - from[0]).hypot(to[1] - from[1]) - reach).abs();
        sum += rest_to_rest(distance, speed.clamp(0.1, SPEED), ACCELERATION, MISSION_JERK);
    };
    for task in &mission.circles {
        leg(here, task.centre, task.transit_speed, task.radius);
        here = task.centre;
    }
    let last = mission.circles.last().map_or(0.0, |task| task.radius);
    leg(here, mission.pad, mission.return_speed, last);
    sum
}

/// Where a straight flight between the nearest points of two circles comes inside a safe distance: the plan flies around it, and
/// only streaming flies the plan.
fn straight_warnings(mission: &VehicleMission) -> Vec<String> {
    let pad = ("the pad", mission.pad, 0.0);
    let stops = mission.circles.iter().map(|task| (task.name.as_str(), task.centre, task.radius));
    let stops: Vec<_> = [pad].into_iter().chain(stops).chain([pad]).collect();
    let mut warnings = Vec::new();
    for pair in stops.windows(2) {
        let [(from, a, leave), (to, b, reach)] = [pair[0], pair[1]];
        let length = (b[0] - a[0]).hypot(b[1] - a[1]).max(f64::MIN_POSITIVE);
        let along = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
        let inside = mission.keep_out.iter().filter_map(|circle| {
            let [x, y] = [circle.centre[0] - a[0], circle.centre[1] - a[1]];
            let ahead = (x * along[0] + y * along[1]).clamp(leave, (length - reach).max(leave));
            let distance = (x - ahead * along[0]).hypot(y - ahead * along[1]);
            (distance < circle.radius - 1e-6).then_some((distance, circle.radius))
        });
        if let Some((distance, radius)) = inside.min_by(|a, b| a.0.total_cmp(&b.0)) {
            warnings.push(format!(
                "from {from} to {to} it flies straight, {distance:.1} m from a target with a safe distance of {radius:.1} m"
            ));
        }
    }
    warnings
}

/// What to raise so that streamed setpoints pass the autopilot's shaping, if they do not pass as they are.
fn shaping_warning(autopilot: Autopilot, samples: &[Sample]) -> Option<String> {
    let level = |v: [f64; 3]| v[0].hypot(v[1]);
    let acceleration = samples.iter().map(|sample| level(sample.acceleration)).fold(0.0, f64::max);
    let speed = samples.iter().map(|sample| level(sample.velocity)).fold(0.0, f64::max);
    let over_a_tenth = samples.windows(2).map(|pair| {
        let step = (pair[1].time - pair[0].time).max(0.02);
        let change = [0, 1, 2].map(|axis| pair[1].acceleration[axis] - pair[0].acceleration[axis]);
        level(change) / step
    });
    let jerk = over_a_tenth.fold(0.0, f64::max);
    // A hair of slack: a plan at the limit is within it.
    let passes = |value: f64, limit: f64| value <= 1.02 * limit;
    if passes(acceleration, ACCELERATION) && passes(jerk, STREAM_JERK) && passes(speed, SPEED) {
        return None;
    }
    Some(shaping_remedy(autopilot, speed, acceleration, jerk))
}

fn shaping_remedy(autopilot: Autopilot, speed: f64, acceleration: f64, jerk: f64) -> String {
    const PLAN: &str = "plan with transition.model = \"jerk-limited\"";
    match autopilot {
        Autopilot::ArduPilot if acceleration > MOST_ACCELERATION || jerk > MOST_JERK => format!(
            "the plan asks for up to {speed:.0} m/s, {acceleration:.0} m/s^2 and {jerk:.0} m/s^3, more than ArduCopter's shaping \
             lets through whatever its parameters (WPNAV_ACCEL up to 500 cm/s^2, PSC_JERK_XY up to 20 m/s^3): the vehicle \
             will lag behind it; {PLAN}"
        ),
        Autopilot::ArduPilot => format!(
            "the plan is faster than ArduCopter's default shaping, and the vehicle will lag behind it: raise WPNAV_SPEED to \
             {:.0}, WPNAV_ACCEL to {:.0} and PSC_JERK_XY to {:.0}, or {PLAN}",
            100.0 * speed.ceil(),
            100.0 * acceleration.ceil(),
            jerk.ceil(),
        ),
        Autopilot::Px4 => format!(
            "the plan may be faster than PX4's limits: set MPC_XY_VEL_MAX to {:.0} and MPC_ACC_HOR_MAX to {:.0}, and \
             MPC_TILTMAX_AIR to the plan's greatest tilt, or {PLAN}",
            speed.ceil(),
            acceleration.ceil(),
        ),
    }
}

/// The largest `WPNAV_ACCEL` (m/s^2) that ArduCopter's documentation names.
const MOST_ACCELERATION: f64 = 5.0;
/// The largest `PSC_JERK_XY` (m/s^3) that ArduCopter's documentation names.
const MOST_JERK: f64 = 20.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::qgc::KeepOut;
    use planner::Direction;

    fn mission(radius: f64) -> VehicleMission {
        let task = CircleTask {
            name: "1".into(),
            centre: [20.0, 0.0],
            radius,
            height: 2.0,
            sweep: TAU,
            entry_angle: 0.0,
            direction: Direction::Clockwise,
            speed: 2.0,
            transit_speed: 5.0,
        };
        VehicleMission { pad: [0.0, 0.0], circles: vec![task], return_speed: 5.0, keep_out: vec![] }
    }

    #[test]
    fn loiter_items_say_what_they_will_do() {
        let way = execution(Way::LoiterItems, Autopilot::ArduPilot, &mission(1.5), 20.0, &[]);
        assert_eq!(way.circles[0].radius, 2.0);
        let text = way.warnings.join("\n");
        assert!(text.contains("fly 2.0 m, not 1.5 m") && text.contains("take 20 s, not 5 s"), "{text}");
        assert!(
            text.contains("see 340 of 360 degrees") && text.contains("instead of the planned 20 s"),
            "{text}"
        );
        assert!(
            execution(Way::LoiterItems, Autopilot::Px4, &mission(3.0), 1e9, &[]).warnings[0]
                .starts_with("PX4 refuses")
        );
    }

    #[test]
    fn streaming_keeps_the_plan_and_an_overlap_keeps_the_view() {
        let mut mission = mission(1.5);
        let plain = execution(Way::Stream, Autopilot::ArduPilot, &mission, 20.0, &[]);
        assert_eq!((plain.duration, plain.circles[0].radius), (20.0, 1.5));
        assert!(plain.warnings[0].contains("see 353 of 360 degrees"), "{:?}", plain.warnings);
        mission.circles[0].sweep = 380f64.to_radians();
        let overlap = execution(Way::Stream, Autopilot::ArduPilot, &mission, 20.0, &[]);
        assert!(overlap.warnings.is_empty() && overlap.circles[0].seen == TAU);
    }

    #[test]
    fn straight_flights_past_targets_are_said() {
        let mut mission = mission(2.0);
        mission.keep_out =
            [[20.0, 0.0], [10.0, 1.0]].map(|centre| KeepOut { centre, radius: 1.5, room: 0.5 }).to_vec();
        let text = execution(Way::Polygon, Autopilot::Px4, &mission, 1e9, &[]).warnings.join("\n");
        assert!(text.contains("from the pad to 1 it flies straight, 1.0 m from a target"), "{text}");
        assert_eq!(text.matches("flies straight").count(), 2, "{text}");
        assert!(
            execution(Way::Stream, Autopilot::Px4, &mission, 1e9, &[])
                .warnings
                .iter()
                .all(|warning| !warning.contains("straight"))
        );
    }

    #[test]
    fn orbits_keep_their_limits() {
        let way = execution(Way::LiveOrbit, Autopilot::Px4, &mission(0.5), 20.0, &[]);
        assert_eq!(way.circles[0].radius, ORBIT_RADIUS);
        assert!(way.circles[0].duration >= TAU / 2f64.sqrt());
    }
}
