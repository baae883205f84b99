//! The command line.

mod flying;
mod planning;
mod solving;
mod starting;
mod studying;
mod values;

pub use flying::FlyArguments;
pub use planning::{ExportArguments, PlanArguments, ReportArguments, SimulateArguments};
pub use solving::{RouteArguments, SolveArguments};
pub use starting::StartArguments;
pub use studying::{PlaceArguments, StudyArguments, StudyCommand};
pub use values::TranscriptionWord;

use crate::command;
use crate::failure::Failure;
use clap::{CommandFactory, Parser, Subcommand};
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
  ground-station init my-field.toml                a commented mission file to begin with
  ground-station import trees.kml                  the same, from a list of targets
  ground-station check my-field.toml               say all that is wrong with a mission file
  ground-station plan my-field.toml --verify       plan it into out/, checked with an independent integrator
  ground-station report my-field.toml              the plan as one HTML page that flies the vehicles
  ground-station export my-field.toml --format kml,waypoints
  ground-station fly my-field.toml --connect udpin:0.0.0.0:14550 --arm

Exit codes: 0 done, 1 could not, 2 bad input. Nothing is written unless the code is 0.";

const ROUTES_EXAMPLES: &str = "\
Examples:
  ground-station routes eil51.tsp --vehicles 3
  ground-station routes points.csv --objective total --open --json";

const TOUR_EXAMPLES: &str = "\
Examples:
  ground-station tour berlin52.tsp --rounded
  ground-station tour points.csv --kicks 20000 --json";

const COMPLETIONS_EXAMPLES: &str = "\
Examples:
  ground-station completions bash > ~/.local/share/bash-completion/completions/ground-station
  ground-station completions zsh > ~/.zfunc/_ground-station";

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Plans a mission and writes the plan, trajectories, autopilot missions and pictures into a folder.
    #[command(after_help = planning::PLAN_EXAMPLES)]
    Plan(PlanArguments),
    /// Plans a mission and writes one HTML page: map, flight through time, charts, tables; opens in any browser, offline.
    #[command(after_help = planning::REPORT_EXAMPLES)]
    Report(ReportArguments),
    /// Plans a mission and writes it in the formats of maps and other ground stations.
    #[command(after_help = planning::EXPORT_EXAMPLES)]
    Export(ExportArguments),
    /// Plans a mission and lets a simulated team fly it in wind: flown against planned.
    #[command(after_help = planning::SIMULATE_EXAMPLES)]
    Simulate(SimulateArguments),
    /// Flies a mission on real or simulated vehicles over MAVLink.
    #[command(after_help = flying::FLY_EXAMPLES)]
    Fly(FlyArguments),
    /// Says all that is wrong with a mission file.
    Check {
        /// The mission file (TOML).
        file: PathBuf,
    },
    /// Writes a commented mission file to begin with.
    Init {
        /// The file to write.
        #[arg(default_value = "mission.toml")]
        out: PathBuf,
        #[command(flatten)]
        #[allow(missing_docs)]
        start: StartArguments,
    },
    /// Writes a mission file with the targets of another program's file.
    #[command(after_help = starting::IMPORT_EXAMPLES)]
    Import {
        /// The file with targets.
        targets: PathBuf,
        /// The file to write.
        #[arg(long, value_name = "FILE", default_value = "mission.toml")]
        out: PathBuf,
        #[command(flatten)]
        #[allow(missing_docs)]
        start: StartArguments,
    },
    /// Routes of several vehicles through the nodes of a file, with a lower bound.
    #[command(after_help = ROUTES_EXAMPLES)]
    Routes {
        #[command(flatten)]
        #[allow(missing_docs)]
        solve: SolveArguments,
        #[command(flatten)]
        #[allow(missing_docs)]
        routes: RouteArguments,
    },
    /// A short tour through the nodes of a file, with a lower bound.
    #[command(after_help = TOUR_EXAMPLES)]
    Tour {
        #[command(flatten)]
        #[allow(missing_docs)]
        solve: SolveArguments,
        /// Kicks of the search.
        #[arg(long, default_value_t = 1000)]
        kicks: u64,
    },
    /// The figures and simulations of the paper behind the method, as tables and pictures.
    #[command(after_help = studying::STUDY_EXAMPLES)]
    Study {
        /// Which.
        #[command(subcommand)]
        study: StudyCommand,
    },
    /// Prints what a shell needs to complete this program's arguments.
    #[command(after_help = COMPLETIONS_EXAMPLES)]
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
}

/// Does what the command line asks; returns the text for the standard output.
///
/// # Errors
///
/// [`Failure`], whose exit code the program returns.
pub fn run(cli: Cli) -> Result<String, Failure> {
    match cli.command {
        Command::Check { file } => command::check(&file).map(|line| format!("{line}\n")),
        Command::Plan(arguments) => {
            let is_silent = arguments.quiet && !arguments.json;
            unless(is_silent, command::plan(&arguments.request()))
        }
        Command::Report(arguments) => unless(arguments.quiet, command::report(&arguments.request())),
        Command::Export(arguments) => unless(arguments.quiet, command::export(&arguments.request())),
        Command::Simulate(arguments) => unless(arguments.quiet, command::simulate(&arguments.request())),
        Command::Fly(arguments) => command::fly(&arguments.request(), &mut |line| println!("{line}")),
        Command::Init { out, start } => command::init(&start.request(None, out)),
        Command::Import { targets, out, start } => command::init(&start.request(Some(targets), out)),
        Command::Routes { solve, routes } => {
            let RouteArguments { vehicles, objective, open, iterations } = routes;
            command::routes(&solve.request(iterations), usize::from(vehicles), objective, open)
        }
        Command::Tour { solve, kicks } => command::tour(&solve.request(kicks)),
        Command::Study { study } => studying::run(study),
        Command::Completions { shell } => {
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "ground-station", &mut text);
            Ok(String::from_utf8_lossy(&text).into_owned())
        }
    }
}

/// The text, unless nobody wants it.
fn unless(is_silent: bool, text: Result<String, Failure>) -> Result<String, Failure> {
    text.map(|text| if is_silent { String::new() } else { text })
}
