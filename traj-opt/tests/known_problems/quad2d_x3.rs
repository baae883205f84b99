//! A planar quadrotor flies 3 m aside in least time.
//!
//! Source: M. Hehn, R. Ritz, R. D'Andrea, Autonomous Robots 33, 2012, p. 69 (0.898 s); here converged.

use super::definition::{Known, c, problem};
use super::planar_model::{planar, planar_bounds, planar_guess};

problem!(Planar3<5, 2>, |t, x, u| planar(x, u),
    mayer: |xf, tf| tf / c(10.0),
    bounds: planar_bounds(3.0, 0.0),
    guess: planar_guess(3.0, 0.0));

pub fn known() -> Known {
    Known::new("quad2d_x3", Planar3, Planar3::guess(), 0.898_702_7, 1e-5, 50)
}
