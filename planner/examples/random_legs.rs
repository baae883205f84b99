//! How many candidate entries do the bounds discard, and is the entry chosen the one that solving all would choose?
//!
//! `cargo run --release -p uav-planner --features rayon --example random_legs -- [LEGS] [SPREAD] [MODEL] [EAST NORTH]`
//!
//! `LEGS` random legs from circle to circle (default 1000), targets up to `SPREAD` m apart (default 60), 16 entries in both
//! directions, `MODEL` thrust-rate (default), rigid-body or point-mass, in a wind towards `EAST`, `NORTH` (m/s; default still air).

use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{Mission, Model, Options, Outcome, Pipeline, Target, plan};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};

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
    let wind: Vec<f64> = words.iter().skip(3).map(|word| word.parse()).collect::<Result<_, _>>()?;
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    let (mut seen, mut discarded, mut candidates) = (0, 0, 0);
    // Of the legs from hover, and of those from circle to circle.
    let mut excess: [Vec<f64>; 2] = Default::default();
    while seen < legs {
        let mut place = || [(); 2].map(|()| spread * (random.random::<f64>() - 0.5));
        let targets = vec![Target::at(place()), Target::at(place())];
        let mut mission = Mission::new(Vehicle::new(VehicleParameters::survey_450())?, 1, targets);
        mission.depot = [spread, spread];
        mission.loiter.radius = random.random_range(2.0..8.0);
        mission.transition.model = model;
        if let [east, north] = wind[..] {
            mission.environment.wind = [east, north];
        }
        mission.pipeline = Pipeline::Paper;
        let [a, b] = [mission.targets[0].position, mission.targets[1].position];
        if (a[0] - b[0]).hypot(a[1] - b[1]) < mission.loiter.radius + mission.transition.safe_distance {
            continue;
        }
        let pruned = plan(&mission, &Options::default())?;
        let all = plan(&mission, &Options::default().with_exhaustive(true))?;
        // The second leg is from circle to circle; it starts alike in both plans if the first one ends alike.
        let [pruned, all] = [pruned, all].map(|plan| plan.vehicles[0].legs[..2].to_vec());
        excess[0].push(pruned[0].transition.duration / all[0].transition.duration - 1.0);
        if pruned[0].loiter != all[0].loiter {
            continue;
        }
        seen += 1;
        candidates += pruned[1].candidates.len();
        let worse = |outcome: &Outcome| matches!(outcome, Outcome::ProvenWorse { .. });
        discarded += pruned[1].candidates.iter().filter(|candidate| worse(&candidate.outcome)).count();
        excess[1].push(pruned[1].transition.duration / all[1].transition.duration - 1.0);
    }
    println!("{seen} legs of {model:?}, targets within {spread} m, wind {wind:?}: {candidates} candidates");
    println!("discarded by their bounds: {:.1} %", 100.0 * discarded as f64 / candidates as f64);
    for (kind, excess) in ["from hover", "from circle to circle"].into_iter().zip(&excess) {
        let agreed = excess.iter().filter(|&&excess| excess <= 1e-3).count();
        let worst = excess.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        println!(
            "{kind}: within 0.1 % of solving all {agreed} of {}; worst {:+.4} %",
            excess.len(),
            100.0 * worst
        );
    }
    Ok(())
}
