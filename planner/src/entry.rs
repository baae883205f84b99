//! Where a circle may be entered, and how soon at best.

use crate::circles::Orbit;
use crate::mission::Entries;
use crate::plan::Entry;
use quad_dynamics::{Direction, Motion};

/// Samples with which a free entry starts: as many as a caller would be content with, so that it is never worse than they are.
const SAMPLES_BEFORE_FREE: usize = 32;

/// A candidate entry with a certified lower bound on the time to reach it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entrance {
    pub entry: Entry,
    /// No admissible motion is there sooner (s).
    pub lower_bound: f64,
}

/// How many entries are sampled.
pub(crate) fn n_entrances(entries: Entries) -> usize {
    2 * match entries {
        Entries::Sampled(n) => n,
        Entries::Free => SAMPLES_BEFORE_FREE,
    }
}

/// The sampled entries, by angle and then direction.
pub(crate) fn sampled(entries: Entries) -> Vec<Entry> {
    let n = n_entrances(entries) / 2;
    (0..n)
        .map(|i| std::f64::consts::TAU * i as f64 / n as f64)
        .flat_map(|angle| Direction::BOTH.map(|direction| Entry { angle, direction }))
        .collect()
}

/// The sampled entries of a circle with bounds for a flight from `here`.
pub(crate) fn entrances(
    here: &Motion,
    orbit: &Orbit,
    entries: Entries,
    least_time: impl Fn(&Motion, &Motion) -> f64,
) -> Vec<Entrance> {
    sampled(entries)
        .into_iter()
        .map(|entry| {
            let there = orbit.at(entry);
            Entrance { entry, lower_bound: least_time(here, &there) }
        })
        .collect()
}
