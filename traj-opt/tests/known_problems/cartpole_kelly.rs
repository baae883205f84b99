//! A cart swings up its pole with least effort.
//!
//! Source: Kelly 2017, section 6; the value is the converged one (dymos' 58.8839 is of a coarse mesh).

use super::cart_pole_model::{cart_pole, swing_guess, swing_up};
use super::definition::{INF, Known, problem};

problem!(CartPoleKelly<4, 1>, |t, x, u| cart_pole(x, u[0], 1.0, 0.3, 0.5),
    lagrange: u[0] * u[0],
    bounds: swing_up(1.0, 20.0, 2.0, INF).with_final_time(2.0, 2.0),
    guess: swing_guess(1.0));

pub fn known() -> Known {
    Known::new("cartpole_kelly", CartPoleKelly, CartPoleKelly::guess(), 58.807_67, 1e-6, 50)
}
