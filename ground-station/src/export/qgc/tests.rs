//! The files against the field tables of the format, read by a parser that shares no type with the writer.

use super::*;
use proptest::prelude::*;
use serde_json::Value;
use std::f64::consts::TAU;

const ORIGIN: Origin = Origin { latitude: 42.0308, longitude: -93.6319, altitude: 290.0 };

fn task(centre: [f64; 2], radius: f64, sweep: f64, direction: Direction) -> CircleTask {
    CircleTask {
        name: "3".into(),
        centre,
        radius,
        height: 1.5,
        sweep,
        entry_angle: 0.4,
        direction,
        speed: 5.0,
        transit_speed: 9.0,
    }
}

fn vehicle(circles: Vec<CircleTask>) -> VehicleMission {
    let keep_out = vec![
        KeepOut { centre: [10.0, 0.0], radius: 1.5, room: 1.5 },
        KeepOut { centre: [20.0, 0.0], radius: 1.5, room: 0.5 },
    ];
    VehicleMission { pad: [3.0, 0.0], circles, return_speed: 9.0, keep_out }
}

/// The command of an item and its parameters.
type Loaded = (u64, Vec<Option<f64>>);

/// What a loader requires: returns (command, params) of every item, or what is wrong.
fn load(text: &str) -> Result<Vec<Loaded>, String> {
    let file: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
    let need = |condition: bool, what: &str| if condition { Ok(()) } else { Err(what.to_owned()) };
    need(file["fileType"] == "Plan" && file["version"] == 1, "file type and version")?;
    let mission = &file["mission"];
    need(mission["version"] == 2, "mission version")?;
    need(mission["firmwareType"] == 3 || mission["firmwareType"] == 12, "firmware")?;
    need(mission["vehicleType"] == 2, "vehicle type")?;
    need(
        mission["plannedHomePosition"].as_array().is_some_and(|home| home.len() == 3),
        "home of three numbers",
    )?;
    let fence = &file["geoFence"];
    need(fence["version"] == 2 && fence["circles"].is_array() && fence["polygons"].is_array(), "fence")?;
    for circle in fence["circles"].as_array().into_iter().flatten() {
        need(circle["inclusion"] == false && circle["version"] == 1, "fence circle")?;
        need(circle["circle"]["center"].as_array().is_some_and(|center| center.len() == 2), "fence center")?;
        need(circle["circle"]["radius"].as_f64().is_some_and(|radius| radius > 0.0), "fence radius")?;
    }
    need(file["rallyPoints"]["points"].is_array() && file["rallyPoints"]["version"] == 2, "rally points")?;
    let items = mission["items"].as_array().ok_or("items")?;
    items.iter().enumerate().map(|(index, item)| load_item(index, item)).collect()
}

fn load_item(index: usize, item: &Value) -> Result<Loaded, String> {
    let params = item["params"].as_array().ok_or("params")?;
    let is_right = item["type"] == "SimpleItem"
        && item["autoContinue"].is_boolean()
        && item["doJumpId"] == index as u64 + 1
        && params.len() == 7
        && params.iter().all(|param| param.is_number() || param.is_null())
        && (item["frame"] == 2 || (item["frame"] == 3 && params[4..].iter().all(Value::is_number)));
    let command = item["command"].as_u64().filter(|_| is_right).ok_or(format!("item {index}: {item}"))?;
    Ok((command, params.iter().map(Value::as_f64).collect()))
}

#[test]
fn ardupilot_gets_turns_with_the_sign_of_the_direction() -> Result<(), Box<dyn std::error::Error>> {
    let circles = vec![
        task([10.0, 0.0], 3.0, TAU, Direction::CounterClockwise),
        task([20.0, 0.0], 2.2, 380f64.to_radians(), Direction::Clockwise),
        task([30.0, 0.0], 300.0, 0.5 * TAU, Direction::Clockwise),
    ];
    let mission =
        qgc_mission(&vehicle(circles), Autopilot::ArduPilot, Way::of_missions(Autopilot::ArduPilot), &ORIGIN);
    let items = load(&mission.plan.to_text()?)?;
    let commands: Vec<u64> = items.iter().map(|item| item.0).collect();
    assert_eq!(commands, [22, 178, 18, 18, 18, 16, 21]);
    let turns: Vec<[f64; 2]> = items[2..5]
        .iter()
        .map(|item| [item.1[0].unwrap_or(f64::NAN), item.1[2].unwrap_or(f64::NAN)])
        .collect();
    assert_eq!(turns, [[1.0, -3.0], [1.0, 3.0], [0.5, 300.0]]);
    assert_eq!(items[1].1[..3], [Some(1.0), Some(9.0), Some(-1.0)]);
    assert!(
        mission.notes[0].starts_with("target 3: a LOITER_TURNS item takes whole metres"),
        "{:?}",
        mission.notes
    );
    assert!(mission.notes.iter().any(|note| note.contains("shows about 340 deg")), "{:?}", mission.notes);
    assert!(
        mission.notes.iter().any(|note| note.starts_with("1 keep-out circle(s) are not")),
        "{:?}",
        mission.notes
    );
    assert_eq!(mission.plan.geo_fence.circles.len(), 1);
    Ok(())
}

#[test]
fn px4_gets_polygons_and_no_loiter_items() -> Result<(), Box<dyn std::error::Error>> {
    let circles = vec![task([10.0, 0.0], 3.0, TAU, Direction::CounterClockwise)];
    let mission = qgc_mission(&vehicle(circles), Autopilot::Px4, Way::of_missions(Autopilot::Px4), &ORIGIN);
    let items = load(&mission.plan.to_text()?)?;
    let commands: Vec<u64> = items.iter().map(|item| item.0).collect();
    let mut wanted = vec![22, 178, 16, 195, 178];
    wanted.extend([16; 16]);
    wanted.extend([197, 178, 16, 21]);
    assert_eq!(commands, wanted);
    Ok(())
}

proptest! {
    /// The sides of the polygon touch the planned circle and never cut into it; the turning sense is the planned one.
    #[test]
    fn px4_polygons_keep_the_radius(
        radius in 1.0..40.0f64, sweep in 0.2..12.0f64, entry in -4.0..4.0f64, clockwise in any::<bool>(),
    ) {
        let direction = if clockwise { Direction::Clockwise } else { Direction::CounterClockwise };
        let circle = CircleTask { entry_angle: entry, ..task([50.0, -20.0], radius, sweep, direction) };
        let mission = qgc_mission(&vehicle(vec![circle]), Autopilot::Px4, Way::of_missions(Autopilot::Px4), &ORIGIN);
        let waypoints = mission.plan.mission.items.iter().filter(|item| item.command == 16);
        let mut corners: Vec<[f64; 2]> = waypoints.map(|item| {
            let at = |index: usize| item.params[index].unwrap_or(f64::NAN);
            let [east, north] = ORIGIN.local(at(4), at(5));
            [east - 50.0, north + 20.0]
        }).collect();
        corners.pop(); // the pad
        let mut flown = 0.0;
        for side in corners.windows(2) {
            let [a, b] = [side[0], side[1]];
            let cross = a[0] * b[1] - a[1] * b[0];
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            prop_assert!((cross.abs() / length - radius).abs() < 1e-3);
            flown += cross.atan2(a[0] * b[0] + a[1] * b[1]);
        }
        let wanted = if clockwise { -sweep } else { sweep };
        prop_assert!((flown - wanted).abs() < 1e-3, "{} {}", flown, wanted);
    }

    /// Whatever is asked, the item holds only what ArduPilot keeps, and never less radius than planned.
    #[test]
    fn ardupilot_items_survive_its_truncation(radius in 0.3..2000.0f64, sweep in 0.1..40.0f64) {
        let circle = task([0.0, 0.0], radius, sweep, Direction::Clockwise);
        let mission = qgc_mission(&vehicle(vec![circle]), Autopilot::ArduPilot, Way::of_missions(Autopilot::ArduPilot), &ORIGIN);
        let item = mission.plan.mission.items.iter().find(|item| item.command == 18);
        let params = item.map_or([None; 7], |item| item.params).map(|param| param.unwrap_or(f64::NAN));
        let kept_radius = if params[2] > 255.0 { (params[2] / 10.0).trunc() * 10.0 } else { params[2].trunc() };
        prop_assert!(kept_radius == params[2] && params[2] >= radius - 1e-3 && params[2] <= radius + 10.0);
        let kept_turns = if params[0] >= 1.0 { params[0].trunc() } else { params[0] };
        prop_assert!(kept_turns == params[0] && params[0] <= sweep / TAU + 1e-9 && params[0] > 0.0);
    }
}

#[test]
fn a_vehicle_that_stays_at_home_has_no_items() {
    let mission =
        qgc_mission(&vehicle(vec![]), Autopilot::ArduPilot, Way::of_missions(Autopilot::ArduPilot), &ORIGIN);
    assert!(mission.plan.mission.items.is_empty());
}
