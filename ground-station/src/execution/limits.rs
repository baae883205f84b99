//! What the autopilots make of missions, with the limits that their parameters have unless changed.

use std::f64::consts::TAU;

/// `CIRCLE_RATE` of ArduCopter (rad/s).
pub const CIRCLE_RATE: f64 = 20.0 * TAU / 360.0;
/// `WPNAV_ACCEL` of ArduCopter (m/s^2).
pub const ACCELERATION: f64 = 2.5;
/// `WPNAV_JERK` of ArduCopter (m/s^3): legs of missions.
pub const MISSION_JERK: f64 = 1.0;
/// `PSC_JERK_XY` of ArduCopter (m/s^3): streamed setpoints.
pub const STREAM_JERK: f64 = 5.0;
/// `WPNAV_SPEED` of ArduCopter (m/s).
pub const SPEED: f64 = 10.0;
/// What a `LOITER_TURNS` item loses of its view (rad): it counts the turns of a point that the vehicle follows.
pub const LOST_BY_ITEMS: f64 = 20.0 * TAU / 360.0;
/// What a streamed circle loses of its view (rad): the vehicle is late by so much. Measured: 353 to 355 degrees of 360.
pub const LOST_BY_STREAM: f64 = 7.0 * TAU / 360.0;
/// What a `LOITER_TURNS` item takes to get moving (s): 19.6 s measured where the rate alone gives 18 s.
pub const GETTING_MOVING: f64 = 1.6;
/// PX4's limit of the centripetal acceleration of an orbit (m/s^2).
pub const ORBIT_ACCELERATION: f64 = 2.0;
/// PX4's least radius of an orbit (m).
pub const ORBIT_RADIUS: f64 = 1.0;
/// `LOITER_TURNS`: radii up to this are stored as whole metres, larger ones as tens of metres.
pub const WHOLE_METRES: f64 = 255.0;
/// The largest radius that a `LOITER_TURNS` item can hold (m).
pub const LARGEST_RADIUS: f64 = 2550.0;
/// The most turns that a `LOITER_TURNS` item can hold.
pub const MOST_TURNS: f64 = 255.0;

/// Time from rest to rest over `distance` (m) within a speed (m/s), an acceleration (m/s^2) and a jerk (m/s^3).
///
/// The seven-phase profile of a jerk-limited axis, shortened where the distance allows neither the full acceleration nor
/// the full speed.
#[must_use]
pub fn rest_to_rest(distance: f64, speed: f64, acceleration: f64, jerk: f64) -> f64 {
    if distance.is_nan() || distance <= 0.0 {
        return 0.0;
    }
    // Least time to reach a speed from rest, and the way it takes (half of speed times time, by symmetry).
    let ramp = |top: f64| {
        if top * jerk < acceleration * acceleration {
            2.0 * (top / jerk).sqrt()
        } else {
            top / acceleration + acceleration / jerk
        }
    };
    let way = |top: f64| top * ramp(top);
    if way(speed) <= distance {
        return 2.0 * ramp(speed) + (distance - way(speed)) / speed;
    }
    let (mut low, mut high) = (0.0, speed);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if way(middle) < distance { low = middle } else { high = middle }
    }
    2.0 * ramp(low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn known_profiles() {
        // Far: cruise at 10 m/s; ramps of 4 s + 2.5 s each.
        let ramp = 10.0 / 2.5 + 2.5 / 1.0;
        assert!(
            (rest_to_rest(100.0, 10.0, 2.5, 1.0) - (2.0 * ramp + (100.0 - 10.0 * ramp) / 10.0)).abs() < 1e-9
        );
        // Near: four phases of full jerk, t = 4 (d / 2 j)^(1/3).
        assert!((rest_to_rest(0.5, 10.0, 2.5, 1.0) - 4.0 * 0.25_f64.cbrt()).abs() < 1e-9);
        assert_eq!(rest_to_rest(0.0, 1.0, 1.0, 1.0), 0.0);
    }

    proptest! {
        #[test]
        fn longer_ways_take_longer(d in 0.01..500.0f64, more in 0.01..50.0f64, v in 0.5..15.0f64, a in 0.5..6.0f64, j in 0.5..20.0f64) {
            let time = rest_to_rest(d, v, a, j);
            prop_assert!(time >= d / v && rest_to_rest(d + more, v, a, j) > time);
        }
    }
}
