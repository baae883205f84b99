//! The matching: known optima, exhaustive optima, certificates, invariance.

use christofides::matching::{
    Solver, certificate, max_cardinality_matching, max_weight_matching, min_weight_perfect_matching,
    sparse_min_weight_perfect_matching,
};
use christofides::{Error, FromFn, Matrix, Metric, Points};
use proptest::prelude::*;
use std::collections::HashSet;
use std::path::Path;

/// Decimals of the weights in `index.csv`.
const PRINTED: f64 = 1e-6;

fn data(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name);
    std::fs::read_to_string(path).unwrap()
}

fn read(name: &str) -> Vec<[f64; 2]> {
    let point =
        |line: &str| line.split_once(',').map(|(x, y)| [x.parse().unwrap(), y.parse().unwrap()]).unwrap();
    data(&format!("{name}.csv")).lines().skip(1).map(point).collect()
}

/// The certificate proves the weight to within the stated error and the rounding of the sums of `f64`.
fn assert_certified(metric: &impl Metric, matching: &christofides::Matching) {
    let proof = certificate(metric, matching);
    let tolerance = matching.error_bound() + 1e-9 * matching.weight();
    assert!(proof.is_optimal_within(tolerance), "{proof:?} {}", matching.error_bound());
    assert!(matching.mates().is_empty() || proof.greatest_matched_slack.abs() <= tolerance, "{proof:?}");
    assert!((proof.weight - matching.weight()).abs() <= 1e-12 * proof.weight);
}

#[test]
fn known_optima() {
    let mut solver = Solver::default();
    for line in data("index.csv").lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let points = read(fields[0]);
        let optimum: f64 = fields[2].parse().unwrap();
        let matching = solver.complete(&Points(&points)).unwrap();
        assert!(
            (matching.weight() - optimum).abs() <= PRINTED,
            "{}: {} {optimum}",
            fields[0],
            matching.weight()
        );
        assert!(matching.error_bound() <= 1e-9 * matching.weight());
        assert_certified(&Points(&points), &matching);
        // The same distances without coordinates, and rounded to integers.
        let rounded = FromFn::symmetric(points.len(), |i, j| (Points(&points).distance(i, j) + 0.5).floor());
        let matching = solver.complete(&rounded).unwrap();
        assert_eq!(matching.weight(), fields[3].parse::<f64>().unwrap(), "{}", fields[0]);
        assert_certified(&rounded, &matching);
    }
}

#[test]
fn a_wrong_matching_has_no_certificate() {
    let points = read("uni_50");
    let right = min_weight_perfect_matching(&Points(&points)).unwrap();
    let mut moved = points.clone();
    moved.swap(0, 25);
    let proof = certificate(&Points(&moved), &right);
    assert!(!proof.is_optimal_within(right.error_bound() + 1e-9 * right.weight()));
    // the slacks of the matched pairs add up to what the weight exceeds the dual objective by
    let duals = right.duals().iter().sum::<f64>() + right.blossoms().iter().map(|b| b.dual).sum::<f64>();
    assert!(proof.greatest_matched_slack >= (proof.weight - duals) / 25.0 - 1e-6);
    assert!(!certificate(&Points(&points[..48]), &right).is_consistent);
}

proptest! {
    /// The least slack that the certificate finds is that of all pairs, also where it is far below zero and the search is pruned.
    #[test]
    fn least_slack_is_exhaustive(
        corners in prop::collection::vec(prop::array::uniform2(0.0..100.0_f64), 2..25),
        shifts in prop::collection::vec(prop::array::uniform2(-8.0..8.0_f64), 150),
        is_far in any::<bool>(),
    ) {
        // odd groups, which blossoms surround
        let spread = |c: &[f64; 2]| [[0.0, 0.0], [1.0, 0.0], [0.0, 1.2]].map(|d| [c[0] + d[0], c[1] + d[1]]);
        let mut points: Vec<[f64; 2]> = corners.iter().flat_map(spread).collect();
        points.truncate(points.len() / 2 * 2);
        let matching = min_weight_perfect_matching(&Points(&points)).unwrap();
        let scale = if is_far { 1.0 } else { 1e-3 };
        for (point, shift) in points.iter_mut().zip(&shifts) {
            *point = [point[0] + scale * shift[0], point[1] + scale * shift[1]];
        }
        let sets: Vec<HashSet<usize>> = (0..matching.blossoms().len())
            .map(|k| {
                let within = |mut j: usize| loop {
                    match matching.blossoms()[j].parent {
                        _ if j == k => return true,
                        Some(parent) => j = parent,
                        None => return false,
                    }
                };
                let inside = (0..=k).filter(|&j| within(j));
                inside.flat_map(|j| matching.blossoms()[j].vertices.iter().copied()).collect()
            })
            .collect();
        let slack = |u: usize, v: usize| {
            let separating = |k: &usize| sets[*k].contains(&u) != sets[*k].contains(&v);
            let duals: f64 = (0..sets.len()).filter(separating).map(|k| matching.blossoms()[k].dual).sum();
            Points(&points).distance(u, v) - matching.duals()[u] - matching.duals()[v] - duals
        };
        let pairs = (0..points.len()).flat_map(|u| (0..u).map(move |v| (u, v)));
        let least = pairs.map(|(u, v)| slack(u, v)).fold(0.0, f64::min);
        let abstract_ = FromFn::symmetric(points.len(), |u, v| Points(&points).distance(u, v));
        for found in [certificate(&Points(&points), &matching), certificate(&abstract_, &matching)] {
            prop_assert!((found.least_slack - least).abs() <= 1e-9 * (1.0 + least.abs()), "{found:?} {least}");
        }
    }
}

#[test]
fn malformed_input_is_refused() {
    let odd = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]];
    assert_eq!(min_weight_perfect_matching(&Points(&odd)), Err(Error::OddVertexCount { n: 3 }));
    let nan = [[0.0, 0.0], [1.0, f64::NAN]];
    assert_eq!(
        min_weight_perfect_matching(&Points(&nan)),
        Err(Error::NonFiniteCoordinate { point: 1, axis: 1 })
    );
    let star = [(0, 1, 1.0), (0, 2, 1.0), (0, 3, 1.0)];
    assert_eq!(sparse_min_weight_perfect_matching(4, &star), Err(Error::NoPerfectMatching { exposed: 2 }));
    assert_eq!(
        sparse_min_weight_perfect_matching(2, &[(0, 2, 1.0)]),
        Err(Error::VertexOutOfRange { vertex: 2, n: 2 })
    );
    assert!(min_weight_perfect_matching(&Points::<2>(&[])).unwrap().mates().is_empty());
}

/// The best of all matchings by size times `bonus` plus weight, edge by edge.
fn exhaustive_maximum(edges: &[(usize, usize, f64)], used: usize, bonus: f64) -> f64 {
    let Some((&(u, v, weight), rest)) = edges.split_first() else { return 0.0 };
    let without = exhaustive_maximum(rest, used, bonus);
    let ends = 1 << u | 1 << v;
    if u == v || used & ends != 0 {
        return without;
    }
    without.max(bonus + weight + exhaustive_maximum(rest, used | ends, bonus))
}

/// Least weight over all matchings, vertex by vertex.
fn exhaustive(n: usize, weight: impl Fn(usize, usize) -> f64) -> f64 {
    let mut best = vec![f64::INFINITY; 1 << n];
    best[0] = 0.0;
    for set in 0..(1_usize << n) - 1 {
        let i = (!set).trailing_zeros() as usize;
        for j in (i + 1..n).filter(|j| set >> j & 1 == 0) {
            let slot = set | 1 << i | 1 << j;
            best[slot] = best[slot].min(best[set] + weight(i, j));
        }
    }
    best[(1 << n) - 1]
}

fn hostile_points(max: usize) -> impl Strategy<Value = Vec<[f64; 2]>> {
    let real = || [-1e3..1e3, -1e3..1e3];
    let uniform = prop::collection::vec(real(), 0..max);
    let grid = prop::collection::vec([0..6i32, 0..6i32].prop_map(|p| p.map(f64::from)), 0..max);
    let line = prop::collection::vec((-100..100i32).prop_map(|x| [f64::from(x), 3.0 * f64::from(x)]), 0..max);
    let triples = prop::collection::vec(real(), 0..max / 3).prop_map(|centres| {
        centres.iter().flat_map(|&[x, y]| [[x, y], [x + 1.0, y], [x, y + 1.5]]).collect()
    });
    let scaled = (prop::collection::vec(real(), 0..max), -200..200i32)
        .prop_map(|(points, e)| points.iter().map(|p| p.map(|x| x * 10_f64.powi(e / 2))).collect());
    prop_oneof![uniform, grid, line, triples, scaled]
}

fn even<T>(mut points: Vec<T>) -> Vec<T> {
    points.truncate(points.len() / 2 * 2);
    points
}

proptest! {
    #[test]
    fn complete_is_certified(points in hostile_points(300).prop_map(even)) {
        let metric = Points(&points);
        let matching = min_weight_perfect_matching(&metric).unwrap();
        assert_certified(&metric, &matching);
        // Coordinates only save work.
        let abstract_matching = min_weight_perfect_matching(&Matrix::tabulate(&metric).unwrap()).unwrap();
        prop_assert!((abstract_matching.weight() - matching.weight()).abs() <= 1e-9 * matching.weight());
    }

    #[test]
    fn spatial_is_certified(points in prop::collection::vec([-9..9i32, -9..9i32, -9..9i32].prop_map(|p| p.map(f64::from)), 0..200).prop_map(even)) {
        assert_certified(&Points(&points), &min_weight_perfect_matching(&Points(&points)).unwrap());
    }

    #[test]
    fn all_equal_distances(n in 0..40_usize) {
        let metric = FromFn::metric(2 * n, |i, j| if i == j { 0.0 } else { 7.0 });
        let matching = min_weight_perfect_matching(&metric).unwrap();
        prop_assert_eq!(matching.weight(), 7.0 * n as f64);
        assert_certified(&metric, &matching);
    }

    #[test]
    fn sparse_is_exhaustive(n in (0..6_usize).prop_map(|n| 2 * n), edges in prop::collection::vec((0..12_usize, 0..12_usize, -20..20i32), 0..60)) {
        let edges: Vec<(usize, usize, f64)> =
            edges.into_iter().filter(|e| e.0 < n && e.1 < n).map(|(u, v, w)| (u, v, f64::from(w))).collect();
        let weight = |i: usize, j: usize| {
            edges.iter().filter(|e| (e.0.min(e.1), e.0.max(e.1)) == (i, j)).map(|e| e.2).fold(f64::INFINITY, f64::min)
        };
        let optimum = exhaustive(n, weight);
        match sparse_min_weight_perfect_matching(n, &edges) {
            Ok(matching) => prop_assert_eq!(matching.weight(), optimum),
            Err(error) => {
                let is_refused = matches!(error, Error::NoPerfectMatching { .. });
                prop_assert!(is_refused && optimum == f64::INFINITY)
            }
        }
    }

    #[test]
    fn maximum_is_exhaustive(n in 0..9_usize, edges in prop::collection::vec((0..9_usize, 0..9_usize, -20..20i32), 0..14)) {
        let edges: Vec<(usize, usize, f64)> =
            edges.into_iter().filter(|e| e.0 < n && e.1 < n).map(|(u, v, w)| (u, v, f64::from(w))).collect();
        let heaviest = max_weight_matching(n, &edges).unwrap();
        prop_assert_eq!(heaviest.weight(), exhaustive_maximum(&edges, 0, 0.0));
        let largest = max_cardinality_matching(n, &edges).unwrap();
        let value = 1000.0 * largest.edges().count() as f64 + largest.weight();
        prop_assert_eq!(value, exhaustive_maximum(&edges, 0, 1000.0));
        for matching in [heaviest, largest] {
            prop_assert!(matching.error_bound() < 1e-9);
            for (u, v) in matching.edges() {
                prop_assert!(matching.mates()[u] == Some(v) && matching.mates()[v] == Some(u));
                prop_assert!(edges.iter().any(|e| (e.0.min(e.1), e.0.max(e.1)) == (u, v)));
            }
        }
    }

    /// Relabelling, turning, moving and scaling the points does not change the weight beyond rounding.
    #[test]
    fn weight_is_invariant(points in prop::collection::vec([-1e3..1e3f64, -1e3..1e3f64], 2..120).prop_map(even), angle in 0.0..6.3f64, scale in 1e-3..1e3f64) {
        let weight = |points: &[[f64; 2]]| min_weight_perfect_matching(&Points(points)).unwrap().weight();
        let (sin, cos) = f64::sin_cos(angle);
        let image = |p: &[f64; 2]| [scale * (cos * p[0] - sin * p[1]) + 5.0, scale * (sin * p[0] + cos * p[1]) - 7.0];
        let moved: Vec<[f64; 2]> = points.iter().rev().map(image).collect();
        prop_assert!((weight(&moved) - scale * weight(&points)).abs() <= 1e-9 * scale * weight(&points));
    }
}
