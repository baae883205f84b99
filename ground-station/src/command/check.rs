//! `check`: says all that is wrong with a mission file.

use crate::failure::Failure;
use crate::input;
use std::path::Path;

/// One line that says what the mission holds.
///
/// # Errors
///
/// [`Failure::Input`] with all that is wrong with it.
pub fn check(path: &Path) -> Result<String, Failure> {
    let file = input::read(path)?;
    let mission = &file.mission;
    Ok(format!(
        "{}: no problems: {} target(s), {} vehicle(s){}",
        file.file,
        mission.targets.len(),
        mission.fleet.vehicles,
        if file.origin.is_some() { "" } else { ", no origin (autopilot missions will be left out)" }
    ))
}
