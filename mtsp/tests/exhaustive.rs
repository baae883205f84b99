//! Solutions, bounds and factors against exact optima of small instances.

mod common;

use christofides::{Metric, christofides};
use common::{instance, optimum};
use mtsp::{
    End, Error, Objective, Options, Problem, assign, k_splitour, least_fleet, lower_bound, solve, split,
};
use proptest::prelude::*;

/// Relative rounding of sums of up to twenty legs.
const ROUNDING: f64 = 1e-12;

/// Enough to find the optimum of nine targets.
const ITERATIONS: u64 = 4000;

/// Both objectives: bounds hold, the search finds the optimum and its own measure is right.
fn verify<M: Metric>(problem: &Problem<'_, M>) -> Result<(), TestCaseError> {
    let bounds = [lower_bound::quick(problem), lower_bound::with_iterations(problem, 60)];
    for objective in [Objective::Makespan, Objective::Total] {
        let best = optimum(problem, objective);
        let solved =
            solve(problem, &Options::default().with_objective(objective).with_iterations(ITERATIONS));
        if best == f64::INFINITY {
            prop_assert!(solved.is_err());
            continue;
        }
        let tour = lower_bound::tour(problem, 60);
        if objective == Objective::Total {
            prop_assert!(tour <= best, "tour bound {} above the optimum {}", tour, best);
        } else {
            let mean = tour / problem.vehicles() as f64;
            prop_assert!(mean <= best, "tour bound {} above the optimum {}", mean, best);
        }
        for bound in bounds {
            let bound = if objective == Objective::Total { bound.total_cost } else { bound.makespan };
            prop_assert!(bound <= best, "bound {} of {:?} above the optimum {}", bound, objective, best);
            prop_assert!(bound > 0.0 || best <= ROUNDING);
        }
        let solution = solved.unwrap();
        prop_assert!(solution.value(objective) >= best * (1.0 - ROUNDING));
        prop_assert!(
            solution.value(objective) <= best * (1.0 + 1e-9),
            "{:?}: found {} of {}",
            objective,
            solution.value(objective),
            best
        );
        for (vehicle, route) in solution.routes.iter().enumerate() {
            let again = problem.route_length(vehicle, route);
            prop_assert!((solution.lengths[vehicle] - again).abs() <= ROUNDING * again);
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn closed_routes_from_one_depot(instance in instance(8)) {
        let metric = instance.metric();
        verify(&Problem::new(&metric, instance.vehicles).unwrap().with_service(instance.service.clone()).unwrap())?;
    }

    #[test]
    fn open_routes(instance in instance(8)) {
        let metric = instance.metric();
        let problem = Problem::new(&metric, instance.vehicles).unwrap().with_open_routes();
        verify(&problem.with_service(instance.service.clone()).unwrap())?;
    }

    #[test]
    fn several_depots_and_given_ends(instance in instance(8), open in any::<bool>()) {
        prop_assume!(instance.nodes.len() > 3);
        let metric = instance.metric();
        let starts = (0..instance.vehicles).map(|v| v % 2).collect();
        let ends = (0..instance.vehicles).map(|v| if open && v > 0 { End::Open } else { End::At(2 - v % 2) }).collect();
        let problem = Problem::new(&metric, instance.vehicles).unwrap().with_depots(starts, ends).unwrap();
        verify(&problem.with_service(instance.service.clone()).unwrap())?;
    }

    #[test]
    fn forbidden_and_required_pairs(instance in instance(8), choice in 0usize..100) {
        prop_assume!(instance.nodes.len() > 2 && instance.vehicles > 1);
        let metric = instance.metric();
        let n = instance.nodes.len() - 1;
        let problem = Problem::new(&metric, instance.vehicles).unwrap()
            .forbidding(choice % instance.vehicles, 1 + choice % n).unwrap()
            .requiring((choice / 7) % instance.vehicles, 1 + (choice + 1) % n).unwrap();
        verify(&problem)?;
    }

    #[test]
    fn k_splitour_keeps_its_factor(instance in instance(8)) {
        let metric = instance.metric();
        let problem = Problem::new(&metric, instance.vehicles).unwrap().with_service(instance.service.clone()).unwrap();
        // The tour must be within 3/2 of the best under the distances with service on the edges.
        let half = |i: usize| if i == 0 { 0.0 } else { 0.5 * instance.service[i] };
        let served = christofides::FromFn::metric(metric.len(), |i, j| {
            if i == j { 0.0 } else { metric.distance(i, j) + (half(i) + half(j)) }
        });
        let mut order = christofides(&served).unwrap().into_order();
        let depot = order.iter().position(|&v| v == 0).unwrap();
        order.rotate_left(depot);
        let best = optimum(&problem, Objective::Makespan);
        let longest = |routes: &[Vec<usize>]| {
            routes.iter().enumerate().map(|(v, r)| problem.route_length(v, r)).fold(0.0, f64::max)
        };
        let routes = k_splitour(&problem, &order[1..]).unwrap();
        let factor = 2.5 - 1.0 / instance.vehicles as f64;
        prop_assert!(longest(&routes) <= factor * best * (1.0 + ROUNDING));
        let cut = split(&problem, &order[1..], Objective::Makespan).unwrap();
        prop_assert!(longest(&cut) <= longest(&routes) * (1.0 + ROUNDING));
    }

    #[test]
    fn split_finds_the_best_cuts(instance in instance(9)) {
        let metric = instance.metric();
        let problem = Problem::new(&metric, instance.vehicles).unwrap().with_service(instance.service.clone()).unwrap();
        let order = problem.targets();
        for objective in [Objective::Makespan, Objective::Total] {
            let value = |cuts: &[usize]| {
                let lengths = cuts.windows(2).enumerate().map(|(v, c)| problem.route_length(v, &order[c[0]..c[1]]));
                if objective == Objective::Total { lengths.sum() } else { lengths.fold(0.0, f64::max) }
            };
            let n = order.len();
            let mut best = f64::INFINITY;
            for a in 0..=n {
                for b in a..=n {
                    let cuts = match instance.vehicles {
                        1 => vec![0, n],
                        2 => vec![0, a, n],
                        _ => vec![0, a, b, n],
                    };
                    best = best.min(value(&cuts));
                }
            }
            let routes = split(&problem, order, objective).unwrap();
            let lengths = routes.iter().enumerate().map(|(v, r)| problem.route_length(v, r));
            let found: f64 = if objective == Objective::Total { lengths.sum() } else { lengths.fold(0.0, f64::max) };
            prop_assert!((found - best).abs() <= ROUNDING * best);
        }
    }

    #[test]
    fn assignment_keeps_its_clusters(instance in instance(12), seed in 0usize..1000) {
        let metric = instance.metric();
        let problem = Problem::new(&metric, instance.vehicles).unwrap().with_service(instance.service.clone()).unwrap();
        let labels: Vec<usize> = problem.targets().iter().map(|t| (t * 7 + seed) / 3 % instance.vehicles).collect();
        let solution = assign(&problem, &labels).unwrap();
        for (&target, &label) in problem.targets().iter().zip(&labels) {
            prop_assert!(solution.routes[label].contains(&target));
        }
        for (vehicle, route) in solution.routes.iter().enumerate() {
            let nearest = route.iter().map(|&t| metric.distance(0, t)).fold(f64::INFINITY, f64::min);
            prop_assert!(route.first().is_none_or(|&t| metric.distance(0, t) == nearest));
            // The other direction around the same tour is no shorter.
            let mut other = route.clone();
            if !other.is_empty() {
                other[1..].reverse();
            }
            prop_assert!(solution.lengths[vehicle] <= problem.route_length(vehicle, &other) * (1.0 + ROUNDING));
        }
        prop_assert!(solution.lower_bounds.makespan <= solution.makespan);
    }

    #[test]
    fn the_least_fleet_is_the_least(instance in instance(7), share in 0.4..1.2f64, open in any::<bool>()) {
        let metric = instance.metric();
        let fleet_of = |m: usize| {
            let problem = Problem::new(&metric, m).unwrap().with_service(instance.service.clone()).unwrap();
            if open { problem.with_open_routes() } else { problem }
        };
        let least = |m: usize| optimum(&fleet_of(m), Objective::Makespan);
        let most = 3;
        let limit = share * least(1);
        let problem = fleet_of(most).with_limits(vec![limit; most]).unwrap();
        // Equality to rounding may go either way.
        prop_assume!((1..=most).all(|m| (least(m) - limit).abs() > 1e-6 * limit || limit == 0.0));
        let wanted = (1..=most).find(|&m| least(m) <= limit);
        match least_fleet(&problem, &Options::default().with_iterations(ITERATIONS)) {
            Ok(found) => {
                let expected = if problem.targets().is_empty() { Some(0) } else { wanted };
                prop_assert_eq!(Some(found.vehicles), expected);
                prop_assert!(found.at_least <= found.vehicles);
                let leaving = found.solution.routes.iter().filter(|route| !route.is_empty()).count();
                prop_assert_eq!(leaving, found.vehicles);
                prop_assert!(found.solution.makespan <= limit * (1.0 + 1e-9));
            }
            Err(_) => prop_assert!(wanted.is_none()),
        }
    }

    #[test]
    fn limits_are_kept_or_refused(instance in instance(7), share in 0.3..1.2f64) {
        let metric = instance.metric();
        let free = Problem::new(&metric, instance.vehicles).unwrap();
        let limit = share * 2.0 * optimum(&free, Objective::Makespan);
        let problem = free.with_limits(vec![limit; instance.vehicles]).unwrap();
        let best = optimum(&problem, Objective::Total);
        let options = Options::default().with_objective(Objective::Total).with_iterations(ITERATIONS);
        match solve(&problem, &options) {
            Ok(solution) => {
                prop_assert!(solution.makespan <= limit * (1.0 + 1e-9));
                prop_assert!(solution.lower_bounds.total_cost <= best);
            }
            Err(error) => {
                prop_assert!(best == f64::INFINITY);
                let (remedy, reached) = match error {
                    Error::TargetOutOfReach { remedy, .. } => (remedy, false),
                    Error::LimitsTooSmall { remedy, .. } | Error::LimitsNotMet { remedy, .. } => (remedy, true),
                    other => return Err(TestCaseError::fail(other.to_string())),
                };
                let with = |vehicles: usize, limit: f64| {
                    let limits = vec![limit * (1.0 + 1e-9); vehicles];
                    optimum(&Problem::new(&metric, vehicles).unwrap().with_limits(limits).unwrap(), Objective::Makespan)
                };
                prop_assert!(with(instance.vehicles, remedy.limit) <= remedy.limit * (1.0 + 1e-9));
                prop_assert_eq!(remedy.vehicles.is_some(), reached);
                if let Some(vehicles) = remedy.vehicles {
                    prop_assert!(vehicles > instance.vehicles && with(vehicles, limit).is_finite());
                }
            }
        }
    }
}

#[test]
fn a_refusal_says_what_would_suffice() {
    let nodes = [[0.0, 0.0], [10.0, 0.0], [-10.0, 0.0], [0.0, 10.0]];
    let metric = christofides::Points(&nodes);
    let with_limit =
        |m: usize, limit: f64| Problem::new(&metric, m).unwrap().with_limits(vec![limit; m]).unwrap();
    let refusal = |problem: &Problem<'_, _>| solve(problem, &Options::default()).unwrap_err().to_string();
    assert_eq!(
        refusal(&with_limit(3, 19.0)),
        "target 1 needs a limit of at least 20 even on a route of its own; limits of 20 would suffice"
    );
    let two = refusal(&with_limit(2, 20.0));
    assert!(two.ends_with("limits of 34.14213562373095 would suffice, or 3 vehicles"), "{two}");
}

#[test]
fn no_targets_and_spare_vehicles() {
    let nodes = [[0.0, 0.0], [1.0, 0.0]];
    let metric = christofides::Points(&nodes);
    let solution = solve(&Problem::new(&metric, 5).unwrap(), &Options::default()).unwrap();
    assert_eq!(solution.routes.iter().filter(|r| r.is_empty()).count(), 4);
    assert_eq!(solution.makespan, 2.0);
    let alone = christofides::Points(&nodes[..1]);
    assert_eq!(solve(&Problem::new(&alone, 2).unwrap(), &Options::default()).unwrap().total_cost, 0.0);
}

#[test]
fn asymmetric_legs_are_taken() {
    let metric =
        christofides::FromFn::symmetric(6, |i, j| if j > i { (j - i) as f64 } else { 10.0 * (i - j) as f64 });
    let problem = Problem::new(&metric, 1).unwrap().with_open_routes();
    let solution = solve(&problem, &Options::default().with_iterations(ITERATIONS)).unwrap();
    assert_eq!(solution.routes, [vec![1, 2, 3, 4, 5]]);
}
