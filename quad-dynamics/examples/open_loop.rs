//! Flies fixed rotor commands open loop and prints the positions: one side of the comparison with another simulator.
//!
//!     cargo run --release -p quad-dynamics --example open_loop -- hummingbird 5 > ours.csv
//!
//! Commands: hover speed with slow, different wobbles on each rotor, held for 10 ms each.

use quad_dynamics::nalgebra::{SVector, Vector3, Vector4};
use quad_dynamics::{Motion, RotorLag, Vehicle, rk4_step_unit};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "hummingbird".to_owned());
    let duration: f64 = arguments.next().map_or(Ok(5.0), |text| text.parse())?;
    let vehicle = Vehicle::preset(&name).ok_or("no such preset")??;
    let model = RotorLag::new(&vehicle).with_wind(Vector3::new(1.0, -0.5, 0.2));
    let hover = (vehicle.weight() / 4.0 / vehicle.thrust_coefficient()).sqrt();
    let start = Motion::hover(&vehicle, Vector3::zeros(), 0.0).rigid_body_state();
    let mut state = SVector::<f64, 17>::from_fn(|i, _| if i < 13 { start[i] } else { hover });
    let step = 0.01;
    println!("t,x,y,z,vx,vy,vz,qw,qx,qy,qz,wx,wy,wz");
    let n_steps = (duration / step).round() as usize;
    for k in 0..=n_steps {
        let t = k as f64 * step;
        let row: Vec<String> = state.iter().take(13).map(|x| format!("{x:.10}")).collect();
        println!("{t:.3},{}", row.join(","));
        let wobble = Vector4::from_fn(|i, _| 0.004 * (2.0 * t + i as f64).sin() + 0.01 * (0.7 * t).sin());
        let command = wobble.map(|w| hover * (1.0 + w));
        for _ in 0..10 {
            state = rk4_step_unit(|x| model.derivative(x, &command), &state, step / 10.0, 6);
        }
    }
    Ok(())
}
