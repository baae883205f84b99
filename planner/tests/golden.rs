//! Plans to the bit, as they were when `golden/` was written, on 1, 2 and 8 threads.
//!
//! A change that is meant to change plans renews them with `GOLDEN=write cargo test -p uav-planner --features rayon --test golden`; the
//! difference then shows in the commit. Bits are those of x86-64 with fused multiply-add under Linux, where this runs.
#![cfg(all(feature = "rayon", target_arch = "x86_64", target_os = "linux"))]

use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{Entries, Mission, Model, Options, Pipeline, Plan, Target, plan};
use std::fmt::Write;
use std::path::Path;

fn missions() -> [(&'static str, Mission); 4] {
    let positions = [[12.0, 3.0], [20.0, 14.0], [-6.0, 11.0], [31.0, -9.0]];
    let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
    let mut plain = Mission::new(vehicle, 2, positions.map(Target::at).to_vec());
    plain.transition.entries = Entries::Sampled(4);
    let (mut paper, mut windy, mut rigid) = (plain.clone(), plain.clone(), plain.clone());
    paper.pipeline = Pipeline::Paper;
    windy.environment.wind = [3.0, -2.0];
    rigid.transition.model = Model::RigidBody;
    rigid.targets.truncate(2);
    [("optimised", plain), ("paper", paper), ("windy", windy), ("rigid-body", rigid)]
}

/// FNV-1a over the bits of numbers (Fowler, Noll, Vo).
fn hash<'a>(numbers: impl Iterator<Item = &'a f64>) -> u64 {
    let bytes = numbers.flat_map(|number| number.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

/// What a plan says: times in full, as decimal numbers that read back to the same bits, states and controls as hashes.
fn written(plan: &Plan) -> String {
    let mut text = String::new();
    let certificate = plan.certificate;
    writeln!(text, "makespan {:?} at least {:?}", certificate.makespan, certificate.makespan_lower_bound)
        .unwrap();
    writeln!(text, "total {:?} at least {:?}", certificate.total, certificate.total_lower_bound).unwrap();
    for planned in &plan.vehicles {
        writeln!(text, "route {:?} from {:?}", planned.route, planned.pad).unwrap();
        for leg in &planned.legs {
            let transition = &leg.transition;
            let entry = leg.loiter.map(|loiter| (loiter.entry.angle, loiter.entry.direction));
            let states = hash(transition.states.iter().flatten());
            let controls = hash(transition.controls.iter().flatten());
            writeln!(
                text,
                "  at {:?} for {:?} to {entry:?}: states {states:016x} controls {controls:016x}",
                leg.start_time, transition.duration
            )
            .unwrap();
        }
    }
    text
}

#[test]
fn plans_are_those_that_are_stored_on_any_number_of_threads() {
    if !std::arch::is_x86_feature_detected!("fma") {
        return;
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
    for (name, mission) in missions() {
        let file = folder.join(format!("{name}.txt"));
        for threads in [1, 2, 8] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let found = written(&pool.install(|| plan(&mission, &Options::default())).unwrap());
            if threads == 1 && std::env::var("GOLDEN").is_ok_and(|value| value == "write") {
                std::fs::write(&file, &found).unwrap();
            }
            let stored = std::fs::read_to_string(&file).unwrap();
            assert_eq!(stored, found, "{name} with {threads} threads");
        }
    }
}
