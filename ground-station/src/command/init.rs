//! `init` and `import`: mission files to begin with.

use crate::export::folder;
use crate::failure::Failure;
use crate::geodesy::Origin;
use crate::input::{self, Autopilot, Template, template};
use std::path::PathBuf;

/// What is asked of `init` and `import`.
#[derive(Debug, Clone, PartialEq)]
pub struct InitRequest {
    /// A file with targets; two examples if there is none.
    pub targets: Option<PathBuf>,
    /// The mission file that is written.
    pub out: PathBuf,
    /// Where the depot is; the middle of the targets if not given.
    pub origin: Option<Origin>,
    /// The firmware.
    pub autopilot: Autopilot,
    /// How many vehicles there are.
    pub vehicles: usize,
    /// Replaces a file that is there.
    pub force: bool,
}

/// Where the built-in field lies.
const FIELD: Origin = Origin { latitude: 42.0308, longitude: -93.6319, altitude: 0.0 };

/// Writes a commented mission file; returns the text to be printed.
///
/// # Errors
///
/// [`Failure::Input`] with all that is wrong with the targets; [`Failure::Exists`]; [`Failure::Write`].
pub fn init(request: &InitRequest) -> Result<String, Failure> {
    let targets = request.targets.as_deref().map(input::read_targets).transpose()?.unwrap_or_default();
    let count = targets.len();
    let middle = |axis: usize| {
        let places = targets.iter().map(|listed| listed.target.position[axis]);
        (places.sum::<f64>() / count as f64 * 1e7).round() / 1e7
    };
    let origin = match (request.origin, count) {
        (Some(origin), _) => origin,
        (None, 0) => FIELD,
        // Places across the date line have no middle that way; they are then far from it, which the check says.
        (None, _) => Origin { latitude: middle(1), longitude: middle(0), altitude: 0.0 },
    };
    let name = request.out.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let content =
        Template { name, origin, autopilot: request.autopilot, vehicles: request.vehicles, targets };
    let text = template(&content);
    let file = request.out.display().to_string();
    // What would be refused tomorrow is refused today.
    input::parse(&file, &text, std::path::Path::new("")).map_err(Failure::Input)?;
    folder::write_file(&request.out, &text, request.force)?;
    let targets = if count == 0 { "two example targets".to_owned() } else { format!("{count} target(s)") };
    Ok(format!("wrote {file} with {targets}: edit it, then `ground-station check {file}`\n"))
}
