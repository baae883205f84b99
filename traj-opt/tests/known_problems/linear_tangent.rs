//! Least time to a height and a speed with a thrust of constant size: tan u is linear in time.
//!
//! Source: Bryson and Ho, section 2.7; J. T. Betts, *Practical Methods*, 2010, section 4.14 (value 0.554570879).

use super::definition::{Known, c, problem, v};
use traj_opt::{Bounds, Guess};

problem!(LinearTangent<4, 1>, |t, x, u| [x[2], x[3], c::<T>(100.0) * u[0].cos(), c::<T>(100.0) * u[0].sin()],
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([-std::f64::consts::FRAC_PI_2]), v([std::f64::consts::FRAC_PI_2])).with_initial_state(v([0.0; 4]))
        .with_terminal_component(1, 5.0).with_terminal_component(2, 45.0).with_terminal_component(3, 0.0).with_final_time(0.01, 10.0),
    guess: Guess::line(v([0.0; 4]), v([10.0, 5.0, 45.0, 0.0]), v([0.0]), 0.6));

pub fn known() -> Known {
    Known::new("linear_tangent", LinearTangent, LinearTangent::guess(), 0.554_570_879, 1e-6, 20)
}
