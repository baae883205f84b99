//! Arguments of `routes` and `tour`.

use super::values::parse_objective;
use crate::command::SolveRequest;
use planner::mtsp::Objective;
use std::path::PathBuf;

/// Arguments of `tour`, and of `routes` beside its own.
#[derive(Debug, clap::Args)]
pub struct SolveArguments {
    /// A TSPLIB file, or lines that end in x,y.
    pub file: PathBuf,
    /// Round distances to whole numbers, as TSPLIB does.
    #[arg(long)]
    pub rounded: bool,
    /// Seed of the search.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// JSON instead of lines.
    #[arg(long)]
    pub json: bool,
}

impl SolveArguments {
    pub(super) fn request(self, iterations: u64) -> SolveRequest {
        let Self { file, rounded: is_rounded, seed, json } = self;
        SolveRequest { file, is_rounded, seed, iterations, json }
    }
}

/// Arguments of `routes` alone.
#[derive(Debug, clap::Args)]
pub struct RouteArguments {
    /// How many vehicles start at the first node.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub vehicles: u16,
    /// What is made short: makespan or total.
    #[arg(long, default_value = "makespan", value_parser = parse_objective)]
    pub objective: Objective,
    /// Routes end at their last node.
    #[arg(long)]
    pub open: bool,
    /// Iterations of the search.
    #[arg(long, default_value_t = 200_000)]
    pub iterations: u64,
}
