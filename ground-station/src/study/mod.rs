//! The paper's figures and simulations (Gao, Mandal, Bhattacharya 2020), as tables that shards can be merged from.
//!
//! | study | figure | what is measured |
//! |---|---|---|
//! | [`cost`] | path cost per vehicle | Algorithm 2 on targets drawn uniformly from a square of 2 km, by n and m |
//! | [`procedures`] | ratio of the procedures | length of Procedure 1 over that of Procedure 2 when r targets arrive |
//! | [`holonomic`] | ratio of times | transition of a quadcopter over that of a vehicle without dynamics, by distance |
//! | [`fans`] | Fig. 3 | minimum-time flights to five entries on the near semicircle, from three distances |
//!
//! Trial `i` of a cell is drawn from its own generator, so that any division of the trials gives the same numbers.

pub mod chart;
pub mod cost;
pub mod fans;
pub mod holonomic;
pub mod procedures;
pub mod tally;

use crate::failure::Failure;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{Rng, SeedableRng};
use rayon::prelude::*;
use tally::Tally;

/// Which of the trials are run: shard `index` of `count`, counted from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// From 0.
    pub index: usize,
    /// At least 1.
    pub count: usize,
}

/// What all studies with trials need.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trials {
    /// Trials of each cell.
    pub count: usize,
    /// Seed of all of them.
    pub seed: u64,
    /// Which of them are run.
    pub shard: Shard,
    /// No progress bar.
    pub quiet: bool,
}

/// The generator of one trial: independent of every other trial's.
pub struct Draw(Xoshiro256PlusPlus);

impl Draw {
    pub(crate) fn new(seed: u64, cell: u64, trial: u64) -> Self {
        // The generator's own seeding scrambles; distinct words are enough.
        let word =
            seed ^ cell.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ trial.wrapping_mul(0xD1B5_4A32_D192_ED03);
        Self(Xoshiro256PlusPlus::seed_from_u64(word))
    }

    /// Uniform in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// So many points, uniform in the paper's square: 2 km wide, its middle at the origin.
    pub fn points(&mut self, count: usize) -> Vec<[f64; 2]> {
        (0..count).map(|_| [self.between(-1000.0, 1000.0), self.between(-1000.0, 1000.0)]).collect()
    }
}

impl Trials {
    /// Runs the trials of this shard, `cells` cells in all, behind a progress bar; one tally per cell.
    ///
    /// # Errors
    ///
    /// The first failure of a trial, in the order of trials.
    pub fn run(
        &self,
        cells: usize,
        trial: impl Fn(usize, &mut Draw) -> Result<f64, Failure> + Sync,
    ) -> Result<Vec<Tally>, Failure> {
        let mine: Vec<usize> =
            (0..self.count).filter(|trial| trial % self.shard.count == self.shard.index).collect();
        let bar = progress(cells * mine.len(), self.quiet);
        let cell = |cell: usize| {
            let one = |&number: &usize| {
                let value = trial(cell, &mut Draw::new(self.seed, cell as u64, number as u64));
                bar.inc(1);
                value
            };
            // Collected in the order of trials: the sum then does not depend on the number of threads.
            let values: Vec<f64> = mine.par_iter().map(one).collect::<Result<_, Failure>>()?;
            Ok(values.into_iter().collect())
        };
        let tallies = (0..cells).map(cell).collect();
        bar.finish_and_clear();
        tallies
    }
}

/// A progress bar on the standard error, which hides itself where that is no terminal.
fn progress(total: usize, quiet: bool) -> ProgressBar {
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr_with_hz(4) };
    let bar = ProgressBar::with_draw_target(Some(total as u64), target);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} trials, {elapsed} gone, {eta} left")
    {
        bar.set_style(style);
    }
    bar
}

/// A failure of a solver in a trial, which drawn instances never cause.
fn solver(error: impl std::fmt::Display) -> Failure {
    Failure::Refused(format!("a trial failed: {error}"))
}
