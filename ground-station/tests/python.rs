//! What programs of others make of ours: `pymavlink` plays three vehicles and reads missions, MAVSDK imports and uploads them,
//! `fastkml`, `geojson` and `shapely` open the maps.
//!
//! `GROUND_STATION_PYTHON` names a Python that has `tests/scripts/requirements.txt`; without it the tests say that they skip.
//! `.ci/run` makes one.

use std::error::Error;
use std::ffi::OsString;
use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Longer than any of these sessions takes on a busy machine.
const LIMIT: Duration = Duration::from_secs(90);

type Outcome = Result<(), Box<dyn Error>>;

/// A program that does not outlive its test.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Running {
    /// What it prints goes into files: a full pipe would hold it up.
    fn start(command: &mut Command, folder: &Path, name: &str) -> Result<Self, Box<dyn Error>> {
        let out = std::fs::File::create(folder.join(name))?;
        let command = command.stdin(Stdio::null()).stderr(out.try_clone()?).stdout(out);
        Ok(Self(command.spawn()?))
    }

    /// Whether it succeeds before the limit.
    fn succeeds(&mut self) -> Result<bool, Box<dyn Error>> {
        let begin = Instant::now();
        while begin.elapsed() < LIMIT {
            if let Some(status) = self.0.try_wait()? {
                return Ok(status.success());
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        Ok(false)
    }
}

fn python() -> Option<OsString> {
    let python = std::env::var_os("GROUND_STATION_PYTHON");
    if python.is_none() {
        println!("skipped: GROUND_STATION_PYTHON names no Python with tests/scripts/requirements.txt");
    }
    python
}

fn script(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scripts").join(name)
}

fn free_port() -> std::io::Result<String> {
    Ok(UdpSocket::bind("127.0.0.1:0")?.local_addr()?.port().to_string())
}

/// The built-in field for an autopilot, in a folder of its own.
fn exported(home: &Path, autopilot: &str) -> Result<PathBuf, Box<dyn Error>> {
    let folder = home.join(autopilot);
    let run = Command::new(env!("CARGO_BIN_EXE_ground-station"))
        .args(["export", "--quiet", "--autopilot", autopilot, "--format", "plan,waypoints,kml,geojson"])
        .arg("--out")
        .arg(&folder)
        .output()?;
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    Ok(folder)
}

/// Missions are uploaded to three vehicles and read back.
#[test]
fn three_vehicles_of_pymavlink_take_their_missions() -> Outcome {
    let Some(python) = python() else { return Ok(()) };
    let home = tempfile::tempdir()?;
    let port = free_port()?;
    let mut vehicles = Command::new(python);
    vehicles.arg(script("vehicles_pymavlink.py")).arg(&port);
    let mut vehicles = Running::start(&mut vehicles, home.path(), "vehicles")?;
    let mut fly = Command::new(env!("CARGO_BIN_EXE_ground-station"));
    let address = format!("udpin:127.0.0.1:{port}");
    fly.args(["fly", "--connect", &address, "--way", "loiter-items", "--quiet"]);
    let mut fly = Running::start(&mut fly, home.path(), "fly")?;
    let succeeded = [fly.succeeds()?, vehicles.succeeds()?];
    let said = |name: &str| std::fs::read_to_string(home.path().join(name));
    let (told, held) = (said("fly")?, said("vehicles")?);
    assert_eq!(succeeded, [true, true], "{told}\n{held}");
    assert_eq!(held.matches("read back: True").count(), 3, "{held}");
    assert_eq!(told.matches("mission read back and compared").count(), 3, "{told}");
    Ok(())
}

/// MAVSDK imports a `.plan` of each autopilot, uploads it to a vehicle and reads it back.
#[test]
fn mavsdk_imports_our_plans() -> Outcome {
    let Some(python) = python() else { return Ok(()) };
    let home = tempfile::tempdir()?;
    for autopilot in ["ardupilot", "px4"] {
        let folder = exported(home.path(), autopilot)?;
        let port = free_port()?;
        let mut vehicles = Command::new(&python);
        vehicles.arg(script("vehicles_pymavlink.py")).arg(&port);
        let _vehicles = Running::start(&mut vehicles, &folder, "vehicles")?;
        let mut reader = Command::new(&python);
        reader.arg(script("plan_mavsdk.py")).arg(&port).arg(folder.join("vehicle-1.plan"));
        let succeeded = Running::start(&mut reader, &folder, "mavsdk")?.succeeds()?;
        let said = std::fs::read_to_string(folder.join("mavsdk"))?;
        assert!(succeeded && said.contains("uploaded and read back"), "{autopilot}: {said}");
    }
    Ok(())
}

/// Maps are what they say in the eyes of other libraries, and both show the targets at the same places.
#[test]
fn maps_and_missions_are_opened_by_other_libraries() -> Outcome {
    let Some(python) = python() else { return Ok(()) };
    let home = tempfile::tempdir()?;
    for autopilot in ["ardupilot", "px4"] {
        let folder = exported(home.path(), autopilot)?;
        let mut reader = Command::new(&python);
        reader.arg(script("read_maps.py")).arg(&folder);
        let succeeded = Running::start(&mut reader, home.path(), "maps")?.succeeds()?;
        let said = std::fs::read_to_string(home.path().join("maps"))?;
        assert!(succeeded && said.contains("8 targets at the same places in both maps"), "{said}");
    }
    Ok(())
}
