//! The route that collects most: labels from the depot to the middle of the route, joined in pairs.
//!
//! Distances are symmetric, so that the second half of a route is a first half backwards: some leg of a route crosses its middle, and both ends of it
//! are reached from the depot within half the limit.

use super::completion::Completion;
use super::cuts::{Parities, Triple};
use super::master::Prices;
use super::{Graph, TARGETS};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Near targets that a route remembers, itself included.
const NEIGHBOURHOOD: usize = 10;

/// Labels at most: some 200 MB.
const LABELS: usize = 4_000_000;

/// Routes returned at most.
const ROUTES: usize = 200;

/// Rounding of sums of prizes.
const EPSILON: f64 = 1e-12;

/// Whether labels must remember the same to be compared.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Effort {
    /// No: few labels, routes that may not be the best.
    Quick,
    /// Yes: no route collects more than the best found.
    Exact,
}

pub(super) struct Priced {
    /// What the best route collects, at least 1.
    pub most: f64,
    /// Routes that collect more than 1, best first.
    pub routes: Vec<Vec<usize>>,
}

struct Label {
    length: f64,
    collected: f64,
    memory: u128,
    parities: Parities,
    target: u32,
    before: u32,
}

/// A length in the queue; lengths are finite.
#[derive(PartialEq)]
struct Length(f64);

impl Eq for Length {}

impl PartialOrd for Length {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Length {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// The best routes of length at most `limit`; none if there are too many labels.
pub(super) fn price(
    graph: &Graph,
    prices: &Prices,
    cuts: &[Triple],
    limit: f64,
    effort: Effort,
) -> Option<Priced> {
    // Charges only take from what a route collects: the bound without them holds.
    let completion = Completion::new(graph, &prices.prizes, limit);
    let mut cuts_of = vec![vec![]; graph.nodes];
    for (cut, triple) in cuts.iter().enumerate().filter(|(cut, _)| prices.charges[*cut] > 0.0) {
        triple.iter().for_each(|&target| cuts_of[target].push(cut));
    }
    let (labels, kept) = (vec![], vec![vec![]; graph.nodes]);
    let mut search = Search { graph, prices, cuts_of, limit, effort, completion, labels, kept };
    search.grow()?;
    Some(search.join())
}

struct Search<'a> {
    graph: &'a Graph,
    prices: &'a Prices,
    /// The cuts with a charge that each target is in.
    cuts_of: Vec<Vec<usize>>,
    limit: f64,
    effort: Effort,
    completion: Option<Completion>,
    labels: Vec<Label>,
    /// Undominated labels of each node, by what they have collected, most first.
    kept: Vec<Vec<usize>>,
}

impl Search<'_> {
    /// All undominated labels up to half the limit that some route of more than 1 may go through.
    fn grow(&mut self) -> Option<()> {
        let n = self.graph.nodes;
        let remembered: Vec<u128> = (0..n)
            .map(|v| self.graph.near[v].iter().take(NEIGHBOURHOOD - 1).fold(bit(v), |set, &w| set | bit(w)))
            .collect();
        let parities = Parities::default();
        self.labels.push(Label { length: 0.0, collected: 0.0, memory: 0, parities, target: 0, before: 0 });
        let mut queue = BinaryHeap::new();
        let mut next = Some(0);
        while let Some(index) = next {
            if self.keep(index) {
                self.extend(index, &remembered, &mut queue);
            }
            if self.labels.len() > LABELS {
                return None;
            }
            next = queue.pop().map(|Reverse((_, index))| index);
        }
        Some(())
    }

    /// Keeps a label unless one that is no longer has collected as much, whatever charges it may yet have to pay, and remembers no more.
    fn keep(&mut self, index: usize) -> bool {
        let label = &self.labels[index];
        let rivals = &self.kept[label.target as usize];
        let mut place = 0;
        for &rival in rivals {
            let rival = &self.labels[rival];
            if rival.collected < label.collected - EPSILON {
                break;
            }
            let charge = || rival.parities.charge_beyond(&label.parities, &self.prices.charges);
            let exact = || {
                rival.memory & !label.memory == 0 && rival.collected - charge() >= label.collected - EPSILON
            };
            if self.effort == Effort::Quick || exact() {
                return false;
            }
            place += 1;
        }
        self.kept[label.target as usize].insert(place, index);
        true
    }

    fn extend(
        &mut self,
        index: usize,
        remembered: &[u128],
        queue: &mut BinaryHeap<Reverse<(Length, usize)>>,
    ) {
        let Label { length, collected, memory, parities, target, .. } = self.labels[index];
        for next in 1..self.graph.nodes {
            if next == target as usize || memory & bit(next) != 0 || self.prices.prizes[next] <= 0.0 {
                continue;
            }
            let length = length + self.graph.leg(target as usize, next);
            let mut collected = collected + self.prices.prizes[next];
            if length > 0.5 * self.limit * (1.0 + EPSILON) {
                continue;
            }
            let rest = self.limit - length;
            if self.completion.as_ref().is_some_and(|c| collected + c.most(next, rest) <= 1.0) {
                continue;
            }
            let mut parities = parities;
            for &cut in &self.cuts_of[next] {
                if parities.flip(cut) {
                    collected -= self.prices.charges[cut];
                }
            }
            let memory = memory & remembered[next] | bit(next);
            queue.push(Reverse((Length(length), self.labels.len())));
            let (target, before) = (next as u32, index as u32);
            self.labels.push(Label { length, collected, memory, parities, target, before });
        }
    }

    /// For each leg in the middle the best route over it that collects more than 1.
    fn join(&self) -> Priced {
        let mut best: Vec<(f64, usize, usize)> = vec![];
        for u in 0..self.graph.nodes {
            for v in u + 1..self.graph.nodes {
                best.extend(self.join_over(u, v));
            }
        }
        best.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let most = best.first().map_or(1.0, |b| b.0);
        let routes = best.iter().take(ROUTES).map(|&(_, a, b)| self.route(a, b)).collect();
        Priced { most, routes }
    }

    fn join_over(&self, u: usize, v: usize) -> Option<(f64, usize, usize)> {
        let mut best = (1.0, 0, 0);
        let first = self.labels[*self.kept[v].first()?].collected;
        for &a in &self.kept[u] {
            let head = &self.labels[a];
            if head.collected + first <= best.0 + EPSILON {
                break;
            }
            let rest = self.limit * (1.0 + EPSILON) - self.graph.leg(u, v) - head.length;
            for &b in &self.kept[v] {
                let tail = &self.labels[b];
                let collected = head.collected + tail.collected;
                if collected <= best.0 + EPSILON {
                    break;
                }
                if tail.length <= rest && head.memory & tail.memory == 0 {
                    let charge = head.parities.charge_of_both(&tail.parities, &self.prices.charges);
                    if collected - charge > best.0 + EPSILON {
                        best = (collected - charge, a, b);
                    }
                }
            }
        }
        (best.0 > 1.0).then_some(best)
    }

    /// The targets of a first half and of one backwards.
    fn route(&self, head: usize, tail: usize) -> Vec<usize> {
        let mut route = self.path(head);
        route.reverse();
        route.extend(self.path(tail));
        route
    }

    /// Targets of a label from its end to the depot.
    fn path(&self, mut index: usize) -> Vec<usize> {
        let mut path = vec![];
        while index != 0 {
            path.push(self.labels[index].target as usize);
            index = self.labels[index].before as usize;
        }
        path
    }
}

/// The bit of a target; the depot is never remembered.
fn bit(target: usize) -> u128 {
    const _: () = assert!(TARGETS <= 128);
    if target == 0 { 0 } else { 1 << (target - 1) }
}
