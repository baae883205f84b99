//! The shortest path of bounded curvature is left, straight, left: exactly pi/2 + 3 sqrt(2).
//!
//! Source: L. E. Dubins, American Journal of Mathematics 79, 1957.

use super::definition::{Known, problem, v};
use traj_opt::{Bounds, Guess};

problem!(Dubins<3, 1>, |t, x, u| [x[2].cos(), x[2].sin(), u[0]],
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([-1.0]), v([1.0])).with_initial_state(v([0.0; 3]))
        .with_terminal_state(v([4.0, 4.0, std::f64::consts::FRAC_PI_2])).with_final_time(0.1, 100.0),
    guess: Guess::line(v([0.0; 3]), v([4.0, 4.0, std::f64::consts::FRAC_PI_2]), v([0.0]), 6.0));

pub fn known() -> Known {
    Known::new("dubins_LSL", Dubins, Dubins::guess(), 5.813_437_01, 1e-6, 50).exact()
}
