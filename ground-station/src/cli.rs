//! The command line.

use crate::command::{self, FlyRequest, PlanRequest, ReportRequest};
use crate::execution::Way;
use crate::failure::Failure;
use crate::link::address::Address;
use crate::link::settings::{Reach, SafeAction, Settings};
use crate::words::{self, TRANSCRIPTIONS};
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

const FLY_EXAMPLES: &str = "\
Examples:
  ground-station fly field-ardupilot.toml --connect udpin:0.0.0.0:14550 --dry-run     checks, nothing is changed
  ground-station fly field-ardupilot.toml --connect udpin:0.0.0.0:14550 --arm --log a.tlog
  ground-station fly field.toml --connect tcpout:127.0.0.1:5760 --way loiter-items    uploads and reads back

Without --arm nothing moves. While it flies, say hold, return or land on the standard input, for all vehicles or with
a vehicle's number. A pilot who changes the mode has the last word: the link then lets go of that vehicle.";

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Plans a mission and writes the plan, trajectories, autopilot missions and pictures into a folder.
    #[command(after_help = PLAN_EXAMPLES)]
    Plan(PlanArguments),
    /// Plans a mission and writes one HTML page: map, flight through time, charts, tables; opens in any browser, offline.
    #[command(after_help = REPORT_EXAMPLES)]
    Report(ReportArguments),
    /// Flies a mission on real or simulated vehicles over MAVLink.
    #[command(after_help = FLY_EXAMPLES)]
    Fly(FlyArguments),
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

/// Arguments of `fly`.
#[derive(Debug, clap::Args)]
pub struct FlyArguments {
    /// The mission file (TOML); without one, the built-in field mission.
    pub file: Option<PathBuf>,
    /// udpin:HOST:PORT, udpout:HOST:PORT or tcpout:HOST:PORT.
    #[arg(long, value_name = "ADDRESS")]
    pub connect: Address,
    /// How the plan is flown.
    #[arg(long, value_parser = parse_way, default_value = "stream")]
    pub way: Way,
    /// Only look: nothing is sent that changes a vehicle.
    #[arg(long, conflicts_with = "arm")]
    pub dry_run: bool,
    /// Arm, take off and fly.
    #[arg(long)]
    pub arm: bool,
    /// System ids of the vehicles in the order of the plan; 1,2,3,.. if not given.
    #[arg(long, value_delimiter = ',', value_name = "IDS")]
    pub systems: Vec<u8>,
    /// Setpoints per second.
    #[arg(long, value_name = "HZ", default_value_t = 20.0, value_parser = parse_setpoint_rate)]
    pub rate: f64,
    /// Least battery before the start (percent).
    #[arg(long, value_name = "PERCENT", default_value_t = 50)]
    pub least_battery: u8,
    /// Battery at which a vehicle returns (percent).
    #[arg(long, value_name = "PERCENT", default_value_t = 20)]
    pub return_battery: u8,
    /// Distance from the plan at which a vehicle is stopped (m).
    #[arg(long, value_name = "M", default_value_t = 2.0, value_parser = parse_positive)]
    pub deviation: f64,
    /// Silence after which a link counts as lost (s).
    #[arg(long, value_name = "S", default_value_t = 3.0, value_parser = parse_positive)]
    pub link_timeout: f64,
    /// What a vehicle is told whose link is lost: hold, return or land.
    #[arg(long, value_parser = parse_action, default_value = "return")]
    pub on_link_loss: SafeAction,
    /// What a vehicle is told that is too far from its plan: hold, return or land.
    #[arg(long, value_parser = parse_action, default_value = "hold")]
    pub on_deviation: SafeAction,
    /// Log every packet of the session into a new file (.tlog).
    #[arg(long, value_name = "FILE")]
    pub log: Option<PathBuf>,
    /// Read hold, return and land from a file (or pipe) instead of the standard input.
    #[arg(long, value_name = "FILE")]
    pub commands: Option<PathBuf>,
    /// No progress bar.
    #[arg(long, short)]
    pub quiet: bool,
}

impl FlyArguments {
    fn request(self) -> FlyRequest {
        let reach = match (self.dry_run, self.arm) {
            (true, _) => Reach::Check,
            (_, true) => Reach::Fly,
            _ => Reach::Upload,
        };
        let settings = Settings {
            reach,
            rate: self.rate,
            least_battery: self.least_battery,
            return_battery: self.return_battery,
            deviation: self.deviation,
            link_timeout: self.link_timeout,
            on_link_loss: self.on_link_loss,
            on_deviation: self.on_deviation,
            ..Settings::default()
        };
        FlyRequest {
            file: self.file,
            address: self.connect,
            way: self.way,
            systems: self.systems,
            settings,
            log: self.log,
            commands: self.commands,
            quiet: self.quiet,
        }
    }
}

/// One of the words of a table.
fn parse_word<T: Copy>(words: &[(&'static str, T)], text: &str) -> Result<T, String> {
    let found = words.iter().find(|(word, _)| *word == text).map(|&(_, value)| value);
    let list = || words.iter().map(|(word, _)| *word).collect::<Vec<_>>().join(", ");
    found.ok_or_else(|| format!("give one of {}", list()))
}

fn parse_way(text: &str) -> Result<Way, String> {
    parse_word(&words::WAYS, text)
}

fn parse_action(text: &str) -> Result<SafeAction, String> {
    parse_word(&words::SAFE_ACTIONS, text)
}

fn parse_positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "give a number above 0".to_owned())
}

/// PX4 lets go below 2 Hz; above 100 Hz radios are full.
fn parse_setpoint_rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate| (4.0..=100.0).contains(rate));
    rate.ok_or_else(|| "give a number of setpoints per second from 4 to 100".to_owned())
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
        Command::Fly(arguments) => command::fly(&arguments.request(), &mut |line| println!("{line}")),
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
