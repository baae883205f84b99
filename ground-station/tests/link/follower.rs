//! How a real ArduCopter follows streamed setpoints: a cascade of position and velocity errors with the setpoint's own
//! velocity and acceleration added, jerk and acceleration limited, late by the tilting of the vehicle.
//!
//! Gains are ArduCopter's defaults (`PSC_POSXY_P` 1, `PSC_VELXY_P` 2); the lateness is calibrated on flown circles.

/// A moment to be at: north, east, down.
#[derive(Clone, Copy, Default, Debug, PartialEq)]
pub struct Setpoint {
    pub position: [f64; 3],
    pub velocity: [f64; 3],
    pub acceleration: [f64; 3],
}

#[derive(Clone, Debug)]
pub struct Follower {
    pub position: [f64; 3],
    pub velocity: [f64; 3],
    acceleration: [f64; 3],
}

const POSITION_GAIN: f64 = 1.0;
const VELOCITY_GAIN: f64 = 2.0;
/// Time of the tilting (s), from the flown radii.
const LATENESS: f64 = 0.12;
const ACCELERATION: f64 = 4.0;
const JERK: f64 = 15.0;
const CLIMB: f64 = 1.5;

impl Follower {
    pub fn new(position: [f64; 3]) -> Self {
        Self { position, velocity: [0.0; 3], acceleration: [0.0; 3] }
    }

    pub fn step(&mut self, wanted: &Setpoint, dt: f64) {
        let mut goal = [0, 1, 2].map(|axis| {
            let mut correction = POSITION_GAIN * (wanted.position[axis] - self.position[axis]);
            correction = correction.clamp(-CLIMB, CLIMB);
            let velocity = wanted.velocity[axis] + correction;
            wanted.acceleration[axis] + VELOCITY_GAIN * (velocity - self.velocity[axis])
        });
        let level = goal[0].hypot(goal[1]);
        if level > ACCELERATION {
            goal[0] *= ACCELERATION / level;
            goal[1] *= ACCELERATION / level;
        }
        for axis in 0..3 {
            let jerk = ((goal[axis] - self.acceleration[axis]) / LATENESS).clamp(-JERK, JERK);
            self.acceleration[axis] += jerk * dt;
            self.velocity[axis] += self.acceleration[axis] * dt;
            self.position[axis] += self.velocity[axis] * dt;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOWN: &str = include_str!("../data/guided_stream_path.csv");

    /// Mean distance from a centre of what the real simulation flew on a circle around it, and of what the follower flies.
    #[test]
    fn circles_are_flown_as_wide_as_an_arducopter_flies_them() {
        let rows: Vec<Vec<f64>> = FLOWN
            .lines()
            .skip(1)
            .map(|line| line.split(',').filter_map(|cell| cell.parse().ok()).collect())
            .collect();
        for (centre, radius, speed) in
            [([10.0, 0.0], 1.5, 1.5), ([18.0, 8.0], 2.0, 1.8), ([8.0, 15.0], 3.0, 2.2)]
        {
            let from_centre = |n: f64, e: f64| (n - centre[0]).hypot(e - centre[1]);
            let near: Vec<f64> = rows
                .iter()
                .map(|row| from_centre(row[1], row[2]))
                .filter(|&distance: &f64| (distance - radius).abs() < 0.25)
                .collect();
            let flown = near.iter().sum::<f64>() / near.len() as f64;
            let rate = speed / radius;
            let at = |time: f64| {
                let (sin, cos) = (rate * time).sin_cos();
                Setpoint {
                    position: [centre[0] + radius * cos, centre[1] + radius * sin, -2.0],
                    velocity: [-speed * sin, speed * cos, 0.0],
                    acceleration: [-speed * rate * cos, -speed * rate * sin, 0.0],
                }
            };
            let mut follower = Follower::new(at(0.0).position);
            follower.velocity = at(0.0).velocity;
            let dt = 0.01;
            let lap = std::f64::consts::TAU / rate;
            let mut distances = Vec::new();
            for tick in 0..(3.0 * lap / dt) as usize {
                let time = tick as f64 * dt;
                follower.step(&at(time), dt);
                if time > 2.0 * lap {
                    distances.push(from_centre(follower.position[0], follower.position[1]));
                }
            }
            let model = distances.iter().sum::<f64>() / distances.len() as f64;
            assert!(
                near.len() > 10 && (model - flown).abs() < 0.06,
                "radius {radius}: flown {flown:.3}, model {model:.3}"
            );
        }
    }
}
