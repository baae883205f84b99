//! Arguments of `study`.

use super::values::{parse_positive, parse_shard};
use crate::command::{self, Study};
use crate::failure::Failure;
use crate::study::procedures::Meaning;
use crate::study::{Shard, Trials};
use clap::Subcommand;
use std::path::PathBuf;

pub(super) const STUDY_EXAMPLES: &str = "\
Examples:
  ground-station study cost                              the paper's counts: 10 000 trials of each n and m
  ground-station study procedures --trials 1000 --out studies
  ground-station study procedures --second-round new --without-home
  ground-station study holonomic --trials 20 --shard 2/8  one of eight parts, for a batch system
  ground-station study merge part-*/procedures-*.csv
  ground-station study transitions                       the fans of minimum-time flights";

/// What studies have in common.
#[derive(Debug, clap::Args)]
pub struct StudyArguments {
    /// Seed of all trials.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Run part I of N of the trials: I/N.
    #[arg(long, value_name = "I/N", default_value = "1/1", value_parser = parse_shard)]
    pub shard: Shard,
    #[command(flatten)]
    #[allow(missing_docs)]
    pub place: PlaceArguments,
}

/// Where a study's files go.
#[derive(Debug, clap::Args)]
pub struct PlaceArguments {
    /// The folder into which the table and the picture go.
    #[arg(long, value_name = "DIR", default_value = "studies")]
    pub out: PathBuf,
    /// Replace files that are there.
    #[arg(long)]
    pub force: bool,
    /// No progress bar.
    #[arg(long, short)]
    pub quiet: bool,
}

/// The studies.
#[derive(Debug, Subcommand)]
pub enum StudyCommand {
    /// Path cost per vehicle for numbers of targets (n) and vehicles (m).
    Cost {
        /// Trials for each n and m.
        #[arg(long, default_value_t = 10_000)]
        trials: usize,
        /// Numbers of targets.
        #[arg(long, value_delimiter = ',', default_values_t = [20, 40, 60, 80, 100])]
        targets: Vec<usize>,
        /// Numbers of vehicles.
        #[arg(long, value_delimiter = ',', default_values_t = [2, 4, 6, 8, 10])]
        vehicles: Vec<usize>,
        #[command(flatten)]
        #[allow(missing_docs)]
        study: StudyArguments,
    },
    /// Length of Procedure 1 over that of Procedure 2 when targets arrive.
    Procedures {
        /// Trials for each number of arrivals.
        #[arg(long, default_value_t = 30_000)]
        trials: usize,
        /// Targets of the first round.
        #[arg(long, default_value_t = 100)]
        targets: usize,
        /// Vehicles.
        #[arg(long, default_value_t = 8)]
        vehicles: usize,
        /// Numbers of arrivals.
        #[arg(long, value_delimiter = ',', default_values_t = [32, 64, 100, 150])]
        arrivals: Vec<usize>,
        /// What the second round visits: all targets again (as in the paper) or the new ones.
        #[arg(long, default_value = "all", value_parser = ["all", "new"])]
        second_round: String,
        /// Leave flights to the depot out of the lengths.
        #[arg(long)]
        without_home: bool,
        #[command(flatten)]
        #[allow(missing_docs)]
        study: StudyArguments,
    },
    /// Transition time of a quadcopter over that of a vehicle without dynamics, by distance.
    Holonomic {
        /// The mission whose vehicle and settings are used; without one, the built-in field mission.
        file: Option<PathBuf>,
        /// Trials for each distance.
        #[arg(long, default_value_t = 40)]
        trials: usize,
        /// Entries tried on the second circle.
        #[arg(long, default_value_t = 16)]
        entries: usize,
        /// Distances from the first circle's exit to the second circle, in loiter radii.
        #[arg(long, value_delimiter = ',', value_parser = parse_positive, default_values_t = [1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 16.0])]
        distances: Vec<f64>,
        #[command(flatten)]
        #[allow(missing_docs)]
        study: StudyArguments,
    },
    /// Minimum-time flights to five entries on the near semicircle.
    Transitions {
        /// The mission whose vehicle and settings are used; without one, the built-in field mission.
        file: Option<PathBuf>,
        /// Distances of the start from the centre, in loiter radii.
        #[arg(long, value_delimiter = ',', value_parser = parse_positive, default_values_t = [3.0, 5.0, 8.0])]
        distances: Vec<f64>,
        #[command(flatten)]
        #[allow(missing_docs)]
        place: PlaceArguments,
    },
    /// Adds up the tables of shards.
    Merge {
        /// Tables of one study.
        #[arg(required = true)]
        tables: Vec<PathBuf>,
        #[command(flatten)]
        #[allow(missing_docs)]
        place: PlaceArguments,
    },
}

pub(super) fn run(study: StudyCommand) -> Result<String, Failure> {
    let (wanted, count, arguments) = match study {
        StudyCommand::Cost { trials, targets, vehicles, study } => {
            (Study::Cost { targets, vehicles }, trials, study)
        }
        StudyCommand::Procedures {
            trials,
            targets,
            vehicles,
            arrivals,
            second_round,
            without_home,
            study,
        } => {
            let meaning = Meaning { new_only: second_round == "new", without_home };
            (Study::Procedures { targets, vehicles, arrivals, meaning }, trials, study)
        }
        StudyCommand::Holonomic { file, trials, entries, distances, study } => {
            (Study::Holonomic { file, entries, distances }, trials, study)
        }
        StudyCommand::Transitions { file, distances, place } => {
            return command::transitions(file.as_deref(), &distances, &place.out, place.force);
        }
        StudyCommand::Merge { tables, place } => return command::merge(&tables, &place.out, place.force),
    };
    let StudyArguments { seed, shard, place } = arguments;
    let trials = Trials { count, seed, shard, quiet: place.quiet };
    command::study(&wanted, &trials, &place.out, place.force)
}
