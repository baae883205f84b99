//! What the plan says of the camera, against the camera's own geometry at samples of the plan.

use planner::quad_dynamics::nalgebra::Vector3;
use planner::quad_dynamics::{Camera, Vehicle, VehicleParameters};
use planner::{CameraSettings, Direction, Entries, LoiterYaw, Mission, Options, Plan, Target, Warning, plan};
use std::f64::consts::FRAC_PI_2;

const TARGET_HEIGHT: f64 = 0.8;

fn mission(camera: Camera) -> Mission {
    let positions = [[12.0, 3.0], [20.0, 14.0], [-6.0, 11.0], [-7.5, 12.0]];
    let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
    let mut mission = Mission::new(vehicle, 2, positions.map(Target::at).to_vec());
    mission.transition.entries = Entries::Sampled(4);
    // The last two are circled as one, and stand beside the centre of their circle.
    mission.merge_within = 3.0;
    mission.loiter.yaw = LoiterYaw::AtTarget;
    mission.camera = Some(CameraSettings { camera, target_height: TARGET_HEIGHT });
    mission
}

fn planned(mission: &Mission) -> Plan {
    plan(mission, &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Between two looks at a flight (s).
const STEP: f64 = 0.01;

/// The share from sampled attitudes, with the picture's edges by plain trigonometry; the camera is mounted along body x, tilted.
fn sampled_share(plan: &Plan, mission: &Mission, target: usize, tilt: f64, view: [f64; 2]) -> f64 {
    let [east, north] = mission.targets[target].position;
    let (mut seen, mut all) = (0, 0);
    for (vehicle, planned) in plan.vehicles.iter().enumerate() {
        let serves = |circle: usize| plan.circles[circle].members.contains(&target);
        let serving =
            planned.legs.iter().filter(|leg| leg.loiter.is_some_and(|loiter| serves(loiter.circle)));
        let spans: Vec<[f64; 2]> = serving.map(|leg| [leg.arrival_time(), leg.end_time()]).collect();
        for (i, motion) in plan.motions(mission, vehicle, STEP).unwrap().iter().enumerate() {
            let time = planned.start_time() + i as f64 * STEP;
            if !spans.iter().any(|&[from, to]| (from..=to).contains(&time)) {
                continue;
            }
            let s = Vector3::new(east, north, TARGET_HEIGHT) - motion.position;
            // Rows of the rotation from world to body: forward, left, up.
            let [forward, left, up] =
                [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| (motion.attitude * axis).dot(&s));
            let ahead = forward * tilt.cos() - up * tilt.sin();
            let above = forward * tilt.sin() + up * tilt.cos();
            let within = |offset: f64, view: f64| ahead > 0.0 && offset.abs() <= ahead * (0.5 * view).tan();
            seen += usize::from(within(left, view[0]) && within(above, view[1]));
            all += 1;
        }
    }
    seen as f64 / all as f64
}

#[test]
fn shares_are_those_of_the_flown_attitude() {
    let view = [0.9, 0.5];
    let mut partly = 0;
    for (wind, tilt) in [([0.0; 2], -0.2), ([0.0; 2], -0.6), ([4.0, 3.0], -0.4), ([6.0, -1.0], 0.0)] {
        let mut mission = mission(Camera::new(view[0], view[1]).unwrap().with_mount(0.0, tilt));
        mission.environment.wind = wind;
        let plan = planned(&mission);
        let shares = plan.shares_in_view(&mission).unwrap();
        for (target, &share) in shares.iter().enumerate() {
            let sampled = sampled_share(&plan, &mission, target, tilt, view);
            assert!((share - sampled).abs() < 0.011, "target {target} in {wind:?}: {share}, {sampled}");
            partly += usize::from(share > 0.05 && share < 0.95);
        }
        let least = shares.iter().copied().fold(1.0, f64::min);
        let warned = plan.warnings.iter().find_map(|warning| match warning {
            Warning::OutOfView { share, .. } => Some(*share),
            _ => None,
        });
        assert_eq!(warned, (least < 1.0).then_some(least));
    }
    assert!(partly > 1, "every share was all or nothing");
}

#[test]
fn a_gimbal_keeps_every_target_in_view_and_a_side_camera_those_circled_its_way() {
    let gimbal = Camera::new(1.2, 0.9).unwrap().with_stabilised(true);
    let looks_down = (1.5 - TARGET_HEIGHT).atan2(3.0);
    let mission_of_gimbal = mission(gimbal.with_mount(0.0, looks_down));
    let plan = planned(&mission_of_gimbal);
    assert_eq!(plan.shares_in_view(&mission_of_gimbal).unwrap(), [1.0; 4]);
    assert!(plan.warnings.is_empty());

    let mut sideways = mission(gimbal.with_mount(FRAC_PI_2, looks_down));
    sideways.loiter.yaw = LoiterYaw::AlongTrack;
    sideways.merge_within = 0.0;
    sideways.targets.pop();
    let plan = planned(&sideways);
    let shares = plan.shares_in_view(&sideways).unwrap();
    for loiter in plan.vehicles.iter().flat_map(|planned| &planned.legs).filter_map(|leg| leg.loiter) {
        let left = loiter.entry.direction == Direction::CounterClockwise;
        assert_eq!(shares[loiter.circle], f64::from(u8::from(left)));
    }
    sideways.camera = None;
    assert_eq!(plan.shares_in_view(&sideways), None);
    sideways.camera = Some(CameraSettings { camera: gimbal, target_height: f64::NAN });
    assert_eq!(sideways.problems()[0].field(), "camera.target_height");
}
