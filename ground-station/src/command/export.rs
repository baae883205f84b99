//! `export`: a plan in the formats of maps and other ground stations.

use super::plan::{mission, search};
use crate::execution::Way;
use crate::export::fleet::{Export, Format, fleet_files};
use crate::export::folder;
use crate::failure::Failure;
use crate::input::Autopilot;
use std::path::PathBuf;

/// What is asked of the command.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportRequest {
    /// The mission file; the built-in field mission if there is none.
    pub file: Option<PathBuf>,
    /// The formats.
    pub formats: Vec<Format>,
    /// The folder into which the files go.
    pub out: PathBuf,
    /// How circles are flown; `None` for what the autopilot's missions can do.
    pub way: Option<Way>,
    /// Instead of the mission's firmware.
    pub autopilot: Option<Autopilot>,
    /// Samples per second of flights (Hz).
    pub rate: f64,
    /// Replaces files that are there.
    pub force: bool,
    /// No progress bar.
    pub quiet: bool,
}

/// Plans and writes the files; returns the text to be printed.
///
/// # Errors
///
/// [`Failure`]; nothing is written then.
pub fn export(request: &ExportRequest) -> Result<String, Failure> {
    let mut file = mission(request.file.as_deref())?;
    file.autopilot = request.autopilot.unwrap_or(file.autopilot);
    let plan = search(&file, request.quiet)?;
    let export = Export { way: request.way, rate: request.rate };
    let (files, warnings) = fleet_files(&file, &plan, &request.formats, export)?;
    folder::write_files(&request.out, &files, request.force)?;
    let mut text = String::new();
    for warning in &warnings {
        text.push_str(&format!("warning: {warning}\n"));
    }
    for file in &files {
        text.push_str(&format!("wrote {}\n", request.out.join(&file.name).display()));
    }
    Ok(text)
}
