//! Chained local search: kick, repair, keep what is no worse (Martin, Otto, Felten 1991; Applegate, Cook, Rohe 2003).
//!
//! To keep slightly longer tours for a while as well (record-to-record travel, Dueck 1993) changed what 20 seeds found in equal
//! time by little more than noise, for better on pcb442 and uniform points and for worse on ch150 and rat783; it is left out.

use super::kick::kick;
use super::lin_kernighan::{Arrays, Search};
use super::neighbours::Neighbours;
use crate::metric::Metric;
use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use std::collections::VecDeque;

/// Vertices to be looked at between two questions whether to stop.
const PATIENCE: usize = 256;

/// Improvements per vertex between two kicks, far more than a real descent takes: gains of distances that are not finite
/// or not symmetric, or that drown in rounding, may be imagined without end.
const IMPROVEMENTS: usize = 50;

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

/// Storage of the chained search; holds the tour from which it starts and, afterwards, the one at which it ended.
#[derive(Debug, Default)]
pub(crate) struct Chain {
    agenda: Agenda,
    pub arrays: Arrays,
}

impl Chain {
    /// Improves the tour (at least eight vertices); it is left as it is when the effort ends.
    pub fn run(&mut self, metric: &impl Metric, neighbours: &Neighbours, effort: Effort<'_>) {
        let tour = &self.arrays.tour;
        self.agenda.queue.clear();
        self.agenda.is_waiting.clear();
        self.agenda.is_waiting.resize(tour.len(), false);
        tour.order().iter().for_each(|&v| self.agenda.push(v));
        let mut search = Search::new(metric, neighbours, &mut self.arrays);
        chained(&mut search, &mut self.agenda, effort);
        self.arrays = search.into_arrays();
    }
}

fn chained<M: Metric>(search: &mut Search<'_, M>, agenda: &mut Agenda, effort: Effort<'_>) {
    let n = search.tour.len();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(effort.seed);
    let mut looked = 0;
    let mut improvements = 0;
    let mut kicks = 0;
    // The gain since the last kick, negative while the kick is not yet repaired.
    let mut gain = 0.0;
    loop {
        while let Some(v) = agenda.pop() {
            looked += 1;
            if looked % PATIENCE == 0 && (effort.should_stop)() {
                if gain < 0.0 {
                    search.roll_back(0);
                }
                return;
            }
            while let Some(gained) = search.improve_at(v) {
                improvements += 1;
                if improvements > IMPROVEMENTS * n {
                    return;
                }
                gain += gained;
                search.touched.iter().for_each(|&u| agenda.push(u));
            }
            if kicks == 0 {
                search.log.clear();
            }
        }
        if gain < 0.0 {
            search.roll_back(0);
        }
        if kicks == effort.kicks {
            return;
        }
        kicks += 1;
        improvements = 0;
        search.log.clear();
        gain = kick(search, &mut rng);
        search.touched.iter().for_each(|&v| agenda.push(v));
    }
}
