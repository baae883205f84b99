//! Targets and plans in the formats of other programs: there and back, and damaged.

use ground_station::command::{InitRequest, init};
use ground_station::execution::Way;
use ground_station::export::fleet::{Export, Format, fleet_files};
use ground_station::export::folder::OutputFile;
use ground_station::input::{self, Autopilot, MissionFile};
use planner::{Options, Plan, Target};
use std::error::Error;
use std::path::Path;
use std::sync::OnceLock;

const MISSION: &str = r#"
name = "round <trip> & back"
origin = { latitude = -33.8, longitude = 151.2, altitude = 20.0 }
[depot]
position = [0.0, 0.0]
[fleet]
vehicles = 2
preset = "survey-450"
[transition]
entries = 2
segments = 20
[[target]]
name = "oak, \"old\" <one>"
position = [18.0, 4.0]
radius = 4.0
[[target]]
position = [-12.0, 15.0]
safe_distance = 1.0
[[target]]
name = "fir"
position = [3.0, -20.0]
height = 2.5
"#;

fn planned(autopilot: Autopilot) -> (MissionFile, &'static Plan) {
    static PLAN: OnceLock<Plan> = OnceLock::new();
    let mut file = input::parse("trip.toml", MISSION, Path::new("")).expect("the mission is right");
    file.autopilot = autopilot;
    let plan =
        PLAN.get_or_init(|| planner::plan(&file.mission, &Options::default()).expect("it can be planned"));
    (file, plan)
}

const ALL: [Format; 5] = [Format::Plan, Format::Waypoints, Format::Kml, Format::GeoJson, Format::Csv];

fn exported(
    autopilot: Autopilot,
    formats: &[Format],
    way: Option<Way>,
) -> Result<Vec<OutputFile>, Box<dyn Error>> {
    let (file, plan) = planned(autopilot);
    Ok(fleet_files(&file, plan, formats, Export { way, rate: 5.0 })?.0)
}

/// What `import` makes of a file: a mission whose origin lies in the middle of the targets.
fn imported(file: &OutputFile, folder: &Path) -> Result<Vec<Target>, Box<dyn Error>> {
    let path = folder.join(&file.name);
    std::fs::write(&path, &file.content)?;
    let out = folder.join(format!("{}.toml", file.name));
    let origin = planned(Autopilot::ArduPilot).0.origin;
    init(&InitRequest {
        targets: Some(path),
        out: out.clone(),
        origin,
        autopilot: Autopilot::Px4,
        vehicles: 2,
        force: true,
    })?;
    Ok(input::read(&out)?.mission.targets)
}

fn same_place(a: &Target, b: &Target) -> bool {
    (a.position[0] - b.position[0]).hypot(a.position[1] - b.position[1]) < 0.02
}

/// Formats for targets give all of them back, with names and settings.
#[test]
fn targets_come_back_from_maps_and_tables() -> Result<(), Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    let wanted = planned(Autopilot::ArduPilot).0.mission.targets;
    let files = exported(Autopilot::ArduPilot, &[Format::Kml, Format::GeoJson, Format::Csv], None)?;
    for name in ["mission.kml", "mission.geojson", "targets.csv"] {
        let file = files.iter().find(|file| file.name == name).ok_or(name)?;
        let targets = imported(file, home.path())?;
        assert_eq!(targets.len(), wanted.len(), "{name}");
        for (target, wanted) in targets.iter().zip(&wanted) {
            assert!(same_place(target, wanted), "{name}: {target:?}");
            assert_eq!(
                (target.radius, target.height, target.safe_distance),
                (wanted.radius, wanted.height, wanted.safe_distance)
            );
            // KML has no place without a name; targets without one get their number.
            assert!(target.name == wanted.name || wanted.name.is_empty(), "{name}: {}", target.name);
        }
    }
    Ok(())
}

/// Missions of both autopilots give back the targets of each vehicle in the order of its route.
#[test]
fn targets_come_back_from_missions() -> Result<(), Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    for (autopilot, way) in
        [(Autopilot::ArduPilot, None), (Autopilot::ArduPilot, Some(Way::Polygon)), (Autopilot::Px4, None)]
    {
        let (mission, plan) = planned(autopilot);
        for file in exported(autopilot, &[Format::Plan, Format::Waypoints], way)? {
            let number: usize =
                file.name.trim_start_matches("vehicle-").split('.').next().unwrap_or_default().parse()?;
            let targets = imported(&file, home.path())?;
            let route = &plan.vehicles[number - 1].route;
            assert_eq!(targets.len(), route.len(), "{}", file.name);
            for (target, &circle) in targets.iter().zip(route) {
                let wanted = &mission.mission.targets[plan.circles[circle].members[0]];
                assert!(same_place(target, wanted), "{}: {target:?}", file.name);
            }
        }
    }
    Ok(())
}

#[test]
fn what_an_autopilot_cannot_is_refused_in_plain_words() {
    let (file, plan) = planned(Autopilot::Px4);
    let refusal = |way, format| {
        fleet_files(&file, plan, &[format], Export { way: Some(way), rate: 5.0 })
            .map(|_| ())
            .unwrap_err()
            .to_string()
    };
    assert!(refusal(Way::LoiterItems, Format::Plan).contains("PX4 refuses a mission with LOITER_TURNS"));
    assert!(refusal(Way::Stream, Format::Waypoints).contains("nothing that is live"));
    let (_, warnings) = fleet_files(&file, plan, &[Format::Kml], Export { way: None, rate: 5.0 })
        .expect("streaming is known");
    assert!(warnings.iter().any(|warning| warning.contains("see 353 of 360 degrees")), "{warnings:?}");
}

/// A generator for damage (xorshift).
struct Damage(u64);

impl Damage {
    fn below(&mut self, bound: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % bound.max(1) as u64) as usize
    }

    /// Bytes changed, cut out, doubled or put in; as text again.
    fn apply(&mut self, text: &str) -> String {
        const INTERESTING: [&str; 12] = [
            "nan",
            "inf",
            "-1e308",
            "1e309",
            "\0",
            "\"",
            "<",
            "]]>",
            "null",
            "[[[[",
            ",,,",
            "99999999999999999999",
        ];
        let mut bytes = text.as_bytes().to_vec();
        for _ in 0..=self.below(4) {
            let at = self.below(bytes.len());
            let length = self.below(40).min(bytes.len() - at);
            match self.below(5) {
                0 if !bytes.is_empty() => bytes[at] ^= 1 << self.below(8),
                1 => drop(bytes.drain(at..at + length)),
                2 => {
                    let part = bytes[at..at + length].to_vec();
                    bytes.splice(at..at, part);
                }
                3 => drop(bytes.splice(at..at + length, INTERESTING[self.below(INTERESTING.len())].bytes())),
                _ => bytes.truncate(at.max(1)),
            }
        }
        String::from_utf8_lossy(&bytes).into_owned()
    }
}

/// 200 damaged files of each format: a mission or problems, never a panic, never a half-written file.
#[test]
fn damaged_files_are_answered() -> Result<(), Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    let mut files = exported(Autopilot::ArduPilot, &ALL, None)?;
    files.retain(|file| !file.name.starts_with("vehicle-2") && file.name != "vehicle-1.csv");
    let gpx = "<?xml version=\"1.0\"?><gpx version=\"1.1\" creator=\"x\" xmlns=\"http://www.topografix.com/GPX/1/1\">\
               <wpt lat=\"-33.8\" lon=\"151.2\"><name>a</name></wpt><wpt lat=\"-33.8001\" lon=\"151.2002\"/></gpx>";
    files.push(OutputFile { name: "points.gpx".into(), content: gpx.into() });
    assert_eq!(files.len(), 6);
    let mut damage = Damage(0x5EED);
    let out = home.path().join("mission.toml");
    for file in &files {
        let (mut taken, path) = (0, home.path().join(&file.name));
        for _ in 0..200 {
            std::fs::write(&path, damage.apply(&file.content))?;
            let _ = std::fs::remove_file(&out);
            let request = InitRequest {
                targets: Some(path.clone()),
                out: out.clone(),
                origin: None,
                autopilot: Autopilot::ArduPilot,
                vehicles: 2,
                force: false,
            };
            match init(&request) {
                Ok(_) => {
                    taken += 1;
                    assert!(input::read(&out).is_ok(), "{}: what was written is not a mission", file.name);
                }
                Err(failure) => {
                    assert!(!out.exists() && !failure.to_string().is_empty());
                }
            }
        }
        assert!(taken < 200, "{}: no damage was seen", file.name);
    }
    // Nothing is left beside the files that were asked for.
    let names: Vec<String> = std::fs::read_dir(home.path())?
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    assert!(names.iter().all(|name| !name.starts_with('.')), "{names:?}");
    Ok(())
}

/// 200 damaged mission files.
#[test]
fn damaged_missions_are_answered() {
    let mut damage = Damage(0xF1E1D);
    for _ in 0..200 {
        let text = damage.apply(include_str!("../missions/field-ardupilot.toml"));
        if let Err(problems) = input::parse("m.toml", &text, Path::new("")) {
            assert!(!problems.is_empty() && problems.iter().all(|problem| !problem.message.is_empty()));
        }
    }
}
