//! Reused storage: the same results, and nothing allocated once it has grown.

use christofides::{
    Ends, FromFn, Metric, Options, Points, Workspace, christofides, christofides_with, solve, solve_path,
    solve_with,
};

/// Points in the unit square by a linear congruence.
fn uniform(n: usize, mut state: u64) -> Vec<[f64; 2]> {
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..n).map(|_| [next(), next()]).collect()
}

/// Allocations of a second round over instances that the workspace has seen.
fn allocations_of_second_round(metrics: &[impl Metric]) -> u64 {
    let mut workspace = Workspace::default();
    let mut round = || {
        for metric in metrics {
            christofides_with(&mut workspace, metric).unwrap();
        }
    };
    round();
    allocation_counter::measure(round).count_total
}

#[test]
fn few_vertices_allocate_nothing() {
    for n in [0, 1, 2, 3, 4, 12, 30, 100, 150] {
        let sets: Vec<_> = (0..10).map(|seed| uniform(n, seed)).collect();
        let planar: Vec<_> = sets.iter().map(|points| Points(points)).collect();
        assert_eq!(allocations_of_second_round(&planar), 0, "{n} points of the plane");
        let abstracts: Vec<_> =
            planar.iter().map(|points| FromFn::metric(n, |i, j| points.distance(i, j))).collect();
        assert_eq!(allocations_of_second_round(&abstracts), 0, "{n} vertices");
        let lifted: Vec<Vec<[f64; 3]>> =
            sets.iter().map(|points| points.iter().map(|&[x, y]| [x, y, x * y]).collect()).collect();
        let spatial: Vec<_> = lifted.iter().map(|points| Points(points)).collect();
        assert_eq!(allocations_of_second_round(&spatial), 0, "{n} points of space");
    }
}

#[test]
fn more_vertices_allocate_only_what_indexes_them() {
    let sets = [uniform(2000, 1)];
    let metrics: Vec<_> = sets.iter().map(|points| Points(points)).collect();
    let again = allocations_of_second_round(&metrics);
    let first = allocation_counter::measure(|| {
        let _ = christofides(&metrics[0]);
    });
    assert!(again > 0 && 2 * again < first.count_total, "{again} {}", first.count_total);
}

#[test]
fn storage_leaves_no_trace() {
    let mut workspace = Workspace::default();
    for n in [40, 3, 200, 0, 12, 1000, 7, 150, 1, 2] {
        let points = uniform(n, n as u64);
        let again = christofides_with(&mut workspace, &Points(&points)).unwrap();
        assert_eq!(again, &christofides(&Points(&points)).unwrap(), "{n}");
    }
}

#[test]
fn solving_in_reused_storage_gives_the_same_bits() {
    let options = Options::default().with_kicks(50).with_ascent_iterations(20);
    let mut workspace = Workspace::default();
    for n in [40, 3, 200, 0, 12, 9, 7, 150, 1, 2, 11] {
        for exact_up_to in [0, 10] {
            let points = uniform(n, n as u64);
            let options = options.clone().with_exact_up_to(exact_up_to);
            let again = solve_with(&mut workspace, &Points(&points), &options, &mut || false).unwrap();
            assert_eq!(again, &solve(&Points(&points), &options, &mut || false).unwrap(), "{n}");
        }
    }
}

/// Without positions no k-d tree is built: nothing is left that allocates.
#[test]
fn the_local_search_allocates_nothing_again() {
    let points = uniform(100, 5);
    let metric = FromFn::metric(100, |i, j| Points(&points).distance(i, j));
    let options = Options::default().with_kicks(100).with_ascent_iterations(0);
    let mut workspace = Workspace::default();
    let mut run = || solve_with(&mut workspace, &metric, &options, &mut || false).map(|_| ()).unwrap();
    run();
    assert_eq!(allocation_counter::measure(run).count_total, 0);
}

/// Without a kick the path ends at a local optimum near Christofides' tour, whatever the order of the input.
#[test]
fn paths_start_from_a_good_tour() {
    let points = uniform(300, 8);
    let metric = Points(&points);
    let options = Options::default().with_kicks(0).with_ascent_iterations(100);
    let tour = christofides(&metric).unwrap();
    for (ends, allowance) in [(Ends::Free, 0.0), (Ends::Start(7), 0.0), (Ends::Both(7, 290), 1.5)] {
        let path = solve_path(&metric, ends, &options, &mut || false).unwrap();
        assert!(
            path.cost() <= tour.cost() + allowance && path.gap().unwrap() < 0.15,
            "{ends:?} {:?}",
            path.gap()
        );
        if let Ends::Start(start) | Ends::Both(start, _) = ends {
            assert_eq!(path.order()[0], start);
        }
        if let Ends::Both(_, end) = ends {
            assert_eq!(path.order()[299], end);
        }
    }
}
