//! Plans that follow events.

use planner::quad_dynamics::{Vehicle, VehicleParameters};
use planner::{
    Entries, Error, Event, Mission, Options, Plan, Problem, Replanner, Target, Tolerances, Warning, plan,
};

/// Two vehicles, four targets.
fn mission() -> Mission {
    let positions = [[14.0, 3.0], [26.0, 14.0], [-14.0, 6.0], [-26.0, 18.0]];
    let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
    let mut mission = Mission::new(vehicle, 2, positions.map(Target::at).to_vec());
    mission.transition.entries = Entries::Sampled(4);
    mission
}

fn replanner() -> Replanner {
    let mission = mission();
    let plan = plan(&mission, &Options::default()).unwrap();
    Replanner::new(mission, plan).unwrap()
}

fn stands(replanner: &Replanner) {
    let verification = replanner.plan().verify(replanner.mission(), &Tolerances::default());
    assert!(verification.passed(), "{:?}", verification.failures);
}

/// Every moment before `time` is flown as it was planned before.
fn same_past(before: &Plan, after: &Plan, was: &Mission, is: &Mission, time: f64) {
    // Of a lost vehicle only the legs that it completed are kept.
    for vehicle in (0..before.vehicles.len()).filter(|&i| after.vehicles[i].lost_at.is_none()) {
        for i in 0..20 {
            let t = time * f64::from(i) / 20.0;
            let [a, b] = [before.sample(was, vehicle, t), after.sample(is, vehicle, t)].map(Option::unwrap);
            let apart = (0..3).map(|axis| (a.position[axis] - b.position[axis]).abs()).fold(0.0, f64::max);
            assert!(apart < 1e-6, "vehicle {vehicle} at {t} s: {apart} m");
        }
    }
}

#[test]
fn a_target_that_appears_is_circled_and_the_past_stays() {
    for time in [0.0, 1.0, 4.0, 7.5] {
        let mut replanner = replanner();
        let (before, was) = (replanner.plan().clone(), replanner.mission().clone());
        let update = replanner.apply(time, &Event::TargetAppears(Target::at([4.0, 24.0]))).unwrap();
        assert_eq!(update.vehicles.len(), 1, "{time}");
        assert!(update.waiting.is_empty());
        stands(&replanner);
        same_past(&before, replanner.plan(), &was, replanner.mission(), time);
        let routes = replanner.plan().vehicles.iter().flat_map(|vehicle| &vehicle.route);
        assert_eq!(routes.filter(|&&circle| circle == 4).count(), 1);
    }
}

#[test]
fn a_target_that_vanishes_is_left_out_even_when_a_vehicle_is_on_its_way() {
    let fresh = replanner();
    let first = fresh.plan().vehicles[0].legs[0].clone();
    let target = first.loiter.unwrap().circle;
    for time in [0.0, 0.3 * first.transition.duration] {
        let mut replanner = fresh.clone();
        let (before, was) = (replanner.plan().clone(), replanner.mission().clone());
        let update = replanner.apply(time, &Event::TargetVanishes(target)).unwrap();
        assert_eq!(update.vehicles, [0]);
        assert!(!replanner.plan().vehicles[0].route.contains(&target));
        stands(&replanner);
        same_past(&before, replanner.plan(), &was, replanner.mission(), time);
    }
    // In the loiter it is too late: the loiter is finished, and counts.
    let mut replanner = fresh.clone();
    let update = replanner.apply(first.arrival_time() + 0.5, &Event::TargetVanishes(target)).unwrap();
    assert!(update.vehicles.is_empty());
    stands(&replanner);
}

#[test]
fn a_target_that_moves_is_circled_where_it_is_then() {
    let mut replanner = replanner();
    let last = replanner.plan().vehicles[1].route.last().copied().unwrap();
    let [x, y] = replanner.mission().targets[last].position;
    let update = replanner.apply(2.0, &Event::TargetMoves(last, [x + 5.0, y - 4.0])).unwrap();
    assert!(!update.vehicles.is_empty() && update.waiting.is_empty());
    assert_eq!(replanner.plan().circles[last].centre, [x + 5.0, y - 4.0]);
    stands(&replanner);
    // Once circled it is not circled again.
    let first = replanner.plan().vehicles[0].legs[0].clone();
    let circled = first.loiter.unwrap().circle;
    let routes: Vec<_> = replanner.plan().vehicles.iter().map(|vehicle| vehicle.route.clone()).collect();
    let [x, y] = replanner.mission().targets[circled].position;
    replanner.apply(first.end_time() + 0.1, &Event::TargetMoves(circled, [x, y + 60.0])).unwrap();
    assert_eq!(routes, replanner.plan().vehicles.iter().map(|v| v.route.clone()).collect::<Vec<_>>());
    stands(&replanner);
}

#[test]
fn others_take_over_what_a_lost_vehicle_has_not_completed() {
    for time in [0.0, 3.0] {
        let mut replanner = replanner();
        let update = replanner.apply(time, &Event::VehicleFails(0)).unwrap();
        assert_eq!(update.vehicles, [0, 1]);
        assert!(update.waiting.is_empty());
        assert_eq!(replanner.plan().vehicles[1].route.len(), 4);
        stands(&replanner);
        if time == 0.0 {
            // It comes back before it has flown, and takes some of them again.
            let update = replanner.apply(1.0, &Event::VehicleReturns(0)).unwrap();
            assert_eq!(update.vehicles, [0, 1]);
            stands(&replanner);
        }
    }
}

#[test]
fn targets_wait_when_nobody_is_left_and_are_not_forgotten() {
    let mut replanner = replanner();
    replanner.apply(0.0, &Event::VehicleFails(0)).unwrap();
    let update = replanner.apply(0.0, &Event::VehicleFails(1)).unwrap();
    assert_eq!(update.waiting.len(), 4);
    let update = replanner.apply(1.0, &Event::VehicleReturns(1)).unwrap();
    assert!(update.waiting.is_empty());
    stands(&replanner);
}

/// One vehicle follows the other, which stays so long on its second circle that both would be there at once.
#[test]
fn a_vehicle_gives_way_by_further_turns_or_a_later_start() {
    let mut mission = mission();
    mission.targets[0].position = [14.0, -10.0];
    let mut plan = planner::plan(&mission, &Options::default()).unwrap();
    let leader = plan.vehicles.iter().position(|vehicle| vehicle.route.len() > 1).unwrap();
    let turn = std::f64::consts::TAU * plan.circles[0].radius / plan.circles[0].speed;
    let gap = 3.0 * turn;
    let mut follower = plan.vehicles[leader].clone();
    follower.vehicle = 1 - leader;
    follower.legs.iter_mut().for_each(|leg| leg.start_time += gap);
    let legs = &mut plan.vehicles[leader].legs;
    let loiter = legs[1].loiter.as_mut().unwrap();
    loiter.length *= 1.0 + 2.0 * turn / loiter.duration;
    loiter.duration += 2.0 * turn;
    legs[2..].iter_mut().for_each(|leg| leg.start_time += 2.0 * turn);
    let first = legs[0].clone();
    // What the follower would have circled is circled by nobody now.
    let harmless = Event::TargetVanishes(plan.vehicles[1 - leader].route[0]);
    plan.vehicles[1 - leader] = follower.clone();

    let in_the_air = follower.legs[0].start_time + 0.1;
    assert!(in_the_air > first.end_time());
    for time in [first.end_time() + 0.1, in_the_air] {
        let mut replanner = Replanner::new(mission.clone(), plan.clone()).unwrap();
        let before = replanner.plan().clone();
        let update = replanner.apply(time, &harmless).unwrap();
        assert_eq!((update.vehicles, update.conflict), (vec![1 - leader], None), "{time}");
        same_past(&before, replanner.plan(), &mission, replanner.mission(), time);
        let approach = replanner.plan().closest_approach.unwrap();
        assert!(approach.distance >= replanner.mission().fleet.separation - 0.01);
        let waited = &replanner.plan().vehicles[1 - leader];
        let longer = waited.duration() - follower.duration();
        if time < follower.start_time() {
            assert!(waited.start_time() > follower.start_time() && longer.abs() < 1e-9);
        } else {
            // Whole turns, which end where they begin.
            assert!(longer > 0.5 * turn && (longer / turn - (longer / turn).round()).abs() < 1e-6);
        }
    }
}

/// Nobody had to keep away from a target before it was there.
#[test]
fn a_target_that_appears_where_a_vehicle_has_flown_breaks_nothing() {
    let mut replanner = replanner();
    let leg = replanner.plan().vehicles[0].legs[0].clone();
    let [x, y, _] =
        replanner.plan().sample(replanner.mission(), 0, 0.4 * leg.transition.duration).unwrap().position;
    replanner.apply(leg.end_time(), &Event::TargetAppears(Target::at([x, y]))).unwrap();
    stands(&replanner);
}

#[test]
fn a_new_target_on_the_way_is_flown_around() {
    let mut mission = mission();
    mission.fleet.vehicles = 1;
    mission.targets = vec![Target::at([60.0, 0.0])];
    let plan = plan(&mission, &Options::default()).unwrap();
    let mut replanner = Replanner::new(mission, plan).unwrap();
    let duration = replanner.plan().vehicles[0].legs[0].transition.duration;
    let [x, y, _] = replanner.plan().sample(replanner.mission(), 0, 0.6 * duration).unwrap().position;
    let update = replanner.apply(0.05, &Event::TargetAppears(Target::at([x, y]))).unwrap();
    assert_eq!(update.vehicles, [0]);
    assert_eq!(replanner.plan().vehicles[0].route.len(), 2);
    stands(&replanner);
}

#[test]
fn legs_are_planned_for_the_wind_that_blows_when_they_start() {
    for time in [0.0, 1.0, 4.0, 7.5] {
        let mut replanner = replanner();
        let (before, was) = (replanner.plan().clone(), replanner.mission().clone());
        let update = replanner.apply(time, &Event::WindChanges([5.0, -2.0])).unwrap();
        assert_eq!(update.vehicles, [0, 1], "{time}");
        stands(&replanner);
        same_past(&before, replanner.plan(), &was, replanner.mission(), time);
        for (old, new) in before.vehicles.iter().zip(&replanner.plan().vehicles) {
            for (old, new) in old.legs.iter().zip(&new.legs) {
                let same = old.transition.controls == new.transition.controls;
                assert_eq!(same, old.start_time <= time);
            }
        }
        // The legs of before cannot be flown as they are in the wind of now.
        let mut forgetful = replanner.plan().clone();
        forgetful.earlier_winds.clear();
        assert!(!forgetful.verify(replanner.mission(), &Tolerances::default()).passed());
        // What happens next, while legs of before are still being flown.
        for event in [
            Event::TargetAppears(Target::at([4.0, 24.0])),
            Event::VehicleFails(0),
            Event::TargetMoves(3, [-20.0, 25.0]),
            Event::WindChanges([-3.0, 3.0]),
        ] {
            let (before, was) = (replanner.plan().clone(), replanner.mission().clone());
            replanner.apply(time + 0.2, &event).unwrap();
            stands(&replanner);
            same_past(&before, replanner.plan(), &was, replanner.mission(), time + 0.2);
        }
    }
}

#[test]
fn warnings_follow_events() {
    let mut mission = mission();
    let durations = |plan: &Plan| plan.vehicles.iter().map(|v| v.duration()).collect::<Vec<_>>();
    let longest = durations(replanner().plan()).into_iter().fold(0.0, f64::max);
    mission.fleet.endurance = 1.01 * longest;
    let planned = plan(&mission, &Options::default()).unwrap();
    assert!(!planned.warnings.iter().any(|warning| matches!(warning, Warning::Endurance { .. })));
    let mut replanner = Replanner::new(mission, planned).unwrap();
    let mut most = 0;
    for (time, wind) in [(0.0, [8.0, 0.0]), (1.0, [9.0, 2.0]), (2.0, [0.0, 0.0])] {
        replanner.apply(time, &Event::WindChanges(wind)).unwrap();
        let limit = replanner.mission().fleet.endurance;
        let too_long = durations(replanner.plan()).iter().filter(|&&duration| duration > limit).count();
        let named =
            replanner.plan().warnings.iter().filter(|w| matches!(w, Warning::Endurance { .. })).count();
        assert_eq!(named, too_long, "{:?}", replanner.plan().warnings);
        most = most.max(too_long);
    }
    assert!(most > 0);
}

#[test]
fn a_vehicle_that_starts_when_the_wind_changes_is_planned_for_the_new_wind() {
    let mut spare = mission();
    (spare.fleet.vehicles, spare.targets) = (2, vec![Target::at([14.0, 3.0])]);
    let plan = plan(&spare, &Options::default()).unwrap();
    let idle = plan.vehicles.iter().position(|vehicle| vehicle.legs.is_empty()).unwrap();
    let mut replanner = Replanner::new(spare, plan).unwrap();
    replanner.apply(1.0, &Event::WindChanges([4.0, 4.0])).unwrap();
    replanner.apply(1.0, &Event::TargetAppears(Target::at([-40.0, -30.0]))).unwrap();
    assert!(!replanner.plan().vehicles[idle].legs.is_empty());
    stands(&replanner);
}

#[test]
fn nonsense_is_refused_and_changes_nothing() {
    let mut replanner = replanner();
    let before = format!("{:?}", replanner.plan());
    let nowhere = Event::TargetAppears(Target::at([f64::NAN, 0.0]));
    let (storm, no_wind) = (Event::WindChanges([30.0, 0.0]), Event::WindChanges([f64::NAN, 0.0]));
    for event in [
        Event::TargetVanishes(4),
        Event::TargetMoves(9, [0.0; 2]),
        Event::VehicleFails(2),
        nowhere,
        storm,
        no_wind,
    ] {
        assert!(matches!(replanner.apply(1.0, &event), Err(Error::Mission { .. })), "{event:?}");
        assert_eq!(before, format!("{:?}", replanner.plan()));
    }
    // Another mission's plan.
    let mut other = mission();
    other.targets.pop();
    let refused = Replanner::new(other, replanner.plan().clone());
    assert!(matches!(refused, Err(Error::Mission { problems }) if problems == [Problem::NotReplannable]));
}

/// Targets that are circled as one: two of four, a fifth that appears beside them, and one of them that runs away.
#[test]
fn merged_targets_stay_together_until_one_moves() {
    let mut merged = mission();
    merged.merge_within = 3.0;
    merged.targets.push(Target::at([-25.0, 20.0]));
    let planned = plan(&merged, &Options::default()).unwrap();
    let together = planned.circles.iter().position(|circle| circle.members == [3, 4]).unwrap();
    let fresh = Replanner::new(merged, planned).unwrap();
    let times_circled = |replanner: &Replanner, target: usize| {
        let plan = replanner.plan();
        let routes = plan.vehicles.iter().flat_map(|vehicle| &vehicle.route);
        routes.filter(|&&circle| plan.circles[circle].members.contains(&target)).count()
    };

    // One that appears beside them joins them; far away it has a circle of its own.
    for (position, joins) in [([-27.0, 19.0], true), ([-40.0, 0.0], false)] {
        let mut replanner = fresh.clone();
        replanner.apply(1.0, &Event::TargetAppears(Target::at(position))).unwrap();
        assert_eq!(replanner.plan().circles[together].members.contains(&5), joins);
        assert_eq!(replanner.plan().circles.len(), if joins { 4 } else { 5 });
        assert_eq!(times_circled(&replanner, 5), 1);
        stands(&replanner);
    }

    // While one of two is left, the circle is flown; without any, it is not.
    let mut replanner = fresh.clone();
    let update = replanner.apply(1.0, &Event::TargetVanishes(3)).unwrap();
    assert!(update.vehicles.is_empty() && times_circled(&replanner, 4) == 1);
    stands(&replanner);
    replanner.apply(1.5, &Event::TargetVanishes(4)).unwrap();
    assert_eq!(times_circled(&replanner, 4), 0);
    stands(&replanner);

    // One that moves away gets its own circle, and the other one's shrinks to its own radius.
    let mut replanner = fresh.clone();
    replanner.apply(1.0, &Event::TargetMoves(4, [-20.0, 30.0])).unwrap();
    let circles = &replanner.plan().circles;
    assert_eq!([&circles[together].members[..], &circles[4].members[..]], [&[3][..], &[4][..]]);
    assert!(circles[together].radius < fresh.plan().circles[together].radius);
    assert!((3..5).all(|target| times_circled(&replanner, target) == 1));
    stands(&replanner);
    // Whoever is left takes over what has moved, too.
    replanner.apply(1.5, &Event::VehicleFails(0)).unwrap();
    stands(&replanner);
    assert!((0..5).all(|target| times_circled(&replanner, target) == 1));

    // Circled once, nobody circles it again, wherever it goes.
    let mut replanner = fresh.clone();
    let legs = replanner.plan().vehicles.iter().flat_map(|vehicle| &vehicle.legs);
    let flown = legs.filter(|leg| leg.loiter.is_some_and(|loiter| loiter.circle == together));
    let time = flown.map(|leg| leg.arrival_time()).fold(0.0, f64::max) + 0.1;
    replanner.apply(time, &Event::TargetMoves(4, [0.0, -40.0])).unwrap();
    assert_eq!(replanner.plan().skipped, [5]);
    stands(&replanner);
}

/// Long legs and many circles do not get longer alike in a wind.
#[test]
fn a_new_wind_moves_targets_to_whoever_is_sooner_done() {
    let mut mission = mission();
    let near =
        (0..8).map(|i| Target::at([-12.0 - 9.0 * f64::from(i / 2), if i % 2 == 0 { 9.0 } else { -9.0 }]));
    let far = [[260.0, 0.0], [230.0, 50.0], [60.0, 20.0], [40.0, -25.0], [25.0, 12.0]].map(Target::at);
    mission.targets = near.chain(far).collect();
    mission.transition.model = planner::Model::PointMass;
    let before = plan(&mission, &Options::default()).unwrap();
    let mut replanner = Replanner::new(mission, before.clone()).unwrap();
    replanner.apply(0.0, &Event::WindChanges([9.0, 0.0])).unwrap();
    stands(&replanner);
    let routes = |plan: &Plan| plan.vehicles.iter().map(|vehicle| vehicle.route.clone()).collect::<Vec<_>>();
    assert_ne!(routes(&before), routes(replanner.plan()));
}
