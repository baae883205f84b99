//! The optimising plan against the paper's pipeline at the paper's scale: 100 targets, 8 vehicles.
//!
//! `cargo run --release -p uav-planner --features rayon --example paper_scale -- [MISSIONS] [TARGETS] [VEHICLES]`
//!
//! Targets uniform in [-1000, 1000]^2 m around the depot, 20 missions by default, 8 entries in both directions.

use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{Entries, Mission, Options, Pipeline, Plan, Target, Tolerances, plan};
use std::time::Instant;

/// xorshift64*: enough for positions.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }
}

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
        let mut random = Random(seed);
        for _ in 0..10 {
            random.next();
        }
        let mut place = || [2000.0 * random.next() - 1000.0, 2000.0 * random.next() - 1000.0];
        let targets = (0..targets).map(|_| Target::at(place())).collect();
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
