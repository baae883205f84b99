//! Missions in a steady wind.

use planner::quad_dynamics::nalgebra::{Quaternion, UnitQuaternion, Vector3};
use planner::quad_dynamics::{self, Vehicle, VehicleParameters};
use planner::{
    Entries, Error, Mission, Model, Options, Outcome, Pipeline, Plan, Problem, Target, Tolerances, plan,
};
use proptest::prelude::*;

/// Two vehicles, three targets; few entries, so that a test stays quick.
fn small(model: Model, wind: [f64; 2]) -> Mission {
    let positions = [[12.0, 3.0], [20.0, 14.0], [-6.0, 11.0]];
    let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
    let mut mission = Mission::new(vehicle, 2, positions.map(Target::at).to_vec());
    mission.transition.model = model;
    mission.transition.entries = Entries::Sampled(4);
    mission.environment.wind = wind;
    mission
}

fn planned(mission: &Mission) -> Plan {
    plan(mission, &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn stands(plan: &Plan, mission: &Mission) {
    let verification = plan.verify(mission, &Tolerances::default());
    assert!(verification.passed(), "{:?}", verification.failures);
}

#[test]
fn every_model_gives_a_plan_that_stands_verification_in_wind_and_in_no_other() {
    for model in [Model::PointMass, Model::JerkLimited, Model::ThrustRate, Model::RigidBody] {
        let mission = small(model, [4.0, -3.0]);
        let plan = planned(&mission);
        stands(&plan, &mission);
        let certificate = plan.certificate;
        assert!(certificate.makespan_lower_bound > 0.0 && certificate.total_lower_bound > 0.0);
        // The shaping of an autopilot knows no wind.
        if model != Model::JerkLimited {
            let still = small(model, [0.0, 0.0]);
            assert!(!plan.verify(&still, &Tolerances::default()).passed(), "{model:?}");
        }
    }
}

#[test]
fn loiters_are_slower_in_wind_and_a_hover_leans_into_it() {
    let (still, windy) = (small(Model::ThrustRate, [0.0; 2]), small(Model::ThrustRate, [6.0, 0.0]));
    let (before, after) = (planned(&still), planned(&windy));
    assert!(after.circles[0].speed < before.circles[0].speed);
    // On its pad: thrust against an east wind points west.
    let sample = after.sample(&windy, 0, -1.0).unwrap();
    let [w, x, y, z] = sample.attitude;
    let up = [2.0 * (x * z + w * y), 2.0 * (y * z - w * x)];
    let drag = 0.5 * windy.fleet.vehicle.drag_coefficient() * 36.0;
    assert!((sample.collective_thrust * up[0] + drag).abs() < 1e-9 && up[1].abs() < 1e-9, "{up:?}");
}

/// Every candidate's bound is below the time in which it can be flown.
#[test]
fn no_candidate_is_faster_than_its_bound() {
    let mut n_discarded = 0;
    for (model, wind) in [
        (Model::ThrustRate, [7.0, 2.0]),
        (Model::ThrustRate, [-3.0, 5.0]),
        (Model::PointMass, [0.0, -7.0]),
        (Model::RigidBody, [5.0, 5.0]),
    ] {
        let mut mission = small(model, wind);
        (mission.pipeline, mission.transition.entries) = (Pipeline::Paper, Entries::Sampled(8));
        let bounded = planned(&mission);
        let all = plan(&mission, &Options::default().with_exhaustive(true)).unwrap();
        // The first leg of a vehicle starts in the same motion in both plans.
        let legs = bounded.vehicles.iter().zip(&all.vehicles);
        let firsts = legs.filter_map(|(a, b)| Some((a.legs.first()?, b.legs.first()?)));
        for (a, b) in firsts.filter(|(a, b)| a.candidates.len() == b.candidates.len()) {
            for (candidate, solved) in a.candidates.iter().zip(&b.candidates) {
                let (Outcome::ProvenWorse { lower_bound }, Outcome::Solved { duration }) =
                    (candidate.outcome, solved.outcome)
                else {
                    continue;
                };
                n_discarded += 1;
                assert!(lower_bound <= duration, "{model:?}: {lower_bound} {duration}");
            }
        }
    }
    assert!(n_discarded > 0, "nothing was discarded on its bound");
}

#[test]
fn a_free_entry_in_wind_is_never_worse_than_the_samples_it_starts_from() {
    let mut mission = small(Model::ThrustRate, [5.0, 1.0]);
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
    stands(&free, &mission);
}

/// The rotors feel the velocity against the air, not that over the ground.
#[test]
fn the_energy_of_a_flight_is_that_against_the_air() {
    let wind = [5.0, -4.0];
    let mission = small(Model::ThrustRate, wind);
    let plan = planned(&mission);
    let step = 0.02;
    let energy = |wind: [f64; 2]| -> f64 {
        let sampler = plan.sampler(&mission).unwrap();
        let power = |sample: planner::Sample| {
            let [w, x, y, z] = sample.attitude;
            let attitude = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
            let against = Vector3::from(sample.velocity) - Vector3::new(wind[0], wind[1], 0.0);
            let body = attitude.inverse_transform_vector(&against);
            mission.fleet.vehicle.power(sample.collective_thrust, &body)
        };
        let powers: Vec<f64> = sampler.samples(0, step).map(power).collect();
        powers.windows(2).map(|pair| 0.5 * step * (pair[0] + pair[1])).sum()
    };
    let planned = plan.energy(&mission, 0).unwrap();
    assert!((planned / energy(wind) - 1.0).abs() < 0.01, "{planned} against {}", energy(wind));
    assert!((planned / energy([0.0; 2]) - 1.0).abs() > 0.02, "the wind makes no difference");
}

#[test]
fn more_wind_than_the_vehicle_holds_is_named_with_the_remedy() {
    let mission = small(Model::ThrustRate, [17.0, 0.0]);
    let Err(Error::Mission { problems }) = plan(&mission, &Options::default()) else { panic!("planned") };
    let [problem @ Problem::Loiter { source: quad_dynamics::Error::WindTooStrong { .. }, .. }] =
        &problems[..]
    else {
        panic!("{problems:?}")
    };
    assert_eq!(problem.field(), "environment.wind");
    assert!(problem.to_string().contains("thrust_budget"), "{problem}");
    for wind in [[f64::NAN, 0.0], [0.0, f64::INFINITY], [101.0, 0.0]] {
        let problems = small(Model::ThrustRate, wind).problems();
        assert!(matches!(&problems[..], [Problem::OutOfRange { field, .. }] if field == "environment.wind"));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn plans_in_any_wind_stand(
        wind in prop::array::uniform2(-6.0..6.0),
        targets in prop::collection::vec(prop::array::uniform2(0.0..25.0), 1..3),
        model in prop::sample::select(vec![Model::PointMass, Model::ThrustRate]),
    ) {
        let mut mission = small(model, wind);
        // Far enough from each other and from the pads.
        let place = |(i, [x, y]): (usize, [f64; 2])| Target::at([x + 12.0 + 40.0 * i as f64, y]);
        mission.targets = targets.into_iter().enumerate().map(place).collect();
        mission.transition.entries = Entries::Sampled(2);
        match plan(&mission, &Options::default()) {
            Ok(plan) => {
                let verification = plan.verify(&mission, &Tolerances::default());
                prop_assert!(verification.passed(), "{:?}", verification.failures);
            }
            Err(error) => prop_assert!(false, "{error}"),
        }
    }
}
