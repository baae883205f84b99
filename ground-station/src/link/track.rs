//! A vehicle's planned flight as setpoints: sampled once, looked up many times a second.

use mavlink::dialects::common::{
    MavFrame, MavMessage, PositionTargetTypemask, SET_POSITION_TARGET_LOCAL_NED_DATA,
};
use planner::Sample;
use std::f64::consts::FRAC_PI_2;

/// One moment of a flight: east-north-up (m, m/s, m/s^2), yaw from east, counter-clockwise (rad).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Moment {
    /// Position.
    pub position: [f64; 3],
    /// Velocity.
    pub velocity: [f64; 3],
    /// Acceleration.
    pub acceleration: [f64; 3],
    /// Where the nose points.
    pub yaw: f64,
}

/// A flight from rest to rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    times: Vec<f64>,
    moments: Vec<Moment>,
}

impl Track {
    /// The flight of a plan; `None` for a vehicle that stays on its pad.
    #[must_use]
    pub fn new(samples: &[Sample]) -> Option<Self> {
        let times: Vec<f64> = samples.iter().map(|sample| sample.time).collect();
        let moments = samples.iter().map(|sample| Moment {
            position: sample.position,
            velocity: sample.velocity,
            acceleration: sample.acceleration,
            yaw: heading(sample.attitude),
        });
        (!times.is_empty()).then(|| Self { times, moments: moments.collect() })
    }

    /// When it starts (s after the mission's start).
    #[must_use]
    pub fn start(&self) -> f64 {
        self.times.first().copied().unwrap_or(0.0)
    }

    /// When it ends (s after the mission's start).
    #[must_use]
    pub fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// The moment at `time` (s after the mission's start); at rest before the start and after the end.
    #[must_use]
    pub fn at(&self, time: f64) -> Moment {
        let high = self.times.partition_point(|&other| other <= time);
        match (high.checked_sub(1).and_then(|low| self.moments.get(low)), self.moments.get(high)) {
            (Some(low), Some(next)) => {
                let [from, to] = [self.times[high - 1], self.times[high]];
                between(low, next, (time - from) / (to - from), to - from)
            }
            (Some(only), None) | (None, Some(only)) => {
                Moment { velocity: [0.0; 3], acceleration: [0.0; 3], ..*only }
            }
            (None, None) => Moment::default(),
        }
    }

    /// How far a position (m) is from where the flight has been within the last `window` seconds.
    #[must_use]
    pub fn deviation(&self, position: [f64; 3], time: f64, window: f64) -> f64 {
        const LOOKS: i32 = 10;
        let looks = (0..=LOOKS).map(|look| {
            let planned = self.at(time - window * f64::from(look) / f64::from(LOOKS)).position;
            let miss = [0, 1, 2].map(|axis| position[axis] - planned[axis]);
            miss.iter().map(|part| part * part).sum::<f64>().sqrt()
        });
        looks.fold(f64::INFINITY, f64::min)
    }
}

/// Between two moments `step` seconds apart: the cubic through both positions and velocities, the rest linear.
fn between(a: &Moment, b: &Moment, share: f64, step: f64) -> Moment {
    let s = share;
    let linear = |a: f64, b: f64| a + (b - a) * s;
    let cubic = |axis: usize| {
        let [h00, h10] = [(1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s), s * (1.0 - s) * (1.0 - s)];
        let [h01, h11] = [s * s * (3.0 - 2.0 * s), s * s * (s - 1.0)];
        h00 * a.position[axis]
            + h10 * step * a.velocity[axis]
            + h01 * b.position[axis]
            + h11 * step * b.velocity[axis]
    };
    Moment {
        position: [0, 1, 2].map(cubic),
        velocity: [0, 1, 2].map(|axis| linear(a.velocity[axis], b.velocity[axis])),
        acceleration: [0, 1, 2].map(|axis| linear(a.acceleration[axis], b.acceleration[axis])),
        yaw: a.yaw + (b.yaw - a.yaw).sin().atan2((b.yaw - a.yaw).cos()) * s,
    }
}

/// Yaw of a body-to-world quaternion (w, x, y, z), from east, counter-clockwise.
fn heading([w, x, y, z]: [f64; 4]) -> f64 {
    (2.0 * (x * y + w * z)).atan2(1.0 - 2.0 * (y * y + z * z))
}

/// Where a vehicle's own local frame lies in the plan's.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LocalFrame {
    /// East and north of its origin (m).
    pub origin: [f64; 2],
    /// Its `z` (m, down) on the ground.
    pub ground: f64,
}

impl LocalFrame {
    /// Plan position of a local north-east-down position.
    #[must_use]
    pub fn plan_position(&self, [north, east, down]: [f64; 3]) -> [f64; 3] {
        [self.origin[0] + east, self.origin[1] + north, self.ground - down]
    }

    /// The setpoint message for a moment; `whole` with velocity, acceleration and yaw, else the position alone.
    #[must_use]
    pub fn setpoint(&self, target: (u8, u8), milliseconds: u32, moment: &Moment, whole: bool) -> MavMessage {
        let Moment { position, velocity, acceleration, yaw } = *moment;
        let mask = match whole {
            true => PositionTargetTypemask::POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE,
            false => PositionTargetTypemask::from_bits_truncate(POSITION_ALONE),
        };
        let north_yaw = FRAC_PI_2 - yaw;
        MavMessage::SET_POSITION_TARGET_LOCAL_NED(SET_POSITION_TARGET_LOCAL_NED_DATA {
            time_boot_ms: milliseconds,
            x: (position[1] - self.origin[1]) as f32,
            y: (position[0] - self.origin[0]) as f32,
            z: (self.ground - position[2]) as f32,
            vx: velocity[1] as f32,
            vy: velocity[0] as f32,
            vz: -velocity[2] as f32,
            afx: acceleration[1] as f32,
            afy: acceleration[0] as f32,
            afz: -acceleration[2] as f32,
            yaw: north_yaw.sin().atan2(north_yaw.cos()) as f32,
            yaw_rate: 0.0,
            type_mask: mask,
            target_system: target.0,
            target_component: target.1,
            coordinate_frame: MavFrame::MAV_FRAME_LOCAL_NED,
        })
    }
}

/// Velocity, acceleration and yaw rate ignored; the yaw counts.
const POSITION_ALONE: u16 = 8 | 16 | 32 | 64 | 128 | 256 | 2048;

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(time: f64) -> Moment {
        let (sin, cos) = time.sin_cos();
        Moment {
            position: [cos, sin, 2.0],
            velocity: [-sin, cos, 0.0],
            acceleration: [-cos, -sin, 0.0],
            yaw: time + FRAC_PI_2,
        }
    }

    fn track() -> Track {
        let times: Vec<f64> = (0..=60).map(|step| 3.0 + f64::from(step) * 0.1).collect();
        Track { moments: times.iter().map(|&time| circle(time)).collect(), times }
    }

    #[test]
    fn lookups_follow_the_flight() {
        let track = track();
        for step in 0..600 {
            let time = 3.0 + f64::from(step) * 0.01;
            let (seen, wanted) = (track.at(time), circle(time));
            for axis in 0..3 {
                assert!((seen.position[axis] - wanted.position[axis]).abs() < 1e-6, "{time}");
                assert!((seen.velocity[axis] - wanted.velocity[axis]).abs() < 2e-3);
            }
            assert!((seen.yaw - wanted.yaw).sin().abs() < 1e-9);
        }
        assert_eq!(track.at(0.0), Moment { velocity: [0.0; 3], acceleration: [0.0; 3], ..circle(3.0) });
        assert_eq!(track.at(99.0).velocity, [0.0; 3]);
        assert!(track.deviation(circle(4.0).position, 4.4, 0.5) < 0.02);
        assert!(track.deviation(circle(4.0).position, 6.0, 0.5) > 1.0);
    }

    #[test]
    fn setpoints_are_north_east_down_in_the_vehicles_frame() {
        let frame = LocalFrame { origin: [10.0, 20.0], ground: -0.5 };
        let moment = Moment {
            position: [11.0, 22.0, 3.0],
            velocity: [1.0, 2.0, 3.0],
            acceleration: [4.0, 5.0, 6.0],
            yaw: 0.0,
        };
        let MavMessage::SET_POSITION_TARGET_LOCAL_NED(data) = frame.setpoint((3, 1), 7, &moment, true) else {
            unreachable!("it is a setpoint");
        };
        assert_eq!([data.x, data.y, data.z, data.vx, data.vy, data.vz], [2.0, 1.0, -3.5, 2.0, 1.0, -3.0]);
        assert_eq!([data.afx, data.afy, data.afz], [5.0, 4.0, -6.0]);
        // East is a quarter turn clockwise from north.
        assert!((f64::from(data.yaw) - FRAC_PI_2).abs() < 1e-6);
        assert_eq!(data.type_mask.bits(), 2048);
        assert_eq!(frame.plan_position([2.0, 1.0, -3.5]), moment.position);
    }
}
