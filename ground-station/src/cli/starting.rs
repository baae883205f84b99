//! Arguments of `init` and `import`.

use super::values::{parse_autopilot, parse_origin};
use crate::command::InitRequest;
use crate::geodesy::Origin;
use crate::input::Autopilot;
use std::path::PathBuf;

pub(super) const IMPORT_EXAMPLES: &str = "\
Examples:
  ground-station import trees.kml                           mission.toml with a target for every placemark
  ground-station import old.plan --out new.toml --vehicles 4 --origin 42.0308,-93.6319,290

Reads .geojson, .json, .csv, .kml, .gpx, .plan (QGroundControl) and .waypoints. A mission file can also name such a
file itself: targets.file = \"trees.kml\".";

/// What `init` and `import` have in common.
#[derive(Debug, clap::Args)]
pub struct StartArguments {
    /// Where the depot is: LATITUDE,LONGITUDE or LATITUDE,LONGITUDE,ALTITUDE.
    #[arg(long, value_name = "PLACE", value_parser = parse_origin, allow_hyphen_values = true)]
    pub origin: Option<Origin>,
    /// The firmware: ardupilot or px4.
    #[arg(long, value_parser = parse_autopilot, default_value = "ardupilot")]
    pub autopilot: Autopilot,
    /// How many vehicles there are.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub vehicles: u16,
    /// Replace the file if it is there.
    #[arg(long)]
    pub force: bool,
}

impl StartArguments {
    pub(super) fn request(self, targets: Option<PathBuf>, out: PathBuf) -> InitRequest {
        let Self { origin, autopilot, vehicles, force } = self;
        InitRequest { targets, out, origin, autopilot, vehicles: usize::from(vehicles), force }
    }
}
