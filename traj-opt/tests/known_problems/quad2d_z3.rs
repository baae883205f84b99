//! A planar quadrotor climbs 3 m in least time: it turns over to brake with its thrust.
//!
//! Source: the statement of Hehn, Ritz and D'Andrea 2012; no published value. Hermite-Simpson and Radau collocation agree on the one
//! here to 2e-8, each refined to 1e-7 and to 1e-8 and solved to 1e-10; 200 uniform segments give 1.0848799.

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
    Known::new("quad2d_z3", PlanarUp, PlanarUp::guess(), 1.084_891_75, 5e-6, 50)
}
