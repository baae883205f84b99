//! Certified lower bounds against exact times and against motions that exist.
#![cfg(feature = "clarabel")]

use proptest::prelude::*;
use traj_opt::{BoundOptions, Error, PointMass, least_time_bound};

fn rest_to_rest(distance: f64, acceleration: f64, speed: f64) -> PointMass {
    let zero = [0.0; 3];
    PointMass {
        start: zero,
        start_velocity: zero,
        end: [0.6 * distance, 0.0, 0.8 * distance],
        end_velocity: zero,
        acceleration,
        bias: zero,
        speed,
    }
}

/// Exact least time along a straight line from rest to rest: a trapezium of velocity.
fn trapezium(d: f64, a: f64, v: f64) -> f64 {
    if d * a <= v * v { 2.0 * (d / a).sqrt() } else { d / v + v / a }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    #[test]
    fn rest_to_rest_bounds_are_below_the_exact_time_and_near_it(d in 0.1..200.0_f64, a in 0.5..20.0_f64, v in 0.5..20.0_f64) {
        let exact = trapezium(d, a, v);
        let bound = least_time_bound(&rest_to_rest(d, a, v), &BoundOptions::default()).unwrap();
        prop_assert!(bound <= exact * (1.0 + 1e-12), "{} above {}", bound, exact);
        prop_assert!(bound >= 0.9 * exact, "{} far below {}", bound, exact);
    }

    #[test]
    fn no_motion_that_exists_is_shorter(
        accelerations in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 1..12), step in 0.05..2.0_f64, fall in 0.0..9.81_f64,
        v0 in prop::array::uniform3(-3.0..3.0_f64),
    ) {
        // fly a motion with piecewise constant acceleration exactly, and let its own extremes be the limits
        let (mut p, mut v, mut fastest, mut strongest) = ([0.0; 3], v0, 0.0_f64, 1e-6_f64);
        let norm = |v: [f64; 3]| -> f64 { f64::hypot(f64::hypot(v[0], v[1]), v[2]) };
        let bias: [f64; 3] = [0.0, 0.0, -fall];
        for b in &accelerations {
            fastest = fastest.max(norm(v));
            strongest = strongest.max(norm(*b));
            for i in 0..3 {
                let a = b[i] + bias[i];
                p[i] += step * (v[i] + 0.5 * step * a);
                v[i] += step * a;
            }
        }
        // speed is convex in time over each piece: greatest at its ends
        fastest = fastest.max(norm(v));
        let mass = PointMass {
            start: [0.0; 3], start_velocity: v0, end: p, end_velocity: v,
            acceleration: strongest * (1.0 + 1e-9), bias, speed: fastest * (1.0 + 1e-9),
        };
        let bound = least_time_bound(&mass, &BoundOptions::default().with_n_intervals(8)).unwrap();
        let flown = step * accelerations.len() as f64;
        prop_assert!(bound <= flown * (1.0 + 1e-9), "{} above {}", bound, flown);
    }
}

#[test]
fn malformed_limits_are_refused_and_no_way_takes_no_time() {
    let mut mass = rest_to_rest(1.0, 1.0, 1.0);
    mass.speed = f64::INFINITY;
    assert!(matches!(least_time_bound(&mass, &BoundOptions::default()), Err(Error::InvalidOption { .. })));
    mass.speed = 1.0;
    mass.acceleration = f64::NAN;
    assert!(least_time_bound(&mass, &BoundOptions::default()).is_err());
    assert_eq!(least_time_bound(&rest_to_rest(0.0, 1.0, 1.0), &BoundOptions::default()), Ok(0.0));
}
