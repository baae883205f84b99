//! Two double integrators at once: exactly 2 sqrt(100) = 20 s.
//!
//! Source: dymos' example *flying robot* (double integrator in two axes).

use super::definition::{Known, problem, v};
use traj_opt::{Bounds, Guess};

problem!(PlanarTwoAxis<4, 2>, |t, x, u| [x[2], x[3], u[0], u[1]],
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([-1.0; 2]), v([1.0; 2])).with_initial_state(v([0.0; 4]))
        .with_terminal_state(v([-100.0, 100.0, 0.0, 0.0])).with_final_time(0.1, 500.0),
    guess: Guess::line(v([0.0; 4]), v([-100.0, 100.0, 0.0, 0.0]), v([0.0; 2]), 15.0));

pub fn known() -> Known {
    Known::new("planar_two_axis", PlanarTwoAxis, PlanarTwoAxis::guess(), 20.0, 1e-6, 20).exact()
}
