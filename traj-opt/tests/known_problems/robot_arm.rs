//! Least time of an arm that stretches and turns.
//!
//! Source: COPS 3.0 (Dolan, More and Munson 2004), problem 8 (9.14093).

use super::definition::{INF, Known, c, problem, v};
use traj_opt::{Bounds, Guess};

problem!(RobotArm<6, 3>, |t, x, u| {
        let l = c::<T>(5.0);
        let (a, b) = (l - x[0], x[0]);
        let cubes = a * a * a + b * b * b;
        let sin = x[2].sin();
        [x[3], x[4], x[5], u[0] / l, c::<T>(3.0) * u[1] / (cubes * sin * sin), c::<T>(3.0) * u[2] / cubes]
    },
    mayer: |xf, tf| tf,
    bounds: Bounds::free().with_control(v([-1.0; 3]), v([1.0; 3])).with_initial_state(v([4.5, 0.0, std::f64::consts::FRAC_PI_4, 0.0, 0.0, 0.0]))
        .with_state(v([0.0, -3.2, 0.01, -INF, -INF, -INF]), v([5.0, 3.2, 3.13, INF, INF, INF]))
        .with_terminal_state(v([4.5, 2.0 * std::f64::consts::FRAC_PI_3, std::f64::consts::FRAC_PI_4, 0.0, 0.0, 0.0])).with_final_time(0.1, 100.0),
    guess: Guess::line(v([4.5, 0.0, std::f64::consts::FRAC_PI_4, 0.0, 0.0, 0.0]), v([4.5, 2.0 * std::f64::consts::FRAC_PI_3, std::f64::consts::FRAC_PI_4, 0.0, 0.0, 0.0]), v([0.0; 3]), 8.0));

pub fn known() -> Known {
    Known::new("robot_arm", RobotArm, RobotArm::guess(), 9.140_92, 1e-5, 200)
}
