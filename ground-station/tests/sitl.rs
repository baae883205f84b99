//! Three ArduCopters in ArduPilot's own simulation fly `missions/field-ardupilot.toml`, where a binary is named:
//!
//! `ARDUCOPTER_SITL=/path/to/arducopter cargo test -p ground-station --test sitl -- --nocapture`
//!
//! Made for ArduCopter 4.6; takes about two minutes.

use ground_station::command::tasks;
use ground_station::execution::Way;
use ground_station::geodesy::Origin;
use ground_station::input;
use ground_station::link::address::Address;
use ground_station::link::frames::{Decoder, Received};
use ground_station::link::pilot::Task;
use ground_station::link::run::{Surroundings, run};
use ground_station::link::session::Session;
use ground_station::link::settings::{Reach, Settings};
use ground_station::link::tlog::TelemetryLog;
use ground_station::link::track::LocalFrame;
use ground_station::link::transport::Transport;
use ground_station::link::vehicle::VehicleState;
use planner::{Options, Plan};
use std::error::Error;
use std::f64::consts::TAU;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

/// What the simulation's own scripts set: a quadcopter with calibrated sensors, no throttle stick.
const PARAMETERS: &str = "FRAME_CLASS 1\nFRAME_TYPE 0\nFS_THR_ENABLE 0\nARMING_CHECK 0\n\
    INS_ACCOFFS_X 0.001\nINS_ACCOFFS_Y 0.001\nINS_ACCOFFS_Z 0.001\nINS_ACCSCAL_X 1.001\nINS_ACCSCAL_Y 1.001\nINS_ACCSCAL_Z 1.001\n\
    INS_ACC2OFFS_X 0.001\nINS_ACC2OFFS_Y 0.001\nINS_ACC2OFFS_Z 0.001\nINS_ACC2SCAL_X 1.001\nINS_ACC2SCAL_Y 1.001\nINS_ACC2SCAL_Z 1.001\n\
    COMPASS_OFS_X 5\nCOMPASS_OFS_Y 13\nCOMPASS_OFS_Z -18\n";

/// Simulated vehicles that end with the test.
struct Vehicles(Vec<Child>);

impl Drop for Vehicles {
    fn drop(&mut self) {
        for child in &mut self.0 {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

fn start(
    binary: &Path,
    tasks: &[Task],
    origin: &Origin,
    port: u16,
    home: &Path,
) -> std::io::Result<Vehicles> {
    let mut vehicles = Vehicles(Vec::new());
    for (index, task) in tasks.iter().enumerate() {
        let folder = home.join(task.system.to_string());
        std::fs::create_dir(&folder)?;
        std::fs::write(folder.join("defaults.parm"), PARAMETERS)?;
        let [latitude, longitude] = origin.geographic([task.pad[0], task.pad[1]]);
        let child = Command::new(binary)
            .current_dir(&folder)
            .args(["--model", "+", "--speedup", "1", "--wipe", "--defaults", "defaults.parm"])
            .args(["--instance", &index.to_string(), "--sysid", &task.system.to_string()])
            .args(["--home", &format!("{latitude:.9},{longitude:.9},{},0", origin.altitude)])
            .args(["--serial0", &format!("udpclient:127.0.0.1:{port}")])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()?;
        vehicles.0.push(child);
    }
    Ok(vehicles)
}

/// Seconds since `begin` (microseconds after 1970), and the message.
fn read_log(path: &Path, begin: u64) -> std::io::Result<Vec<(f64, Received)>> {
    let log = std::fs::read(path)?;
    let (mut place, mut found) = (0, Vec::new());
    while place + 10 <= log.len() {
        let time = u64::from_be_bytes(log[place..place + 8].try_into().unwrap_or_default());
        let signed = if log[place + 8] == 0xFD && log[place + 10] & 1 == 1 { 13 } else { 0 };
        let around = if log[place + 8] == 0xFD { 12 } else { 8 };
        let end = place + 8 + around + signed + usize::from(log[place + 9]);
        let since = time.saturating_sub(begin) as f64 / 1e6;
        found.extend(
            Decoder::default().push(&log[place + 8..end]).into_iter().map(|received| (since, received)),
        );
        place = end;
    }
    Ok(found)
}

/// Where a vehicle was in the plan's frame, with the time since the plan's start.
fn flown(log: &[(f64, Received)], system: u8, origin: &Origin, start: f64) -> Vec<(f64, [f64; 3])> {
    let mut state = VehicleState::default();
    let mut frame: Option<LocalFrame> = None;
    let mut path = Vec::new();
    for (time, received) in
        log.iter().filter(|(_, received)| received.system == system && received.component == 1)
    {
        state.receive(&received.message, *time);
        if !state.is_armed {
            frame = state.local_frame(origin).or(frame);
        }
        if let (Some(frame), Some((at, local))) = (frame, state.local)
            && at == *time
        {
            path.push((time - start, frame.plan_position(local)));
        }
    }
    path.dedup();
    path
}

fn look_at(plan: &Plan, task: &Task, path: &[(f64, [f64; 3])]) {
    let vehicle = &plan.vehicles[task.number - 1];
    let during = |from: f64, to: f64| path.iter().filter(move |(time, _)| *time >= from && *time <= to);
    let (mut squares, mut count) = (0.0, 0.0);
    for (time, [east, north, _]) in during(task.track.start(), task.track.end()) {
        let planned = task.track.at(*time).position;
        squares += (east - planned[0]).powi(2) + (north - planned[1]).powi(2);
        count += 1.0;
    }
    let rms = f64::sqrt(squares / f64::max(count, 1.0));
    assert!(count > 100.0 && rms < 0.3, "vehicle {}: RMS error {rms:.3} m of {count} reports", task.number);
    for leg in &vehicle.legs {
        let Some(circle) = leg.loiter.and_then(|loiter| plan.circles.get(loiter.circle)) else { continue };
        let (mut sum, mut worst, mut seen, mut reports) = (0.0, 0f64, 0.0, 0.0);
        let mut last: Option<f64> = None;
        for (_, [east, north, _]) in during(leg.arrival_time(), leg.end_time()) {
            let (x, y) = (east - circle.centre[0], north - circle.centre[1]);
            sum += x.hypot(y);
            worst = worst.max((x.hypot(y) - circle.radius).abs());
            let angle = y.atan2(x);
            seen += last.map_or(0.0, |last: f64| (angle - last + 1.5 * TAU).rem_euclid(TAU) - 0.5 * TAU);
            last = Some(angle);
            reports += 1.0;
        }
        let mean = sum / f64::max(reports, 1.0);
        println!(
            "vehicle {}: radius {mean:.3} m, worst {worst:.3} m, {:.0} deg",
            task.number,
            seen.to_degrees()
        );
        assert!((mean - circle.radius).abs() < 0.15 && worst < 0.4 && seen.abs() >= TAU - 0.01);
    }
    let pad = vehicle.pad;
    let back = path.iter().find(|(time, [east, north, _])| {
        *time > task.track.end() - 1.0 && (east - pad[0]).hypot(north - pad[1]) < 0.5
    });
    let late = back.map_or(f64::INFINITY, |(time, _)| time / task.track.end());
    assert!(late < 1.05, "vehicle {}: {late:.3} of the planned time", task.number);
}

#[test]
fn three_arducopters_fly_the_field() -> Result<(), Box<dyn Error>> {
    let Some(binary) = std::env::var_os("ARDUCOPTER_SITL") else {
        println!("skipped: name an ArduCopter simulation in ARDUCOPTER_SITL");
        return Ok(());
    };
    let home = tempfile::tempdir()?;
    let file = input::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("missions/field-ardupilot.toml"))?;
    let origin = file.origin.ok_or("no origin")?;
    let plan = planner::plan(&file.mission, &Options::default())?;
    let tasks = tasks(&file, &plan, Way::Stream, &[], &mut |warning| println!("{warning}"))?;
    let address: Address = "udpin:127.0.0.1:0".parse()?;
    let transport = Transport::open(&address, Duration::from_millis(4))?;
    let port = transport.local_address()?.port();
    let vehicles = start(Path::new(&binary), &tasks, &origin, port, home.path())?;
    let settings = Settings { reach: Reach::Fly, check_patience: 120.0, rate: 25.0, ..Settings::default() };
    let log = home.path().join("session.tlog");
    let begin = Instant::now();
    let begin_on_the_clock = SystemTime::now().duration_since(UNIX_EPOCH)?.as_micros() as u64;
    let mut session = Session::new(tasks.clone(), origin, settings, 0.0);
    run(
        &mut session,
        &mut Surroundings {
            transport,
            address: address.to_string(),
            log: Some(TelemetryLog::create(&log)?),
            clock: &|| begin.elapsed().as_secs_f64(),
            attend: &mut |_, _| (),
            tell: &mut |event| println!("{event:?}"),
        },
    )?;
    drop(vehicles);
    let (entries, start) =
        (read_log(&log, begin_on_the_clock)?, session.start().ok_or("the plan never began")?);
    let paths: Vec<_> = tasks.iter().map(|task| flown(&entries, task.system, &origin, start)).collect();
    for (task, path) in tasks.iter().zip(&paths) {
        look_at(&plan, task, path);
    }
    let apart = |time: f64, a: &[f64; 3], other: &[(f64, [f64; 3])]| {
        let near = other.iter().filter(|(at, _)| (at - time).abs() < 0.1);
        near.map(|(_, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(f64::INFINITY, f64::min)
    };
    let least = (0..paths.len())
        .flat_map(|i| (0..i).map(move |j| (i, j)))
        .flat_map(|(i, j)| paths[i].iter().map(move |(time, a)| (j, *time, a)))
        .filter(|(_, time, _)| *time > 0.0)
        .map(|(j, time, a)| apart(time, a, &paths[j]))
        .fold(f64::INFINITY, f64::min);
    // Reports are a tenth of a second apart, and each vehicle may be 0.3 m off its plan.
    assert!(least > file.mission.fleet.separation - 1.0, "vehicles came {least:.2} m close");
    Ok(())
}
