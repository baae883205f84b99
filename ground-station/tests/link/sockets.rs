//! The same over loopback UDP: real sockets, a real clock that runs fast.

use crate::air::{mission_text, peers_of, tasks_of};
use crate::peer::{Firmware, Peer};
use ground_station::execution::Way;
use ground_station::failure::Failure;
use ground_station::link::address::Address;
use ground_station::link::run::{Surroundings, run};
use ground_station::link::session::{Event, Session};
use ground_station::link::settings::{Reach, Settings};
use ground_station::link::tlog::TelemetryLog;
use ground_station::link::transport::Transport;
use std::error::Error;
use std::io::Write;
use std::net::{SocketAddr, UdpSocket};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Seconds of flight in a second of test.
const PACE: f64 = 6.0;

/// Vehicles that live until they are told to stop: one socket each, all sending to one place.
struct Fleet {
    stop: Arc<AtomicBool>,
    thread: JoinHandle<Vec<Peer>>,
}

impl Fleet {
    fn start(mut peers: Vec<Peer>, station: SocketAddr, begin: Instant, pace: f64) -> std::io::Result<Self> {
        let stop = Arc::new(AtomicBool::new(false));
        let is_stopped = stop.clone();
        let sockets: Vec<UdpSocket> =
            peers.iter().map(|_| UdpSocket::bind("127.0.0.1:0")).collect::<Result<_, _>>()?;
        for socket in &sockets {
            socket.set_nonblocking(true)?;
        }
        let thread = std::thread::spawn(move || {
            let mut buffer = [0; 512];
            while !is_stopped.load(Ordering::Relaxed) {
                let now = begin.elapsed().as_secs_f64() * pace;
                for (peer, socket) in peers.iter_mut().zip(&sockets) {
                    while let Ok(length) = socket.recv(&mut buffer) {
                        peer.receive(&buffer[..length]);
                    }
                    peer.advance(now);
                    for bytes in peer.take() {
                        let _ = socket.send_to(&bytes, station);
                    }
                }
                std::thread::sleep(Duration::from_millis(1));
            }
            peers
        });
        Ok(Self { stop, thread })
    }

    fn stop(self) -> Vec<Peer> {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.join().unwrap_or_default()
    }
}

type Seen = (Vec<Event>, Vec<Peer>, Vec<u8>);

/// A session of three vehicles over UDP; what was told, the vehicles afterwards, and the log.
fn session(firmware: Firmware, way: Way, reach: Reach) -> Result<Seen, Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    let (tasks, origin) = tasks_of(firmware, way);
    let peers = peers_of(firmware, &tasks, &origin);
    let address: Address = "udpin:127.0.0.1:0".parse()?;
    let transport = Transport::open(&address, Duration::from_millis(1))?;
    let begin = Instant::now();
    let fleet = Fleet::start(peers, transport.local_address()?, begin, PACE)?;
    // A busy machine may take a thread away for a second of test: that is no trouble of the link.
    let settings = Settings { reach, link_timeout: 10.0, deviation: 20.0, ..Settings::default() };
    let mut session = Session::new(tasks, origin, settings, 0.0);
    let log = home.path().join("session.tlog");
    let mut events = Vec::new();
    let outcome = run(
        &mut session,
        &mut Surroundings {
            transport,
            address: address.to_string(),
            log: Some(TelemetryLog::create(&log)?),
            clock: &|| begin.elapsed().as_secs_f64() * PACE,
            attend: &mut |_, _| (),
            tell: &mut |event| events.push(event.clone()),
        },
    );
    let peers = fleet.stop();
    outcome.map_err(|failure: Failure| format!("{failure}\n{events:?}"))?;
    Ok((events, peers, std::fs::read(log)?))
}

/// Frames in a log, each behind eight bytes of time.
fn frames_in(log: &[u8]) -> usize {
    let (mut place, mut count) = (0, 0);
    while place + 10 < log.len() {
        assert!([0xFD, 0xFE].contains(&log[place + 8]), "frame {count} of the log");
        place += 8 + 12 + usize::from(log[place + 9]);
        count += 1;
    }
    assert_eq!(place, log.len());
    count
}

#[test]
fn missions_go_up_and_come_back_over_udp() -> Result<(), Box<dyn Error>> {
    for (firmware, way) in [(Firmware::ArduCopter, Way::LoiterItems), (Firmware::Px4, Way::Polygon)] {
        let (events, peers, log) = session(firmware, way, Reach::Upload)?;
        assert!(peers.iter().all(|peer| peer.completed_uploads == 1 && peer.faults.is_empty()), "{events:?}");
        assert!(frames_in(&log) > 60);
    }
    Ok(())
}

#[test]
fn a_fleet_flies_over_udp() -> Result<(), Box<dyn Error>> {
    for firmware in [Firmware::ArduCopter, Firmware::Px4] {
        let (events, peers, _) = session(firmware, Way::Stream, Reach::Fly)?;
        assert_eq!(events.iter().filter(|event| event.text == "landed").count(), 3, "{events:?}");
        assert!(peers.iter().all(|peer| !peer.armed && peer.path.len() > 1000 && peer.faults.is_empty()));
    }
    Ok(())
}

/// The program itself, with an operator at its standard input: nothing runs fast here, and half a minute passes.
#[test]
fn a_user_flies_a_fleet_and_a_target_appears() -> Result<(), Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    let file = home.path().join("three.toml");
    std::fs::write(&file, mission_text("ardupilot"))?;
    let station = UdpSocket::bind("127.0.0.1:0")?.local_addr()?;
    let (tasks, origin) = tasks_of(Firmware::ArduCopter, Way::Stream);
    let fleet = Fleet::start(peers_of(Firmware::ArduCopter, &tasks, &origin), station, Instant::now(), 1.0)?;
    let mut fly = Command::new(env!("CARGO_BIN_EXE_ground-station"))
        .args(["fly", "three.toml", "--quiet", "--arm", "--link-timeout", "10", "--deviation", "20"])
        .args(["--connect", &format!("udpin:{station}"), "--log", "a.tlog"])
        .current_dir(home.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()?;
    let mut operator = fly.stdin.take().ok_or("no standard input")?;
    operator.write_all(b"what?\n1.5 appears 24 -6 # a stray calf\n")?;
    let run = fly.wait_with_output()?;
    let peers = fleet.stop();
    let told = String::from_utf8_lossy(&run.stdout);
    assert!(run.status.success(), "{told}");
    assert!(
        told.contains("target 4 appears at 24.0 m east, -6.0 m north: new flights for vehicle"),
        "{told}"
    );
    assert!(told.contains("3 vehicle(s) have flown"), "{told}");
    assert!(peers.iter().all(|peer| !peer.armed && peer.path.len() > 1000 && peer.faults.is_empty()));
    assert!(frames_in(&std::fs::read(home.path().join("a.tlog"))?) > 1000);
    Ok(())
}
