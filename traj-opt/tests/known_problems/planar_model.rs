//! The planar quadrotor: what four problems share.

use super::definition::v;
use nalgebra::{RealField, SVector};
use traj_opt::{Bounds, Guess};

/// Two-dimensional quadrotor, nondimensional with 10 rad/s.
pub fn planar<T: RealField + Copy>(x: &SVector<T, 5>, u: &SVector<T, 2>) -> [T; 5] {
    [x[2], x[3], u[0] * x[4].sin(), u[0] * x[4].cos() - T::one(), u[1]]
}

pub fn planar_bounds(x: f64, z: f64) -> Bounds<5, 2> {
    let length = 100.0 / 9.81;
    Bounds::free()
        .with_control(v([1.0 / 9.81, -1.0]), v([20.0 / 9.81, 1.0]))
        .with_initial_state(v([0.0; 5]))
        .with_terminal_state(v([x * length, z * length, 0.0, 0.0, 0.0]))
        .with_final_time(0.1, 500.0)
}

pub fn planar_guess(x: f64, z: f64) -> Guess<5, 2> {
    let length = 100.0 / 9.81;
    Guess::line(v([0.0; 5]), v([x * length, z * length, 0.0, 0.0, 0.0]), v([1.0, 0.0]), 12.0)
}
