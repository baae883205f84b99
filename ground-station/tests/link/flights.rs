//! Flights: streamed plans, missions, and everything that goes wrong in the air.

use crate::air::{Air, Radio, turned};
use crate::peer::{Firmware, Trouble};
use ground_station::execution::Way;
use ground_station::link::pilot::{Outcome, Phase};
use ground_station::link::session::Request;
use ground_station::link::settings::{Reach, SafeAction, Settings};
use std::f64::consts::TAU;

const FAIR: Radio = Radio { loss: 0.05, twice: 0.05, delay: 0.1, room: 0 };

fn settings() -> Settings {
    Settings { reach: Reach::Fly, ..Settings::default() }
}

fn streamed(firmware: Firmware, radio: Radio, seed: u64) -> Air {
    Air::new(firmware, Way::Stream, settings(), radio, seed)
}

/// What is asked of a streamed flight: circles as planned within decimetres, on time, seen from all sides.
#[test]
fn fleets_fly_their_plans() {
    for firmware in [Firmware::ArduCopter, Firmware::Px4] {
        let mut air = streamed(firmware, FAIR, 1);
        air.run(200.0);
        assert!(air.session.failures().is_empty(), "{:?}\n{}", air.session.failures(), air.told());
        let start = air.session.start().unwrap_or_default();
        for (peer, pilot) in air.peers.iter().zip(air.session.pilots()) {
            assert!(peer.faults.is_empty(), "{:?}", peer.faults);
            let (mut sum, mut worst, mut count) = (0.0, 0f64, 0);
            let track = &pilot.task().track;
            let ground = peer.ground();
            // The vehicle's own frame lies 1.5 m north and 2.5 m east of where it stood.
            let pad = pilot.task().pad;
            for (time, [north, east, down]) in &peer.path {
                let planned = track.at(time - start).position;
                if *time < start + track.start() || *time > start + track.end() {
                    continue;
                }
                let miss = (east + 2.5 + pad[0] - planned[0]).hypot(north - 1.5 + pad[1] - planned[1]);
                worst = worst.max(miss).max((ground - down - planned[2]).abs());
                sum += miss * miss;
                count += 1;
            }
            let rms = (sum / f64::from(count)).sqrt();
            assert!(rms < 0.3 && worst < 0.6, "{firmware:?} {}: RMS {rms:.3}, worst {worst:.3}", peer.system);
            let rate = peer.setpoints as f64 / (air.time - start);
            assert!(rate > 10.0, "{rate} setpoints a second");
            assert!(!peer.armed, "it has landed");
        }
        assert!(air.told().contains("has flown its plan"), "{}", air.told());
    }
}

#[test]
fn missions_are_flown_one_after_the_other() {
    for (firmware, way) in [(Firmware::ArduCopter, Way::LoiterItems), (Firmware::Px4, Way::Polygon)] {
        let mut air = Air::new(firmware, way, settings(), FAIR, 2);
        let mut most = 0;
        while air.time < 300.0 && !air.session.is_over() {
            air.tick();
            most = most.max(air.peers.iter().filter(|peer| peer.armed).count());
        }
        assert!(
            air.session.is_over() && air.session.failures().is_empty(),
            "{:?}\n{}",
            air.session.failures(),
            air.told()
        );
        assert_eq!(most, 1);
        assert!(air.peers.iter().all(|peer| !peer.path.is_empty() && peer.setpoints == 0));
    }
}

/// Circles by live commands, one vehicle after the other: as wide as planned, and all the way round.
#[test]
fn px4_circles_by_live_commands() {
    let mut air = Air::new(Firmware::Px4, Way::LiveOrbit, settings(), FAIR, 8);
    let mut most = 0;
    while air.time < 400.0 && !air.session.is_over() {
        air.tick();
        most = most.max(air.peers.iter().filter(|peer| peer.armed).count());
    }
    assert!(
        air.session.is_over() && air.session.failures().is_empty(),
        "{:?}\n{}",
        air.session.failures(),
        air.told()
    );
    assert_eq!((most, air.told().matches("has circled").count()), (1, 3), "{}", air.told());
    for (peer, pilot) in air.peers.iter().zip(air.session.pilots()) {
        assert!(peer.faults.is_empty() && !peer.armed && peer.setpoints == 0 && peer.completed_uploads == 0);
        let (task, pad) = (&pilot.task().circles[0], pilot.task().pad);
        let (mut angle, mut last, mut sum, mut count) = (0.0, None, 0.0, 0.0);
        for (_, [north, east, _]) in &peer.path {
            let [x, y] = [east + 2.5 + pad[0] - task.centre[0], north - 1.5 + pad[1] - task.centre[1]];
            if (x.hypot(y) - task.radius).abs() < 0.5 {
                angle += turned(last, y.atan2(x));
                sum += x.hypot(y);
                count += 1.0;
            }
            last = Some(y.atan2(x));
        }
        let around = angle * f64::from(ground_station::words::sign(task.direction));
        assert!(
            around > TAU && (sum / count - task.radius).abs() < 0.15,
            "{around} {}\n{}",
            sum / count,
            air.told()
        );
    }
}

#[test]
fn a_px4_that_refuses_an_orbit_returns() {
    let mut air = Air::new(Firmware::Px4, Way::LiveOrbit, settings(), FAIR, 9);
    air.peers[0].trouble.denies_orbits = true;
    air.run(400.0);
    assert!(air.told().contains("DO_ORBIT is refused: MAV_RESULT_DENIED: commands RTL"), "{}", air.told());
    assert!(air.peers[0].modes_seen.contains(&(4 << 16 | 5 << 24)) && !air.peers[0].armed);
    // The others have not taken off, and stay where they are.
    assert!(air.session.failures().len() == 3 && air.peers[1].path.is_empty(), "{}", air.told());
}

#[test]
fn without_leave_nothing_moves() {
    for reach in [Reach::Check, Reach::Upload] {
        let mut air = Air::new(Firmware::Px4, Way::Stream, Settings { reach, ..settings() }, FAIR, 3);
        air.run(60.0);
        assert!(air.session.failures().is_empty());
        assert!(
            air.peers.iter().all(|peer| !peer.armed && peer.modes_seen.is_empty() && peer.setpoints == 0)
        );
    }
}

#[test]
fn nobody_takes_off_if_one_cannot() {
    let mut air = streamed(Firmware::ArduCopter, Radio::default(), 4);
    air.peers[1].trouble.mute = Some((0.0, 1e9));
    air.run(120.0);
    assert!(air.peers.iter().all(|peer| peer.path.is_empty()), "{}", air.told());
    assert_eq!(air.session.failures().len(), 3);
}

#[test]
fn a_vehicle_that_will_not_arm_brings_the_others_down() {
    let mut air = streamed(Firmware::ArduCopter, Radio::default(), 5);
    air.peers[2].trouble.denies_arming = true;
    air.run(200.0);
    assert!(
        air.session.failures().iter().any(|failure| failure.contains("ARM_DISARM is refused")),
        "{}",
        air.told()
    );
    assert!(air.peers.iter().all(|peer| !peer.armed), "{}", air.told());
}

/// When a vehicle is flying its plan (s), for trouble that has to come then.
const IN_FLIGHT: f64 = 12.0;

fn in_trouble(trouble: Trouble) -> Air {
    let mut air = streamed(Firmware::ArduCopter, Radio::default(), 6);
    while !matches!(air.session.pilots()[0].phase(), Phase::Flying) && air.time < 100.0 {
        air.tick();
    }
    assert!(air.time < IN_FLIGHT, "{}", air.told());
    air.peers[0].trouble = trouble;
    air.run(400.0);
    assert!(air.peers.iter().all(|peer| peer.faults.is_empty()));
    air
}

#[test]
fn a_low_battery_brings_one_vehicle_home_and_the_others_go_on() {
    let air = in_trouble(Trouble { battery_low_at: Some(IN_FLIGHT), ..Trouble::default() });
    assert!(air.told().contains("battery at 10 %: commands RTL"), "{}", air.told());
    assert!(air.peers[0].modes_seen.contains(&6) && !air.peers[0].armed);
    let phases: Vec<&Phase> = air.session.pilots().iter().map(|pilot| pilot.phase()).collect();
    assert_eq!(
        phases,
        [&Phase::Over(Outcome::CutShort), &Phase::Over(Outcome::Done), &Phase::Over(Outcome::Done)]
    );
}

#[test]
fn a_vehicle_far_from_its_plan_holds_and_with_it_the_fleet() {
    let air = in_trouble(Trouble { gust_at: Some(IN_FLIGHT), ..Trouble::default() });
    assert!(air.told().contains("m from its plan: commands BRAKE"), "{}", air.told());
    assert!(air.told().contains("another vehicle holds: commands BRAKE"), "{}", air.told());
    assert!(air.told().contains("has held long enough: commands RTL"), "{}", air.told());
    assert!(air.peers.iter().all(|peer| peer.modes_seen.contains(&17) && !peer.armed));
}

#[test]
fn a_lost_link_is_said_and_the_vehicle_returns_when_it_is_back() {
    let air = in_trouble(Trouble { mute: Some((IN_FLIGHT, IN_FLIGHT + 10.0)), ..Trouble::default() });
    assert!(air.told().contains("link lost for 3."), "{}", air.told());
    assert!(air.peers[0].modes_seen.contains(&6) && !air.peers[0].armed, "{}", air.told());
    let gone = in_trouble(Trouble { mute: Some((IN_FLIGHT, 1e9)), ..Trouble::default() });
    assert!(gone.session.failures().iter().any(|failure| failure.contains("the link did not come back")));
}

#[test]
fn a_pilot_with_a_remote_control_has_the_last_word() {
    let air = in_trouble(Trouble { taken_over_at: Some(IN_FLIGHT), ..Trouble::default() });
    assert!(air.told().contains("someone else changed its mode: hands off"), "{}", air.told());
    assert_eq!(air.peers[0].modes_seen.last(), Some(&5), "no command after the hand-over");
}

#[test]
fn an_operator_can_hold_and_return() {
    let mut air = streamed(Firmware::Px4, FAIR, 7);
    while air.time < IN_FLIGHT {
        air.tick();
    }
    air.session.ask(Request { vehicle: Some(2), action: SafeAction::Return }, air.time);
    while air.time < IN_FLIGHT + 3.0 {
        air.tick();
    }
    assert!(air.told().contains("obeys: RTL"), "{}", air.told());
    air.session.ask(Request { vehicle: None, action: SafeAction::Land }, air.time);
    air.run(200.0);
    assert!(air.peers.iter().all(|peer| !peer.armed));
}
