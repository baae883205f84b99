//! Targets that no vehicle can circle are named before anything is planned, and no others are.

use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{Entries, Error, Mission, Options, Plan, Problem, Target, plan};
use proptest::prelude::*;

/// One vehicle and a battery of so many joules.
fn mission(targets: &[[f64; 2]], wind: [f64; 2], battery: Option<f64>) -> Mission {
    let mut parameters = VehicleParameters::survey_450();
    if let Some(usable) = battery {
        parameters.battery.energy = usable / parameters.battery.usable_share;
    }
    let targets = targets.iter().copied().map(Target::at).collect();
    let mut mission = Mission::new(Vehicle::new(parameters).unwrap(), 1, targets);
    mission.transition.entries = Entries::Sampled(2);
    mission.environment.wind = wind;
    mission
}

fn planned(mission: &Mission) -> Plan {
    plan(mission, &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_target_beyond_the_endurance_is_named_in_wind_too() {
    for wind in [[0.0, 0.0], [5.0, 0.0], [-4.0, 4.0]] {
        let mut mission = mission(&[[20.0, 0.0], [900.0, 0.0]], wind, None);
        mission.fleet.endurance = 90.0;
        let Err(Error::Mission { problems }) = plan(&mission, &Options::default()) else { panic!("planned") };
        let [problem @ Problem::BeyondEndurance { target: 1, least, endurance: 90.0 }] = &problems[..] else {
            panic!("{problems:?}")
        };
        assert!((90.0..200.0).contains(least), "{least}");
        assert!(problem.to_string().contains("target 2") && problem.field() == "fleet.endurance");
        mission.fleet.endurance = 2.0 * least;
        assert!(mission.problems().is_empty());
    }
}

#[test]
fn a_target_beyond_the_battery_is_named_with_the_remedy() {
    let near_and_far = [[20.0, 0.0], [90_000.0, 0.0]];
    for wind in [[0.0, 0.0], [3.0, 3.0]] {
        let problems = mission(&near_and_far, wind, None).problems();
        let [problem @ Problem::BeyondBattery { target: 1, least, usable }] = &problems[..] else {
            panic!("{problems:?}")
        };
        assert!(least > usable);
        assert!(problem.to_string().contains("larger battery") && problem.field() == "fleet.vehicle.battery");
        assert!(mission(&near_and_far, wind, Some(1.01 * least)).problems().is_empty());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// What a plan needs is never refused.
    #[test]
    fn no_target_that_can_be_circled_is_refused(
        place in prop::array::uniform2(-300.0..300.0),
        wind in prop::sample::select(vec![[0.0, 0.0], [6.0, -2.0], [-3.0, 5.0]]),
    ) {
        let place: [f64; 2] = place;
        prop_assume!(place[0].hypot(place[1]) > 5.0);
        let whole = mission(&[place], wind, None);
        let plan = planned(&whole);
        let mut tight = mission(&[place], wind, plan.energy(&whole, 0));
        tight.fleet.endurance = plan.vehicles[0].duration();
        prop_assert!(tight.problems().is_empty(), "{:?}", tight.problems());
        // The bound on times means something.
        tight.fleet.endurance *= 0.4;
        prop_assert!(!tight.problems().is_empty());
    }
}
