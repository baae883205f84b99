//! Simulated annealing over ruin and recreate.

use super::arcs::{Arcs, Neighbours};
use super::energy::Energy;
use super::random::Random;
use super::recreate::Places;
use super::ruin::{Ruin, RuinSize};
use super::state::State;
use crate::objective::Objective;

/// What a solution is compared by: excess over limits, the objective, the other objective.
pub(crate) type Value = (f64, f64, f64);

/// Relative difference below which two values count as equal, so that rounding is no progress.
const SAME: f64 = 1e-12;

/// Temperature at which an annealing ends, in mean arc costs. On the instances of the literature 0.0003 to 0.01 are alike.
const COLD: f64 = 0.001;

/// Mean number of targets taken out and longest string: the source's values.
const SIZE: RuinSize = RuinSize { mean: 10.0, longest: 10.0 };

/// Targets for each of which the best state is kept one iteration later: copying it takes time in proportion to the targets.
const LATE: usize = 64;

/// Iterations between two questions to the caller whether to stop, and between two temperatures.
const PATIENCE: u64 = 128;

/// What is told to the caller every few iterations.
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

/// What stays the same during a search.
pub(crate) struct Setting<'a, A: Arcs> {
    pub arcs: &'a A,
    pub near: &'a Neighbours,
    pub places: Places<'a>,
    pub objective: Objective,
    pub limits: Vec<f64>,
    /// The objective's value at which the search may stop.
    pub target: f64,
}

impl<A: Arcs> Setting<'_, A> {
    pub fn value(&self, state: &State) -> Value {
        let over: f64 =
            state.length.iter().zip(&self.limits).map(|(length, limit)| (length - limit).max(0.0)).sum();
        let (makespan, total) = (state.makespan(), state.total());
        match self.objective {
            Objective::Total => (over, total, makespan),
            Objective::Makespan => (over, makespan, total),
        }
    }

    pub fn is_good_enough(&self, value: Value) -> bool {
        value.0 <= 0.0 && value.1 <= self.target
    }
}

/// The budget and the caller's say in it.
pub(crate) struct Clock<'a> {
    pub iteration: u64,
    pub iterations: u64,
    /// Makespan and total of the best state so far.
    pub best: (f64, f64),
    pub proceed: &'a mut dyn FnMut(&Progress) -> bool,
    pub stopped: bool,
}

impl Clock<'_> {
    /// Counts an iteration; false when it is time to stop.
    #[inline(always)]
    fn tick(&mut self) -> bool {
        if self.iteration.is_multiple_of(PATIENCE) {
            self.report();
        }
        self.stopped |= self.iteration >= self.iterations;
        self.iteration += 1;
        !self.stopped
    }

    pub fn report(&mut self) {
        let (makespan, total_cost) = self.best;
        self.stopped |= !(self.proceed)(&Progress { iteration: self.iteration, makespan, total_cost });
    }

    pub fn note(&mut self, state: &State) {
        self.best = (state.makespan(), state.total());
    }
}

/// One annealing at a time, with everything it needs.
pub(crate) struct Annealer<'a, A: Arcs> {
    pub setting: &'a Setting<'a, A>,
    pub random: Random,
    pub energy: Energy,
    ruin: Ruin,
    /// The best state of the current annealing.
    best: State,
}

impl<'a, A: Arcs> Annealer<'a, A> {
    pub fn new(setting: &'a Setting<'a, A>, random: Random, state: &State) -> Self {
        let energy = Energy::new(setting.objective, setting.limits.clone());
        Self { setting, random, energy, ruin: Ruin::new(setting.limits.len()), best: state.clone() }
    }

    /// Anneals `state` for some iterations from a temperature of `hot` mean arc costs; the best state seen ends up in it.
    /// `overall` is the best value before; `clock` is told when it falls.
    pub fn run(
        &mut self,
        state: &mut State,
        iterations: u64,
        hot: f64,
        overall: Value,
        clock: &mut Clock<'_>,
    ) {
        let Setting { arcs, near, places, .. } = self.setting;
        self.best.clone_from(state);
        let (mut best_value, mut overall) = (self.setting.value(state), overall);
        self.energy.set_scale(state.makespan());
        let mut current = self.total_energy(state);
        let arc = state.total() / (state.n + state.length.len()) as f64;
        let mut temperature = hot * arc;
        let pause = (state.n / LATE) as u64;
        let mut kept = 0;
        let cooling = (COLD / hot).powf(PATIENCE as f64 / iterations.max(1) as f64);
        for iteration in 0..iterations {
            if !clock.tick() {
                break;
            }
            if iteration % PATIENCE == PATIENCE - 1 {
                temperature *= cooling;
            }
            self.ruin.apply(state, *arcs, near, SIZE, &mut self.random);
            places.recreate(state, *arcs, &mut self.energy, &mut self.ruin.removed, &mut self.random);
            let next = self.energy.total();
            if next >= current - temperature * (1.0 - self.random.unit()).ln() {
                state.undo();
                continue;
            }
            state.commit();
            current = next;
            if iteration >= kept + pause && better(self.setting.value(state), best_value) {
                kept = iteration;
                state.measure(*arcs);
                best_value = self.setting.value(state);
                self.best.clone_from(state);
                self.energy.set_scale(state.makespan());
                current = self.total_energy(state);
                if better(best_value, overall) {
                    overall = best_value;
                    clock.note(state);
                }
                if self.setting.is_good_enough(best_value) {
                    break;
                }
            }
        }
        if better(self.setting.value(state), best_value) {
            state.measure(*arcs);
            return;
        }
        state.clone_from(&self.best);
    }

    fn total_energy(&self, state: &State) -> f64 {
        state.length.iter().enumerate().map(|(vehicle, &length)| self.energy.of(vehicle, length)).sum()
    }
}

/// Lexicographically less by more than rounding.
pub(crate) fn better(a: Value, b: Value) -> bool {
    let less = |x: f64, y: f64| x < y - SAME * y.abs();
    let same = |x: f64, y: f64| !less(x, y) && !less(y, x);
    less(a.0, b.0) || same(a.0, b.0) && (less(a.1, b.1) || same(a.1, b.1) && less(a.2, b.2))
}
