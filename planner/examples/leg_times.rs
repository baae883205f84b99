//! How far do solved legs scatter around a model that knows only the distance of two circles?
//!
//! `cargo run --release -p uav-planner --features rayon --example leg_times -- [TARGETS] [SIDE]`
//!
//! `TARGETS` random targets (default 100) in a square of `SIDE` m (default 300), one plan of the paper's pipeline and one optimised. Its
//! legs from circle to circle are fitted by `t = a + b sqrt(d) + c d`, concave and increasing in the distance `d` of the centres, 0 or more
//! at 0: of such kind is the time by which targets are allocated.

use planner::quad_dynamics::nalgebra::{Matrix3, Vector3};
use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{Mission, Options, Pipeline, Plan, Target, plan};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};

/// Distance (m) and time (s) of every leg from circle to circle.
fn legs(plan: &Plan) -> Vec<[f64; 2]> {
    let mut legs = Vec::new();
    for planned in &plan.vehicles {
        for (pair, leg) in planned.route.windows(2).zip(planned.legs.iter().skip(1)) {
            let [[a, b], [x, y]] = [plan.circles[pair[0]].centre, plan.circles[pair[1]].centre];
            legs.push([(x - a).hypot(y - b), leg.transition.duration]);
        }
    }
    legs
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let n_targets: usize = words.first().map_or(Ok(100), |word| word.parse())?;
    let side: f64 = words.get(1).map_or(Ok(300.0), |word| word.parse())?;
    let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
    let mut places: Vec<[f64; 2]> = Vec::new();
    while places.len() < n_targets {
        let [x, y] = [(); 2].map(|()| side * (random.random::<f64>() - 0.5));
        // Apart from each other and from the pads.
        if x.hypot(y) > 12.0 && places.iter().all(|[a, b]| (x - a).hypot(y - b) > 5.0) {
            places.push([x, y]);
        }
    }
    let vehicle = Vehicle::new(VehicleParameters::survey_450())?;
    let mut mission = Mission::new(vehicle, 8, places.into_iter().map(Target::at).collect());
    for pipeline in [Pipeline::Paper, Pipeline::Optimised] {
        mission.pipeline = pipeline;
        let legs = legs(&plan(&mission, &Options::default())?);
        let row = |distance: f64| Vector3::new(1.0, distance.sqrt(), distance);
        let normal: Matrix3<f64> = legs.iter().map(|leg| row(leg[0]) * row(leg[0]).transpose()).sum();
        let right: Vector3<f64> = legs.iter().map(|leg| row(leg[0]) * leg[1]).sum();
        let fit = normal.try_inverse().ok_or("too few legs")? * right;
        let mut errors: Vec<f64> = legs.iter().map(|leg| (leg[1] - row(leg[0]).dot(&fit)).abs()).collect();
        errors.sort_by(f64::total_cmp);
        let n = errors.len();
        let spread = (errors.iter().map(|error| error * error).sum::<f64>() / n as f64).sqrt();
        let mean = legs.iter().map(|leg| leg[1]).sum::<f64>() / n as f64;
        println!(
            "{pipeline:?}: {n} legs of {mean:.2} s on average, t = {:.2} + {:.2} sqrt(d) + {:.3} d",
            fit.x, fit.y, fit.z
        );
        println!(
            "    off by {spread:.2} s (root mean square), {:.2} s in nine of ten, {:.2} s at most",
            errors[(n * 9 / 10).min(n - 1)],
            errors[n - 1]
        );
    }
    Ok(())
}
