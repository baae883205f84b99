//! The bounds of the algorithm, on generated metrics.

use christofides::tsplib::Instance;
use christofides::{
    Ends, Error, FromFn, Matrix, Metric, Options, Path, Points, chained_improve, christofides, exact_path,
    exact_tour, held_karp, improve, improve_path, min_weight_perfect_matching, minimum_spanning_tree, solve,
    solve_path, validate,
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

fn spanning_tree_cost(metric: &impl Metric) -> f64 {
    minimum_spanning_tree(metric).unwrap().iter().map(|&[i, j]| metric.distance(i, j)).sum()
}

/// Shortest paths between all pairs make a metric of any weights.
fn closure(n: usize, weights: &[u8]) -> Matrix {
    let mut d: Vec<f64> =
        (0..n * n).map(|k| f64::from(weights[(k / n).min(k % n) * n + (k / n).max(k % n)])).collect();
    for via in 0..n {
        for i in 0..n {
            for j in 0..n {
                d[i * n + j] = d[i * n + j].min(d[i * n + via] + d[via * n + j]);
            }
        }
    }
    (0..n).for_each(|i| d[i * n + i] = 0.0);
    Matrix::metric(n, d).unwrap()
}

/// Everything that Christofides' proof says, on one metric.
fn check_proof(metric: &impl Metric) -> Result<(), TestCaseError> {
    let n = metric.len();
    let slack = 1.0 + 1e-12;
    let optimum = exact_tour(metric).unwrap().cost();
    let tree = minimum_spanning_tree(metric).unwrap();
    let tree_cost = spanning_tree_cost(metric);
    let mut is_odd = vec![false; n];
    tree.iter().flatten().for_each(|&v| is_odd[v] ^= true);
    let odd: Vec<usize> = (0..n).filter(|&v| is_odd[v]).collect();
    let matching = exhaustive(&FromFn::metric(odd.len(), |i, j| metric.distance(odd[i], odd[j])));
    prop_assert!(tree_cost <= optimum * slack);
    prop_assert!(matching <= 0.5 * optimum * slack);
    prop_assert!(tree_cost + matching <= 1.5 * optimum * slack);
    prop_assert!(christofides(metric).unwrap().cost() <= (tree_cost + matching) * slack);
    prop_assert!(held_karp(metric, 60).unwrap().value() <= optimum);
    Ok(())
}

proptest! {
    #[test]
    fn the_proof_holds_for_points(points in points(12)) {
        check_proof(&Points(&points))?;
    }

    #[test]
    fn the_proof_holds_in_space(points in prop::collection::vec([0..4i32, 0..4i32, 0..4i32].prop_map(|p| p.map(f64::from)), 0..11)) {
        check_proof(&Points(&points))?;
    }

    #[test]
    fn the_proof_holds_for_closures(n in 0..11_usize, weights in prop::collection::vec(0..30u8, 121)) {
        check_proof(&closure(n, &weights))?;
    }

    #[test]
    fn the_proof_holds_for_equal_distances(n in 0..12_usize) {
        check_proof(&FromFn::metric(n, |i, j| if i == j { 0.0 } else { 3.0 }))?;
    }

    /// Spanning tree, optimum and bound do not depend on names, place, direction or unit.
    #[test]
    fn values_are_invariant(points in prop::collection::vec([-1e3..1e3f64, -1e3..1e3f64], 3..11), angle in 0.0..6.3f64, scale in 1e-3..1e3f64) {
        let (sin, cos) = angle.sin_cos();
        let image = |p: &[f64; 2]| [scale * (cos * p[0] - sin * p[1]) + 5.0, scale * (sin * p[0] + cos * p[1]) - 7.0];
        let moved: Vec<[f64; 2]> = points.iter().rev().map(image).collect();
        let (here, there) = (Points(&points), Points(&moved));
        let close = |a: f64, b: f64, tolerance: f64| (scale * a - b).abs() <= tolerance * scale * a;
        prop_assert!(close(spanning_tree_cost(&here), spanning_tree_cost(&there), 1e-9));
        prop_assert!(close(exact_tour(&here).unwrap().cost(), exact_tour(&there).unwrap().cost(), 1e-9));
        // The ascent stops near the same limit, wherever it starts.
        let bound = |metric: &Points<2>| held_karp(metric, 2000).unwrap().value();
        prop_assert!(close(bound(&here), bound(&there), 3e-3), "{} {}", scale * bound(&here), bound(&there));
    }

    /// The same seed gives the same bits; a path is bounded from below; tours and paths cover every vertex.
    #[test]
    fn solving_is_deterministic(points in prop::collection::vec([-1e3..1e3f64, -1e3..1e3f64], 0..60), seed in 0..9_u64) {
        let metric = Points(&points);
        let options = Options::default().with_seed(seed).with_kicks(30).with_ascent_iterations(50);
        let tour = solve(&metric, &options, &mut || false).unwrap();
        prop_assert_eq!(&tour, &solve(&metric, &options, &mut || false).unwrap());
        prop_assert!(tour.lower_bound().unwrap() <= tour.cost() && tour.gap().unwrap() >= 0.0);
        let path = solve_path(&metric, Ends::Free, &options, &mut || false).unwrap();
        prop_assert!(path.lower_bound().unwrap() <= path.cost() && path.cost() <= tour.cost() * (1.0 + 1e-12));
        let stopped = solve(&metric, &options, &mut || true).unwrap();
        prop_assert_eq!(stopped.order().len(), points.len());
    }
}

#[test]
fn what_is_no_metric_is_refused() {
    let bent = vec![0.0, 1.0, 9.0, 2.0, 1.0, 0.0, 1.0, 2.0, 9.0, 1.0, 0.0, 2.0, 2.0, 2.0, 2.0, 0.0];
    let triangle = Error::TriangleInequality { i: 0, j: 2, via: 1 };
    assert_eq!(Matrix::metric(4, bent.clone()), Err(triangle.clone()));
    let matrix = Matrix::symmetric(4, bent).unwrap();
    assert_eq!(christofides(&matrix), Err(triangle.clone()));
    assert_eq!(validate(&matrix), Err(triangle));
    // Without a guarantee it is solved all the same.
    assert_eq!(solve(&matrix, &Options::default(), &mut || false).unwrap().cost(), 6.0);
    let one_way = FromFn::metric(3, |i, j| if i < j { 1.0 } else { f64::from(u8::from(i != j)) * 2.0 });
    assert_eq!(christofides(&one_way), Err(Error::Asymmetric { i: 0, j: 1 }));
    let infinite = [[0.0, 0.0], [f64::INFINITY, 0.0]];
    assert_eq!(christofides(&Points(&infinite)), Err(Error::NonFiniteCoordinate { point: 1, axis: 0 }));
    let huge = [[-1e308, 0.0], [1e308, 0.0]];
    assert_eq!(christofides(&Points(&huge)), Err(Error::Overflow));
}

fn tsplib(name: &str) -> Instance {
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name);
    Instance::read(&std::fs::read_to_string(file).unwrap()).unwrap()
}

#[test]
fn tsplib_optima_are_found() {
    for (name, optimum) in
        [("eil51.tsp", 426.0), ("berlin52.tsp", 7542.0), ("st70.tsp", 675.0), ("kroA100.tsp", 21282.0)]
    {
        let instance = tsplib(name);
        let rounded = instance.metric(true);
        let start = christofides(&instance.metric(false)).unwrap();
        let start = christofides::Tour::new(&rounded, start.into_order()).unwrap();
        let tour = chained_improve(&rounded, start, 2000, 1, &mut || false).unwrap();
        assert_eq!(tour.cost(), optimum, "{name}");
        let bound = held_karp(&rounded, 400).unwrap().value();
        assert!(bound <= optimum && bound >= 0.98 * optimum, "{name}: {bound}");
    }
}
