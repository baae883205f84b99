//! The curve of quickest descent: a cycloid, 1.80160312 s by its closed form.
//!
//! Source: Johann Bernoulli 1696; statement and numbers of dymos' example (R. Falck et al., JOSS 6, 2021).

use super::definition::{Known, c, problem, v};
use traj_opt::{Bounds, Guess};

problem!(Brachistochrone<3, 1>, |t, x, u| [x[2] * u[0].sin(), -x[2] * u[0].cos(), c::<T>(9.80665) * u[0].cos()],
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([0.0]), v([3.2])).with_initial_state(v([0.0, 10.0, 0.0]))
        .with_terminal_component(0, 10.0).with_terminal_component(1, 5.0).with_final_time(0.1, 50.0),
    guess: Guess::line(v([0.0, 10.0, 0.0]), v([10.0, 5.0, 10.0]), v([1.0]), 2.0));

pub fn known() -> Known {
    Known::new("brachistochrone", Brachistochrone, Brachistochrone::guess(), 1.801_603_12, 1e-6, 20).exact()
}
