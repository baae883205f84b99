//! The bounds of the algorithm, on generated metrics.

use christofides::{
    Ends, Metric, Path, Points, christofides, exact_path, exact_tour, held_karp, improve, improve_path,
    min_weight_perfect_matching,
};
use proptest::prelude::*;

fn exhaustive(metric: &impl Metric) -> f64 {
    let n = metric.len();
    let mut best = vec![f64::INFINITY; 1 << n];
    best[0] = 0.0;
    for set in 0..(1_usize << n) {
        let Some(i) = (0..n).find(|i| set >> i & 1 == 0) else { continue };
        for j in (i + 1..n).filter(|j| set >> j & 1 == 0) {
            let slot = set | 1 << i | 1 << j;
            best[slot] = best[slot].min(best[set] + metric.distance(i, j));
        }
    }
    best[(1 << n) - 1]
}

fn points(max: usize) -> impl Strategy<Value = Vec<[f64; 2]>> {
    let real = prop::collection::vec([-1e3..1e3, -1e3..1e3], 0..=max);
    let grid = prop::collection::vec([0..5i32, 0..5i32].prop_map(|p| p.map(f64::from)), 0..=max);
    let line = prop::collection::vec((-100..100i32).prop_map(|x| [f64::from(x), 3.0]), 0..=max);
    prop_oneof![real, grid, line]
}

proptest! {
    #[test]
    fn matching_is_optimal(mut points in points(14)) {
        if points.len() % 2 == 1 { points.pop(); }
        let metric = Points(&points);
        let matching = min_weight_perfect_matching(&metric).unwrap();
        let optimum = exhaustive(&metric);
        prop_assert!((matching.weight() - optimum).abs() <= 1e-9 * optimum + 1e-12, "{} {optimum}", matching.weight());
    }

    #[test]
    fn bounds_hold(points in points(11)) {
        let metric = Points(&points);
        let optimum = exact_tour(&metric).unwrap().cost();
        let tour = christofides(&metric).unwrap();
        prop_assert!(tour.cost() <= 1.5 * optimum * (1.0 + 1e-12));
        prop_assert!(held_karp(&metric, 100).unwrap().value() <= optimum);
        let improved = improve(&metric, tour.clone()).unwrap();
        prop_assert!(improved.cost() <= tour.cost() * (1.0 + 1e-12) && improved.cost() >= optimum * (1.0 - 1e-12));
    }

    #[test]
    fn paths_keep_their_ends(points in points(9)) {
        prop_assume!(points.len() > 3);
        let metric = Points(&points);
        let n = points.len();
        for ends in [Ends::Free, Ends::Start(0), Ends::Both(0, n - 1)] {
            let start = Path::new(&metric, (0..n).collect()).unwrap();
            let best = exact_path(&metric, ends).unwrap();
            let improved = improve_path(&metric, start.clone(), ends).unwrap();
            prop_assert!(improved.cost() <= start.cost() * (1.0 + 1e-12) && improved.cost() >= best.cost() * (1.0 - 1e-12));
            if ends != Ends::Free { prop_assert_eq!(improved.order()[0], 0); prop_assert_eq!(best.order()[0], 0); }
            if matches!(ends, Ends::Both(..)) { prop_assert_eq!(improved.order()[n - 1], n - 1); prop_assert_eq!(best.order()[n-1], n-1); }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Both exact algorithms find the same length: subsets at ten vertices, branch and bound when one more lies on an edge.
    #[test]
    fn exact_algorithms_agree(points in prop::collection::vec([-1e3..1e3, -1e3..1e3], 10), at in 0..10_usize) {
        let optimum = exact_tour(&Points(&points)).unwrap();
        let (a, b) = (optimum.order()[at], optimum.order()[(at + 1) % 10]);
        let mut more = points.clone();
        more.push([0.5 * (points[a][0] + points[b][0]), 0.5 * (points[a][1] + points[b][1])]);
        let larger = exact_tour(&Points(&more)).unwrap();
        prop_assert!((larger.cost() - optimum.cost()).abs() <= 1e-9 * optimum.cost(), "{} {}", larger.cost(), optimum.cost());
    }

    /// The bound from below and the best tour known meet.
    #[test]
    fn branch_and_bound_is_bounded(points in prop::collection::vec([-1e3..1e3, -1e3..1e3], 11..30)) {
        let metric = Points(&points);
        let tour = exact_tour(&metric).unwrap();
        prop_assert!(held_karp(&metric, 300).unwrap().value() <= tour.cost());
        let n = points.len();
        for ends in [Ends::Free, Ends::Start(3), Ends::Both(2, 5)] {
            let path = exact_path(&metric, ends).unwrap();
            let longest = (0..n).map(|k| metric.distance(tour.order()[k], tour.order()[(k + 1) % n])).fold(0.0, f64::max);
            if ends == Ends::Free {
                prop_assert!(path.cost() <= (tour.cost() - longest) * (1.0 + 1e-12));
            }
            let closing = metric.distance(path.order()[0], path.order()[n - 1]);
            prop_assert!(path.cost() + closing >= tour.cost() * (1.0 - 1e-12));
        }
    }
}
