//! Vehicles that talk rubbish, with right checksums: a session comes to its end all the same, and says what went wrong.

use crate::air::{Air, Radio};
use crate::peer::Firmware;
use ground_station::execution::Way;
use ground_station::link::frames::Decoder;
use ground_station::link::settings::{Reach, Settings};

const RADIO: Radio = Radio { loss: 0.02, twice: 0.02, delay: 0.1, room: 0 };

fn session(firmware: Firmware, way: Way, reach: Reach, seed: u64) -> Air {
    let mut air = Air::new(firmware, way, Settings { reach, ..Settings::default() }, RADIO, seed);
    air.rubbish = [0.002, 0.02, 0.2][seed as usize % 3];
    air
}

/// 160 uploads: what is reported done is what the vehicle has.
#[test]
fn uploads_end_and_are_whole_or_said_to_have_failed() {
    let mut done = 0;
    for seed in 0..80 {
        for (firmware, way) in [(Firmware::ArduCopter, Way::LoiterItems), (Firmware::Px4, Way::Polygon)] {
            let mut air = session(firmware, way, Reach::Upload, seed);
            air.run(600.0);
            let failures = air.session.failures();
            for (peer, pilot) in air.peers.iter().zip(air.session.pilots()) {
                let number = format!("vehicle {}: ", pilot.task().number);
                if failures.iter().all(|failure| !failure.starts_with(&number)) {
                    assert_eq!(peer.mission.len(), pilot.task().items.len(), "{}", air.told());
                    done += 1;
                }
            }
            assert!(air.peers.iter().all(|peer| !peer.armed && peer.faults.is_empty()));
        }
    }
    assert!(done > 100, "{done} of 480 were done");
}

/// 60 flights: nobody is sent to a place that is none, and nobody is left in the air unsaid.
#[test]
fn flights_end() {
    for seed in 0..30 {
        for firmware in [Firmware::ArduCopter, Firmware::Px4] {
            let mut air = session(firmware, Way::Stream, Reach::Fly, seed);
            air.run(900.0);
            // A height that is a lie may end a climb early; what is sent then is still right.
            let faults = air.peers.iter().flat_map(|peer| &peer.faults);
            let faults: Vec<&String> = faults.filter(|fault| !fault.ends_with("the take-off")).collect();
            assert!(faults.is_empty(), "{firmware:?} {seed}: {faults:?}\n{}", air.told());
            let failures = air.session.failures();
            for (peer, pilot) in air.peers.iter().zip(air.session.pilots()) {
                let number = format!("vehicle {}: ", pilot.task().number);
                let is_told = failures.iter().any(|failure| failure.starts_with(&number));
                assert!(!peer.armed || is_told, "{firmware:?} {seed}\n{}", air.told());
            }
        }
    }
}

/// 200 recorded streams, bits turned and bytes cut out, doubled and put in: a decoder finds frames only where there are some.
#[test]
fn damaged_streams_are_read() {
    let mut air = session(Firmware::ArduCopter, Way::LoiterItems, Reach::Upload, 0);
    let mut stream = Vec::new();
    for _ in 0..400 {
        air.tick();
        for peer in &mut air.peers {
            peer.advance(air.time + 1.0);
            peer.take().iter().for_each(|bytes| stream.extend(bytes));
        }
    }
    let whole = Decoder::default().push(&stream).len();
    assert!(whole > 400, "{whole}");
    let mut random = 0x5EED_u64;
    let mut below = |bound: usize| {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random % bound as u64) as usize
    };
    for _ in 0..200 {
        let mut bytes = stream.clone();
        for _ in 0..=below(20) {
            let at = below(bytes.len() - 100);
            let part = bytes[at..at + 1 + below(80)].to_vec();
            match below(4) {
                0 => bytes[at] ^= 1 << below(8),
                1 => drop(bytes.drain(at..at + part.len())),
                2 => drop(bytes.splice(at..at, part)),
                _ => drop(bytes.splice(at..at, [0xFD, 0xFF, 0, 0xFE, 0xFF])),
            }
        }
        let (mut decoder, mut found) = (Decoder::default(), 0);
        for chunk in bytes.chunks(1 + below(300)) {
            for received in decoder.push(chunk) {
                found += 1;
                air.session.receive(&received, air.time);
            }
        }
        // Each damage costs the frame that it hits, and what a wrong length swallows; doubled parts may hold a few more.
        assert!(found > whole / 2 && found < whole + 80, "{found} of {whole}");
        air.session.poll(air.time);
    }
}
