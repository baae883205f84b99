//! Numbers at the edge of what `f64` holds: every public function answers or refuses, none panics.

use christofides::matching::{
    Solver, certificate, max_cardinality_matching, max_weight_matching, min_weight_perfect_matching,
    sparse_min_weight_perfect_matching,
};
use christofides::{
    Ends, Error, FromFn, Matrix, Metric, Options, Path, Points, Tour, Workspace, chained_improve,
    chained_improve_path, christofides, christofides_with, euler_circuit, exact_path, exact_tour, held_karp,
    improve, improve_path, minimum_spanning_tree, shortcut, solve, solve_path, solve_with, validate,
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
            let improved = improve_path(metric, path, ends).unwrap();
            let chained = chained_improve_path(metric, improved.clone(), ends, 3, 1, &mut || false).unwrap();
            assert!(chained.cost() <= improved.cost());
        }
    }
    // Storage that failed calls leave behind is as good as new.
    let mut workspace = Workspace::default();
    let _ = solve_with(&mut workspace, metric, &options, &mut || true).is_ok();
    assert_eq!(christofides_with(&mut workspace, metric).cloned(), christofides(metric));
    let mut solver = Solver::default();
    let _ = solver.sparse(2, &[(0, 1, 1e300)]);
    assert_eq!(solver.complete(metric), min_weight_perfect_matching(metric));
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
        for matching in [max_weight_matching(n, &edges), max_cardinality_matching(n, &edges)].into_iter().flatten() {
            for (u, v) in matching.edges() {
                prop_assert!(edges.iter().any(|e| (e.0.min(e.1), e.0.max(e.1)) == (u, v)));
                prop_assert_eq!(matching.mates()[v], Some(u));
            }
        }
        let ends: Vec<[usize; 2]> = edges.iter().map(|edge| [edge.0, edge.1]).collect();
        let _ = euler_circuit(n, &ends);
    }

    /// What a file claims to be a matching is proven or refused, whatever it says.
    #[cfg(feature = "serde")]
    #[test]
    fn forged_matchings_prove_nothing(
        mates in prop::collection::vec(0..7_usize, 0..7),
        duals in prop::collection::vec(-1e3..1e3f64, 0..7),
        blossoms in prop::collection::vec((-1e3..1e3f64, prop::option::of(0..5_usize), prop::collection::vec(0..8_usize, 0..6)), 0..4),
    ) {
        let blossoms: Vec<_> = blossoms
            .iter()
            .map(|(dual, parent, vertices)| serde_json::json!({"dual": dual, "parent": parent, "vertices": vertices}))
            .collect();
        let text = serde_json::json!({"mates": mates, "weight": 0.0, "error_bound": 1e300, "duals": duals, "blossoms": blossoms});
        let forged: christofides::Matching = serde_json::from_value(text).unwrap();
        let points: Vec<[f64; 2]> = (0..6).map(|k| [f64::from(k * k), f64::from(7 - k)]).collect();
        let optimum = min_weight_perfect_matching(&Points(&points)).unwrap().weight();
        let proof = certificate(&Points(&points), &forged);
        prop_assert!(!proof.is_consistent || proof.lower_bound <= optimum);
        prop_assert!(!proof.is_optimal_within(0.0) || proof.weight <= optimum);
    }

    #[cfg(feature = "petgraph")]
    #[test]
    fn road_graphs_of_any_weights(n in 0..9_usize, edges in prop::collection::vec((0..9_u32, 0..9_u32, extreme()), 0..40)) {
        let mut graph = petgraph::graph::UnGraph::<(), f64>::default();
        for _ in 0..n {
            graph.add_node(());
        }
        for &(u, v, length) in edges.iter().filter(|e| (e.0 as usize) < n && (e.1 as usize) < n) {
            graph.add_edge(u.into(), v.into(), length);
        }
        if let Ok(closure) = Matrix::closure(&graph, |length| *length) {
            prop_assert!(closure.as_slice().iter().all(|x| x.is_finite() && *x >= 0.0));
            call_everything(&closure);
        }
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

/// A number of vertices alone takes neither memory nor time.
#[test]
fn enormous_numbers_of_vertices_are_refused() {
    for n in [(1 << 30) + 2, 1 << 40, usize::MAX - 1, usize::MAX] {
        let metric = FromFn::metric(n, |_, _| 0.0);
        let too_many = Error::TooManyVertices { n, limit: 1 << 30 };
        assert_eq!(validate(&metric), Err(too_many.clone()));
        assert_eq!(christofides(&metric), Err(too_many.clone()));
        assert_eq!(christofides_with(&mut Workspace::default(), &metric).cloned(), Err(too_many.clone()));
        assert_eq!(solve(&metric, &Options::default(), &mut || true), Err(too_many.clone()));
        assert_eq!(solve_path(&metric, Ends::Free, &Options::default(), &mut || true), Err(too_many.clone()));
        assert_eq!(exact_tour(&metric), Err(too_many.clone()));
        assert_eq!(exact_path(&metric, Ends::Start(5)), Err(too_many.clone()));
        assert_eq!(held_karp(&metric, 1), Err(too_many.clone()));
        assert_eq!(minimum_spanning_tree(&metric), Err(too_many.clone()));
        assert_eq!(min_weight_perfect_matching(&metric), Err(too_many.clone()));
        assert_eq!(euler_circuit(n, &[]), Err(too_many.clone()));
        assert_eq!(max_weight_matching(n, &[]), Err(too_many.clone()));
        assert_eq!(max_cardinality_matching(n, &[(0, 1, 1.0)]), Err(too_many));
        assert!(matches!(Matrix::tabulate(&metric), Err(Error::TooManyVertices { .. })));
        assert!(matches!(Matrix::symmetric(n, vec![]), Err(Error::DimensionMismatch { .. })));
        assert!(matches!(Tour::new(&metric, vec![]), Err(Error::DimensionMismatch { .. })));
        assert_eq!(shortcut(&metric, &[0]), Err(Error::NotAPermutation { vertex: 1 }));
        assert!(sparse_min_weight_perfect_matching(n, &[(0, 1, 1.0)]).is_err());
    }
    let few = sparse_min_weight_perfect_matching(1 << 30, &[(0, 1, 1.0)]);
    assert_eq!(few, Err(Error::NoPerfectMatching { exposed: (1 << 30) - 2 }));
}

/// A caller that stops at once gets an answer, and one that keeps counting is asked.
#[test]
fn endless_budgets_are_cut_short() {
    let points: Vec<[f64; 2]> = (0..500).map(|k| [f64::from(k * 37 % 101), f64::from(k * 73 % 97)]).collect();
    let options = Options::default().with_kicks(usize::MAX).with_ascent_iterations(3);
    let mut asked = 0;
    let mut stop = || {
        asked += 1;
        asked > 3
    };
    let tour = solve(&Points(&points), &options, &mut stop).unwrap();
    assert_eq!(tour.order().len(), 500);
    let path = solve_path(&Points(&points), Ends::Free, &options, &mut || true).unwrap();
    assert_eq!(path.order().len(), 500);
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

/// Seen from two points that are very far away all others are one: no bound tells their orders apart, and the search must give up.
#[test]
fn a_proof_that_cannot_be_found_is_not_claimed() {
    let near = (0..22).map(|i| [1e3 * f64::from(i).sin(), 1e3 * f64::from(3 * i).cos()]);
    let points: Vec<[f64; 2]> = near.chain([[1e150, 0.0], [0.0, 1e150]]).collect();
    let tour = exact_tour(&Points(&points)).unwrap();
    let bound = tour.lower_bound().unwrap();
    assert!(0.0 < bound && bound <= tour.cost() && tour.cost() <= 1.5 * bound, "{bound} {}", tour.cost());
}
