//! A free entry against many samples.

use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{Entries, Leg, Mission, Options, Pipeline, Target, plan};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};

/// The solver's tolerance in seconds of a flight: scaled residuals of 3e-6.
const TOLERANCE: f64 = 1e-4;

/// The first leg of a plan: from hover to the first circle, and the second one, to the next circle.
fn legs(mission: &mut Mission, entries: Entries) -> Vec<Leg> {
    mission.transition.entries = entries;
    plan(mission, &Options::default()).unwrap_or_else(|error| panic!("{error}")).vehicles[0].legs[..2]
        .to_vec()
}

#[test]
fn free_is_never_worse_than_32_samples_on_random_legs() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
    let mut faster = 0;
    for wind in [[0.0, 0.0]; 8].into_iter().chain([[3.0, -4.0]; 2]) {
        let mut place = |least: f64| [(); 2].map(|()| least + 40.0 * random.random::<f64>());
        let [first, second] = [place(10.0), place(60.0)];
        let targets = [first, second].map(Target::at).to_vec();
        let mut mission = Mission::new(Vehicle::new(VehicleParameters::survey_450()).unwrap(), 1, targets);
        // Each leg by itself the fastest.
        mission.pipeline = Pipeline::Paper;
        mission.environment.wind = wind;
        let (free, sampled) = (legs(&mut mission, Entries::Free), legs(&mut mission, Entries::Sampled(32)));
        let [free, sampled] = [free, sampled].map(|legs| legs[0].transition.duration);
        assert!(free <= sampled + TOLERANCE, "{wind:?}: {free} against {sampled}");
        faster += usize::from(free < sampled - TOLERANCE);
    }
    assert!(faster > 2, "{faster} faster: the samples are as good as free entries");
}
