//! The bound by column generation against exact optima.

mod common;

use common::{instance, optimum};
use mtsp::{End, Objective, Options, Problem, lower_bound, solve};
use proptest::prelude::*;

const ITERATIONS: u64 = 1000;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn never_above_the_optimum_nor_below_the_other_bounds(instance in instance(8)) {
        let metric = instance.metric();
        let problem = Problem::new(&metric, instance.vehicles).unwrap().with_service(instance.service.clone()).unwrap();
        let solution = solve(&problem, &Options::default().with_iterations(ITERATIONS)).unwrap();
        let best = optimum(&problem, Objective::Makespan);
        for cuts in [0, 60] {
            let bound = lower_bound::columns(&problem, &solution.routes, cuts, &mut || true).unwrap();
            prop_assert!(bound <= best * (1.0 + 1e-12), "bound {} above the optimum {}", bound, best);
            prop_assert!(bound >= solution.lower_bounds.makespan);
        }
    }

    #[test]
    fn any_solution_will_do(instance in instance(7)) {
        let metric = instance.metric();
        let problem = Problem::new(&metric, instance.vehicles).unwrap();
        let mut routes = vec![vec![]; instance.vehicles];
        routes[0] = problem.targets().to_vec();
        let bound = lower_bound::columns(&problem, &routes, 0, &mut || true).unwrap();
        prop_assert!(bound <= optimum(&problem, Objective::Makespan) * (1.0 + 1e-12));
    }
}

/// Thirty targets on two rings, with duplicates or without: the search's best is above the bound, and the bound above the others.
#[test]
fn tighter_than_the_others_where_routes_are_short() {
    let on_ring = |i: usize| {
        let (angle, radius) = (2.4 * i as f64, if i.is_multiple_of(3) { 40.0 } else { 90.0 });
        [radius * angle.cos(), radius * angle.sin()]
    };
    let mut nodes = vec![[0.0, 0.0]];
    nodes.extend((0..30).map(on_ring));
    for duplicates in [0, 3] {
        nodes.extend((0..duplicates).map(on_ring));
        let metric = christofides::Points(&nodes);
        let problem = Problem::new(&metric, 5).unwrap();
        let solution = solve(&problem, &Options::default().with_iterations(20_000)).unwrap();
        let bound = lower_bound::columns(&problem, &solution.routes, 0, &mut || true).unwrap();
        assert!(bound <= solution.makespan && bound > 1.01 * solution.lower_bounds.makespan, "{bound}");
        let cut = lower_bound::columns(&problem, &solution.routes, 100, &mut || true).unwrap();
        assert!(cut <= solution.makespan && cut > 1.002 * bound, "{cut} after {bound}");
    }
}

#[test]
fn other_variants_keep_the_other_bounds() {
    let nodes = [[0.0, 0.0], [3.0, 0.0], [0.0, 4.0], [5.0, 5.0]];
    let metric = christofides::Points(&nodes);
    let closed = Problem::new(&metric, 2).unwrap();
    let routes = [vec![1, 3], vec![2]];
    for problem in [
        closed.clone().with_open_routes(),
        closed.clone().with_limits(vec![30.0; 2]).unwrap(),
        closed.clone().with_depots(vec![0; 2], vec![End::At(0), End::Open]).unwrap(),
    ] {
        let bound = lower_bound::columns(&problem, &routes, 0, &mut || true).unwrap();
        assert_eq!(bound, lower_bound::both(&problem).makespan);
    }
    let stopped = lower_bound::columns(&closed, &routes, 0, &mut || false).unwrap();
    assert_eq!(stopped, lower_bound::both(&closed).makespan);
}
