//! The program as a user runs it, short of planning.

use std::error::Error;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn run<S: AsRef<OsStr>>(arguments: &[S], folder: &Path) -> Result<Output, std::io::Error> {
    Command::new(env!("CARGO_BIN_EXE_ground-station")).args(arguments).current_dir(folder).output()
}

fn missions() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("missions")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn help_has_examples() -> Result<(), Box<dyn Error>> {
    for arguments in [vec!["--help"], vec!["plan", "--help"]] {
        let run = run(&arguments, Path::new("."))?;
        assert_eq!(run.status.code(), Some(0));
        assert!(text(&run.stdout).contains("Examples:"), "{arguments:?}");
    }
    Ok(())
}

#[test]
fn slips_on_the_command_line_are_bad_input() -> Result<(), Box<dyn Error>> {
    for arguments in [
        vec!["plam"],
        vec!["plan", "--rate", "0"],
        vec!["plan", "--rate", "nan"],
        vec!["plan", "--transcription", "euler"],
        vec!["check"],
    ] {
        let run = run(&arguments, Path::new("."))?;
        assert_eq!(run.status.code(), Some(2), "{arguments:?}");
    }
    Ok(())
}

#[test]
fn the_missions_beside_the_program_have_no_problems() -> Result<(), Box<dyn Error>> {
    for name in ["field.toml", "pasture.toml", "field-ardupilot.toml"] {
        let run = run(&["check".into(), missions().join(name)], Path::new("."))?;
        assert_eq!(run.status.code(), Some(0), "{name}: {}", text(&run.stderr));
        assert!(text(&run.stdout).contains("no problems"));
    }
    Ok(())
}

#[test]
fn a_missing_file_is_said_with_its_name() -> Result<(), Box<dyn Error>> {
    for command in ["check", "plan"] {
        let run = run(&[command, "nowhere.toml"], Path::new("."))?;
        assert_eq!(run.status.code(), Some(2));
        let error = text(&run.stderr);
        assert!(error.contains("nowhere.toml: cannot be read (no such file or directory)"), "{error}");
    }
    Ok(())
}

#[test]
fn files_that_a_mission_names_are_checked_too() -> Result<(), Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    let mission = |file: &str| {
        format!(
            "origin = {{ latitude = 42.0, longitude = -93.0 }}\n[depot]\nposition = [0, 0]\n[fleet]\nvehicles = 1\n[targets]\nfile = \"{file}\"\n"
        )
    };
    std::fs::write(home.path().join("bad.geojson"), r#"{"type":"Point","coordinates":[-93.0,142.0]}"#)?;
    std::fs::write(home.path().join("bad.csv"), "id,lat,lon\n1,north,-93\n")?;
    for (file, wanted) in [
        ("none.csv", "targets.file = \"none.csv\" cannot be read"),
        ("bad.geojson", "bad.geojson: geometry.geometry.coordinates: latitude 142 is out of range"),
        ("bad.csv", "bad.csv:2: lat = north is out of range"),
        ("bad.kmz", "targets.file = \"bad.kmz\" cannot be read"),
    ] {
        std::fs::write(home.path().join("m.toml"), mission(file))?;
        let run = run(&["check", "m.toml"], home.path())?;
        let error = text(&run.stderr);
        assert_eq!(run.status.code(), Some(2), "{error}");
        assert!(error.contains(wanted), "{error}");
    }
    Ok(())
}

#[test]
fn geographic_targets_need_an_origin() -> Result<(), Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    let mission =
        "[depot]\nposition = [0, 0]\n[fleet]\nvehicles = 1\n[[target]]\nlatitude = 42.0\nlongitude = -93.0\n";
    std::fs::write(home.path().join("m.toml"), mission)?;
    let run = run(&["check", "m.toml"], home.path())?;
    let error = text(&run.stderr);
    assert!(
        error.contains(
            "m.toml:6: target[0].latitude = 42.0 is geographic, but the mission has no usable origin"
        ),
        "{error}"
    );
    assert!(error.contains("add origin = "), "{error}");
    Ok(())
}

/// A refusal comes before any planning, and leaves the folder alone.
#[test]
fn a_foreign_folder_is_refused() -> Result<(), Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    let out = home.path().join("out");
    std::fs::create_dir(&out)?;
    std::fs::write(out.join("thesis.txt"), "mine")?;
    let run = run(&["plan"], home.path())?;
    let error = text(&run.stderr);
    assert_eq!(run.status.code(), Some(1), "{error}");
    assert!(error.contains("out exists and does not hold a plan") && error.contains("--force"), "{error}");
    assert_eq!(std::fs::read_to_string(out.join("thesis.txt"))?, "mine");
    assert_eq!(std::fs::read_dir(&out)?.count(), 1);
    Ok(())
}

/// Three safe distances that touch one another wall the pad in, and the only entry tried lies outside.
#[test]
fn a_leg_that_cannot_be_flown_is_said_and_nothing_is_written() -> Result<(), Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    let mission = r#"
        name = "wall"
        [depot]
        position = [0.0, 0.0]
        [fleet]
        vehicles = 1
        preset = "survey-450"
        [loiter]
        radius = 5.501
        height = 1.5
        [transition]
        entries = 1
        segments = 20
        safe_distance = 5.499
        [targets]
        positions = [[6.351, 0.0], [-3.1755, 5.50013], [-3.1755, -5.50013]]
    "#;
    std::fs::write(home.path().join("wall.toml"), mission)?;
    let run = run(&["plan", "wall.toml", "--out", "out"], home.path())?;
    assert_eq!(run.status.code(), Some(1));
    let error = text(&run.stderr);
    assert!(error.contains("leg 1 of vehicle 1") && error.contains("residual"), "{error}");
    assert!(!home.path().join("out").exists());
    Ok(())
}

/// Commands that need no planning, as a user runs them.
#[test]
fn missions_are_begun_and_points_are_solved() -> Result<(), Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    assert_eq!(run(&["init"], home.path())?.status.code(), Some(0));
    assert_eq!(run(&["init"], home.path())?.status.code(), Some(1), "a file is not replaced unasked");
    assert_eq!(run(&["check", "mission.toml"], home.path())?.status.code(), Some(0));
    std::fs::write(home.path().join("points.csv"), "x,y\n0,0\n30,0\n0,40\n-35,5\n10,10\n")?;
    let tour = run(&["tour", "points.csv", "--json"], home.path())?;
    assert!(text(&tour.stdout).contains("\"nodes\":5"), "{}", text(&tour.stdout));
    let routes = run(&["routes", "points.csv", "--vehicles", "3"], home.path())?;
    assert!(text(&routes.stdout).contains("makespan 80.000"), "{}", text(&routes.stdout));
    for shell in ["bash", "zsh", "fish"] {
        assert!(text(&run(&["completions", shell], home.path())?.stdout).contains("ground-station"));
    }
    let study = ["study", "cost", "--trials", "2", "--targets", "10", "--vehicles", "2", "--out", "s"];
    assert_eq!(run(&study, home.path())?.status.code(), Some(0));
    let merge = run(&["study", "merge", "s/cost.csv", "s/cost.csv", "--out", "m"], home.path())?;
    assert!(text(&merge.stdout).contains("m = 2   10       4  "), "{}", text(&merge.stdout));
    Ok(())
}

/// Two targets flown in wind: files whole, errors below what a controller is asked for.
#[test]
fn a_plan_is_flown_in_wind() -> Result<(), Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    assert_eq!(run(&["init", "m.toml", "--vehicles", "1"], home.path())?.status.code(), Some(0));
    let simulate =
        run(&["simulate", "m.toml", "--wind", "2,-1", "--gusts", "3", "--noise", "--out", "s"], home.path())?;
    assert_eq!(simulate.status.code(), Some(0), "{}", text(&simulate.stderr));
    let table = std::fs::read_to_string(home.path().join("s/flown-1.csv"))?;
    let errors = table.lines().skip(1).filter_map(|line| line.rsplit(',').next()?.parse::<f64>().ok());
    assert!(table.lines().count() > 100 && errors.fold(0.0, f64::max) < 1.5);
    let log = std::fs::read_to_string(home.path().join("s/events.log"))?;
    assert!(
        log.contains("takes off") && log.contains("has circled 2") && log.contains("is back at its pad"),
        "{log}"
    );
    assert!(home.path().join("s/flown.svg").exists());
    let again = run(&["simulate", "m.toml", "--out", "s"], home.path())?;
    assert_eq!(again.status.code(), Some(1));
    assert_eq!(run(&["simulate", "--wind", "storm"], home.path())?.status.code(), Some(2));
    Ok(())
}

/// Targets come, go and move: the log says what came of each, and the last plan stands.
#[test]
fn events_are_followed_while_the_team_flies() -> Result<(), Box<dyn Error>> {
    let home = tempfile::tempdir()?;
    assert_eq!(run(&["init", "m.toml", "--vehicles", "2"], home.path())?.status.code(), Some(0));
    let events =
        "# five\n1.0 appears 30 -25\n3 vanishes 99\n4 moves 1 -20 22 # away\n5 vanishes 2\n6 returns 7\n";
    std::fs::write(home.path().join("events.txt"), events)?;
    let simulate = run(&["simulate", "m.toml", "--arrivals", "events.txt", "--out", "s"], home.path())?;
    assert_eq!(simulate.status.code(), Some(0), "{}", text(&simulate.stderr));
    assert!(
        text(&simulate.stdout).contains("stands up to the independent check"),
        "{}",
        text(&simulate.stdout)
    );
    let log = std::fs::read_to_string(home.path().join("s/events.log"))?;
    for wanted in [
        "appears at 30.0 m east, -25.0 m north: new flights",
        "refused: there is no target 99",
        "no vehicle 7",
    ] {
        assert!(log.contains(wanted), "{wanted}: {log}");
    }
    let chance = ["simulate", "m.toml", "--arrival-rate", "6", "--seed", "4", "--out", "c"];
    assert_eq!(run(&chance, home.path())?.status.code(), Some(0));
    assert!(std::fs::read_to_string(home.path().join("c/events.log"))?.contains("target"));

    std::fs::write(home.path().join("bad.txt"), "1 appears 2\nsoon fails 1\n")?;
    let bad = run(&["simulate", "m.toml", "--arrivals", "bad.txt", "--out", "b"], home.path())?;
    let error = text(&bad.stderr);
    assert!(
        bad.status.code() == Some(2) && error.contains("bad.txt:1") && error.contains("bad.txt:2"),
        "{error}"
    );
    let plain = std::fs::read_to_string(home.path().join("m.toml"))?;
    let merged = format!("{plain}\n[targets]\nmerge_within = 5.0\n");
    std::fs::write(home.path().join("merged.toml"), merged)?;
    let merged = run(&["simulate", "merged.toml", "--arrivals", "events.txt", "--out", "b"], home.path())?;
    assert_eq!(merged.status.code(), Some(0), "{}", text(&merged.stderr));
    assert!(home.path().join("b/events.log").exists());
    Ok(())
}
