//! Recreate: targets taken out are put back one by one where they cost least, blinking now and then.

use super::arcs::{Arcs, Neighbours};
use super::energy::Energy;
use super::random::Random;
use super::state::{NOWHERE, State};

/// Who may serve whom, and the neighbours whose sides are tried.
pub(crate) struct Places<'a> {
    pub near: &'a Neighbours,
    /// Neighbours tried a target.
    pub width: usize,
    /// `allowed[target * m + vehicle]`; empty if all pairs are.
    pub allowed: Vec<bool>,
    /// Whether empty vehicles are all alike.
    pub alike: bool,
}

/// Probability of overlooking a place (the source's value).
const BLINK: f64 = 0.01;

struct Best {
    cost: f64,
    after: usize,
}

impl Best {
    const NONE: Self = Self { cost: f64::INFINITY, after: usize::MAX };
}

impl Places<'_> {
    #[inline(always)]
    fn allows(&self, target: usize, vehicle: usize, vehicles: usize) -> bool {
        self.allowed.is_empty() || self.allowed[target * vehicles + vehicle]
    }

    /// Puts each of `removed` back, in an order drawn among random, farthest first and closest first.
    pub fn recreate(
        &self,
        state: &mut State,
        arcs: &impl Arcs,
        energy: &mut Energy,
        removed: &mut [u32],
        random: &mut Random,
    ) {
        let depot = state.n;
        let far = |t: &u32| arcs.arc(depot, *t as usize);
        match random.below(7) {
            0..4 => shuffle(removed, random),
            4..6 => removed.sort_unstable_by(|a, b| far(b).total_cmp(&far(a)).then(a.cmp(b))),
            _ => removed.sort_unstable_by(|a, b| far(a).total_cmp(&far(b)).then(a.cmp(b))),
        }
        energy.cache_all(&state.length);
        let mut until_blink = blink_distance(random);
        for &target in removed.iter() {
            let place = self.best_place(state, arcs, energy, target as usize, &mut until_blink, random);
            state.insert(target as usize, place, arcs);
            let vehicle = state.route[place] as usize;
            energy.cache(vehicle, state.length[vehicle]);
        }
    }

    /// The vertex behind which the target costs least.
    fn best_place(
        &self,
        state: &State,
        arcs: &impl Arcs,
        energy: &Energy,
        target: usize,
        until_blink: &mut u32,
        random: &mut Random,
    ) -> usize {
        let m = state.length.len();
        let mut best = Best::NONE;
        let near = self.near.of(target);
        for &neighbour in &near[..self.width.min(near.len())] {
            let neighbour = neighbour as usize;
            let vehicle = state.route[neighbour];
            if vehicle == NOWHERE || !self.allows(target, vehicle as usize, m) {
                continue;
            }
            for after in [neighbour, state.prev[neighbour] as usize] {
                if !blinks(until_blink, random) {
                    consider(state, arcs, energy, target, after, &mut best);
                }
            }
        }
        for vehicle in (0..m).filter(|&v| state.count[v] == 0) {
            if self.allows(target, vehicle, m) && !blinks(until_blink, random) {
                consider(state, arcs, energy, target, state.n + vehicle, &mut best);
                if self.alike {
                    break;
                }
            }
        }
        if best.after == usize::MAX {
            self.search_everywhere(state, arcs, energy, target, &mut best);
        }
        best.after
    }

    /// All places of all allowed vehicles: for targets whose neighbours are all out or out of bounds.
    fn search_everywhere(
        &self,
        state: &State,
        arcs: &impl Arcs,
        energy: &Energy,
        target: usize,
        best: &mut Best,
    ) {
        let m = state.length.len();
        for vehicle in (0..m).filter(|&v| self.allows(target, v, m)) {
            let end = state.n + vehicle;
            if best.after == usize::MAX {
                best.after = end; // even if every cost overflows
            }
            let mut after = end;
            loop {
                consider(state, arcs, energy, target, after, best);
                after = state.next[after] as usize;
                if after == end {
                    break;
                }
            }
        }
    }
}

/// Compares the place behind `after` with the best. The energy is convex, so slope times detour bounds the cost from below and most
/// places need no power.
#[inline(always)]
fn consider(state: &State, arcs: &impl Arcs, energy: &Energy, target: usize, after: usize, best: &mut Best) {
    let before = state.next[after] as usize;
    let vehicle = state.route[after] as usize;
    let added = arcs.arc(after, target) + arcs.arc(target, before) - arcs.arc(after, before);
    let (value, slope) = energy.cached(vehicle);
    if added * slope >= best.cost {
        return;
    }
    let cost = energy.of(vehicle, state.length[vehicle] + added) - value;
    if cost < best.cost {
        *best = Best { cost, after };
    }
}

/// Whether this place is overlooked.
#[inline(always)]
fn blinks(until_blink: &mut u32, random: &mut Random) -> bool {
    if *until_blink == 0 {
        *until_blink = blink_distance(random);
        return true;
    }
    *until_blink -= 1;
    false
}

/// Places until the next one overlooked: geometric.
fn blink_distance(random: &mut Random) -> u32 {
    ((1.0 - random.unit()).ln() / (1.0 - BLINK).ln()) as u32
}

fn shuffle(list: &mut [u32], random: &mut Random) {
    for i in (1..list.len()).rev() {
        list.swap(i, random.below(i + 1));
    }
}
