//! A cart swings up its pole in least time: a local minimum.
//!
//! Source: OptimTraj's demo `cartPole`, minimum time; no published value. Hermite-Simpson and Radau collocation, refined to 1e-8 and on
//! 1600 segments, solved to 1e-10, agree on the one here to 1e-6; 200 uniform segments give 1.10666.

use super::cart_pole_model::{cart_pole, swing_guess, swing_up};
use super::definition::{Known, problem};
use traj_opt::Transcription;

problem!(CartPoleTime<4, 1>, |t, x, u| cart_pole(x, u[0], 2.0, 0.5, 0.5),
    mayer: |xf, tf| tf,
    bounds: swing_up(1.0, 50.0, 2.0, 2.0 * std::f64::consts::PI).with_final_time(0.1, 10.0),
    guess: swing_guess(1.0));

pub fn known() -> Known {
    // a local minimum with arcs of bang and inner control
    Known::new("cartpole_optimtraj_time", CartPoleTime, CartPoleTime::guess(), 1.106_640, 5e-6, 50)
        .except(Transcription::Trapezoidal, 2e-4)
}
