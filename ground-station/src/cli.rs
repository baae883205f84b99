//! The command line.

use crate::command::{self, PlanRequest, ReportRequest};
use crate::failure::Failure;
use crate::words::TRANSCRIPTIONS;
use clap::{Parser, Subcommand, ValueEnum};
use planner::Transcription;
use std::path::PathBuf;

/// Plans missions for teams of quadcopters that fly a full circle around each of many targets.
#[derive(Debug, Parser)]
#[command(version, after_help = EXAMPLES)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

const EXAMPLES: &str = "\
Examples:
  ground-station plan                              plan the built-in field mission into out/
  ground-station plan my-field.toml --out plans/a  plan a mission file into plans/a
  ground-station plan my-field.toml --verify       check the plan with an independent integrator first
  ground-station report my-field.toml              the same as one HTML page that flies the vehicles
  ground-station check my-field.toml               say all that is wrong with a mission file

Exit codes: 0 done, 1 could not, 2 bad input. Nothing is written unless the code is 0.";

const PLAN_EXAMPLES: &str = "\
Examples:
  ground-station plan
  ground-station plan pasture.toml --out plans/pasture --rate 50
  ground-station plan field.toml --transcription hermite-simpson --verify

Files: plan.json (everything), map.svg, and for each vehicle vehicle-<i>.csv (trajectory), vehicle-<i>.plan
(QGroundControl mission; needs an origin), profile-<i>.svg (speed, tilt, thrust). The folder is replaced as a whole.";

const REPORT_EXAMPLES: &str = "\
Examples:
  ground-station report                                  the built-in field mission as report.html
  ground-station report pasture.toml --out pasture.html  another mission, another file
A link to a moment: report.html#t=12.5";

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Plans a mission and writes the plan, trajectories, autopilot missions and pictures into a folder.
    #[command(after_help = PLAN_EXAMPLES)]
    Plan(PlanArguments),
    /// Plans a mission and writes one HTML page: map, flight through time, charts, tables; opens in any browser, offline.
    #[command(after_help = REPORT_EXAMPLES)]
    Report(ReportArguments),
    /// Says all that is wrong with a mission file.
    Check {
        /// The mission file (TOML).
        file: PathBuf,
    },
}

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

/// A transcription on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TranscriptionWord(Transcription);

const WORDS: [TranscriptionWord; 3] = [
    TranscriptionWord(TRANSCRIPTIONS[0].1),
    TranscriptionWord(TRANSCRIPTIONS[1].1),
    TranscriptionWord(TRANSCRIPTIONS[2].1),
];

impl ValueEnum for TranscriptionWord {
    fn value_variants<'a>() -> &'a [Self] {
        &WORDS
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        Some(clap::builder::PossibleValue::new(crate::words::word(&TRANSCRIPTIONS, &self.0)))
    }
}

/// A rate that makes a table of sensible length.
fn parse_rate(text: &str) -> Result<f64, String> {
    const RATES: std::ops::RangeInclusive<f64> = 0.1..=1000.0;
    let rate = text.parse().ok().filter(|rate| RATES.contains(rate));
    rate.ok_or_else(|| "give a number of samples per second from 0.1 to 1000".to_owned())
}

/// Does what the command line asks; returns the text for the standard output.
///
/// # Errors
///
/// [`Failure`], whose exit code the program returns.
pub fn run(cli: Cli) -> Result<String, Failure> {
    match cli.command {
        Command::Check { file } => command::check(&file).map(|line| format!("{line}\n")),
        Command::Report(arguments) => {
            let ReportArguments { file, out, force, rate, quiet } = arguments;
            let text = command::report(&ReportRequest { file, out, force, rate, quiet })?;
            Ok(if quiet { String::new() } else { text })
        }
        Command::Plan(arguments) => {
            let quiet = arguments.quiet;
            let request = PlanRequest {
                file: arguments.file,
                out: arguments.out,
                force: arguments.force,
                rate: arguments.rate,
                verify: arguments.verify,
                transcription: arguments.transcription.map(|word| word.0),
                quiet,
            };
            command::plan(&request).map(|text| if quiet { String::new() } else { text })
        }
    }
}
