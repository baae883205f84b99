//! The missions beside the program, planned, verified and written as they are.

use ground_station::command::{PlanRequest, plan};
use ground_station::export::plan_json::PlanDocument;
use std::error::Error;
use std::path::{Path, PathBuf};

fn missions() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("missions")
}

fn request(file: PathBuf, out: PathBuf) -> PlanRequest {
    PlanRequest {
        file: Some(file),
        out,
        force: false,
        rate: 20.0,
        verify: true,
        transcription: None,
        json: false,
        quiet: true,
    }
}

/// Plans a file with `--verify` and looks at everything that is written.
fn plan_and_look(file: PathBuf, vehicles: usize) -> Result<(), Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    let out = home.path().join("out");
    let text = plan(&request(file, out.clone()))?;
    assert!(text.contains("verification passed"), "{text}");
    let mut names: Vec<String> = std::fs::read_dir(&out)?
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let mut wanted = vec!["map.svg".to_owned(), "plan.json".to_owned()];
    for number in 1..=vehicles {
        wanted.extend(["csv", "plan"].map(|kind| format!("vehicle-{number}.{kind}")));
        wanted.push(format!("profile-{number}.svg"));
    }
    wanted.sort();
    assert_eq!(names, wanted);
    look_at_document(&std::fs::read_to_string(out.join("plan.json"))?)?;
    for number in 1..=vehicles {
        look_at_table(&std::fs::read_to_string(out.join(format!("vehicle-{number}.csv")))?);
    }
    Ok(())
}

/// The document survives a round trip, its times add up and every target is circled once.
fn look_at_document(text: &str) -> Result<(), Box<dyn Error>> {
    let document: PlanDocument = serde_json::from_str(text)?;
    assert_eq!(document.to_text()?, text);
    let mut circled = vec![0; document.targets.len()];
    for vehicle in &document.vehicles {
        let start = vehicle.legs.first().map_or(0.0, |leg| leg.start_time_s);
        let mut time = start;
        for leg in &vehicle.legs {
            assert!((leg.start_time_s - time).abs() < 1e-9 && leg.end_time_s >= leg.arrival_time_s);
            time = leg.end_time_s;
            for &target in leg.loiter.iter().flat_map(|loiter| &document.circles[loiter.circle - 1].targets) {
                circled[target - 1] += 1;
            }
            let miss = leg.transition.integrated_miss;
            assert!(miss.position_m < 0.05 && miss.velocity_m_s < 0.05 && miss.attitude_deg < 1.0);
            let knots = leg.transition.knots_s.len();
            assert!(knots > 1 && leg.transition.states.values().all(|column| column.len() == knots));
            let controls = (knots - 1) * leg.transition.controls_per_segment;
            assert!(leg.transition.controls.values().all(|column| column.len() == controls));
        }
        assert!((vehicle.duration_s - (time - start)).abs() < 1e-9);
        let execution = &vehicle.execution;
        assert_eq!((execution.way.as_str(), execution.circles.len()), ("stream", vehicle.route.len()));
        assert!(execution.circles.iter().all(|circle| (352.0..=360.0).contains(&circle.seen_deg)));
    }
    assert!(circled.iter().all(|&times| times == 1), "{circled:?}");
    assert!(document.certificate.makespan_lower_bound_s <= document.team.makespan_s);
    Ok(())
}

/// Twenty columns, times that rise by a twentieth of a second, and no jump that the speed does not explain.
fn look_at_table(text: &str) {
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').take(7).filter_map(|cell| cell.parse().ok()).collect())
        .collect();
    assert!(rows.len() > 20 && text.lines().all(|line| line.split(',').count() == 20));
    for pair in rows.windows(2) {
        let step = pair[1][0] - pair[0][0];
        assert!(step > 0.0 && step < 0.05 + 1e-6, "{step}");
        for axis in 1..4 {
            let mean = (pair[0][axis + 3] + pair[1][axis + 3]) / 2.0;
            let moved = pair[1][axis] - pair[0][axis];
            assert!(
                (moved - mean * step).abs() < 0.03,
                "at {} s: {moved} against {}",
                pair[0][0],
                mean * step
            );
        }
    }
}

/// A mission file with some of its text replaced, in a folder of its own.
fn lighter(name: &str, changes: &[(&str, &str)], folder: &Path) -> Result<PathBuf, Box<dyn Error>> {
    let mut text = std::fs::read_to_string(missions().join(name))?;
    for (from, to) in changes {
        assert!(text.contains(from), "{name} has no {from}");
        text = text.replace(from, to);
    }
    let file = folder.join(name);
    std::fs::write(&file, text)?;
    Ok(file)
}

/// The same mission gives the same bytes in every file.
#[test]
fn planning_twice_gives_the_same_files() -> Result<(), Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    let changes = [
        ("entries = 16", "entries = 1"),
        ("segments = 40", "segments = 20"),
        ("    [27.5, 22.0],\n    [8.0, 31.0],\n    [45.5, 38.0],\n    [19.0, 44.5],\n    [33.0, 6.0],\n", ""),
    ];
    let file = lighter("field.toml", &changes, home.path())?;
    let [first, second] = ["first", "second"].map(|name| home.path().join(name));
    for out in [&first, &second] {
        plan(&request(file.clone(), out.clone()))?;
    }
    for entry in std::fs::read_dir(&first)?.flatten() {
        let other = second.join(entry.file_name());
        assert!(std::fs::read(entry.path())? == std::fs::read(&other)?, "{}", other.display());
    }
    // A plan of ours is replaced without being asked.
    plan(&request(file, first))?;
    Ok(())
}

#[test]
fn the_field() -> Result<(), Box<dyn Error>> {
    plan_and_look(missions().join("field.toml"), 3)
}

#[test]
fn the_field_for_ardupilot() -> Result<(), Box<dyn Error>> {
    plan_and_look(missions().join("field-ardupilot.toml"), 3)
}

#[test]
fn the_pasture() -> Result<(), Box<dyn Error>> {
    plan_and_look(missions().join("pasture.toml"), 8)
}

/// One vehicle with too small a battery for all targets flies several times; every file and table says which flight it is about.
#[test]
fn batteries_are_swapped_and_pictures_are_looked_for() -> Result<(), Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    let field = std::fs::read_to_string(missions().join("field.toml"))?;
    let text = field
        .replace("vehicles = 3", "vehicles = 2\nswap_time = 30.0")
        .replace("endurance = 900.0", "endurance = 22.0")
        .replace("[loiter]", "[camera]\nhorizontal_view = 62.0\nvertical_view = 48.0\nmount_yaw = 90.0\nmount_pitch = 20.0\nmount = \"gimbal\"\n\n[loiter]");
    let file = home.path().join("m.toml");
    std::fs::write(&file, text)?;
    let out = home.path().join("out");
    let text = plan(&request(file, out.clone()))?;
    for wanted in [
        "1 flight 1 ",
        "2 flight 2 ",
        "with batteries swapped on the pads",
        "vehicle 1 flight 2",
        "in the picture",
    ] {
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
    for name in ["vehicle-1-flight-2.csv", "vehicle-2-flight-1.plan", "profile-2-flight-2.svg"] {
        assert!(out.join(name).exists(), "{name}");
    }
    let document: PlanDocument = serde_json::from_str(&std::fs::read_to_string(out.join("plan.json"))?)?;
    let flights: Vec<_> = document.vehicles.iter().map(|entry| (entry.vehicle, entry.flight)).collect();
    assert_eq!(flights[..3], [(1, 1), (2, 1), (1, 2)], "{flights:?}");
    assert_eq!(document.mission.swap_time_s, Some(30.0));
    assert!(document.targets.iter().all(|target| target.share_in_view.is_some()));
    let map = std::fs::read_to_string(out.join("map.svg"))?;
    assert!(map.contains("vehicle 1 flight 2: "));
    Ok(())
}

/// Circles overlap their end for an autopilot, unless the file says how far they go.
#[test]
fn circles_overlap_for_an_autopilot() {
    let mission = "[depot]\nposition = [0, 0]\n[fleet]\nvehicles = 1\n[[target]]\nposition = [20, 5]\n";
    let sweep = |text: &str| {
        let file = ground_station::input::parse("m.toml", text, Path::new(""))
            .map_err(|problems| format!("{problems:?}"));
        file.map(|file| file.mission.loiter.sweep.to_degrees().round())
    };
    assert_eq!(sweep(mission), Ok(360.0));
    assert_eq!(sweep(&format!("autopilot = \"px4\"\n{mission}")), Ok(380.0));
    assert_eq!(sweep(&format!("autopilot = \"px4\"\n{mission}[loiter]\nsweep = 400.0\n")), Ok(400.0));
}
