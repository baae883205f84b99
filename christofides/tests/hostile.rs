//! Numbers at the edge of what `f64` holds: every public function answers or refuses, none panics.

use christofides::matching::{certificate, min_weight_perfect_matching, sparse_min_weight_perfect_matching};
use christofides::{
    Ends, Error, FromFn, Matrix, Metric, Options, Path, Points, Tour, chained_improve, christofides,
    euler_circuit, exact_path, exact_tour, held_karp, improve, improve_path, minimum_spanning_tree, shortcut,
    solve, solve_path, validate,
};
use proptest::prelude::*;

/// Everything that takes a metric; what comes back covers all vertices at a finite cost.
fn call_everything(metric: &impl Metric) {
    let n = metric.len();
    let options = Options::default().with_kicks(5).with_ascent_iterations(5);
    let is_valid = validate(metric).is_ok();
    let tours = [christofides(metric), solve(metric, &options, &mut || false), exact_tour(metric)];
    for tour in tours.into_iter().flatten() {
        assert!(tour.order().len() == n && tour.cost().is_finite());
        let improved = improve(metric, tour.clone()).unwrap();
        assert!(improved.cost() <= tour.cost());
        let _ = chained_improve(metric, tour, 3, 1, &mut || false).unwrap();
    }
    assert!(!is_valid || christofides(metric).is_ok());
    for ends in [Ends::Free, Ends::Start(n / 2), Ends::Both(n / 2, 0)] {
        let _ = exact_path(metric, ends);
        if let Ok(path) = solve_path(metric, ends, &options, &mut || false) {
            assert!(path.order().len() == n && path.cost().is_finite());
            let _ = improve_path(metric, path, ends).unwrap();
        }
    }
    let _ = (held_karp(metric, 5), minimum_spanning_tree(metric), Matrix::tabulate(metric));
    if let Ok(matching) = min_weight_perfect_matching(metric) {
        let _ = certificate(metric, &matching);
    }
    // Orders that were made elsewhere, on distances that nobody checked.
    let identity: Vec<usize> = (0..n).collect();
    let _ = improve(metric, Tour::new(metric, identity.clone()).unwrap());
    let _ = improve_path(metric, Path::new(metric, identity.clone()).unwrap(), Ends::Free);
    let _ = shortcut(metric, &identity);
}

fn extreme() -> impl Strategy<Value = f64> {
    let special = prop::sample::select(vec![
        0.0,
        -0.0,
        1.0,
        5e-324,
        1e-310,
        1e-160,
        1e150,
        1e154,
        1e300,
        -1e300,
        f64::MAX,
        f64::INFINITY,
        f64::NAN,
    ]);
    prop_oneof![3 => special, 1 => prop::num::f64::NORMAL, 6 => -1e3..1e3]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn points_of_any_size(points in prop::collection::vec([extreme(), extreme()], 0..40)) {
        call_everything(&Points(&points));
    }

    #[test]
    fn tiny_or_huge_points(points in prop::collection::vec([-1e3..1e3f64, -1e3..1e3f64], 0..60), e in -320..153i32) {
        let scaled: Vec<[f64; 2]> = points.iter().map(|p| p.map(|x| x * 10_f64.powi(e))).collect();
        call_everything(&Points(&scaled));
    }

    #[test]
    fn points_in_space(points in prop::collection::vec([extreme(), extreme(), extreme()], 0..30)) {
        call_everything(&Points(&points));
    }

    #[test]
    fn distances_of_any_size(n in 0..14_usize, values in prop::collection::vec(extreme(), 14 * 14)) {
        call_everything(&FromFn::symmetric(n, |i, j| if i == j { 0.0 } else { values[i.min(j) * 14 + i.max(j)] }));
        call_everything(&FromFn::metric(n, |i, j| values[i * 14 + j]));
    }

    #[test]
    fn graphs_of_any_weights(n in 0..9_usize, edges in prop::collection::vec((0..9_usize, 0..9_usize, extreme()), 0..40)) {
        let _ = sparse_min_weight_perfect_matching(n, &edges);
        let ends: Vec<[usize; 2]> = edges.iter().map(|edge| [edge.0, edge.1]).collect();
        let _ = euler_circuit(n, &ends);
    }

    /// More points than the quadratic algorithms take, where most coincide or lie on a line.
    #[test]
    fn many_degenerate_points(points in prop::collection::vec((0..9i32, extreme()), 151..220)) {
        let mixed: Vec<[f64; 2]> = points.iter().map(|&(x, y)| [f64::from(x), y]).collect();
        let line: Vec<[f64; 2]> = points.iter().map(|&(x, _)| [f64::from(x) * 1e-300, 0.0]).collect();
        for points in [mixed, line] {
            let _ = (christofides(&Points(&points)), minimum_spanning_tree(&Points(&points)));
        }
    }
}

#[test]
fn wrong_orders_are_refused() {
    let points = Points(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]);
    assert_eq!(Tour::new(&points, vec![0, 1]), Err(Error::DimensionMismatch { expected: 3, found: 2 }));
    assert_eq!(Tour::new(&points, vec![0, 1, 1]), Err(Error::NotAPermutation { vertex: 1 }));
    assert_eq!(Path::new(&points, vec![0, 1, 3]), Err(Error::VertexOutOfRange { vertex: 3, n: 3 }));
    assert_eq!(shortcut(&points, &[0, 2]), Err(Error::NotAPermutation { vertex: 1 }));
    assert_eq!(shortcut(&points, &[0, 9]), Err(Error::VertexOutOfRange { vertex: 9, n: 3 }));
    assert_eq!(Matrix::symmetric(2, vec![0.0; 3]), Err(Error::DimensionMismatch { expected: 4, found: 3 }));
}
