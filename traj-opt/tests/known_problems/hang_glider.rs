//! The greatest range of a hang glider through a thermal updraft. A coarse mesh has a false optimum of 1496 m that jumps the thermal.
//!
//! Source: R. Bulirsch et al., International Series of Numerical Mathematics 111, 1993; COPS 3.0, problem 11 (1248.03).

use super::definition::{Known, problem, v};
use super::glider_model::{glider, glider_bounds};
use traj_opt::Guess;

problem!(HangGlider<4, 1>, |t, x, u| glider(x, u[0], 9.81),
    mayer: |xf, tf| -xf[0],
    bounds: glider_bounds([0.0, 1000.0, 13.23, -1.288], [900.0, 13.23, -1.288]),
    guess: Guess::line(v([0.0, 1000.0, 13.23, -1.288]), v([1250.0, 900.0, 13.23, -1.288]), v([0.7]), 100.0));

pub fn known() -> Known {
    Known::new("hang_glider", HangGlider, HangGlider::guess(), 1247.99, 1e-5, 50).maximised()
}
