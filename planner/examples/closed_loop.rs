//! A plan flown by a simulated team in gusts, many times: how often are safe distances kept?
//!
//! `cargo run --release -p uav-planner --features rayon --example closed_loop -- [RUNS] [WIND] [MARGIN] [BUDGET]`
//!
//! `RUNS` seeded flights (default 1000) of eight targets and three vehicles in gusts of the standard deviation `WIND` (m/s,
//! default 3) with sensor noise. The plan keeps `MARGIN` (m, default 0.75) more than the safe distance, leaves the controller all
//! but the share `BUDGET` (default 0.6) of the thrust, and uses the model with body dynamics, which the controller can follow
//! to a decimetre in still air.

use planner::quad_dynamics::nalgebra::Vector3;
use planner::quad_dynamics::simulation::{SensorNoise, SimulationOptions};
use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{Mission, Model, Options, Target, plan};

const TARGETS: [[f64; 2]; 8] = [
    [12.0, 8.0],
    [41.0, 15.5],
    [27.5, 22.0],
    [8.0, 31.0],
    [45.5, 38.0],
    [19.0, 44.5],
    [33.0, 6.0],
    [31.5, 41.5],
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let numbers: Vec<f64> = std::env::args().skip(1).map(|word| word.parse()).collect::<Result<_, _>>()?;
    let number = |i: usize, default: f64| numbers.get(i).copied().unwrap_or(default);
    let (runs, wind) = (number(0, 1000.0) as u64, number(1, 3.0));
    let (margin, budget) = (number(2, 0.75), number(3, 0.6));

    let vehicle = Vehicle::new(VehicleParameters::survey_450())?;
    let mut mission = Mission::new(vehicle, 3, TARGETS.map(Target::at).to_vec());
    mission.loiter.speed_limit = 6.0;
    mission.transition.model = Model::RigidBody;
    mission.transition.thrust_budget = budget;
    let asked = mission.transition.safe_distance;
    mission.transition.safe_distance = asked + margin;
    let plan = plan(&mission, &Options::default())?;
    mission.transition.safe_distance = asked;

    let mut options = SimulationOptions::default().with_noise(SensorNoise::typical());
    options.gusts = Vector3::repeat(wind);
    let (mut kept, mut worst, mut errors) = (0, f64::INFINITY, Vec::new());
    for seed in 0..runs {
        let team = plan.fly(&mission, &options, seed).ok_or("the plan is not the mission's")?;
        let clearance = team.iter().map(|flown| flown.clearance).fold(f64::INFINITY, f64::min);
        let complete = team.iter().all(|flown| flown.tracking.completed == 1.0);
        kept += u64::from(complete && clearance >= 0.0);
        worst = worst.min(clearance);
        errors.extend(team.iter().map(|flown| flown.tracking.max_error));
    }
    errors.sort_by(f64::total_cmp);
    let makespan = plan.certificate.makespan;
    println!("makespan {makespan:.2} s, safe distance {asked} m, margin {margin} m, thrust budget {budget}");
    println!("gusts of {wind} m/s standard deviation on every axis, {runs} runs of three vehicles");
    println!("safe distances kept in {kept} of {runs} runs, least clearance {worst:.2} m");
    if let Some(last) = errors.last() {
        println!(
            "greatest distance to the planned place: median {:.2} m, worst {last:.2} m",
            errors[errors.len() / 2]
        );
    }
    Ok(())
}
