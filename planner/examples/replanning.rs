//! How long events take: 100 targets and 8 vehicles, a target that appears, vanishes or moves, a vehicle that fails, a new wind.
//!
//! `cargo run --release -p uav-planner --example replanning`

use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{Error, Event, Mission, Options, Replanner, Target, Tolerances, plan};
use std::time::Instant;

fn main() -> Result<(), Error> {
    let vehicle = Vehicle::new(VehicleParameters::survey_450()).expect("a preset is a vehicle");
    let side = 600.0;
    // A lattice that is turned and sheared: scattered, but nothing random about it.
    let place = |i: f64, share: f64| side * ((i * share).fract() - 0.5);
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let targets =
        (0..100).map(|i| Target::at([side * (f64::from(i) / 100.0 - 0.495), place(f64::from(i), golden)]));
    let mission = Mission::new(vehicle, 8, targets.collect());
    let clock = Instant::now();
    let planned = plan(&mission, &Options::default())?;
    println!(
        "planned in {:.2} s, makespan {:.1} s",
        clock.elapsed().as_secs_f64(),
        planned.certificate.makespan
    );
    let first = Replanner::new(mission, planned)?;
    println!("{:<34} {:>6} {:>10} {:>9} {:>9}", "event", "at", "took", "vehicles", "verified");
    for time in [0.0, 40.0, 100.0] {
        let events = [
            ("a target appears", Event::TargetAppears(Target::at([37.0, -61.0]))),
            ("a target vanishes", Event::TargetVanishes(17)),
            ("a target moves by 25 m", Event::TargetMoves(60, moved(&first, 60))),
            ("a vehicle fails", Event::VehicleFails(3)),
            ("a wind of 5 m/s comes up", Event::WindChanges([4.0, 3.0])),
        ];
        for (name, event) in events {
            let mut replanner = first.clone();
            let clock = Instant::now();
            let update = replanner.apply(time, &event)?;
            let took = 1e3 * clock.elapsed().as_secs_f64();
            let verification = replanner.plan().verify(replanner.mission(), &Tolerances::default());
            let stands = verification.passed();
            println!("{name:<34} {time:>4} s {took:>7.1} ms {:>9} {stands:>9}", update.vehicles.len());
            for failure in &verification.failures {
                println!("    {failure}");
            }
        }
    }
    Ok(())
}

fn moved(replanner: &Replanner, target: usize) -> [f64; 2] {
    let [x, y] = replanner.mission().targets[target].position;
    [x + 15.0, y - 20.0]
}
