//! The hang glider: what two problems share.

use super::definition::{INF, c, v};
use nalgebra::{RealField, SVector};
use traj_opt::Bounds;

pub fn glider<T: RealField + Copy>(x: &SVector<T, 4>, lift: T, g: f64) -> [T; 4] {
    let r = (x[0] / c(100.0) - c(2.5)) * (x[0] / c(100.0) - c(2.5));
    let updraft = c::<T>(2.5) * (T::one() - r) * (-r).exp();
    let w = x[3] - updraft;
    let speed = (x[2] * x[2] + w * w).sqrt();
    let pressure = c::<T>(0.5 * 1.13 * 14.0) * speed * speed;
    let (lift_force, drag) = (lift * pressure, (c::<T>(0.034) + c::<T>(0.069_662) * lift * lift) * pressure);
    let (sin, cos) = (w / speed, x[2] / speed);
    [
        x[2],
        x[3],
        (-lift_force * sin - drag * cos) / c(100.0),
        (lift_force * cos - drag * sin) / c(100.0) - c(g),
    ]
}

pub fn glider_bounds(start: [f64; 4], end: [f64; 3]) -> Bounds<4, 1> {
    Bounds::free()
        .with_control(v([0.0]), v([1.4]))
        .with_state(v([0.0, -INF, 0.0, -INF]), v([INF; 4]))
        .with_initial_state(v(start))
        .with_terminal_component(1, end[0])
        .with_terminal_component(2, end[1])
        .with_terminal_component(3, end[2])
        .with_final_time(1.0, 300.0)
}
