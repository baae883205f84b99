//! How much can still be collected on the way home: a bound for every target and length left.
//!
//! The best of all walks by dynamic programming over lengths rounded down to a unit, with a small memory of near targets.

use super::Graph;

/// Near targets that are remembered.
const MEMORY: usize = 5;

/// Units in the limit, about.
const UNITS: f64 = 1200.0;

/// Prizes are collected in single precision, rounded up by this.
const ROUNDING: f64 = 1e-5;

pub(super) struct Completion {
    unit: f64,
    units: usize,
    most: Vec<f32>,
}

impl Completion {
    /// None if some leg is shorter than a unit, so that walks of length 0 would never end.
    pub fn new(graph: &Graph, prizes: &[f64], limit: f64) -> Option<Self> {
        let (n, unit) = (graph.nodes, limit / UNITS);
        // More than needed by two, against the rounding of quotients.
        let units = (limit / unit) as usize + 3;
        // A leg longer than the limit is as good as any other such leg.
        let in_units = |leg: f64| ((leg / unit) as usize).min(units);
        let legs: Vec<usize> = (0..n * n).map(|ij| in_units(graph.leg(ij / n, ij % n))).collect();
        if (0..n * n).any(|ij| ij / n != ij % n && legs[ij] == 0) {
            return None;
        }
        let walks = walks(graph, prizes, &legs, units);
        let mut most = vec![f32::NEG_INFINITY; n * units];
        for target in 1..n {
            let mut best = f32::NEG_INFINITY;
            for length in 0..units {
                let states = (length * n + target) << MEMORY;
                best = walks[states..states + (1 << MEMORY)].iter().copied().fold(best, f32::max);
                most[target * units + length] = best - prizes[target] as f32 + ROUNDING as f32;
            }
        }
        Some(Self { unit, units, most })
    }

    /// At least what a walk from `target` (its own prize not counted) to the depot within `length` collects.
    #[inline]
    pub fn most(&self, target: usize, length: f64) -> f64 {
        let units = ((length / self.unit) as usize).saturating_add(1);
        f64::from(self.most[target * self.units + units.min(self.units - 1)])
    }
}

/// For each length, target and memory, what the best walk from the depot to the target collects.
fn walks(graph: &Graph, prizes: &[f64], legs: &[usize], units: usize) -> Vec<f32> {
    let n = graph.nodes;
    let next = transitions(graph);
    let mut walks = vec![f32::NEG_INFINITY; (units * n) << MEMORY];
    let paying: Vec<usize> = (1..n).filter(|&w| prizes[w] > 0.0).collect();
    for &target in &paying {
        if legs[target] < units {
            walks[(legs[target] * n + target) << MEMORY] = prizes[target] as f32;
        }
    }
    for length in 0..units {
        for &target in &paying {
            for memory in 0..1 << MEMORY {
                let collected = walks[((length * n + target) << MEMORY) + memory];
                if collected < 0.0 {
                    continue;
                }
                let row = &next[((target << MEMORY) + memory) * n..];
                for &w in &paying {
                    let there = length + legs[target * n + w];
                    // A walk that cannot get home within the limit is of no use.
                    if row[w] != BARRED && there + legs[w] < units {
                        let state = ((there * n + w) << MEMORY) + usize::from(row[w]);
                        walks[state] = walks[state].max(collected + prizes[w] as f32);
                    }
                }
            }
        }
    }
    walks
}

const BARRED: u8 = u8::MAX;

/// The memory after a step, by target, memory and next target; barred for the target itself and those remembered.
fn transitions(graph: &Graph) -> Vec<u8> {
    let n = graph.nodes;
    let near = |v: usize| graph.near[v].iter().take(MEMORY).copied();
    let mut next = vec![BARRED; (n << MEMORY) * n];
    for v in 1..n {
        for memory in 0..1usize << MEMORY {
            let remembered: Vec<usize> =
                near(v).enumerate().filter(|(bit, _)| memory >> bit & 1 == 1).map(|(_, w)| w).collect();
            for w in (1..n).filter(|&w| w != v && !remembered.contains(&w)) {
                let kept = near(w).enumerate().filter(|(_, x)| *x == v || remembered.contains(x));
                next[((v << MEMORY) + memory) * n + w] = kept.fold(0, |bits, (bit, _)| bits | 1 << bit);
            }
        }
    }
    next
}
