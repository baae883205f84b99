//! Loiter speed of a preset against radius, with the limit that binds.
//!
//!     cargo run -p quad-dynamics --example loiter_table -- survey-450 0.6

use quad_dynamics::{Loiter, LoiterSpec, Vehicle};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "survey-450".to_owned());
    let budget: f64 = arguments.next().map_or(Ok(0.6), |text| text.parse())?;
    let vehicle = Vehicle::preset(&name).ok_or("no such preset")??;
    println!("{name}, thrust budget {budget}: hovers {:.0} s on its battery", vehicle.hover_endurance());
    println!("radius m  speed m/s  period s  bank deg  yaw rate rad/s  energy J  limit");
    for radius in [0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0, 13.0, 20.0, 50.0] {
        let spec = LoiterSpec::new(radius).with_thrust_budget(budget);
        let loiter = Loiter::new(&vehicle, &spec)?;
        let rates = loiter.state(0.0, quad_dynamics::Direction::CounterClockwise).body_rates;
        println!(
            "{radius:8.2}  {:9.2}  {:8.2}  {:8.1}  {:14.2}  {:8.0}  {}",
            loiter.speed,
            loiter.period(),
            loiter.bank.to_degrees(),
            rates.z,
            loiter.energy(),
            loiter.limit.map_or("chosen".to_owned(), |limit| limit.to_string()),
        );
    }
    let quickest = Loiter::quickest(&vehicle, &LoiterSpec::new(1.0).with_thrust_budget(budget), 0.3, 50.0)?;
    println!("quickest circle: radius {:.2} m in {:.2} s", quickest.radius, quickest.period());
    Ok(())
}
