//! Arguments of `plan`, `report` and `export`.

use super::values::{
    TranscriptionWord, parse_autopilot, parse_format, parse_not_negative, parse_rate, parse_way, parse_wind,
};
use crate::command::{ExportRequest, PlanRequest, ReportRequest, SimulateRequest};
use crate::execution::Way;
use crate::export::fleet::Format;
use crate::input::Autopilot;
use std::path::PathBuf;

pub(super) const PLAN_EXAMPLES: &str = "\
Examples:
  ground-station plan
  ground-station plan pasture.toml --out plans/pasture --rate 50
  ground-station plan field.toml --transcription hermite-simpson --verify

Files: plan.json (everything), map.svg, and for each vehicle vehicle-<i>.csv (trajectory), vehicle-<i>.plan
(QGroundControl mission; needs an origin), profile-<i>.svg (speed, tilt, thrust). The folder is replaced as a whole.";

pub(super) const REPORT_EXAMPLES: &str = "\
Examples:
  ground-station report                                  the built-in field mission as report.html
  ground-station report pasture.toml --out pasture.html  another mission, another file
A link to a moment: report.html#t=12.5";

pub(super) const SIMULATE_EXAMPLES: &str = "\
Examples:
  ground-station simulate field.toml                      still air
  ground-station simulate field.toml --wind 3,-2 --gusts 5 --noise --seed 7
  ground-station simulate field.toml --arrivals events.txt    re-planned at every event of a file
  ground-station simulate field.toml --arrival-rate 4         four events a minute, by chance

Files: flown.svg (planned and flown), flown-<i>.csv, events.log.";

pub(super) const EXPORT_EXAMPLES: &str = "\
Examples:
  ground-station export field.toml --format waypoints,kml --out files
  ground-station export field.toml --format plan --autopilot px4 --force
  ground-station export field.toml --format plan --way polygon      ArduCopter without cut radii

Formats: plan (QGroundControl), waypoints (QGC WPL 110), kml (tracks in time and a tour), geojson, csv.";

/// Arguments of `plan`.
#[derive(Debug, clap::Args)]
pub struct PlanArguments {
    /// The mission file (TOML); without one, the built-in field mission is planned.
    pub file: Option<PathBuf>,
    /// The folder to write; it is replaced if it is empty or holds a plan, and refused otherwise.
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    /// Replace the folder whatever it holds.
    #[arg(long)]
    pub force: bool,
    /// Samples per second of the trajectory tables.
    #[arg(long, value_name = "HZ", default_value_t = 20.0, value_parser = parse_rate)]
    pub rate: f64,
    /// Check the plan with an independent integrator; a plan that fails is not written.
    #[arg(long)]
    pub verify: bool,
    /// How the optimal control problem is made finite, instead of what the mission says.
    #[arg(long, value_enum)]
    pub transcription: Option<TranscriptionWord>,
    /// Print plan.json instead of the table.
    #[arg(long)]
    pub json: bool,
    /// Neither progress bar nor table.
    #[arg(long, short)]
    pub quiet: bool,
}

/// Arguments of `report`.
#[derive(Debug, clap::Args)]
pub struct ReportArguments {
    /// The mission file (TOML); without one, the built-in field mission.
    pub file: Option<PathBuf>,
    /// The file to write.
    #[arg(long, value_name = "FILE", default_value = "report.html")]
    pub out: PathBuf,
    /// Replace the file if it is there.
    #[arg(long)]
    pub force: bool,
    /// Samples per second of the flight.
    #[arg(long, value_name = "HZ", default_value_t = 10.0, value_parser = parse_rate)]
    pub rate: f64,
    /// Neither progress bar nor table.
    #[arg(long, short)]
    pub quiet: bool,
}

/// Arguments of `export`.
#[derive(Debug, clap::Args)]
pub struct ExportArguments {
    /// The mission file (TOML); without one, the built-in field mission.
    pub file: Option<PathBuf>,
    /// The formats: plan, waypoints, kml, geojson, csv.
    #[arg(long, value_name = "FORMATS", value_delimiter = ',', required = true, value_parser = parse_format)]
    pub format: Vec<Format>,
    /// The folder into which the files go.
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub out: PathBuf,
    /// How circles are flown: loiter-items or polygon in missions; stream or live-orbit to see what they would do.
    #[arg(long, value_parser = parse_way)]
    pub way: Option<Way>,
    /// Instead of the mission's firmware: ardupilot or px4.
    #[arg(long, value_parser = parse_autopilot)]
    pub autopilot: Option<Autopilot>,
    /// Samples per second of flights.
    #[arg(long, value_name = "HZ", default_value_t = 5.0, value_parser = parse_rate)]
    pub rate: f64,
    /// Replace files that are there.
    #[arg(long)]
    pub force: bool,
    /// Neither progress bar nor list.
    #[arg(long, short)]
    pub quiet: bool,
}

/// Arguments of `simulate`.
#[derive(Debug, clap::Args)]
pub struct SimulateArguments {
    /// The mission file (TOML); without one, the built-in field mission.
    pub file: Option<PathBuf>,
    /// The folder into which the files go.
    #[arg(long, value_name = "DIR", default_value = "simulated")]
    pub out: PathBuf,
    /// Steady wind on top of the one that the mission is planned for, towards east and north (m/s): EAST,NORTH.
    #[arg(long, value_name = "E,N", default_value = "0,0", value_parser = parse_wind, allow_hyphen_values = true)]
    pub wind: [f64; 2],
    /// Gusts as in a wind of this speed at 20 ft (m/s).
    #[arg(long, value_name = "M/S", default_value_t = 0.0, value_parser = parse_not_negative)]
    pub gusts: f64,
    /// Errors of the estimates that the controllers see, as of satellite positioning with corrections.
    #[arg(long)]
    pub noise: bool,
    /// Events while the team flies, one a line: TIME appears EAST NORTH, TIME moves TARGET EAST NORTH, TIME vanishes TARGET,
    /// TIME fails VEHICLE, TIME returns VEHICLE (s, m, numbered from 1).
    #[arg(long, value_name = "FILE")]
    pub arrivals: Option<PathBuf>,
    /// Events per minute by chance: targets that appear (half of them), vanish and move.
    #[arg(long, value_name = "PER-MINUTE", default_value_t = 0.0, value_parser = parse_not_negative, conflicts_with = "arrivals")]
    pub arrival_rate: f64,
    /// Seed of gusts, errors and events by chance.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Replace files that are there.
    #[arg(long)]
    pub force: bool,
    /// Neither progress bar nor table.
    #[arg(long, short)]
    pub quiet: bool,
}

impl SimulateArguments {
    pub(super) fn request(self) -> SimulateRequest {
        let Self { file, out, wind, gusts, noise, arrivals, arrival_rate, seed, force, quiet } = self;
        SimulateRequest { file, out, wind, gusts, noise, arrivals, arrival_rate, seed, force, quiet }
    }
}

impl PlanArguments {
    pub(super) fn request(self) -> PlanRequest {
        PlanRequest {
            file: self.file,
            out: self.out,
            force: self.force,
            rate: self.rate,
            verify: self.verify,
            transcription: self.transcription.map(|word| word.0),
            json: self.json,
            quiet: self.quiet,
        }
    }
}

impl ReportArguments {
    pub(super) fn request(self) -> ReportRequest {
        let Self { file, out, force, rate, quiet } = self;
        ReportRequest { file, out, force, rate, quiet }
    }
}

impl ExportArguments {
    pub(super) fn request(self) -> ExportRequest {
        let Self { file, format: formats, out, way, autopilot, rate, force, quiet } = self;
        ExportRequest { file, formats, out, way, autopilot, rate, force, quiet }
    }
}
