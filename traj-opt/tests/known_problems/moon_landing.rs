//! Soft landing with most mass left: free fall, then full thrust; exactly 0.395354364 by root finding.
//!
//! Source: J. Meditch, IEEE Trans. Automatic Control 9, 1964; statement and numbers of dymos' example.

use super::definition::{INF, Known, c, problem, v};
use traj_opt::{Bounds, Guess};

problem!(MoonLanding<3, 1>, |t, x, u| [x[1], u[0] / x[2] - T::one(), -u[0] / c(2.349)],
    mayer: |xf, tf| -xf[2],
    bounds: Bounds::free().with_control(v([0.0]), v([1.227])).with_state(v([-INF, -INF, 1e-3]), v([INF; 3]))
        .with_initial_state(v([1.0, -0.783, 1.0])).with_terminal_component(0, 0.0).with_terminal_component(1, 0.0).with_final_time(0.1, 20.0),
    guess: Guess::line(v([1.0, -0.783, 1.0]), v([0.0, 0.0, 0.5]), v([0.6]), 1.5));

pub fn known() -> Known {
    Known::new("moon_landing", MoonLanding, MoonLanding::guess(), 0.395_354_364, 1e-6, 40).maximised().exact()
}
