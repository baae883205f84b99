//! A fast estimate of transition times, calibrated on transitions that were solved.
//!
//! It bounds nothing and decides nothing alone: what it proposes is solved, and kept only if it is faster.

use nalgebra::Vector2;
use quad_dynamics::Motion;

/// `t = offset + slope m`, where `m` is the least time in which a point in level flight could do it along the worst of several
/// directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TimeModel {
    /// Greatest acceleration in level flight (m/s^2).
    acceleration: f64,
    /// Greatest speed in level flight (m/s).
    speed: f64,
    /// Velocity of the air: east, north (m/s).
    wind: Vector2<f64>,
    offset: f64,
    slope: f64,
}

/// Directions looked at.
const DIRECTIONS: usize = 16;

impl TimeModel {
    /// Not calibrated yet.
    pub(crate) fn new(acceleration: f64, speed: f64) -> Self {
        Self { acceleration, speed, wind: Vector2::zeros(), offset: 0.0, slope: 1.0 }
    }

    /// The same where the air moves: east, north (m/s). Only the greatest speed over the ground changes.
    pub(crate) fn in_wind(self, wind: Vector2<f64>) -> Self {
        Self { wind, ..self }
    }

    /// The least-squares line through solved transitions: from, to, time (s). As it was if they determine none.
    pub(crate) fn calibrated(self, solved: &[(Motion, Motion, f64)]) -> Self {
        let points: Vec<[f64; 2]> =
            solved.iter().map(|(from, to, time)| [self.level(from, to), *time]).collect();
        let n = points.len() as f64;
        let mean = |i: usize| points.iter().map(|point| point[i]).sum::<f64>() / n;
        let [x, y] = [mean(0), mean(1)];
        let spread: f64 = points.iter().map(|point| (point[0] - x).powi(2)).sum();
        let slope = points.iter().map(|point| (point[0] - x) * (point[1] - y)).sum::<f64>() / spread;
        if slope.is_finite() && slope > 0.0 { Self { offset: y - slope * x, slope, ..self } } else { self }
    }

    /// About how long a transition takes (s).
    pub(crate) fn time(&self, from: &Motion, to: &Motion) -> f64 {
        self.offset + self.slope * self.level(from, to)
    }

    /// About how long a transition over an offset (m: east, north) takes that starts and ends at a speed (m/s) in its
    /// direction (s).
    pub(crate) fn time_over(&self, [east, north]: [f64; 2], speed: f64) -> f64 {
        let distance = east.hypot(north);
        let tail = if distance > 0.0 { (self.wind.x * east + self.wind.y * north) / distance } else { 0.0 };
        self.offset + self.slope * self.along(tail, distance, speed, speed)
    }

    fn level(&self, from: &Motion, to: &Motion) -> f64 {
        let offset = (to.position - from.position).xy();
        let (v_0, v_1) = (from.velocity.xy(), to.velocity.xy());
        let along = |n: Vector2<f64>| self.along(self.wind.dot(&n), offset.dot(&n), v_0.dot(&n), v_1.dot(&n));
        (0..DIRECTIONS)
            .map(|i| (i as f64 / DIRECTIONS as f64 * std::f64::consts::TAU).sin_cos())
            .map(|(sin, cos)| along(Vector2::new(cos, sin)))
            .fold(offset.try_normalize(0.0).map_or(0.0, along), f64::max)
    }

    /// Least time on a line, from speed to speed: the double integrator with bounded acceleration and speed, the latter raised
    /// by the wind along the line.
    fn along(&self, tail: f64, distance: f64, from: f64, to: f64) -> f64 {
        let a = self.acceleration;
        let direct = (to - from).abs() / a;
        if distance <= 0.5 * (from + to) * direct {
            return direct;
        }
        let peak = (a * distance + 0.5 * (from * from + to * to)).max(0.0).sqrt();
        let v = (self.speed + tail).max(0.1 * self.speed).max(from).max(to);
        if peak <= v {
            return (2.0 * peak - from - to) / a;
        }
        let cruise = distance - (2.0 * v * v - from * from - to * to) / (2.0 * a);
        (2.0 * v - from - to) / a + cruise / v
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use quad_dynamics::{Vehicle, VehicleParameters};

    fn at(x: f64, speed: f64) -> Motion {
        let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
        let mut motion = Motion::hover(&vehicle, [x, 0.0, 2.0].into(), 0.0);
        motion.velocity.x = speed;
        motion
    }

    #[test]
    fn a_line_takes_the_double_integrators_time() {
        let model = TimeModel::new(2.0, 4.0);
        // 8 m from rest to rest: up to 4 m/s and down again, 2 s each.
        assert!((model.time(&at(0.0, 0.0), &at(8.0, 0.0)) - 4.0).abs() < 1e-12);
        // 16 m: two more seconds at full speed.
        assert!((model.time(&at(0.0, 0.0), &at(16.0, 0.0)) - 6.0).abs() < 1e-12);
    }

    #[test]
    fn calibration_recovers_a_line_and_refuses_nonsense() {
        let model = TimeModel::new(2.0, 4.0);
        let solved: Vec<_> = [4.0, 9.0, 25.0]
            .map(|x| (at(0.0, 0.0), at(x, 0.0), 0.5 + 1.25 * model.time(&at(0.0, 0.0), &at(x, 0.0))))
            .to_vec();
        let found = model.calibrated(&solved);
        for (from, to, time) in &solved {
            assert!((found.time(from, to) - time).abs() < 1e-9);
        }
        assert_eq!(model.calibrated(&[]), model);
        assert_eq!(model.calibrated(&solved[..1]), model);
    }
}
