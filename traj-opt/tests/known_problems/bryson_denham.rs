//! A double integrator turned back in front of a wall at l = 1/9: exactly 4 / (9 l) = 4.
//!
//! Source: A. E. Bryson, W. F. Denham, S. E. Dreyfus, AIAA Journal 1, 1963; Bryson and Ho, section 3.11.

use super::definition::{INF, Known, c, problem, v};
use traj_opt::{Bounds, Guess};

problem!(BrysonDenham<2, 1>, |t, x, u| [x[1], u[0]],
    lagrange: c::<T>(0.5) * u[0] * u[0],
    bounds: Bounds::free().with_state(v([-INF, -INF]), v([1.0 / 9.0, INF])).with_initial_state(v([0.0, 1.0]))
        .with_terminal_state(v([0.0, -1.0])).with_final_time(1.0, 1.0),
    guess: Guess::line(v([0.0, 1.0]), v([0.0, -1.0]), v([0.0]), 1.0));

pub fn known() -> Known {
    Known::new("bryson_denham", BrysonDenham, BrysonDenham::guess(), 4.0, 1e-6, 50).exact()
}
