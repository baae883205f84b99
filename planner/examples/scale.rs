//! How long does a plan for many targets take, and where does the time go?
//!
//! `cargo run --release -p uav-planner --features rayon --example scale -- [TARGETS] [VEHICLES] [SIDE] [MODEL] [SEED]`
//!
//! `TARGETS` (default 1000) uniform in a square of `SIDE` m (default 2000) around the depot, at least 10 m apart, `VEHICLES` (default 20),
//! `MODEL` thrust-rate (default), rigid-body or point-mass, 8 entries in both directions. Prints seconds of the clock and of the processor
//! for the plan and for its verification, the makespan beside its bound, and what became of the candidates.

use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{Entries, Mission, Model, Options, Outcome, Plan, Target, Tolerances, plan};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use rustix::time::{ClockId, clock_gettime};

/// Least distance between targets, and from the depot (m).
const APART: f64 = 10.0;

/// Seconds of the clock and of the processor, all threads together.
fn seconds() -> [f64; 2] {
    [ClockId::Monotonic, ClockId::ProcessCPUTime].map(|clock| {
        let time = clock_gettime(clock);
        time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
    })
}

fn timed<R>(work: impl FnOnce() -> R) -> (R, [f64; 2]) {
    let before = seconds();
    let result = work();
    let after = seconds();
    (result, [after[0] - before[0], after[1] - before[1]])
}

fn places(n: usize, side: f64, seed: u64) -> Vec<[f64; 2]> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut places: Vec<[f64; 2]> = Vec::new();
    while places.len() < n {
        let [x, y] = [(); 2].map(|()| random.random_range(-0.5 * side..0.5 * side));
        if x.hypot(y) > APART && places.iter().all(|[a, b]| (x - a).hypot(y - b) > APART) {
            places.push([x, y]);
        }
    }
    places
}

fn count(plan: &Plan) -> String {
    let mut counts = [0; 4];
    for candidate in plan.vehicles.iter().flat_map(|vehicle| &vehicle.legs).flat_map(|leg| &leg.candidates) {
        counts[match candidate.outcome {
            Outcome::Solved { .. } => 0,
            Outcome::Slower { .. } => 1,
            Outcome::ProvenWorse { .. } => 2,
            _ => 3,
        }] += 1;
    }
    let [solved, slower, worse, failed] = counts;
    format!("{solved} solved, {slower} slower, {worse} proven worse, {failed} failed")
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, default: f64| words.get(i).map_or(Ok(default), |word| word.parse::<f64>());
    let (targets, vehicles, side) = (number(0, 1000.0)?, number(1, 20.0)?, number(2, 2000.0)?);
    let seed = number(4, 1.0)? as u64;
    let targets = places(targets as usize, side, seed).into_iter().map(Target::at).collect();
    let mut mission =
        Mission::new(Vehicle::new(VehicleParameters::survey_450())?, vehicles as usize, targets);
    mission.transition.entries = Entries::Sampled(8);
    mission.transition.model = match words.get(3).map(String::as_str) {
        None | Some("thrust-rate") => Model::ThrustRate,
        Some("rigid-body") => Model::RigidBody,
        Some("point-mass") => Model::PointMass,
        Some(other) => return Err(format!("no model {other}").into()),
    };
    mission.seed = seed;

    let (plan, planning) = timed(|| plan(&mission, &Options::default()));
    let plan = plan?;
    let (verification, verifying) = timed(|| plan.verify(&mission, &Tolerances::default()));
    println!("planned in {:.2} s, {:.2} s of processor", planning[0], planning[1]);
    println!(
        "verified in {:.2} s, {:.2} s of processor: {}",
        verifying[0],
        verifying[1],
        verification.passed()
    );
    let certificate = &plan.certificate;
    println!(
        "makespan {:.2} s, at most {:.1} % above the best possible; in the air {:.1} s",
        certificate.makespan,
        100.0 * certificate.makespan_gap(),
        certificate.total
    );
    println!("candidates: {}", count(&plan));
    Ok(())
}
