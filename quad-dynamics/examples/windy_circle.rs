//! A circle in wind: the greatest ground speed, the states round it, and the same circle flown in gusts.
//!
//!     cargo run -p quad-dynamics --example windy_circle

use quad_dynamics::nalgebra::Vector3;
use quad_dynamics::simulation::{SensorNoise, sample};
use quad_dynamics::{Direction, Loiter, LoiterSpec, SimulationOptions, Vehicle, WindyLoiter, simulate_batch};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let vehicle = Vehicle::survey_450();
    let spec = LoiterSpec::new(5.0);
    let wind = Vector3::new(5.0, 0.0, 0.0);
    let still = Loiter::new(&vehicle, &spec)?;
    let windy = WindyLoiter::new(&vehicle, &spec, wind, Direction::CounterClockwise)?;
    println!(
        "still air {:.2} m/s, in 5 m/s of wind {:.2} m/s ({} limit)",
        still.speed, windy.speed, windy.limit
    );
    println!("angle deg  thrust N  tilt deg  body rates rad/s");
    for degrees in (0..360).step_by(45) {
        let motion = windy.state(f64::from(degrees).to_radians());
        let w = motion.body_rates;
        println!(
            "{degrees:9}  {:8.2}  {:8.1}  {:.2} {:.2} {:.2}",
            motion.collective_thrust,
            motion.tilt().to_degrees(),
            w.x,
            w.y,
            w.z
        );
    }
    let options =
        SimulationOptions::default().with_wind(wind).with_gusts(5.0, 1.5).with_noise(SensorNoise::typical());
    let angle = |t: f64| windy.angular_speed() * t;
    let plan = sample(|t| windy.state(angle(t)), windy.period(), options.step);
    let seeds: Vec<u64> = (0..20).collect();
    let flown = simulate_batch(&vehicle, &plan, &options, &seeds);
    let worst = flown.iter().map(|tracking| tracking.max_cross_track).fold(0.0, f64::max);
    println!("flown 20 times in gusts: at most {worst:.2} m from the circle");
    Ok(())
}
