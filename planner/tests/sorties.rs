//! Missions that are too long for one battery each.

use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{Entries, Failure, Mission, Options, Plan, Replanner, Target, Tolerances, Warning, plan};

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
        assert!(Replanner::new(mission, plan).is_err());
    }
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
