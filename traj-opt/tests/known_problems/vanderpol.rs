//! Van der Pol's oscillator is brought to rest with a bounded control.
//!
//! Source: PROPT's example (2.86725954 with 60 points); the value here is the one that finer meshes converge to.

use super::definition::{Known, problem, v};
use traj_opt::{Bounds, Guess, Transcription};

problem!(VanDerPol<2, 1>, |t, x, u| [(T::one() - x[1] * x[1]) * x[0] - x[1] + u[0], x[0]],
    lagrange: x[0] * x[0] + x[1] * x[1] + u[0] * u[0],
    bounds: Bounds::free().with_control(v([-0.3]), v([1.0])).with_initial_state(v([0.0, 1.0])).with_final_time(5.0, 5.0),
    guess: Guess::line(v([0.0, 1.0]), v([0.0, 0.0]), v([0.0]), 5.0));

pub fn known() -> Known {
    // the control leaves its bound inside a segment, where the start is extrapolated
    Known::new("vanderpol", VanDerPol, VanDerPol::guess(), 2.867_261, 1e-6, 50)
        .except(Transcription::LegendreGaussRadau { degree: 3 }, 1e-5)
}
