//! Cart and pole: what three problems share.

use super::definition::{INF, c, v};
use nalgebra::{RealField, SVector};
use traj_opt::{Bounds, Guess};

/// Acceleration of cart and pole: masses m1, m2, length l.
pub fn cart_pole<T: RealField + Copy>(x: &SVector<T, 4>, u: T, m1: f64, m2: f64, l: f64) -> [T; 4] {
    let (sin, cos) = (x[1].sin(), x[1].cos());
    let d = c::<T>(m1) + c::<T>(m2) * (T::one() - cos * cos);
    let (m2, l, g, total) = (c::<T>(m2), c::<T>(l), c::<T>(9.81), c::<T>(m1 + m2));
    let rate = x[3] * x[3];
    let cart = (l * m2 * sin * rate + u + m2 * g * cos * sin) / d;
    let pole = -(l * m2 * cos * sin * rate + u * cos + total * g * sin) / (l * d);
    [x[2], x[3], cart, pole]
}

pub fn swing_up(distance: f64, force: f64, track: f64, angle: f64) -> Bounds<4, 1> {
    Bounds::free()
        .with_control(v([-force]), v([force]))
        .with_state(v([-track, -angle, -INF, -INF]), v([track, angle, INF, INF]))
        .with_initial_state(v([0.0; 4]))
        .with_terminal_state(v([distance, std::f64::consts::PI, 0.0, 0.0]))
}

pub fn swing_guess(distance: f64) -> Guess<4, 1> {
    Guess::line(v([0.0; 4]), v([distance, std::f64::consts::PI, 0.0, 0.0]), v([0.0]), 2.0)
}
