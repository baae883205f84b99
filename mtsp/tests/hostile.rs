//! Numbers at the edge of what `f64` holds: every public function answers or refuses, none panics.

use christofides::{FromFn, Metric, Points};
use mtsp::lower_bound::{self, NumRoutes};
use mtsp::{
    Absorb, End, Error, Fleet, Nodes, Objective, Options, Problem, Revisit, Solution, assign, check,
    k_splitour, least_fleet, procedure_1, procedure_2, solve, solve_from, solve_with, split,
};
use proptest::prelude::*;

fn extreme() -> impl Strategy<Value = f64> {
    let special = prop::sample::select(vec![
        0.0,
        -0.0,
        1.0,
        5e-324,
        1e-310,
        1e-160,
        1e154,
        1e300,
        -1e300,
        f64::MAX,
        f64::INFINITY,
        f64::NAN,
    ]);
    prop_oneof![2 => special, 1 => prop::num::f64::NORMAL, 9 => -1e3..1e3]
}

/// What a vehicle, a limit and a list of numbers make of a metric.
struct Case<'a> {
    vehicles: usize,
    numbers: &'a [f64],
    open: bool,
    depots: bool,
}

/// Every function of a problem; solutions visit every target, and no bound is above a value.
fn call_everything(metric: &impl Metric, case: &Case<'_>) {
    let n = metric.len();
    let number = |i: usize| case.numbers[i % case.numbers.len()];
    let Ok(mut problem) = Problem::new(metric, case.vehicles) else { return };
    let service: Vec<f64> =
        (0..n).map(|i| if case.open { number(i) } else { number(i).abs().min(1e3) }).collect();
    problem = problem.clone().with_service(service).unwrap_or(problem);
    if case.open {
        problem = problem.with_open_routes();
    }
    if case.depots {
        let starts = (0..case.vehicles).map(|v| v % n).collect();
        let ends =
            (0..case.vehicles).map(|v| if v % 2 == 0 { End::At(v % (n + 1)) } else { End::Open }).collect();
        problem = problem.clone().with_depots(starts, ends).unwrap_or(problem);
    }
    let limits = (0..case.vehicles).map(|v| number(v + 3).abs() * 10.0).collect();
    let limited = problem.clone().with_limits(limits).unwrap_or_else(|_| problem.clone());
    let forbidding = limited.clone().forbidding(0, n / 2).unwrap_or_else(|_| limited.clone());
    let requiring =
        limited.clone().requiring(case.vehicles, n).or_else(|_| limited.clone().requiring(0, n - 1));
    for problem in [&problem, &limited, &forbidding].into_iter().chain(requiring.as_ref()) {
        solve_everything(problem);
    }
}

fn solve_everything<M: Metric>(problem: &Problem<'_, M>) {
    let options = Options::default().with_iterations(30);
    let mut found = vec![];
    for objective in [Objective::Makespan, Objective::Total] {
        let options = options.clone().with_objective(objective).with_horizon(10).with_gap(f64::NAN);
        found.extend(solve_with(problem, &options, &mut |progress| progress.makespan > 1.0));
        found.extend(
            split(problem, problem.targets(), objective).and_then(|routes| Solution::of(problem, routes)),
        );
    }
    let labels: Vec<usize> = (0..problem.targets().len()).map(|i| i % problem.vehicles()).collect();
    found.extend(assign(problem, &labels));
    found.extend(k_splitour(problem, problem.targets()).and_then(|routes| Solution::of(problem, routes)));
    found.extend(least_fleet(problem, &options).map(|fleet| fleet.solution));
    for solution in found {
        let again = check(problem, &solution.routes).unwrap();
        assert_eq!(again.lengths, solution.lengths);
        #[cfg(feature = "columns")]
        {
            let mut rounds = 0;
            let bound = lower_bound::columns(problem, &solution.routes, 5, &mut || {
                rounds += 1;
                rounds < 40
            });
            assert!(bound.is_ok_and(|bound| !bound.is_nan()));
        }
        let improved = solve_from(problem, solution.routes.clone(), &options, &mut |_| true);
        if let Ok(improved) = improved {
            assert!(
                improved.makespan <= solution.makespan || improved.makespan.is_nan(),
                "{improved:?} from {solution:?}"
            );
        }
        for objective in [Objective::Makespan, Objective::Total] {
            let _ = (solution.gap(objective), solution.lower_bound(objective), solution.value(objective));
        }
    }
    let bounds =
        [lower_bound::quick(problem), lower_bound::both(problem), lower_bound::with_iterations(problem, 3)];
    for bound in bounds {
        assert!(!bound.makespan.is_nan() && !bound.total_cost.is_nan(), "{bound:?}");
    }
    for bound in [
        lower_bound::radius(problem),
        lower_bound::pigeonhole(problem),
        lower_bound::tour(problem, 3),
        lower_bound::forest(problem, NumRoutes::AtMost, 3),
        lower_bound::forest(problem, NumRoutes::Exactly, 3),
    ] {
        assert!(!bound.is_nan());
    }
}

/// Events at places of any numbers; the books stay in order.
fn fly(fleet: &mut Fleet, places: &[[f64; 2]]) {
    let mut vehicles = vec![];
    let mut targets = vec![];
    for (i, &place) in places.iter().enumerate() {
        match i % 4 {
            0 => vehicles.extend(fleet.join(place)),
            1 | 2 => targets.extend(fleet.appear(place)),
            _ => {
                for &target in &targets {
                    let _ = fleet.shift(target, place);
                }
            }
        }
        for &vehicle in &vehicles {
            let _ = (fleet.visit_next(vehicle), fleet.retour(vehicle));
            let (trip, cluster) = (fleet.trip(vehicle).unwrap(), fleet.cluster(vehicle).unwrap());
            assert!(trip.iter().all(|target| cluster.contains(target)));
            assert!(fleet.position(vehicle).unwrap().iter().all(|x| x.is_finite()));
        }
    }
    for vehicle in vehicles {
        fleet.drop_out(vehicle).unwrap();
        assert_eq!(fleet.drop_out(vehicle), Err(Error::UnknownVehicleId { vehicle }));
    }
    assert_eq!(fleet.unassigned().len(), targets.len());
    for target in targets {
        fleet.vanish(target).unwrap();
        assert_eq!(fleet.is_visited(target), None);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn points_of_any_size(
        points in prop::collection::vec([extreme(), extreme()], 0..12), vehicles in 0..5_usize,
        numbers in prop::collection::vec(extreme(), 5), open in any::<bool>(), depots in any::<bool>(),
    ) {
        call_everything(&Points(&points), &Case { vehicles, numbers: &numbers, open, depots });
        let ordinary: Vec<[f64; 2]> = points.iter().map(|p| p.map(|x| if x.abs() < 1e3 { x } else { 5.0 })).collect();
        call_everything(&Points(&ordinary), &Case { vehicles, numbers: &numbers, open, depots });
    }

    #[test]
    fn tiny_or_huge_points(
        points in prop::collection::vec([-1e3..1e3_f64, -1e3..1e3_f64], 1..12), e in -320..305_i32, vehicles in 1..5_usize,
        numbers in prop::collection::vec(0.0..1e3_f64, 5), open in any::<bool>(),
    ) {
        let scaled: Vec<[f64; 2]> = points.iter().map(|p| p.map(|x| x * 10_f64.powi(e))).collect();
        let numbers: Vec<f64> = numbers.iter().map(|x| x * 10_f64.powi(e)).collect();
        call_everything(&Points(&scaled), &Case { vehicles, numbers: &numbers, open, depots: false });
    }

    #[test]
    fn distances_of_any_size(
        n in 0..9_usize, values in prop::collection::vec(extreme(), 81), vehicles in 1..4_usize, depots in any::<bool>(),
    ) {
        let case = Case { vehicles, numbers: &values, open: false, depots };
        call_everything(&FromFn::symmetric(n, |i, j| values[i * 9 + j]), &case);
        call_everything(&FromFn::metric(n, |i, j| if i == j { 0.0 } else { values[i.min(j) * 9 + i.max(j)].abs() }), &case);
    }

    #[test]
    fn fleets_at_places_of_any_size(places in prop::collection::vec([extreme(), extreme()], 0..40)) {
        for absorb in [Absorb::NearestCluster, Absorb::CheapestInsertion] {
            for revisit in [Revisit::All, Revisit::NewOnly] {
                fly(&mut Fleet::new(revisit, absorb), &places);
            }
        }
    }

    #[test]
    fn rounds_of_any_size(depot in [extreme(), extreme()], targets in prop::collection::vec([extreme(), extreme()], 0..20), vehicles in 0..4_usize) {
        let rounds: Vec<Vec<[f64; 2]>> = targets.chunks(5).map(<[[f64; 2]]>::to_vec).collect();
        for procedure in [procedure_1, procedure_2] {
            if let Ok(cost) = procedure(depot, &rounds, vehicles, 1) {
                prop_assert!(cost.rounds.len() == rounds.len() && !cost.total().is_nan());
            }
        }
    }
}

/// A number alone takes neither memory nor time.
#[test]
fn enormous_numbers_are_refused() {
    let line = FromFn::metric(4, |i, j| i.abs_diff(j) as f64);
    for number in [1 << 40, usize::MAX] {
        let metric = FromFn::metric(number, |_, _| 0.0);
        assert!(matches!(Problem::new(&metric, 1), Err(Error::TooManyNodes { .. })));
        assert!(matches!(Problem::new(&line, number), Err(Error::TooManyVehicles { .. })));
        for procedure in [procedure_1, procedure_2] {
            let refused = procedure([0.0; 2], &[vec![[1.0, 2.0]]], number, 1);
            assert!(matches!(refused, Err(Error::TooManyVehicles { .. })));
        }
        let problem = Problem::new(&line, 2).unwrap();
        assert!(matches!(problem.clone().forbidding(number, 1), Err(Error::UnknownVehicle { .. })));
        assert!(matches!(problem.clone().requiring(0, number), Err(Error::UnknownNode { .. })));
        assert!(matches!(assign(&problem, &[0, 1, number]), Err(Error::LabelOutOfRange { .. })));
        assert!(matches!(split(&problem, &[1, 2, number], Objective::Total), Err(Error::UnknownNode { .. })));
        assert!(matches!(check(&problem, &[vec![1, 2], vec![number]]), Err(Error::UnknownNode { .. })));
        let mut fleet = Fleet::over(Nodes(line), Revisit::All, Absorb::NearestCluster);
        assert!(fleet.join(number).is_err() && fleet.appear(number).is_err());
    }
}

/// A caller that stops at once gets an answer, and no budget is too large to be counted.
#[test]
fn endless_budgets_are_cut_short() {
    let points: Vec<[f64; 2]> = (0..80).map(|k| [f64::from(k * 37 % 101), f64::from(k * 73 % 97)]).collect();
    let metric = Points(&points);
    let problem = Problem::new(&metric, 5).unwrap();
    let endless = Options::default().with_iterations(u64::MAX).with_horizon(u64::MAX);
    let mut asked = 0;
    let stopped = solve_with(&problem, &endless, &mut |_| {
        asked += 1;
        asked < 3
    });
    assert_eq!(stopped.unwrap().routes.iter().map(Vec::len).sum::<usize>(), 79);
    let none = solve(&problem, &Options::default().with_iterations(0).with_horizon(0));
    assert_eq!(none.unwrap().routes.len(), 5);
}
