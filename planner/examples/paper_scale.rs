//! The optimising plan against the paper's pipeline at the paper's scale: 100 targets, 8 vehicles.
//!
//! `cargo run --release -p uav-planner --features rayon --example paper_scale -- [MISSIONS] [TARGETS] [VEHICLES]`
//!
//! One line for each mission, by the paper's pipeline (k-means, Christofides, the fastest entry leg by leg) and optimised: makespan and sum
//! of flight times, seconds to plan, how far above the proven lower bound the optimised makespan is at most (`gap`), how much shorter than
//! the paper's it is, and whether the plan stands an independent verification.
//!
//! Targets uniform in [-1000, 1000]^2 m around the depot, at least 5 m apart, 20 missions by default, 8 entries in both directions. Times to plan depend on
//! what else the machine does; all else is the same on every run.

use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{Entries, Mission, Options, Pipeline, Plan, Target, Tolerances, plan};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use std::time::Instant;

/// Least distance between targets (m).
const APART: f64 = 5.0;

fn timed(mission: &Mission) -> Result<(Plan, f64), planner::Error> {
    let start = Instant::now();
    let plan = plan(mission, &Options::default())?;
    Ok((plan, start.elapsed().as_secs_f64()))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let numbers: Vec<usize> = std::env::args().skip(1).map(|word| word.parse()).collect::<Result<_, _>>()?;
    let number = |i: usize, default: usize| numbers.get(i).copied().unwrap_or(default);
    let (missions, targets, vehicles) = (number(0, 20), number(1, 100), number(2, 8));
    println!(
        "mission   paper: makespan  total   time | optimised: makespan  total   time  gap   shorter  verified"
    );
    let (mut shorter, mut seconds) = (0.0, 0.0);
    for seed in 1..=missions as u64 {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut places: Vec<[f64; 2]> = Vec::new();
        while places.len() < targets {
            let [x, y] = [(); 2].map(|()| random.random_range(-1000.0..1000.0));
            // Nobody can circle a target inside another's safe distance.
            if places.iter().all(|[a, b]| (x - a).hypot(y - b) > APART) {
                places.push([x, y]);
            }
        }
        let targets = places.into_iter().map(Target::at).collect();
        let mut mission = Mission::new(Vehicle::new(VehicleParameters::survey_450())?, vehicles, targets);
        mission.transition.entries = Entries::Sampled(8);
        mission.seed = seed;
        let (best, time) = timed(&mission)?;
        mission.pipeline = Pipeline::Paper;
        let (paper, paper_time) = timed(&mission)?;
        let (a, b) = (paper.certificate, best.certificate);
        let saved = 1.0 - b.makespan / a.makespan;
        let verified = best.verify(&mission, &Tolerances::default()).passed();
        println!(
            "{seed:7} {:15.1} s {:7.0} s {paper_time:5.1} s | {:16.1} s {:7.0} s {time:5.1} s {:4.0} % {:6.1} %  {verified}",
            a.makespan,
            a.total,
            b.makespan,
            b.total,
            100.0 * b.makespan_gap(),
            100.0 * saved
        );
        (shorter, seconds) = (shorter + saved, seconds + time);
    }
    let n = missions.max(1) as f64;
    println!(
        "makespan shorter by {:.1} % on average, planned in {:.2} s on average",
        100.0 * shorter / n,
        seconds / n
    );
    Ok(())
}
