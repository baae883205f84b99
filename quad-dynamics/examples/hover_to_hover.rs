//! A flip-free flight from hover to hover: a polynomial, its attitude by flatness, flown by the controller.
//!
//!     cargo run -p quad-dynamics --example hover_to_hover

use quad_dynamics::nalgebra::Vector3;
use quad_dynamics::simulation::sample;
use quad_dynamics::{Error, FlatOutput, Motion, SimulationOptions, Vehicle, simulate};

/// Ninth-order blend from 0 to 1 over a unit of time with four zero derivatives at both ends: value and four derivatives.
fn blend(t: f64) -> [f64; 5] {
    let coefficients = [126.0, -420.0, 540.0, -315.0, 70.0];
    let mut derivatives = [0.0; 5];
    for (k, c) in coefficients.into_iter().enumerate() {
        let mut factor = c;
        for (order, derivative) in derivatives.iter_mut().enumerate() {
            let power = 5 + k as i32 - order as i32;
            *derivative += factor * t.powi(power);
            factor *= f64::from(power);
        }
    }
    derivatives
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let vehicle = Vehicle::survey_450();
    let (start, goal, duration) = (Vector3::new(0.0, 0.0, 2.0), Vector3::new(12.0, 5.0, 4.0), 4.0);
    let motion = |t: f64| -> Result<Motion, Error> {
        let blend = blend(t / duration);
        let order = |n: i32| (goal - start) * (blend[n as usize] / duration.powi(n));
        let flat = FlatOutput {
            position: start + order(0),
            velocity: order(1),
            acceleration: order(2),
            jerk: order(3),
            snap: order(4),
            ..FlatOutput::default()
        };
        Ok(flat.state(&vehicle, &vehicle.linear_drag())?.motion)
    };
    let options = SimulationOptions::default();
    let hover = Motion::hover(&vehicle, goal, 0.0);
    let plan = sample(|t| motion(t.min(duration)).unwrap_or(hover), duration + 1.0, options.step);
    let tilt = plan.iter().map(Motion::tilt).fold(0.0, f64::max).to_degrees();
    let thrust = plan.iter().map(|m| m.rotor_thrusts.max()).fold(0.0, f64::max);
    println!(
        "planned: tilt at most {tilt:.1} deg, rotor thrust at most {thrust:.2} of {:.2} N",
        vehicle.max_rotor_thrust()
    );
    let flight = simulate(&vehicle, &plan, &options, 1).ok_or("empty plan")?;
    println!("flown: {:#?}", flight.tracking);
    println!("energy: {:.0} J", vehicle.flight_energy(&plan, options.step, &Vector3::zeros()));
    Ok(())
}
