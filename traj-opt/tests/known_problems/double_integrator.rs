//! Least time from rest to rest over a distance d with |u| <= a: exactly 2 sqrt(d / a).
//!
//! Source: A. E. Bryson, Y.-C. Ho, *Applied Optimal Control*, 1975, section 3.9: bang-bang with one switch.

use super::definition::{Known, problem, v};
use traj_opt::{Bounds, Guess};

problem!(DoubleIntegrator<2, 1>, |t, x, u| [x[1], u[0]],
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([-1.0]), v([1.0])).with_initial_state(v([0.0, 0.0])).with_terminal_state(v([1.0, 0.0])).with_final_time(0.01, 100.0),
    guess: Guess::line(v([0.0, 0.0]), v([1.0, 0.0]), v([0.0]), 1.0));

pub fn known() -> Known {
    Known::new("double_integrator", DoubleIntegrator, DoubleIntegrator::guess(), 2.0, 1e-6, 20).exact()
}
