//! Targets that come, move and vanish and vehicles that are lost while the fleet flies: everyone concerned gets a new flight.

use crate::air::{Air, Radio, turned};
use crate::peer::{Firmware, Peer, Trouble};
use ground_station::execution::Way;
use ground_station::link::pilot::{Outcome, Phase};
use ground_station::link::settings::{Reach, Settings};
use std::f64::consts::TAU;

const FAIR: Radio = Radio { loss: 0.05, twice: 0.05, delay: 0.1, room: 0 };

fn air(firmware: Firmware, way: Way, events: &[&str]) -> Air {
    let settings = Settings { reach: Reach::Fly, ..Settings::default() };
    Air::new(firmware, way, settings, FAIR, 11).with_events(firmware, events)
}

/// Where a vehicle has been in the plan's frame: its own lies 1.5 m north and 2.5 m east of where it stood.
fn flown(peer: &Peer, pad: [f64; 3]) -> Vec<(f64, [f64; 2])> {
    let place =
        |&(time, [north, east, _]): &(f64, [f64; 3])| (time, [east + 2.5 + pad[0], north - 1.5 + pad[1]]);
    peer.path.iter().map(place).collect()
}

/// The angle (rad) through which the fleet was seen from a place while a vehicle was on the circle around it.
fn circled(air: &Air, centre: [f64; 2]) -> f64 {
    let mut most = 0f64;
    for (peer, pilot) in air.peers.iter().zip(air.session.pilots()) {
        let (mut angle, mut last) = (0.0, None);
        for (_, [east, north]) in flown(peer, pilot.task().pad) {
            let (x, y) = (east - centre[0], north - centre[1]);
            let is_on_circle = (x.hypot(y) - 2.5).abs() < 0.5;
            let step = turned(last, y.atan2(x));
            angle += if is_on_circle { step } else { 0.0 };
            last = Some(y.atan2(x));
        }
        most = most.max(f64::abs(angle));
    }
    most
}

/// Every vehicle that was not lost has flown the plan as it stood in the end, and without a jump.
fn assert_flown(air: &Air) {
    let start = air.session.start().unwrap_or_default();
    for (peer, pilot) in air.peers.iter().zip(air.session.pilots()) {
        assert!(peer.faults.is_empty() && !peer.armed, "{:?}\n{}", peer.faults, air.told());
        if *pilot.phase() != Phase::Over(Outcome::Done) {
            continue;
        }
        let track = &pilot.task().track;
        for (time, [east, north]) in flown(peer, pilot.task().pad) {
            let planned = track.at(time - start).position;
            let miss = (east - planned[0]).hypot(north - planned[1]);
            assert!(
                time < start || miss < 0.6,
                "{}: {miss:.2} m off at {time:.2} s\n{}",
                peer.system,
                air.told()
            );
        }
    }
}

#[test]
fn a_target_that_appears_is_circled_and_one_that_vanishes_is_not() {
    for firmware in [Firmware::ArduCopter, Firmware::Px4] {
        let mut air = air(firmware, Way::Stream, &["2 appears 24 -6", "3.5 moves 2 -12 18", "4 vanishes 9"]);
        air.run(200.0);
        assert!(air.session.failures().is_empty(), "{:?}\n{}", air.session.failures(), air.told());
        assert!(
            air.told().contains("target 4 appears at 24.0 m east, -6.0 m north: new flights for vehicle"),
            "{}",
            air.told()
        );
        assert!(air.told().contains("refused: there is no target 9"), "{}", air.told());
        for target in [[24.0, -6.0], [14.0, 6.0], [-12.0, 18.0], [3.0, -18.0]] {
            assert!(circled(&air, target) > 0.97 * TAU, "{firmware:?} {target:?}\n{}", air.told());
        }
        assert!(circled(&air, [-9.0, 14.0]) < 0.7 * TAU, "it has moved away\n{}", air.told());
        assert_flown(&air);
    }
}

#[test]
fn targets_of_a_vehicle_that_is_lost_are_circled_by_others() {
    let mut air = air(Firmware::ArduCopter, Way::Stream, &[]);
    while air.session.start().is_none_or(|start| air.time < start + 1.5) {
        air.tick();
    }
    air.peers[0].trouble = Trouble { battery_low_at: Some(air.time), ..Trouble::default() };
    air.run(300.0);
    assert!(air.told().contains("battery at 10 %: commands RTL"), "{}", air.told());
    assert!(air.told().contains("vehicle 1 fails: new flights for vehicle"), "{}", air.told());
    assert_eq!(air.session.failures(), ["vehicle 1: its flight was cut short"], "{}", air.told());
    for target in [[14.0, 6.0], [-9.0, 14.0], [3.0, -18.0]] {
        assert!(circled(&air, target) > 0.97 * TAU, "{target:?}\n{}", air.told());
    }
    assert_flown(&air);
}

#[test]
fn an_operator_takes_a_vehicle_out() {
    let mut air = air(Firmware::Px4, Way::Stream, &["2 fails 3"]);
    air.run(300.0);
    assert!(air.told().contains("the operator asks for it: commands RTL"), "{}", air.told());
    assert_eq!(air.told().matches("vehicle 3 fails").count(), 1, "{}", air.told());
    for target in [[14.0, 6.0], [-9.0, 14.0], [3.0, -18.0]] {
        assert!(circled(&air, target) > 0.97 * TAU, "{target:?}\n{}", air.told());
    }
    assert_flown(&air);
}

/// The first vehicle flies its mission as it is; another one that has not taken off gets the new target, and keeps its own.
#[test]
fn missions_on_the_ground_are_uploaded_again() {
    for (firmware, way) in [(Firmware::ArduCopter, Way::LoiterItems), (Firmware::Px4, Way::Polygon)] {
        let mut air = air(firmware, way, &["0.5 appears 24 -6"]);
        air.run(300.0);
        assert!(air.session.failures().is_empty(), "{:?}\n{}", air.session.failures(), air.told());
        assert!(air.told().contains("gets another mission"), "{}", air.told());
        let uploads: Vec<usize> = air.peers.iter().map(|peer| peer.completed_uploads).collect();
        assert!(uploads[0] == 1 && uploads.iter().sum::<usize>() == 4, "{uploads:?}\n{}", air.told());
        for (peer, pilot) in air.peers.iter().zip(air.session.pilots()) {
            assert_eq!(peer.mission.len(), pilot.task().items.len());
            assert!(!peer.path.is_empty() && peer.faults.is_empty());
        }
        let route = |live: &ground_station::command::LivePlan| -> Vec<usize> {
            live.plan().vehicles.iter().map(|vehicle| vehicle.route.len()).collect()
        };
        assert!(air.live.as_ref().map(route).is_some_and(|routes| routes.contains(&2)), "{}", air.told());
    }
}
