//! Bounds of flights under way against all their continuations: every share, order, direction and entry, each leg solved.

use super::{Changes, Event, Outlook, Replanner, Settled, Skies, Ways};
use crate::airs::Airs;
use crate::exhaustive::Times;
use crate::mission::{Entries, Mission, Model, Target};
use crate::options::Options;
use crate::planning::plan;
use quad_dynamics::{Vehicle, VehicleParameters};

/// The least makespan and the least total of all continuations from a moment on (s).
fn best(replanner: &Replanner, time: f64, changes: &Changes) -> [f64; 2] {
    let airs = Airs::new(&replanner.plan, &replanner.mission);
    let skies = Skies::new(&airs);
    let settled = |planned| Settled::at(&skies, planned, time, changes);
    let team: Vec<Settled> = replanner.plan.vehicles.iter().map(settled).collect();
    let ways = Ways::of(skies.now(), &team, None);
    let outlook = Outlook::new(&ways, skies.now(), &replanner.plan, (&team, &replanner.usable), time);
    let vehicles: Vec<_> = outlook.starts.iter().map(|start| (start.here, start.pad)).collect();
    let begin: Vec<f64> = outlook.starts.iter().map(|start| start.time).collect();
    let [makespan, total] = match vehicles.is_empty() {
        true => [0.0; 2],
        false => Times::from(skies.now(), &outlook.open, &vehicles).best(&begin),
    };
    [makespan.max(outlook.ended), outlook.flown + total]
}

#[test]
fn no_continuation_of_a_flight_under_way_beats_its_bounds() {
    let positions = [[40.0, 10.0], [33.0, -25.0], [-30.0, -14.0]];
    let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
    let mut mission = Mission::new(vehicle, 2, positions.map(Target::at).to_vec());
    mission.transition.model = Model::PointMass;
    mission.transition.segments = 20;
    mission.transition.entries = Entries::Sampled(2);
    let planned = plan(&mission, &Options::default()).unwrap();
    let first = Replanner::new(mission, planned).unwrap();
    let ends: Vec<f64> = first.plan.vehicles.iter().map(|vehicle| vehicle.end_time()).collect();
    let (early, late) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    let appears = || Event::TargetAppears(Target::at([-12.0, 30.0]));
    for (time, event) in [
        (0.0, appears()),
        (4.0, appears()),
        (early + 0.1, appears()),
        (late - 1.0, appears()),
        (4.0, Event::VehicleFails(0)),
        (4.0, Event::WindChanges([4.0, -3.0])),
    ] {
        let mut replanner = first.clone();
        let waiting = replanner.apply(time, &event).unwrap().waiting;
        let wind = matches!(event, Event::WindChanges(_));
        let [makespan, total] = best(&replanner, time, &Changes { wind, ..Changes::default() });
        let found = replanner.plan.certificate;
        println!(
            "{event:?} at {time:.1} s: makespan {:.3} >= {makespan:.3} >= {:.3}, total {:.3} >= {total:.3} >= {:.3}",
            found.makespan, found.makespan_lower_bound, found.total, found.total_lower_bound
        );
        assert!(waiting.is_empty());
        assert!(found.makespan_lower_bound <= makespan && found.total_lower_bound <= total, "{found:?}");
        // The bounds mean something: they are not far below.
        assert!(found.makespan_lower_bound > 0.7 * makespan && found.total_lower_bound > 0.7 * total);
    }
}
