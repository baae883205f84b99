//! A heavier cart swings up its pole with least effort.
//!
//! Source: OptimTraj's demo `cartPole`, minimum force; no published value, the one here is converged.

use super::cart_pole_model::{cart_pole, swing_guess, swing_up};
use super::definition::{Known, problem};

problem!(CartPoleForce<4, 1>, |t, x, u| cart_pole(x, u[0], 2.0, 0.5, 0.5),
    lagrange: u[0] * u[0],
    bounds: swing_up(0.8, 100.0, 1.6, 2.0 * std::f64::consts::PI).with_final_time(2.0, 2.0),
    guess: swing_guess(0.8));

pub fn known() -> Known {
    Known::new("cartpole_optimtraj_force", CartPoleForce, CartPoleForce::guess(), 225.5537, 1e-6, 50)
}
