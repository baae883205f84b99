//! A planar quadrotor flies 12 m aside in least time.
//!
//! Source: Hehn, Ritz and D'Andrea 2012 (1.705 s); here converged.

use super::definition::{Known, c, problem};
use super::planar_model::{planar, planar_bounds, planar_guess};

problem!(Planar12<5, 2>, |t, x, u| planar(x, u),
    mayer: |xf, tf| tf / c(10.0),
    bounds: planar_bounds(12.0, 0.0),
    guess: planar_guess(12.0, 0.0));

pub fn known() -> Known {
    Known::new("quad2d_x12", Planar12, Planar12::guess(), 1.704_896_4, 1e-5, 50)
}
