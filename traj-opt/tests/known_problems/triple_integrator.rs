//! Least time from rest to rest over a distance d with a jerk of at most j: exactly (32 d / j)^(1/3), two switches.
//!
//! Source: E. B. Lee, L. Markus, *Foundations of Optimal Control Theory*, 1967; the value follows from integrating the four quarters of jerk.

use super::definition::{Known, problem, v};
use traj_opt::{Bounds, Guess};

problem!(TripleIntegrator<3, 1>, |t, x, u| [x[1], x[2], u[0]],
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([-1.0]), v([1.0])).with_initial_state(v([0.0; 3])).with_terminal_state(v([1.0, 0.0, 0.0])).with_final_time(0.01, 100.0),
    guess: Guess::line(v([0.0; 3]), v([1.0, 0.0, 0.0]), v([0.0]), 1.0));

pub fn known() -> Known {
    Known::new("triple_integrator", TripleIntegrator, TripleIntegrator::guess(), 3.174_802_1, 1e-6, 40)
        .exact()
}
