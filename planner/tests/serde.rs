//! Missions as data.
#![cfg(feature = "serde")]

use planner::quad_dynamics::{Camera, Vehicle, VehicleParameters};
use planner::{CameraSettings, Entries, Mission, Model, Objective, Pipeline, Target};
use proptest::prelude::*;
use serde_json::{Value, json};

fn written(mission: &Mission) -> Value {
    serde_json::to_value(mission).unwrap()
}

/// A mission in which nothing is as by default.
fn unusual() -> Mission {
    let mut parameters = VehicleParameters::survey_450();
    parameters.mass = 1.7;
    let mut mission = Mission::new(
        Vehicle::new(parameters).unwrap(),
        3,
        vec![Target::at([12.5, -3.0]), Target::at([0.1, 40.0])],
    );
    mission.name = "field".to_owned();
    mission.depot = [1.0, 2.0];
    (mission.fleet.separation, mission.fleet.endurance) = (4.5, 900.0);
    (mission.loiter.sweep, mission.loiter.speed_limit) = (6.9, 5.5);
    mission.transition.model = Model::RigidBody;
    mission.transition.entries = Entries::Free;
    mission.transition.heights = [1.0, 25.0];
    mission.swap_time = Some(60.0);
    let camera = Camera::new(1.2, 0.9).unwrap();
    mission.camera = Some(CameraSettings { camera, target_height: 0.8 });
    mission.environment.wind = [3.0, -4.0];
    mission.targets[1].radius = Some(5.0);
    mission.merge_within = 2.0;
    (mission.objective, mission.pipeline) = (Objective::Total, Pipeline::Paper);
    mission.seed = u64::MAX;
    mission
}

#[test]
fn a_mission_is_read_as_it_was_written() {
    let plain = Mission::new(Vehicle::new(VehicleParameters::survey_450()).unwrap(), 1, vec![]);
    for mission in [plain, unusual()] {
        let text = serde_json::to_string(&mission).unwrap();
        let read: Mission = serde_json::from_str(&text).unwrap();
        // Debug prints every field, infinite limits included, to the last bit.
        assert_eq!(format!("{mission:?}"), format!("{read:?}"));
    }
}

#[test]
fn what_is_left_out_is_as_by_default() {
    let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
    let full = Mission::new(vehicle.clone(), 2, vec![Target::at([15.0, 5.0])]);
    let least = json!({
        "fleet": { "vehicles": 2, "vehicle": serde_json::to_value(&vehicle).unwrap() },
        "targets": [{ "position": [15.0, 5.0] }],
    });
    let read: Mission = serde_json::from_value(least).unwrap();
    assert_eq!(format!("{full:?}"), format!("{read:?}"));
    for missing in ["fleet", "targets"] {
        let mut without = written(&full);
        without.as_object_mut().unwrap().remove(missing);
        assert!(serde_json::from_value::<Mission>(without).is_err(), "{missing}");
    }
}

#[test]
fn unknown_fields_are_refused_wherever_they_stand() {
    for place in [
        "",
        "/fleet",
        "/fleet/vehicle",
        "/loiter",
        "/transition",
        "/transition/shaping",
        "/camera",
        "/environment",
        "/targets/0",
    ] {
        let mut data = written(&unusual());
        let object =
            data.pointer_mut(place).and_then(Value::as_object_mut).unwrap_or_else(|| panic!("{place}"));
        object.insert("colour".to_owned(), json!(7));
        let error = serde_json::from_value::<Mission>(data).expect_err(place).to_string();
        assert!(error.contains("colour"), "{place}: {error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_numbers_survive(
        places in prop::collection::vec(prop::array::uniform2(prop::num::f64::NORMAL), 0..5),
        endurance in prop::num::f64::POSITIVE,
        n in 1usize..400,
        seed in any::<u64>(),
    ) {
        let mut mission = unusual();
        mission.targets = places.into_iter().map(Target::at).collect();
        mission.fleet.endurance = endurance;
        mission.transition.entries = Entries::Sampled(n);
        mission.seed = seed;
        let read: Mission = serde_json::from_str(&serde_json::to_string(&mission).unwrap()).unwrap();
        prop_assert_eq!(format!("{mission:?}"), format!("{read:?}"));
    }
}

#[test]
fn a_misspelt_field_of_the_camera_is_refused() {
    let mut value = written(&unusual());
    value["camera"]["camera"]["mount_yav"] = json!(0.1);
    let refused = serde_json::from_value::<Mission>(value).unwrap_err();
    assert!(refused.to_string().contains("mount_yav"), "{refused}");
}
