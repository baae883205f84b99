//! A stiff system is kept outside a tube with four sharp peaks: the standard test of mesh refinement.
//!
//! Source: Betts 2010, section 4.11.2 (2030.85609).

use super::definition::{INF, Known, c, problem, v};
use nalgebra::RealField;
use traj_opt::{Bounds, Guess, RefineOptions, Transcription};

fn bump<T: RealField + Copy>(t: T, at: f64, rate: f64) -> T {
    (c::<T>(-rate) * (t - c(at)) * (t - c(at))).exp()
}

problem!(AlpRider<4, 2>, |t, x, u| [
        c::<T>(-10.0) * x[0] + u[0] + u[1],
        c::<T>(-2.0) * x[1] + u[0] + c::<T>(2.0) * u[1],
        c::<T>(-3.0) * x[2] + c::<T>(5.0) * x[3] + u[0] - u[1],
        c::<T>(5.0) * x[2] - c::<T>(3.0) * x[3] + u[0] + c::<T>(3.0) * u[1]],
    lagrange: c::<T>(100.0) * x.norm_squared() + c::<T>(0.01) * u.norm_squared(),
    path: [x.norm_squared() - c::<T>(3.0) * (bump(t, 3.0, 12.0) + bump(t, 6.0, 10.0) + bump(t, 10.0, 6.0)) - c::<T>(8.0) * bump(t, 15.0, 4.0)] in [(0.01, INF)],
    bounds: Bounds::free().with_initial_state(v([2.0, 1.0, 2.0, 1.0])).with_terminal_state(v([2.0, 3.0, 1.0, -2.0])).with_final_time(20.0, 20.0),
    guess: Guess::line(v([2.0, 1.0, 2.0, 1.0]), v([2.0, 3.0, 1.0, -2.0]), v([0.0; 2]), 20.0));

pub fn known() -> Known {
    // the layer at the start, where the cost is high, wants a tight tolerance. Multiple shooting imposes path constraints at the
    // knots alone: the states swing below the constraint in between
    Known::new("alp_rider", AlpRider, AlpRider::guess(), 2_030.856_09, 1e-6, 100)
        .refined_by(RefineOptions::default().with_tolerance(3e-9).with_violation_tolerance(INF))
        .except(Transcription::Trapezoidal, 1e-4)
        .except(Transcription::RungeKutta { substeps: 2 }, INF)
}
