//! Every key of the mission schema, mutated: missing, wrong type, out of range, not a number, unknown.
//!
//! Each mutation either gives a mission or a list of problems that names the mutated key with a remedy; never a panic.

use ground_station::input::parse;
use ground_station::problem::Problem;
use std::path::{Path, PathBuf};
use std::process::Command;
use toml::{Table, Value};

const COMPLETE: &str = include_str!("data/complete.toml");

/// A way to a value: keys and indices.
#[derive(Debug, Clone, PartialEq)]
enum Step {
    Key(String),
    Index(usize),
}

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data")
}

fn complete() -> Table {
    COMPLETE.parse().unwrap_or_default()
}

fn problems(document: &Table) -> Vec<Problem> {
    let source = toml::to_string(document).unwrap_or_default();
    parse("m.toml", &source, &data()).err().unwrap_or_default()
}

/// The ways to all values that are no tables, tables of lists included.
fn leaves(value: &Value, way: &[Step], found: &mut Vec<Vec<Step>>) {
    let mut next = |step: Step, value: &Value| {
        let way = [way, &[step]].concat();
        leaves(value, &way, found);
    };
    match value {
        Value::Table(table) => table.iter().for_each(|(key, value)| next(Step::Key(key.clone()), value)),
        Value::Array(list) => {
            list.iter().enumerate().for_each(|(index, value)| next(Step::Index(index), value));
            found.push(way.to_vec());
        }
        _ => found.push(way.to_vec()),
    }
}

fn all_leaves() -> Vec<Vec<Step>> {
    let mut found = Vec::new();
    leaves(&Value::Table(complete()), &[], &mut found);
    assert!(found.len() > 70, "the complete file has lost keys: {}", found.len());
    found
}

fn at<'a>(document: &'a mut Value, way: &[Step]) -> Option<&'a mut Value> {
    way.iter().try_fold(document, |value, step| match step {
        Step::Key(key) => value.get_mut(key.as_str()),
        Step::Index(index) => value.get_mut(*index),
    })
}

/// The document with one value replaced.
fn with(way: &[Step], value: Value) -> Table {
    let mut document = Value::Table(complete());
    if let Some(place) = at(&mut document, way) {
        *place = value;
    }
    document.as_table().cloned().unwrap_or_default()
}

/// The document with the table around a value changed.
fn around(way: &[Step], change: impl FnOnce(&mut Table, &str)) -> Table {
    let mut document = Value::Table(complete());
    if let (Some((Step::Key(key), parents)), root) = (way.split_last(), &mut document)
        && let Some(Value::Table(table)) = at(root, parents)
    {
        change(table, key);
    }
    document.as_table().cloned().unwrap_or_default()
}

/// As messages write it: `targets.positions[1][0]`.
fn path(way: &[Step]) -> String {
    let mut path = String::new();
    for step in way {
        match step {
            Step::Key(key) if path.is_empty() => path.push_str(key),
            Step::Key(key) => path.push_str(&format!(".{key}")),
            Step::Index(index) => path.push_str(&format!("[{index}]")),
        }
    }
    path
}

/// Some problem is about the key (or a part of it, or the list it is in), and says what to do.
fn assert_named(problems: &[Problem], key: &str, what: &str) {
    let about = |problem: &&Problem| {
        problem.key.starts_with(key) || (!problem.key.is_empty() && key.starts_with(&problem.key))
    };
    let named = problems.iter().find(about);
    assert!(named.is_some(), "{key} {what}: {problems:#?}");
    for problem in problems {
        assert!(problem.message.contains(": ") || problem.message.contains("; "), "no remedy: {problem}");
        assert!(!problem.message.contains('\n') && problem.message.len() < 420, "{problem}");
    }
}

#[test]
fn the_complete_file_is_right() {
    let problems = problems(&complete());
    assert!(problems.is_empty(), "{problems:#?}");
}

#[test]
fn missing_keys_are_named_or_have_a_default() {
    const NEEDED: [&str; 10] = [
        "camera.horizontal_view",
        "camera.vertical_view",
        "origin.latitude",
        "origin.longitude",
        "depot.latitude",
        "depot.longitude",
        "fleet.vehicles",
        "target[0].position",
        "target[1].latitude",
        "target[1].longitude",
    ];
    for way in all_leaves() {
        let document = around(&way, |table, key| drop(table.remove(key)));
        let problems = problems(&document);
        let key = path(&way);
        if NEEDED.contains(&key.as_str()) {
            assert_named(&problems, &key, "removed");
        } else {
            assert!(problems.is_empty(), "{key} removed: {problems:#?}");
        }
    }
}

#[test]
fn wrong_types_are_named() {
    let values = [
        Value::String("x".into()),
        Value::Boolean(true),
        Value::Integer(3),
        Value::Float(0.5),
        Value::Array(vec![]),
        Value::Table(Table::new()),
        "1979-05-27".parse().map_or(Value::Boolean(false), Value::Datetime),
    ];
    for way in all_leaves() {
        let original = at(&mut Value::Table(complete()), &way).cloned();
        for value in &values {
            let numeric = |value: &Value| value.is_float() || value.is_integer();
            let is_same = original
                .as_ref()
                .is_some_and(|original| original.same_type(value) || (numeric(original) && numeric(value)));
            if !is_same {
                assert_named(&problems(&with(&way, value.clone())), &path(&way), &format!("= {value}"));
            }
        }
    }
}

#[test]
fn numbers_out_of_range_are_named() {
    for way in all_leaves() {
        let number = at(&mut Value::Table(complete()), &way)
            .is_some_and(|value| value.is_float() || value.is_integer());
        if !number {
            continue;
        }
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1e9] {
            assert_named(&problems(&with(&way, Value::Float(value))), &path(&way), &format!("= {value}"));
        }
        assert_named(&problems(&with(&way, Value::Integer(i64::MIN))), &path(&way), "least integer");
        // The greatest numbers are right for some keys; they must not do harm.
        for value in [Value::Float(1e300), Value::Float(1e-300), Value::Integer(i64::MAX), Value::Integer(0)]
        {
            let _ = problems(&with(&way, value));
        }
    }
}

#[test]
fn words_that_are_not_known_are_named() {
    for way in all_leaves() {
        let key = path(&way);
        let is_word = at(&mut Value::Table(complete()), &way).is_some_and(|value| value.is_str());
        if is_word && !key.ends_with("name") {
            assert_named(
                &problems(&with(&way, Value::String("no such thing".into()))),
                &key,
                "= \"no such thing\"",
            );
        }
    }
}

#[test]
fn unknown_keys_are_named_with_the_near_miss() {
    for way in all_leaves() {
        let key = path(&way);
        if !matches!(way.last(), Some(Step::Key(_))) {
            continue;
        }
        let misspelt = around(&way, |table, key| drop(table.insert(format!("{key}_"), Value::Integer(1))));
        let found = problems(&misspelt);
        assert_named(&found, &format!("{key}_"), "added");
        let last = key.rsplit('.').next().unwrap_or_default();
        assert!(
            found.iter().any(|problem| problem.message.contains(&format!("did you mean \"{last}"))),
            "{found:#?}"
        );
        let strange =
            around(&way, |table, _| drop(table.insert("colour".into(), Value::String("red".into()))));
        assert!(
            problems(&strange)
                .iter()
                .any(|problem| problem.message.contains("colour = \"red\": unknown key: remove it"))
        );
    }
}

#[test]
fn all_problems_are_listed_at_once() {
    let source = "seed = -1\nautopilot = \"px5\"\n[depot]\nposition = [nan, 0.0]\n[fleet]\nvehicles = 0\nvehicels = 3\n\
                  [loiter]\nradius = \"wide\"\n[targets]\npositions = [[1.0], [2.0, inf]]\n";
    let found = parse("m.toml", source, Path::new("")).err().unwrap_or_default();
    let keys: Vec<&str> = found.iter().map(|problem| problem.key.as_str()).collect();
    for key in [
        "seed",
        "autopilot",
        "depot.position[0]",
        "fleet.vehicles",
        "fleet.vehicels",
        "loiter.radius",
        "targets.positions[0]",
    ] {
        assert!(keys.contains(&key), "{key}: {found:#?}");
    }
    assert!(found.iter().all(|problem| problem.line.is_some_and(|line| line <= 11)), "{found:#?}");
}

/// The program itself: exit code 2, the key on the standard error, and nothing written.
#[test]
fn the_program_says_so_and_writes_nothing() -> Result<(), Box<dyn std::error::Error>> {
    let home = tempfile::tempdir()?;
    std::fs::copy(data().join("targets.csv"), home.path().join("targets.csv"))?;
    let file = home.path().join("m.toml");
    for (index, way) in all_leaves().iter().enumerate() {
        let values = [Value::Boolean(true), Value::Float(f64::NAN), Value::Table(Table::new())];
        let document = with(way, values[index % values.len()].clone());
        std::fs::write(&file, toml::to_string(&document)?)?;
        let out = home.path().join("out");
        let run = Command::new(env!("CARGO_BIN_EXE_ground-station"))
            .args(["plan".as_ref(), file.as_os_str(), "--out".as_ref(), out.as_os_str()])
            .output()?;
        let (text, key) = (String::from_utf8_lossy(&run.stderr).into_owned(), path(way));
        let last =
            key.rsplit('.').next().unwrap_or_default().split('[').next().unwrap_or_default().to_owned();
        assert_eq!(run.status.code(), Some(2), "{key}: {text}");
        assert!(
            text.starts_with("error: ") && text.contains("m.toml:") && text.contains(&last),
            "{key}: {text}"
        );
        assert!(run.stdout.is_empty() && !out.exists(), "{key}");
    }
    let names: Vec<_> = std::fs::read_dir(home.path())?.flatten().map(|entry| entry.file_name()).collect();
    assert_eq!(names.len(), 2, "{names:?}");
    Ok(())
}

/// Missions that read well and cannot be flown: each is said with key, value and remedy.
#[test]
fn missions_that_cannot_be_flown_are_said() {
    let field = ground_station::input::FIELD;
    for (from, to, key, wanted) in [
        ("vehicles = 3", "vehicles = 0", "fleet.vehicles", "give a whole number from 1"),
        ("thrust_budget = 0.6", "thrust_budget = 0.4", "loiter", "short of the weight"),
        ("position = [0.0, 0.0]", "position = [12.0, 7.0]", "depot.position", "move the depot away"),
        ("[12.0, 8.0],", "[12.0, 8.0],\n    [14.0, 8.0],", "targets", "too close"),
        ("thrust_budget = 0.9", "thrust_budget = 0.51", "transition.thrust_budget", "raise it to at least"),
        ("safe_distance = 1.5", "safe_distance = 3.5", "loiter.radius", "is inside the safe distance"),
        ("height = 1.5", "height = 45.0", "transition.heights", "outside transition.heights"),
    ] {
        assert!(field.contains(from), "{from}");
        let found = parse("m.toml", &field.replace(from, to), Path::new("")).err().unwrap_or_default();
        let named =
            found.iter().any(|problem| problem.key.starts_with(key) && problem.message.contains(wanted));
        assert!(named, "{to}: {found:#?}");
    }
    let empty = "[depot]\nposition = [0, 0]\n[fleet]\nvehicles = 1\n";
    let found = parse("m.toml", empty, Path::new("")).err().unwrap_or_default();
    assert!(found.len() == 1 && found[0].message.starts_with("targets: there are none"), "{found:#?}");
}
