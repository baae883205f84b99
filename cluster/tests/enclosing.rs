//! Smallest enclosing balls against all circles through two or three points.

mod common;

use cluster::{smallest_enclosing_ball, smallest_enclosing_circle, smallest_enclosing_sphere};
use common::{distance, points};
use proptest::prelude::*;

/// The least radius over all circles spanned by pairs and triples that hold every point: the definition, O(n^4).
fn exhaustive(points: &[[f64; 2]]) -> f64 {
    let radius = |c: [f64; 2]| points.iter().map(|p| distance(p, &c)).fold(0.0, f64::max);
    let mut best = points.first().map_or(0.0, |p| radius(*p));
    for (i, a) in points.iter().enumerate() {
        for (j, b) in points[..i].iter().enumerate() {
            best = best.min(radius([0.5 * a[0] + 0.5 * b[0], 0.5 * a[1] + 0.5 * b[1]]));
            for c in &points[..j] {
                let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
                let cross = 2.0 * (u[0] * v[1] - u[1] * v[0]);
                let (uu, vv) = (u[0] * u[0] + u[1] * u[1], v[0] * v[0] + v[1] * v[1]);
                let centre = [a[0] + (v[1] * uu - u[1] * vv) / cross, a[1] + (u[0] * vv - v[0] * uu) / cross];
                if centre.iter().all(|x| x.is_finite()) {
                    best = best.min(radius(centre));
                }
            }
        }
    }
    best
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn is_the_smallest_circle(points in points(14)) {
        let size = points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let unit: Vec<[f64; 2]> = points.iter().map(|p| p.map(|x| if size > 0.0 { x / size } else { x })).collect();
        let circle = smallest_enclosing_circle(&unit).unwrap();
        prop_assert!((circle.radius - exhaustive(&unit)).abs() <= 1e-9);
        prop_assert!(unit.iter().all(|p| distance(p, &circle.centre) <= circle.radius * (1.0 + 1e-15)));
        let original = smallest_enclosing_circle(&points).unwrap();
        if size > 0.0 {
            prop_assert!((original.radius / size - circle.radius).abs() <= 1e-9);
        }
    }

    #[test]
    fn cocircular_points_give_their_circle(angles in prop::collection::vec(0.0..6.3f64, 1..40), r in 0.1..10.0f64) {
        let mut points: Vec<[f64; 2]> = angles.iter().map(|a| [3.0 + r * a.cos(), -1.0 + r * a.sin()]).collect();
        points.push([3.0 - r, -1.0]);
        points.push([3.0 + r, -1.0]);
        let circle = smallest_enclosing_circle(&points).unwrap();
        prop_assert!((circle.radius - r).abs() <= 1e-12 * r);
    }

    #[test]
    fn no_small_shift_of_the_centre_gives_a_smaller_sphere(
        raw in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64), 1..60),
    ) {
        let points: Vec<[f64; 3]> = raw.into_iter().map(|(x, y, z)| [x, y, z]).collect();
        let sphere = smallest_enclosing_sphere(&points).unwrap();
        let radius = |c: [f64; 3]| {
            points.iter().map(|p| (0..3).map(|i| (p[i] - c[i]).powi(2)).sum::<f64>().sqrt()).fold(0.0, f64::max)
        };
        // The radius is a convex function of the centre: a local minimum is the minimum.
        for axis in 0..3 {
            for step in [-1e-4, 1e-4] {
                let mut moved = sphere.centre;
                moved[axis] += step;
                prop_assert!(radius(moved) >= sphere.radius - 1e-12);
            }
        }
    }
}

#[test]
fn degenerate_sets() {
    assert_eq!(smallest_enclosing_ball::<2>(&[]).unwrap().radius, 0.0);
    assert_eq!(smallest_enclosing_ball(&[[4.0, 5.0]; 7]).unwrap().centre, [4.0, 5.0]);
    let line: Vec<[f64; 2]> = (0..50).map(|i| [i as f64, 2.0 * i as f64]).collect();
    assert_eq!(smallest_enclosing_circle(&line).unwrap().centre, [24.5, 49.0]);
    assert!(smallest_enclosing_circle(&[[f64::NAN, 0.0]]).is_err());
}
