//! Missions that are too long for one battery each.

use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{
    Entries, Event, Failure, Mission, Options, Plan, Replanner, Target, Tolerances, Warning, plan,
};

const SWAP_TIME: f64 = 45.0;

fn mission(vehicles: usize) -> Mission {
    let positions = [[14.0, 3.0], [26.0, 14.0], [-14.0, 6.0], [-26.0, 18.0], [2.0, -22.0], [-9.0, -30.0]];
    let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
    let mut mission = Mission::new(vehicle, vehicles, positions.map(Target::at).to_vec());
    mission.transition.entries = Entries::Sampled(4);
    mission
}

fn planned(mission: &Mission) -> Plan {
    plan(mission, &Options::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn longest(plan: &Plan) -> f64 {
    plan.vehicles.iter().map(|flight| flight.duration()).fold(0.0, f64::max)
}

#[test]
fn batteries_are_swapped_where_one_flight_each_is_too_long() {
    for n_vehicles in [1, 2] {
        let mut mission = mission(n_vehicles);
        let whole = planned(&mission);
        mission.swap_time = Some(SWAP_TIME);
        // Who has endurance enough does not land.
        assert_eq!(format!("{whole:?}"), format!("{:?}", planned(&mission)));

        mission.fleet.endurance = 0.7 * longest(&whole);
        let plan = planned(&mission);
        let verification = plan.verify(&mission, &Tolerances::default());
        assert!(verification.passed(), "{:?}", verification.failures);
        assert!(longest(&plan) <= mission.fleet.endurance);
        assert!(plan.flights() > n_vehicles);
        assert_eq!(plan.warnings, [Warning::Sorties { flights: plan.flights() }]);
        assert!(plan.vehicles.iter().all(|flight| flight.vehicle < n_vehicles));
        assert!(plan.certificate.makespan >= whole.certificate.makespan_lower_bound);
        // Sorties of a vehicle are apart by a swap, and not idly apart.
        let mut last = plan.vehicles[..n_vehicles].to_vec();
        for (flight, later) in plan.vehicles.iter().enumerate().skip(n_vehicles) {
            let before = std::mem::replace(&mut last[later.vehicle], later.clone());
            let pause = later.start_time() - before.end_time();
            assert!((SWAP_TIME - 1e-9..SWAP_TIME + 30.0).contains(&pause), "{pause}");
            let mut hasty = plan.clone();
            hasty.vehicles[flight].legs.iter_mut().for_each(|leg| leg.start_time -= pause - 0.5 * SWAP_TIME);
            let seen = hasty.verify(&mission, &Tolerances::default()).failures;
            assert!(seen.contains(&Failure::Swap { vehicle: later.vehicle, flight }), "{seen:?}");
        }
    }
}

/// Every target once, flights in order with swaps between, none longer than the endurance.
fn stands(replanner: &Replanner) {
    let (plan, mission) = (replanner.plan(), replanner.mission());
    let verification = plan.verify(mission, &Tolerances::default());
    assert!(verification.passed(), "{:?}", verification.failures);
    // No order of the same targets is short enough in every wind.
    let is_calm = mission.environment.wind == [0.0; 2];
    assert!(!is_calm || longest(plan) <= mission.fleet.endurance);
}

#[test]
fn events_are_followed_over_several_flights() {
    let mut mission = mission(2);
    mission.swap_time = Some(SWAP_TIME);
    mission.fleet.endurance = 0.7 * longest(&planned(&mission));
    let plan = planned(&mission);
    let second = plan.vehicles[2].clone();
    let first = Replanner::new(mission, plan).unwrap();
    let new = || Event::TargetAppears(Target::at([20.0, -18.0]));
    let between = second.start_time() - 0.5 * SWAP_TIME;
    for (time, event) in [
        (3.0, new()),
        (between, new()),
        (second.start_time() + 2.0, new()),
        (3.0, Event::TargetVanishes(second.route[0])),
        (3.0, Event::WindChanges([3.0, -2.0])),
    ] {
        let mut replanner = first.clone();
        let update = replanner.apply(time, &event).unwrap();
        assert!(update.waiting.is_empty() && update.conflict.is_none(), "{event:?} at {time}: {update:?}");
        stands(&replanner);
    }
    // A lost vehicle loses its later flights as well, and the other one flies once more.
    for time in [3.0, between] {
        let mut replanner = first.clone();
        let update = replanner.apply(time, &Event::VehicleFails(second.vehicle)).unwrap();
        assert!(update.waiting.is_empty(), "{update:?}");
        assert!(
            replanner
                .plan()
                .vehicles
                .iter()
                .all(|flight| flight.vehicle != second.vehicle || flight.end_time() <= time)
        );
        stands(&replanner);
    }
    // When all have landed, a vehicle takes off again.
    let mut replanner = first.clone();
    let late = first.plan().certificate.makespan + 1.0;
    replanner.apply(late, &new()).unwrap();
    assert_eq!(replanner.plan().flights(), first.plan().flights() + 1);
    stands(&replanner);
}

#[test]
fn a_small_battery_is_swapped_too() {
    let mut mission = mission(2);
    let whole = planned(&mission);
    let energy = (0..2).filter_map(|vehicle| whole.energy(&mission, vehicle)).fold(0.0, f64::max);
    let mut parameters = VehicleParameters::survey_450();
    parameters.battery.energy = 0.7 * energy / parameters.battery.usable_share;
    mission.fleet.vehicle = Vehicle::new(parameters).unwrap();
    mission.swap_time = Some(SWAP_TIME);
    let plan = planned(&mission);
    let usable = mission.fleet.vehicle.parameters().battery.usable_energy();
    for flight in 0..plan.vehicles.len() {
        assert!(plan.energy(&mission, flight).unwrap() <= usable);
    }
    assert_eq!(plan.warnings, [Warning::Sorties { flights: plan.flights() }]);
    assert!(plan.verify(&mission, &Tolerances::default()).passed());
}

/// A target that is farther than an endurance reaches cannot be helped by swaps: the plan says who flies too long.
#[test]
fn what_no_swap_can_help_is_still_said() {
    let mut mission = mission(2);
    mission.targets = vec![Target::at([14.0, 3.0]), Target::at([-60.0, 0.0])];
    // Above the proven bound, below what the solved flight takes.
    let far = longest(&planned(&mission));
    mission.fleet.endurance = 0.99 * far;
    mission.swap_time = Some(0.0);
    let plan = planned(&mission);
    assert!(plan.warnings.iter().any(|warning| matches!(warning, Warning::Endurance { .. })));
    mission.swap_time = Some(-1.0);
    assert_eq!(mission.problems()[0].field(), "fleet.swap_time");
}
