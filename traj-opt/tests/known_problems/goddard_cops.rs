//! The greatest height of a rocket in air: full thrust, a singular arc, coasting.
//!
//! Source: R. H. Goddard 1919; E. D. Dolan, J. J. More, T. S. Munson, COPS 3.0, 2004, problem 10 (1.01283).

use super::definition::{INF, Known, c, problem, v};
use traj_opt::{Bounds, Guess};

problem!(Goddard<3, 1>, |t, x, u| {
        let drag = c::<T>(310.0) * x[1] * x[1] * (c::<T>(-500.0) * (x[0] - T::one())).exp();
        [x[1], (u[0] - drag) / x[2] - T::one() / (x[0] * x[0]), -u[0] / c(0.5)]
    },
    mayer: |xf, tf| -xf[0],
    bounds: Bounds::free().with_control(v([0.0]), v([3.5])).with_state(v([1.0, 0.0, 0.6]), v([INF, INF, 1.0]))
        .with_initial_state(v([1.0, 0.0, 1.0])).with_terminal_component(2, 0.6).with_final_time(0.01, 1.0),
    guess: Guess::line(v([1.0, 0.0, 1.0]), v([1.01, 0.05, 0.6]), v([1.0]), 0.2));

pub fn known() -> Known {
    Known::new("goddard_cops", Goddard, Goddard::guess(), 1.012_837, 1e-6, 50).maximised()
}
