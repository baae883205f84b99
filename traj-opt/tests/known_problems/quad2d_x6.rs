//! A planar quadrotor flies 6 m aside in least time.
//!
//! Source: Hehn, Ritz and D'Andrea 2012 (1.231 s); here converged.

use super::definition::{Known, c, problem};
use super::planar_model::{planar, planar_bounds, planar_guess};

problem!(Planar6<5, 2>, |t, x, u| planar(x, u),
    mayer: |xf, tf| tf / c(10.0),
    bounds: planar_bounds(6.0, 0.0),
    guess: planar_guess(6.0, 0.0));

pub fn known() -> Known {
    Known::new("quad2d_x6", Planar6, Planar6::guess(), 1.231_318_7, 1e-5, 50)
}
