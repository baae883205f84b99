//! Plans flown by a simulated team.

use planner::quad_dynamics::simulation::SimulationOptions;
use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{Mission, Model, Options, Target, plan};

#[test]
fn a_plan_with_body_dynamics_is_flown_to_a_decimetre_or_two_in_still_air() {
    let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
    let mut mission = Mission::new(vehicle, 2, [[12.0, 3.0], [-6.0, 11.0]].map(Target::at).to_vec());
    mission.transition.model = Model::RigidBody;
    mission.transition.entries = planner::Entries::Sampled(4);
    let plan = plan(&mission, &Options::default()).unwrap();
    let team = plan.fly(&mission, &SimulationOptions::default(), 1).unwrap();
    assert_eq!(team.len(), 2);
    for flown in &team {
        assert_eq!(flown.tracking.completed, 1.0);
        assert!(flown.tracking.max_error < 0.2, "{:?}", flown.tracking);
        assert!(flown.clearance > -0.2, "{}", flown.clearance);
    }
    let again = plan.fly(&mission, &SimulationOptions::default(), 1).unwrap();
    assert_eq!(team[1].flight, again[1].flight);
}

#[test]
fn a_plan_is_not_flown_for_another_mission_or_by_no_vehicle() {
    let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
    let mission = Mission::new(vehicle.clone(), 2, vec![Target::at([12.0, 3.0])]);
    let mut quick = mission.clone();
    quick.transition.entries = planner::Entries::Sampled(2);
    let plan = plan(&quick, &Options::default()).unwrap();
    let other = Mission::new(vehicle, 2, [[12.0, 3.0], [9.0, -9.0]].map(Target::at).to_vec());
    assert!(plan.fly(&other, &SimulationOptions::default(), 1).is_none());
    assert!(plan.motions(&quick, 2, 0.01).is_none());
    assert!(plan.motions(&quick, 0, 0.0).is_none() && plan.motions(&quick, 0, f64::NAN).is_none());
    let spare = plan.vehicles.iter().position(|vehicle| vehicle.route.is_empty()).unwrap();
    assert!(plan.motions(&quick, spare, 0.01).unwrap().is_empty());
}
