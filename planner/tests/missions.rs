//! Whole missions, planned and then checked by an integration that does not know the solver.

use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{
    Entries, Error, Failure, Mission, Model, Options, Outcome, Phase, Pipeline, Plan, Problem, Target,
    Tolerances, Warning, plan,
};

/// Two vehicles, three targets; few entries, so that a test stays quick.
fn small(model: Model) -> Mission {
    let positions = [[12.0, 3.0], [20.0, 14.0], [-6.0, 11.0]];
    let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
    let mut mission = Mission::new(vehicle, 2, positions.map(Target::at).to_vec());
    mission.transition.model = model;
    mission.transition.entries = Entries::Sampled(4);
    mission
}

fn planned(mission: &Mission) -> Plan {
    plan(mission, &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_model_gives_a_plan_that_stands_verification() {
    for model in [Model::PointMass, Model::JerkLimited, Model::ThrustRate, Model::RigidBody] {
        let mission = small(model);
        let plan = planned(&mission);
        let verification = plan.verify(&mission, &Tolerances::default());
        assert!(verification.passed(), "{model:?}: {:?}", verification.failures);
        assert_eq!(verification.legs.len(), 5, "{model:?}: three circles and two ways home");
        let certificate = plan.certificate;
        assert!(certificate.makespan_lower_bound > 0.0 && certificate.total_lower_bound > 0.0);
        assert!(certificate.makespan >= certificate.makespan_lower_bound);
        assert!(certificate.total >= certificate.total_lower_bound);
    }
}

#[test]
fn every_candidate_is_accounted_for_and_the_best_is_flown() {
    let mission = small(Model::ThrustRate);
    for leg in planned(&mission).vehicles.iter().flat_map(|vehicle| &vehicle.legs) {
        // The only candidate is one that was chosen for the route as a whole.
        let all = leg.loiter.is_some() && leg.candidates.len() > 1;
        assert_eq!(leg.candidates.len(), if all { 8 } else { 1 });
        let solved = leg.candidates.iter().filter_map(|candidate| match candidate.outcome {
            Outcome::Solved { duration } => Some(duration),
            _ => None,
        });
        let best = solved.fold(f64::INFINITY, f64::min);
        assert_eq!(best, leg.transition.duration);
        for candidate in &leg.candidates {
            if let Outcome::ProvenWorse { lower_bound } = candidate.outcome {
                assert!(lower_bound >= best);
            }
        }
    }
}

#[test]
fn entries_chosen_for_whole_routes_are_never_slower_and_often_faster() {
    let mut mission = small(Model::ThrustRate);
    mission.fleet.vehicles = 1;
    let plan = planned(&mission);
    let vehicle = &plan.vehicles[0];
    let saved = vehicle.leg_by_leg - vehicle.duration();
    assert!(saved > 0.0, "{saved}");
    assert!(vehicle.legs.iter().any(|leg| leg.loiter.is_some() && leg.candidates.len() == 1));
    assert!(plan.verify(&mission, &Tolerances::default()).passed());
}

#[test]
fn a_free_entry_is_never_worse_than_the_samples_it_starts_from() {
    let mut mission = small(Model::ThrustRate);
    mission.targets.truncate(1);
    mission.transition.entries = Entries::Sampled(16);
    let sampled = planned(&mission);
    mission.transition.entries = Entries::Free;
    let free = planned(&mission);
    let first = |plan: &Plan| {
        let flying = plan.vehicles.iter().find(|vehicle| !vehicle.legs.is_empty()).unwrap();
        flying.legs[0].transition.duration
    };
    assert!(first(&free) <= first(&sampled), "{} against {}", first(&free), first(&sampled));
    let verification = free.verify(&mission, &Tolerances::default());
    assert!(verification.passed(), "{:?}", verification.failures);
}

#[test]
fn spare_vehicles_stay_on_their_pads() {
    let mut mission = small(Model::PointMass);
    mission.fleet.vehicles = 5;
    let plan = planned(&mission);
    let flying = plan.vehicles.iter().filter(|vehicle| !vehicle.legs.is_empty()).count();
    assert!(flying <= 3);
    let spare = plan.vehicles.iter().position(|vehicle| vehicle.legs.is_empty()).unwrap();
    let sample = plan.sample(&mission, spare, 3.0).unwrap();
    assert_eq!((sample.phase, sample.position), (Phase::Pad, plan.vehicles[spare].pad));
    assert!(plan.verify(&mission, &Tolerances::default()).passed());
}

/// The way leads right over a target that nobody looked out for: its safe distance is passed closely, not in a wide curve, and the
/// entry is the one that solving all candidates would choose.
#[test]
fn a_safe_distance_on_the_way_is_passed_closely() {
    let mut mission = Mission::new(
        Vehicle::survey_450(),
        1,
        vec![Target::at([-21.232, 13.434]), Target::at([2.662, -9.103])],
    );
    mission.depot = [60.0, 60.0];
    mission.loiter.radius = 7.009;
    mission.pipeline = Pipeline::Paper;
    let all = plan(&mission, &Options::default().with_exhaustive(true)).unwrap();
    let plan = plan(&mission, &Options::default()).unwrap();
    let [plan, all] = [plan, all].map(|plan| plan.vehicles[0].legs[1].transition.duration);
    assert!(plan < 3.445 && plan <= 1.001 * all, "{plan} s, of all candidates {all} s");
}

#[test]
fn the_papers_pipeline_and_merged_targets_are_planned() {
    let mut mission = small(Model::PointMass);
    mission.pipeline = Pipeline::Paper;
    mission.targets.push(Target::at([12.5, 3.5]));
    mission.merge_within = 2.0;
    let plan = planned(&mission);
    assert_eq!(plan.circles.len(), 3);
    let merged = plan.circles.iter().find(|circle| circle.members.len() == 2).unwrap();
    assert!(merged.radius > mission.loiter.radius);
    assert!(plan.verify(&mission, &Tolerances::default()).passed());
}

#[test]
fn trajectories_are_continuous_from_pad_to_pad() {
    let mission = small(Model::ThrustRate);
    let plan = planned(&mission);
    for (vehicle, planned) in plan.vehicles.iter().enumerate() {
        let samples = plan.samples(&mission, vehicle, 50.0).unwrap();
        let (first, last) = (samples[0], samples[samples.len() - 1]);
        assert!(
            (first.time - planned.start_time()).abs() < 1e-9 && (last.time - planned.end_time()).abs() < 1e-9
        );
        for axis in 0..3 {
            assert!((first.position[axis] - planned.pad[axis]).abs() < 1e-9);
            assert!((last.position[axis] - planned.pad[axis]).abs() < 0.05);
        }
        for pair in samples.windows(2) {
            let speed = pair[0].velocity.iter().chain(&pair[1].velocity).map(|v| v * v).sum::<f64>().sqrt();
            let step = (0..3)
                .map(|axis| (pair[1].position[axis] - pair[0].position[axis]).powi(2))
                .sum::<f64>()
                .sqrt();
            assert!(
                step <= (pair[1].time - pair[0].time) * (speed + 1.0) + 0.02,
                "a jump at {} s",
                pair[1].time
            );
        }
    }
}

/// Verification must be able to fail.
#[test]
fn a_tampered_plan_is_caught() {
    let mission = small(Model::ThrustRate);
    let plan = planned(&mission);
    let flying = plan.vehicles.iter().position(|vehicle| vehicle.legs.len() > 1).unwrap();
    let failures = |plan: &Plan| plan.verify(&mission, &Tolerances::default()).failures;

    let mut weaker = plan.clone();
    for control in &mut weaker.vehicles[flying].legs[0].transition.controls {
        control[0] *= 0.95;
    }
    assert!(failures(&weaker).iter().any(|failure| matches!(failure, Failure::Miss { leg: 0, .. })));

    let mut stronger = plan.clone();
    stronger.vehicles[flying].legs[0].transition.controls[3][0] = 40.0;
    assert!(failures(&stronger).iter().any(|failure| matches!(failure, Failure::Bound { leg: 0, .. })));

    let mut late = plan.clone();
    late.vehicles[flying].legs[1].start_time += 1.0;
    assert!(failures(&late).iter().any(|failure| matches!(failure, Failure::Joint { leg: 1, .. })));

    let mut forgetful = plan.clone();
    forgetful.vehicles[flying].legs.clear();
    forgetful.vehicles[flying].route.clear();
    assert!(failures(&forgetful).iter().any(|failure| matches!(failure, Failure::Coverage { times: 0, .. })));

    let mut ragged = plan.clone();
    ragged.vehicles[flying].legs[0].transition.states[1].pop();
    assert!(failures(&ragged).iter().any(|failure| matches!(failure, Failure::Joint { leg: 0, .. })));

    let mut crowded = plan.clone();
    let other = (0..2).find(|&vehicle| vehicle != flying).unwrap();
    crowded.vehicles[other] = crowded.vehicles[flying].clone();
    assert!(failures(&crowded).iter().any(|failure| matches!(failure, Failure::Separation { .. })));

    let mut boastful = plan;
    boastful.certificate.makespan = 0.5 * boastful.certificate.makespan_lower_bound;
    assert!(failures(&boastful).iter().any(|failure| matches!(failure, Failure::Certificate { .. })));
}

#[test]
fn the_same_mission_gives_the_same_plan_to_the_bit() {
    let mission = small(Model::ThrustRate);
    let text = |plan: &Plan| format!("{:?}", plan.vehicles);
    assert_eq!(text(&planned(&mission)), text(&planned(&mission)));
}

#[test]
fn a_caller_can_stop_the_planning() {
    let mission = small(Model::ThrustRate);
    let stop = || true;
    let outcome = plan(&mission, &Options::default().with_should_stop(&stop));
    assert!(matches!(outcome, Err(Error::Stopped)));
}

#[test]
fn progress_counts_every_candidate_once() {
    use std::sync::atomic::{AtomicUsize, Ordering};
    let (greatest, total) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let progress = |progress: planner::Progress| {
        greatest.fetch_max(progress.done, Ordering::Relaxed);
        total.store(progress.total, Ordering::Relaxed);
    };
    let mission = small(Model::PointMass);
    plan(&mission, &Options::default().with_progress(&progress)).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(greatest.into_inner(), total.into_inner());
}

#[test]
fn problems_are_listed_together_and_nothing_is_planned() {
    let mut mission = small(Model::ThrustRate);
    mission.fleet.vehicles = 0;
    mission.loiter.radius = f64::NAN;
    mission.transition.segments = 1;
    mission.targets[1].position[0] = f64::INFINITY;
    let Err(Error::Mission { problems }) = plan(&mission, &Options::default()) else { panic!("planned") };
    let fields: Vec<&str> = problems.iter().map(Problem::field).collect();
    for field in ["fleet.vehicles", "loiter.radius", "transition.segments", "targets.positions[1]"] {
        assert!(fields.contains(&field), "{field} is missing from {fields:?}");
    }
}

#[test]
fn impossible_geometry_and_budgets_are_named() {
    let problems = |change: &dyn Fn(&mut Mission)| {
        let mut mission = small(Model::ThrustRate);
        change(&mut mission);
        mission.problems()
    };
    assert!(problems(&|_| {}).is_empty());
    assert!(matches!(problems(&|m| m.loiter.thrust_budget = 0.4)[..], [Problem::Loiter { .. }]));
    assert!(matches!(
        problems(&|m| m.depot = [12.5, 3.0])[..],
        [Problem::DepotTooClose { target: 0, .. }, ..]
    ));
    let close = problems(&|m| m.targets.push(Target::at([14.0, 3.0])));
    assert!(matches!(close[..], [Problem::TargetsTooClose { first: 0, second: 3, .. }, ..]), "{close:?}");
    assert!(matches!(
        problems(&|m| m.transition.thrust_budget = 0.55)[..],
        [Problem::TransitionBudget { .. }]
    ));
    assert!(
        problems(&|m| m.transition.heights = [2.0, 30.0])
            .iter()
            .all(|p| matches!(p, Problem::HeightOutsideLimits { .. }))
    );
    assert!(matches!(
        problems(&|m| m.targets[2].safe_distance = Some(4.0))[..],
        [Problem::CircleInsideSafeDistance { target: 2, .. }, ..]
    ));
    assert!(matches!(problems(&|m| m.targets.clear())[..], [Problem::NoTargets]));
}

#[test]
fn a_small_endurance_or_battery_is_named_with_what_is_needed() {
    let mut mission = small(Model::ThrustRate);
    mission.fleet.vehicles = 1;
    let whole = planned(&mission);
    let (duration, energy) = (whole.vehicles[0].duration(), whole.energy(&mission, 0).unwrap());
    assert!(whole.warnings.is_empty() && energy > 0.0);
    // Flown at 0.9 of twice the weight at most; power goes with the thrust to the power of 1.5.
    let hovering = mission.fleet.vehicle.hover_power() * duration;
    assert!(energy > hovering && energy < 1.8_f64.powf(1.5) * hovering, "{energy} J, {hovering} J hovering");

    mission.fleet.endurance = 0.7 * duration;
    let needed = |plan: &Plan| {
        plan.warnings.iter().find_map(|warning| match warning {
            Warning::MoreVehicles { needed } => Some(*needed),
            _ => None,
        })
    };
    let short = planned(&mission);
    assert!(matches!(short.warnings[0], Warning::Endurance { vehicle: 0, .. }));
    let vehicles = needed(&short).unwrap();
    assert!((2..=3).contains(&vehicles), "{vehicles}");
    mission.fleet.vehicles = vehicles;
    assert_eq!(needed(&planned(&mission)), None);

    let mut parameters = VehicleParameters::survey_450();
    parameters.battery.energy = 0.7 * energy / parameters.battery.usable_share;
    mission.fleet = planner::Fleet {
        vehicles: 1,
        vehicle: Vehicle::new(parameters).unwrap(),
        endurance: f64::INFINITY,
        ..mission.fleet
    };
    let weak = planned(&mission);
    assert!(matches!(weak.warnings[0], Warning::Battery { vehicle: 0, .. }));
    assert!(needed(&weak).unwrap() >= 2);

    mission.fleet.endurance = 1.0;
    let Err(Error::Mission { problems }) = plan(&mission, &Options::default()) else { panic!("planned") };
    assert_eq!(problems.len(), mission.targets.len());
    assert!(matches!(problems[0], Problem::BeyondEndurance { target: 0, endurance: 1.0, .. }));
}

/// Three safe distances that touch one another wall the pad in, and the only entry tried lies outside.
#[test]
fn a_leg_that_cannot_be_flown_is_an_error_with_its_residuals() {
    let mut mission = small(Model::ThrustRate);
    let corners = [[6.351, 0.0], [-3.1755, 5.500_13], [-3.1755, -5.500_13]];
    mission.targets = corners.map(Target::at).to_vec();
    mission.fleet.vehicles = 1;
    (mission.loiter.radius, mission.transition.safe_distance) = (5.501, 5.499);
    mission.transition.entries = Entries::Sampled(1);
    mission.transition.segments = 20;
    let Err(Error::Leg { leg: 0, circle: Some(_), candidates, .. }) = plan(&mission, &Options::default())
    else {
        panic!("a flight through a wall")
    };
    assert_eq!(candidates.len(), 2);
    for candidate in candidates {
        let Outcome::Failed { primal_residual, dual_residual } = candidate.outcome else {
            panic!("{candidate:?}")
        };
        assert!(primal_residual.max(dual_residual) > 1e-6);
    }
}

/// A loiter whose acceleration turns faster than the autopilot's jerk allows is named before anything is planned.
#[test]
fn shaping_below_the_loiter_is_named() {
    let mut mission = small(Model::JerkLimited);
    mission.transition.shaping.jerk = 0.1;
    assert!(matches!(mission.problems()[..], [Problem::ShapingBelowLoiter { limit: "jerk", target: 0, .. }]));
}

#[test]
fn budgets_are_iterations() {
    let mut mission = small(Model::PointMass);
    mission.targets = (0..12)
        .map(f64::from)
        .map(|i| Target::at([20.0 * (1.7 * i).cos() + 30.0, 12.0 * i - 60.0]))
        .collect();
    let makespan = |iterations: u64| {
        let plan = plan(&mission, &Options::default().with_search_iterations(iterations)).unwrap();
        assert!(plan.verify(&mission, &Tolerances::default()).passed());
        plan.certificate.makespan
    };
    assert!(makespan(20_000) <= makespan(0) * (1.0 + 1e-3));
    let Err(Error::Leg { candidates, .. }) = plan(&mission, &Options::default().with_solver_iterations(1))
    else {
        panic!("solved in one iteration")
    };
    assert!(candidates.iter().all(|candidate| matches!(candidate.outcome, Outcome::Failed { .. })));
    assert!(plan(&mission, &Options::default().with_solver_iterations(300)).is_ok());
}

#[test]
fn a_sampler_gives_the_moments_of_the_plan() {
    let mission = small(Model::ThrustRate);
    let plan = planned(&mission);
    let sampler = plan.sampler(&mission).unwrap();
    for vehicle in 0..plan.vehicles.len() {
        let samples: Vec<_> = sampler.samples(vehicle, 0.02).collect();
        assert_eq!(samples, plan.samples(&mission, vehicle, 50.0).unwrap());
        for sample in samples.iter().step_by(97) {
            assert_eq!(Some(*sample), plan.sample(&mission, vehicle, sample.time));
            assert_eq!(Some(*sample), sampler.sample(vehicle, sample.time));
        }
    }
    assert_eq!(sampler.sample(2, 0.0), None);
    for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(sampler.samples(0, step).count(), 0);
    }
    assert_eq!(sampler.samples(7, 1.0).count(), 0);
    let mut other = mission.clone();
    other.targets.pop();
    assert!(plan.sampler(&other).is_none());
}

/// On a leg of 800 m knots are farther apart than a safe distance is wide: entering it between two of them is no way out.
#[test]
fn a_safe_distance_is_kept_between_knots_that_are_far_apart() {
    for step in 0..12 {
        let aside = 0.3 * f64::from(step) - 1.5;
        let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
        let mut mission =
            Mission::new(vehicle, 1, vec![Target::at([420.0, aside]), Target::at([800.0, 3.0])]);
        mission.transition.entries = Entries::Sampled(2);
        let plan = plan(&mission, &Options::default()).unwrap();
        let verification = plan.verify(&mission, &Tolerances::default());
        assert!(verification.passed(), "{aside} m: {:?}", verification.failures);
    }
}
