//! A mission in code: eight targets, three vehicles; prints what every vehicle does, leg by leg.
//!
//!     cargo run --release -p uav-planner --example mission -- [point-mass|jerk-limited|thrust-rate|rigid-body]

use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{Mission, Model, Options, Outcome, Target, Tolerances, plan};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let positions = [
        [12.0, 8.0],
        [41.0, 15.5],
        [25.0, 22.0],
        [8.0, 30.0],
        [35.0, 34.0],
        [46.0, 44.0],
        [20.0, 43.0],
        [31.0, 5.0],
    ];
    let vehicle = Vehicle::new(VehicleParameters::survey_450())?;
    let mut mission = Mission::new(vehicle, 3, positions.map(Target::at).to_vec());
    mission.transition.model = match std::env::args().nth(1).as_deref() {
        Some("point-mass") => Model::PointMass,
        Some("jerk-limited") => Model::JerkLimited,
        Some("rigid-body") => Model::RigidBody,
        _ => Model::ThrustRate,
    };
    let plan = plan(&mission, &Options::default())?;

    for (i, vehicle) in plan.vehicles.iter().enumerate() {
        println!("vehicle {}: {:.1} m in {:.1} s", i + 1, vehicle.length(), vehicle.duration());
        for leg in &vehicle.legs {
            let goal =
                leg.loiter.map_or("the pad".to_owned(), |loiter| format!("circle {}", loiter.circle + 1));
            let count =
                |wanted: fn(&Outcome) -> bool| leg.candidates.iter().filter(|c| wanted(&c.outcome)).count();
            let solved = count(|outcome| matches!(outcome, Outcome::Solved { .. }));
            let slower = count(|outcome| matches!(outcome, Outcome::Slower { .. }));
            let discarded = count(|outcome| matches!(outcome, Outcome::ProvenWorse { .. }));
            let failed = count(|outcome| matches!(outcome, Outcome::Failed { .. }));
            let (t, miss) = (&leg.transition, leg.transition.miss);
            println!(
                "  to {goal}: {:.3} s, {} iterations; {solved} candidates solved, {slower} given up, {discarded} proven worse, {failed} failed; \
                 miss {:.1e} m, {:.1e} m/s, {:.1e} rad",
                t.duration, t.iterations, miss.position, miss.velocity, miss.attitude
            );
        }
    }
    let certificate = plan.certificate;
    println!(
        "makespan {:.2} s, at least {:.2} s for any plan",
        certificate.makespan, certificate.makespan_lower_bound
    );
    println!(
        "total {:.2} s, at least {:.2} s for any plan",
        certificate.total, certificate.total_lower_bound
    );
    for warning in &plan.warnings {
        println!("warning: {warning:?}");
    }
    let verification = plan.verify(&mission, &Tolerances::default());
    let clearance = verification.legs.iter().map(|leg| leg.clearance).fold(f64::INFINITY, f64::min);
    let worst = verification.worst_miss();
    println!(
        "verified: {} ({:.1e} m, {:.1e} m/s, {:.1e} rad at worst; {clearance:.2} m clear of every safe distance)",
        verification.passed(),
        worst.position,
        worst.velocity,
        worst.attitude
    );
    for failure in &verification.failures {
        println!("failure: {failure}");
    }
    Ok(())
}
