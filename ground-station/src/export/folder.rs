//! The output folder, written whole or not at all.
//!
//! Everything is written into a temporary folder beside the output folder and then renamed into place, so that a full disk
//! or a killed process leaves the old folder, or none, but never half of a new one.

use crate::failure::Failure;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

/// The first field of every `plan.json` of ours, by which a folder is recognised.
pub const FORMAT: &str = "uav-planner mission plan";

/// A file to be written: its name in the folder and its content.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutputFile {
    /// Name in the folder.
    pub name: String,
    /// Content.
    pub content: String,
}

/// Refuses a folder that may not be replaced; to be asked before the work is done.
///
/// A folder may be replaced if it does not exist, is empty, or holds a plan of ours; any other folder needs `force`. A
/// file, or a folder in which the program itself runs, is refused in any case.
///
/// # Errors
///
/// [`Failure::ForeignFolder`] if it may not be replaced.
pub fn check(folder: &Path, force: bool) -> Result<(), Failure> {
    let foreign = || Failure::ForeignFolder { folder: folder.to_owned() };
    if fs::symlink_metadata(folder).is_err() {
        return Ok(());
    }
    let real = folder.canonicalize().map_err(|_| foreign())?;
    let runs_inside = std::env::current_dir().is_ok_and(|current| current.starts_with(&real));
    if !real.is_dir() || runs_inside {
        return Err(foreign());
    }
    let is_empty = fs::read_dir(&real).is_ok_and(|mut entries| entries.next().is_none());
    if force || is_empty || holds_a_plan(&real) { Ok(()) } else { Err(foreign()) }
}

/// Whether `plan.json` begins with our format marker.
fn holds_a_plan(folder: &Path) -> bool {
    let mut head = String::new();
    let read =
        fs::File::open(folder.join("plan.json")).and_then(|file| file.take(256).read_to_string(&mut head));
    read.is_ok() && head.contains(&format!("\"format\": \"{FORMAT}\""))
}

/// Writes the files, replacing the folder if it exists.
///
/// # Errors
///
/// [`Failure::ForeignFolder`] if the folder may not be replaced (it may have changed since it was asked), and
/// [`Failure::Write`] if the operating system refuses; the folder is then as it was before.
pub fn write(folder: &Path, files: &[OutputFile], force: bool) -> Result<(), Failure> {
    check(folder, force)?;
    let target = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let parent = parent_of(&target);
    let created = create_parents(&parent)?;
    let outcome = write_beside(&target, &parent, files);
    if outcome.is_err() {
        // Only folders that are empty go, so that nothing of anyone else's can be lost.
        created.iter().for_each(|folder| drop(fs::remove_dir(folder)));
    }
    outcome
}

/// Creates the folders that are missing; returns them, innermost first.
fn create_parents(parent: &Path) -> Result<Vec<PathBuf>, Failure> {
    let missing =
        parent.ancestors().take_while(|ancestor| !ancestor.as_os_str().is_empty() && !ancestor.exists());
    let missing: Vec<PathBuf> = missing.map(Path::to_owned).collect();
    fs::create_dir_all(parent).map_err(Failure::writing(parent))?;
    Ok(missing)
}

fn write_beside(target: &Path, parent: &Path, files: &[OutputFile]) -> Result<(), Failure> {
    let workshop =
        tempfile::Builder::new().prefix(".plan-").tempdir_in(parent).map_err(Failure::writing(parent))?;
    // A folder inside the temporary one has the usual permissions; the temporary one is for its owner only.
    let fresh = workshop.path().join("new");
    fs::create_dir(&fresh).map_err(Failure::writing(&fresh))?;
    for file in files {
        let path = fresh.join(&file.name);
        fs::write(&path, &file.content).map_err(Failure::writing(&target.join(&file.name)))?;
    }
    if !target.exists() {
        return fs::rename(&fresh, target).map_err(Failure::writing(target));
    }
    let old = workshop.path().join("old");
    fs::rename(target, &old).map_err(Failure::writing(target))?;
    fs::rename(&fresh, target).map_err(|error| {
        // Should putting the old folder back fail too, it must not be deleted with the workshop.
        if fs::rename(&old, target).is_err() {
            let _ = workshop.keep();
        }
        Failure::writing(target)(error)
    })
}

/// Writes one file, whole or not at all; its folder is created if need be.
///
/// # Errors
///
/// [`Failure::Exists`] if it is there already and `force` is not given; [`Failure::Write`] if the operating system refuses.
pub fn write_file(path: &Path, content: &str, force: bool) -> Result<(), Failure> {
    check_file(path, force)?;
    let parent = parent_of(path);
    let created = create_parents(&parent)?;
    let outcome = write_file_beside(path, &parent, content);
    if outcome.is_err() {
        created.iter().for_each(|folder| drop(fs::remove_dir(folder)));
    }
    outcome
}

/// Refuses a file that may not be replaced; to be asked before the work is done.
///
/// # Errors
///
/// [`Failure::Exists`] if it is there already and `force` is not given, or if it is no file.
pub fn check_file(path: &Path, force: bool) -> Result<(), Failure> {
    match fs::symlink_metadata(path) {
        Ok(found) if !force || found.is_dir() => Err(Failure::Exists { path: path.to_owned() }),
        _ => Ok(()),
    }
}

/// Writes files into a folder, all or none; what else is there stays.
///
/// # Errors
///
/// [`Failure::Exists`] if one is there already and `force` is not given; [`Failure::Write`] if the operating system refuses.
pub fn write_files(folder: &Path, files: &[OutputFile], force: bool) -> Result<(), Failure> {
    files.iter().try_for_each(|file| check_file(&folder.join(&file.name), force))?;
    let created = create_parents(folder)?;
    let outcome = write_into(folder, files);
    if outcome.is_err() {
        created.iter().for_each(|folder| drop(fs::remove_dir(folder)));
    }
    outcome
}

/// All are written beside their places before the first is moved there.
fn write_into(folder: &Path, files: &[OutputFile]) -> Result<(), Failure> {
    let workshop =
        tempfile::Builder::new().prefix(".files-").tempdir_in(folder).map_err(Failure::writing(folder))?;
    for file in files {
        let path = folder.join(&file.name);
        fs::write(workshop.path().join(&file.name), &file.content).map_err(Failure::writing(&path))?;
    }
    for file in files {
        let path = folder.join(&file.name);
        fs::rename(workshop.path().join(&file.name), &path).map_err(Failure::writing(&path))?;
    }
    Ok(())
}

fn write_file_beside(path: &Path, parent: &Path, content: &str) -> Result<(), Failure> {
    // Made readable like any other file: a temporary file is for its owner only.
    let fresh = tempfile::Builder::new()
        .prefix(".file-")
        .make_in(parent, |path| fs::OpenOptions::new().write(true).create_new(true).open(path))
        .map_err(Failure::writing(path))?;
    fs::write(fresh.path(), content).map_err(Failure::writing(path))?;
    fresh.persist(path).map(drop).map_err(|error| Failure::writing(path)(error.error))
}

fn parent_of(folder: &Path) -> PathBuf {
    match folder.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        _ => PathBuf::from("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(mark: &str) -> Vec<OutputFile> {
        let content = format!("{{\n  \"format\": \"{FORMAT}\",\n  \"mark\": \"{mark}\"\n}}");
        vec![
            OutputFile { name: "plan.json".into(), content },
            OutputFile { name: "a.csv".into(), content: mark.into() },
        ]
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        let mut names: Vec<String> =
            entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn new_empty_and_own_folders_are_written_and_nothing_else_stays() -> Result<(), Box<dyn std::error::Error>>
    {
        let home = tempfile::tempdir()?;
        let out = home.path().join("deep/er/out");
        write(&out, &plan("one"), false)?;
        assert_eq!(names(&out), ["a.csv", "plan.json"]);
        fs::write(out.join("old.csv"), "x")?;
        write(&out, &plan("two"), false)?;
        assert_eq!(names(&out), ["a.csv", "plan.json"]);
        assert_eq!(fs::read_to_string(out.join("a.csv"))?, "two");
        assert_eq!(names(&home.path().join("deep/er")), ["out"]);
        let empty = home.path().join("empty");
        fs::create_dir(&empty)?;
        write(&empty, &plan("three"), false)?;
        Ok(())
    }

    #[test]
    fn foreign_folders_are_refused_and_left_alone() -> Result<(), Box<dyn std::error::Error>> {
        let home = tempfile::tempdir()?;
        let out = home.path().join("out");
        fs::create_dir(&out)?;
        fs::write(out.join("plan.json"), "{\"format\": \"something else\"}")?;
        assert!(matches!(write(&out, &plan("one"), false), Err(Failure::ForeignFolder { .. })));
        assert_eq!(names(&out), ["plan.json"]);
        write(&out, &plan("one"), true)?;
        assert_eq!(names(&out), ["a.csv", "plan.json"]);
        let file = home.path().join("file");
        fs::write(&file, "mine")?;
        assert!(check(&file, true).is_err());
        assert!(check(Path::new("."), true).is_err() && check(Path::new("/"), true).is_err());
        Ok(())
    }

    #[test]
    fn a_file_is_replaced_only_when_asked() -> Result<(), Box<dyn std::error::Error>> {
        let home = tempfile::tempdir()?;
        let path = home.path().join("deep/a.html");
        write_file(&path, "one", false)?;
        assert!(matches!(write_file(&path, "two", false), Err(Failure::Exists { .. })));
        assert_eq!(fs::read_to_string(&path)?, "one");
        write_file(&path, "two", true)?;
        assert_eq!((fs::read_to_string(&path)?.as_str(), names(&home.path().join("deep")).len()), ("two", 1));
        assert!(matches!(write_file(home.path(), "x", true), Err(Failure::Exists { .. })));
        Ok(())
    }

    #[test]
    fn a_failed_write_leaves_nothing_behind() -> Result<(), Box<dyn std::error::Error>> {
        let home = tempfile::tempdir()?;
        let out = home.path().join("deep/out");
        let mut files = plan("one");
        files.push(OutputFile { name: "no/such/folder.txt".into(), content: String::new() });
        assert!(matches!(write(&out, &files, false), Err(Failure::Write { .. })));
        assert!(names(home.path()).is_empty());
        Ok(())
    }
}
