//! The best mix of two catalysts along a reactor: bang, singular, bang.
//!
//! Source: COPS 3.0, problem 14 (-0.0480556). Radau collocation agrees with itself on the value here to 1e-8, from 100 to 1600
//! segments; Hermite-Simpson's control rings on the singular arc, which makes the discretised optimum better than the true one.

use super::definition::{Known, c, problem, v};
use traj_opt::{Bounds, Guess, Transcription};

problem!(CatalystMixing<2, 1>, |t, x, u| {
        let flow = u[0] * (c::<T>(10.0) * x[1] - x[0]);
        [flow, -flow - (T::one() - u[0]) * x[1]]
    },
    mayer: |xf, tf| xf[0] + xf[1] - T::one(),
    bounds: Bounds::free().with_control(v([0.0]), v([1.0])).with_initial_state(v([1.0, 0.0])).with_final_time(1.0, 1.0),
    guess: Guess::line(v([1.0, 0.0]), v([0.9, 0.05]), v([0.5]), 1.0));

pub fn known() -> Known {
    // the control that Hermite and Simpson's defect leaves free inside a segment rings most
    Known::new("catmix", CatalystMixing, CatalystMixing::guess(), -0.048_055_68, 1e-5, 200)
        .except(Transcription::CompressedHermiteSimpson, 5e-5)
}
