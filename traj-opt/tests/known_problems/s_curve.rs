//! A triple integrator with limits on speed v, acceleration a and jerk j over d metres: exactly d/v + v/a + a/j = 2.6 s.
//!
//! Source: M. Kelly, OptimTraj, demo `minTimeBvp`, without its regulariser.

use super::definition::{Known, problem, v};
use traj_opt::{Bounds, Guess, Transcription};

problem!(SCurve<3, 1>, |t, x, u| [x[1], x[2], u[0]],
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([-40.0]), v([40.0])).with_state(v([0.0, -2.0, -4.0]), v([4.0, 2.0, 4.0]))
        .with_initial_state(v([0.0; 3])).with_terminal_state(v([4.0, 0.0, 0.0])).with_final_time(0.01, 100.0),
    guess: Guess::line(v([0.0; 3]), v([4.0, 0.0, 0.0]), v([0.0]), 2.0));

pub fn known() -> Known {
    // between the knots the compressed form leaves the bounds on states; multiple shooting has constant controls, and the
    // switches are inside segments
    Known::new("s_curve", SCurve, SCurve::guess(), 2.6, 1e-6, 50)
        .exact()
        .except(Transcription::CompressedHermiteSimpson, 2e-4)
        .except(Transcription::RungeKutta { substeps: 2 }, 2e-4)
}
