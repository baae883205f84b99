//! How many candidate entries do the bounds discard, and is the entry chosen the one that solving all would choose?
//!
//! `cargo run --release -p uav-planner --features rayon --example random_legs -- [LEGS] [SPREAD] [MODEL]`
//!
//! `LEGS` random legs from circle to circle (default 1000), targets up to `SPREAD` m apart (default 60), 16 entries in both
//! directions, `MODEL` thrust-rate (default), rigid-body or point-mass.

use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{Mission, Model, Options, Outcome, Pipeline, Target, plan};

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

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let legs: usize = words.first().map_or(Ok(1000), |word| word.parse())?;
    let spread: f64 = words.get(1).map_or(Ok(60.0), |word| word.parse())?;
    let model = match words.get(2).map(String::as_str) {
        None | Some("thrust-rate") => Model::ThrustRate,
        Some("rigid-body") => Model::RigidBody,
        Some("point-mass") => Model::PointMass,
        Some(other) => return Err(format!("no model {other}").into()),
    };
    let mut random = Random(7);
    let (mut seen, mut discarded, mut candidates) = (0, 0, 0);
    let (mut worst, mut agreed, mut failed) = (0.0_f64, 0, 0);
    while seen < legs {
        let mut place = || [spread * (random.next() - 0.5), spread * (random.next() - 0.5)];
        let targets = vec![Target::at(place()), Target::at(place())];
        let mut mission = Mission::new(Vehicle::new(VehicleParameters::survey_450())?, 1, targets);
        mission.depot = [spread, spread];
        mission.loiter.radius = 2.0 + 6.0 * random.next();
        mission.transition.model = model;
        mission.pipeline = Pipeline::Paper;
        let [a, b] = [mission.targets[0].position, mission.targets[1].position];
        if (a[0] - b[0]).hypot(a[1] - b[1]) < mission.loiter.radius + mission.transition.safe_distance {
            continue;
        }
        let pruned = plan(&mission, &Options::default())?;
        let all = plan(&mission, &Options::default().with_exhaustive(true))?;
        // The second leg is from circle to circle; it starts alike in both plans if the first one ends alike.
        let [pruned, all] = [pruned, all].map(|plan| plan.vehicles[0].legs[..2].to_vec());
        if pruned[0].loiter != all[0].loiter {
            failed += 1;
            continue;
        }
        seen += 1;
        candidates += pruned[1].candidates.len();
        let worse = |outcome: &Outcome| matches!(outcome, Outcome::ProvenWorse { .. });
        discarded += pruned[1].candidates.iter().filter(|candidate| worse(&candidate.outcome)).count();
        let ratio = pruned[1].transition.duration / all[1].transition.duration - 1.0;
        worst = worst.max(ratio);
        agreed += usize::from(ratio <= 1e-3);
    }
    println!("{seen} legs of {model:?}, targets within {spread} m: {candidates} candidates");
    println!("discarded by their bounds: {:.1} %", 100.0 * discarded as f64 / candidates as f64);
    println!("within 0.1 % of solving all: {agreed} of {seen}; worst {:+.4} %", 100.0 * worst);
    println!("first legs that ended at another entry: {failed}");
    Ok(())
}
