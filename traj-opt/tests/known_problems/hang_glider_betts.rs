//! The hang glider with Betts' numbers.
//!
//! Source: J. T. Betts, *Practical Methods*, 2010, section 6.5 (1248.03103 m in 98.436940 s).

use super::definition::{Known, problem, v};
use super::glider_model::{glider, glider_bounds};
use traj_opt::Guess;

problem!(HangGliderBetts<4, 1>, |t, x, u| glider(x, u[0], 9.80665),
    mayer: |xf, tf| -xf[0],
    bounds: glider_bounds([0.0, 1000.0, 13.2275675, -1.28750052], [900.0, 13.2275675, -1.28750052]),
    guess: Guess::line(v([0.0, 1000.0, 13.2275675, -1.28750052]), v([1250.0, 900.0, 13.2275675, -1.28750052]), v([0.7]), 100.0));

pub fn known() -> Known {
    Known::new("hang_glider_betts", HangGliderBetts, HangGliderBetts::guess(), 1_248.031_03, 1e-5, 50)
        .maximised()
}
