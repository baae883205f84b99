//! A robot with four thrusters comes to rest with the least fuel.
//!
//! Source: Y. Sakawa, Optimal Control Applications and Methods 20, 1999; Betts 2010, section 6.13 (7.9101471).

use super::definition::{INF, Known, c, problem, v};
use traj_opt::{Bounds, Guess, Transcription};

problem!(FreeFlyingRobot<6, 4>, |t, x, u| {
        let thrust = u[0] - u[1] + u[2] - u[3];
        let turn = c::<T>(0.2) * (u[0] - u[1] - u[2] + u[3]);
        [x[3], x[4], x[5], thrust * x[2].cos(), thrust * x[2].sin(), turn]
    },
    lagrange: u[0] + u[1] + u[2] + u[3],
    path: [u[0] + u[1], u[2] + u[3]] in [(-INF, 1.0), (-INF, 1.0)],
    bounds: Bounds::free().with_control(v([0.0; 4]), v([INF; 4]))
        .with_initial_state(v([-10.0, -10.0, std::f64::consts::FRAC_PI_2, 0.0, 0.0, 0.0])).with_terminal_state(v([0.0; 6])).with_final_time(12.0, 12.0),
    guess: Guess::line(v([-10.0, -10.0, std::f64::consts::FRAC_PI_2, 0.0, 0.0, 0.0]), v([0.0; 6]), v([0.0; 4]), 12.0));

pub fn known() -> Known {
    // the thrusters switch inside segments
    Known::new("free_flying_robot", FreeFlyingRobot, FreeFlyingRobot::guess(), 7.910_15, 1e-4, 50)
        .except(Transcription::Trapezoidal, 2e-4)
}
