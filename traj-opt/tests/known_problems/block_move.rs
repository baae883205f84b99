//! A block moves by one metre in one second with least effort: exactly 12, with u = 6 - 12 t.
//!
//! Source: M. Kelly, *An Introduction to Trajectory Optimization*, SIAM Review 59, 2017, section 2.

use super::definition::{Known, problem, v};
use traj_opt::{Bounds, Guess};

problem!(BlockMove<2, 1>, |t, x, u| [x[1], u[0]],
    lagrange: u[0] * u[0],
    bounds: Bounds::free().with_initial_state(v([0.0, 0.0])).with_terminal_state(v([1.0, 0.0])).with_final_time(1.0, 1.0),
    guess: Guess::line(v([0.0, 0.0]), v([1.0, 0.0]), v([0.0]), 1.0));

pub fn known() -> Known {
    Known::new("block_move", BlockMove, BlockMove::guess(), 12.0, 1e-6, 20).exact()
}
