//! `report`: from a mission file to one HTML page.

use super::plan::{mission, rows, search};
use crate::export::folder;
use crate::failure::Failure;
use crate::page::{PageData, page};
use crate::report::{certificate_lines, vehicle_table};
use std::path::PathBuf;

/// What is asked of the command.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportRequest {
    /// The mission file; the built-in field mission if there is none.
    pub file: Option<PathBuf>,
    /// The file that is written.
    pub out: PathBuf,
    /// Replaces a file that is there.
    pub force: bool,
    /// Samples per second (Hz).
    pub rate: f64,
    /// No progress bar.
    pub quiet: bool,
}

/// Plans and writes the page; returns the text to be printed.
///
/// # Errors
///
/// [`Failure`]; nothing is written then.
pub fn report(request: &ReportRequest) -> Result<String, Failure> {
    let file = mission(request.file.as_deref())?;
    folder::check_file(&request.out, request.force)?;
    let plan = search(&file, request.quiet)?;
    let data = PageData::new(&file, &plan, request.rate)?;
    let text = page(&data).map_err(|source| Failure::Format { source })?;
    folder::write_file(&request.out, &text, request.force)?;
    let mut lines = vehicle_table(&rows(&file, &plan)?).render();
    for line in certificate_lines(&plan) {
        lines.push_str(&format!("{line}\n"));
    }
    lines.push_str(&format!("\nwrote {}\n", request.out.display()));
    Ok(lines)
}
