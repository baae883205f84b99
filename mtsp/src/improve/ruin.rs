//! Ruin: strings of consecutive targets are taken out of routes near a random target.
//!
//! Christiaens and Vanden Berghe 2020, "Slack induction by string removals", doi:10.1287/trsc.2019.0914, section 5.1.

use super::arcs::{Arcs, Neighbours};
use super::random::Random;
use super::state::{NOWHERE, State};

/// How much is taken out.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RuinSize {
    /// Mean number of targets taken out.
    pub mean: f64,
    /// Longest string.
    pub longest: f64,
}

/// Scratch of the ruin step.
pub(crate) struct Ruin {
    /// Per vehicle: the round in which it lost a string.
    touched: Vec<u32>,
    round: u32,
    /// The targets taken out.
    pub removed: Vec<u32>,
}

/// Probability of a split string (targets in its middle stay) and of each further target staying: the source's values.
const SPLIT: f64 = 0.5;
const STOP_GROWING: f64 = 0.01;

/// Probability of taking a whole route out, and the longest route (in mean sizes) to which that happens: strings alone
/// cannot hand a route over to another vehicle.
const WHOLE: f64 = 0.02;
const WHOLE_UP_TO: f64 = 4.0;

/// Strings may be this long even where the routes have fewer targets on average (the source stops at their mean): of 4000
/// instances of at most eight targets, 1000 iterations then miss the least makespan of one, else of twelve.
const SHORT: f64 = 4.0;

impl Ruin {
    pub fn new(vehicles: usize) -> Self {
        Self { touched: vec![0; vehicles], round: 0, removed: Vec::new() }
    }

    /// Takes strings out of the routes of a random target and its neighbours, at most one a route.
    pub fn apply(
        &mut self,
        state: &mut State,
        arcs: &impl Arcs,
        near: &Neighbours,
        size: RuinSize,
        random: &mut Random,
    ) {
        self.removed.clear();
        self.round = self.round.wrapping_add(1);
        let used = state.count.iter().filter(|&&c| c > 0).count();
        let mean_count = state.n as f64 / used.max(1) as f64;
        let longest = size.longest.min(mean_count.max(SHORT));
        let most_strings = (4.0 * size.mean / (1.0 + longest) - 1.0).max(0.0);
        let strings = (random.unit() * most_strings + 1.0) as usize;
        let seed = random.below(state.n);
        let vehicle = state.route[seed] as usize;
        if f64::from(state.count[vehicle]) <= WHOLE_UP_TO * size.mean && random.unit() < WHOLE {
            self.take_route(state, arcs, vehicle);
            return;
        }
        let mut done = 0;
        for target in std::iter::once(seed).chain(near.of(seed).iter().map(|&t| t as usize)) {
            let vehicle = state.route[target];
            if vehicle == NOWHERE || self.touched[vehicle as usize] == self.round {
                continue;
            }
            self.touched[vehicle as usize] = self.round;
            let count = state.count[vehicle as usize] as usize;
            let length = 1 + (random.unit() * longest.min(count as f64)) as usize;
            self.take_string(state, arcs, target, length.min(count), random);
            done += 1;
            if done >= strings {
                break;
            }
        }
    }

    fn take_route(&mut self, state: &mut State, arcs: &impl Arcs, vehicle: usize) {
        let end = state.n + vehicle;
        while state.count[vehicle] > 0 {
            let first = state.next[end] as usize;
            state.remove(first, arcs);
            self.removed.push(first as u32);
        }
    }

    /// Takes a random string of `length` targets that holds `target` out; sometimes with a gap in it.
    fn take_string(
        &mut self,
        state: &mut State,
        arcs: &impl Arcs,
        target: usize,
        length: usize,
        random: &mut Random,
    ) {
        let count = state.count[state.route[target] as usize] as usize;
        let mut gap = 0;
        if length > 1 && length < count && random.unit() < SPLIT {
            gap = 1;
            while length + gap < count && random.unit() > STOP_GROWING {
                gap += 1;
            }
        }
        let whole = length + gap;
        // Go back at most to the first target of the route.
        let n = state.n;
        let mut start = target;
        for _ in 0..random.below(whole) {
            let before = state.prev[start] as usize;
            if before >= n {
                break;
            }
            start = before;
        }
        let gap_start = if gap > 0 { 1 + random.below(length - 1) } else { usize::MAX };
        let mut here = start;
        for position in 0..whole {
            if here >= n {
                break;
            }
            let next = state.next[here] as usize;
            if position < gap_start || position >= gap_start + gap {
                state.remove(here, arcs);
                self.removed.push(here as u32);
            }
            here = next;
        }
    }
}
