//! Chained local search: kick, repair, keep what is no worse (Martin, Otto, Felten 1991; Applegate, Cook, Rohe 2003).

use super::array_tour::ArrayTour;
use super::lin_kernighan::Search;
use super::neighbours::Neighbours;
use crate::metric::Metric;
use rand::rngs::Xoshiro256PlusPlus;
use rand::{Rng, SeedableRng};
use std::collections::VecDeque;

/// Longest of the three pieces that a kick permutes, in vertices.
const PIECE: usize = 100;

/// Vertices to be looked at between two questions whether to stop.
const PATIENCE: usize = 256;

/// How long to go on.
pub(crate) struct Effort<'a> {
    pub kicks: usize,
    pub seed: u64,
    pub should_stop: &'a mut dyn FnMut() -> bool,
}

/// Vertices that wait to be looked at, each at most once.
#[derive(Debug, Default)]
struct Agenda {
    queue: VecDeque<u32>,
    is_waiting: Vec<bool>,
}

impl Agenda {
    fn push(&mut self, v: u32) {
        if !std::mem::replace(&mut self.is_waiting[v as usize], true) {
            self.queue.push_back(v);
        }
    }

    fn pop(&mut self) -> Option<u32> {
        let v = self.queue.pop_front()?;
        self.is_waiting[v as usize] = false;
        Some(v)
    }
}

/// Improves `order` (at least eight vertices) and returns it as it is when the effort ends.
pub(crate) fn chained(
    metric: &impl Metric,
    neighbours: &Neighbours,
    order: Vec<u32>,
    effort: Effort<'_>,
) -> Vec<u32> {
    let n = order.len();
    let mut agenda = Agenda { queue: VecDeque::with_capacity(n), is_waiting: vec![false; n] };
    order.iter().for_each(|&v| agenda.push(v));
    let mut search = Search::new(metric, neighbours, ArrayTour::new(order));
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(effort.seed);
    let mut looked = 0;
    let mut kick = 0;
    // The gain since the last kick, negative while the kick is not yet repaired.
    let mut gain = 0.0;
    loop {
        while let Some(v) = agenda.pop() {
            looked += 1;
            if looked % PATIENCE == 0 && (effort.should_stop)() {
                if gain < 0.0 {
                    search.roll_back(0);
                }
                return search.tour.order().to_vec();
            }
            while let Some(gained) = search.improve_at(v) {
                gain += gained;
                search.touched.iter().for_each(|&u| agenda.push(u));
            }
            if kick == 0 {
                search.log.clear();
            }
        }
        if gain < 0.0 {
            search.roll_back(0);
        }
        if kick == effort.kicks {
            return search.tour.order().to_vec();
        }
        kick += 1;
        search.log.clear();
        gain = double_bridge(&mut search, &mut rng, &mut agenda);
    }
}

/// A number below `bound`, by a multiplication of high words; the bias of `bound / 2^64` does not matter here.
fn below(rng: &mut Xoshiro256PlusPlus, bound: usize) -> usize {
    ((u128::from(rng.next_u64()) * bound as u128) >> 64) as usize
}

/// Puts three consecutive short pieces into the opposite order, each in its direction; returns the gain.
fn double_bridge<M: Metric>(
    search: &mut Search<'_, M>,
    rng: &mut Xoshiro256PlusPlus,
    agenda: &mut Agenda,
) -> f64 {
    let n = search.tour.len();
    let piece = PIECE.min((n - 2) / 3);
    let before = below(rng, n) as u32;
    let mut ends = [(0, 0); 3];
    let mut last = before;
    for end in &mut ends {
        let first = search.tour.next(last);
        last = search.tour.ahead(first, below(rng, piece));
        *end = (first, last);
    }
    let after = search.tour.next(last);
    let [b, c, d] = ends;
    let removed = [(before, b.0), (b.1, c.0), (c.1, d.0), (d.1, after)];
    let added = [(before, d.0), (d.1, c.0), (c.1, b.0), (b.1, after)];
    search.reverse(b.0, d.1);
    search.reverse(d.1, d.0);
    search.reverse(c.1, c.0);
    search.reverse(b.1, b.0);
    removed.iter().for_each(|&(u, v)| {
        agenda.push(u);
        agenda.push(v);
    });
    let sum = |edges: [(u32, u32); 4]| edges.iter().map(|&(u, v)| search.distance(u, v)).sum::<f64>();
    sum(removed) - sum(added)
}
