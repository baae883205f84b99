//! Simulated annealing over ruin and recreate.

use super::arcs::{Arcs, Neighbours};
use super::energy::Energy;
use super::options::Options;
use super::random::Random;
use super::recreate::Places;
use super::ruin::{Ruin, RuinSize};
use super::state::State;
use crate::objective::Objective;

/// What a solution is compared by: excess over limits, the objective, the other objective.
pub(crate) type Value = (f64, f64, f64);

/// Relative difference below which two values count as equal, so that rounding is no progress.
const SAME: f64 = 1e-12;

/// How hot the annealing starts and ends, in mean arc costs.
const HOT: f64 = 0.5;
const COLD: f64 = 0.001;

pub(crate) struct Annealing<'a, A: Arcs> {
    pub arcs: &'a A,
    pub near: &'a Neighbours,
    pub places: Places<'a>,
    pub objective: Objective,
    pub limits: Vec<f64>,
    /// The objective's value at which the search may stop.
    pub target: f64,
}

/// What is told to the caller at each improvement and now and then in between.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Progress {
    /// Iterations so far.
    pub iteration: u64,
    /// The best makespan so far.
    pub makespan: f64,
    /// The total cost of that solution.
    pub total_cost: f64,
}

/// Iterations between two questions to the caller whether to stop.
const PATIENCE: u64 = 128;

impl<A: Arcs> Annealing<'_, A> {
    pub fn value(&self, state: &State) -> Value {
        let over: f64 =
            state.length.iter().zip(&self.limits).map(|(length, limit)| (length - limit).max(0.0)).sum();
        let (makespan, total) = (state.makespan(), state.total());
        match self.objective {
            Objective::Total => (over, total, makespan),
            Objective::Makespan => (over, makespan, total),
        }
    }

    /// Improves `state`; the best state seen ends up in it. `proceed` is asked now and then and told of each improvement.
    pub fn run(&self, state: &mut State, options: &Options, proceed: &mut dyn FnMut(&Progress) -> bool) {
        let mut random = Random::new(options.seed);
        let mut ruin = Ruin::new(self.limits.len());
        let mut energy = Energy::new(self.objective, self.limits.clone());
        let mut best = state.clone();
        let mut best_value = self.value(state);
        energy.set_scale(state.makespan());
        let mut current = self.energy(state, &energy);
        let size = RuinSize { mean: 10.0, longest: 10.0 };
        let arc = state.total() / (state.n + state.length.len()) as f64;
        let horizon = options.horizon.unwrap_or(options.iterations).max(1);
        let cooling = (COLD / HOT).powf(256.0 / horizon as f64);
        let mut temperature = HOT * arc;
        for iteration in 0..options.iterations {
            if iteration % PATIENCE == 0 && !proceed(&progress(iteration, &best)) {
                break;
            }
            if iteration % 256 == 255 {
                temperature *= cooling;
            }
            if iteration > 0 && iteration % horizon == 0 {
                temperature = (HOT * COLD).sqrt() * arc;
                state.clone_from(&best);
                current = self.energy(state, &energy);
            }
            ruin.apply(state, self.arcs, self.near, size, &mut random);
            self.places.recreate(state, self.arcs, &energy, &mut ruin.removed, &mut random);
            let next = self.energy(state, &energy);
            if next >= current - temperature * (1.0 - random.unit()).ln() {
                state.undo();
                continue;
            }
            state.commit();
            current = next;
            if better(self.value(state), best_value) {
                state.measure(self.arcs);
                best_value = self.value(state);
                best.clone_from(state);
                energy.set_scale(state.makespan());
                current = self.energy(state, &energy);
                if best_value.0 <= 0.0 && best_value.1 <= self.target {
                    break;
                }
            }
        }
        proceed(&progress(options.iterations, &best));
        state.clone_from(&best);
    }

    fn energy(&self, state: &State, energy: &Energy) -> f64 {
        state.length.iter().enumerate().map(|(vehicle, &length)| energy.of(vehicle, length)).sum()
    }
}

fn progress(iteration: u64, best: &State) -> Progress {
    Progress { iteration, makespan: best.makespan(), total_cost: best.total() }
}

/// Lexicographically less by more than rounding.
pub(crate) fn better(a: Value, b: Value) -> bool {
    let less = |x: f64, y: f64| x < y - SAME * y.abs();
    let same = |x: f64, y: f64| !less(x, y) && !less(y, x);
    less(a.0, b.0) || same(a.0, b.0) && (less(a.1, b.1) || same(a.1, b.1) && less(a.2, b.2))
}
