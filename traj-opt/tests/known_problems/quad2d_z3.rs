//! A planar quadrotor climbs 3 m in least time: it turns over to brake with its thrust.
//!
//! Source: the statement of Hehn, Ritz and D'Andrea 2012; no published value, the one here is converged.

use super::definition::{Known, c, problem, v};
use super::planar_model::{planar, planar_bounds};
use traj_opt::Guess;

// the faster of two local minima turns over to brake with thrust: the guess must turn over too
problem!(PlanarUp<5, 2>, |t, x, u| planar(x, u),
mayer: |xf, tf| tf / c(10.0),
bounds: planar_bounds(0.0, 3.0),
guess: Guess::from_fn(12.0, 20, |s| {
    let turn = (std::f64::consts::PI * s).sin();
    (v([0.0, 30.0 / 0.981 * s, 0.0, 2.5, 3.0 * turn]), v([1.0, 0.0]))
}));

pub fn known() -> Known {
    Known::new("quad2d_z3", PlanarUp, PlanarUp::guess(), 1.084_879_9, 1e-4, 50)
}
