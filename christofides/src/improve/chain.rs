//! Chained local search: kick, repair, keep what is no worse (Martin, Otto, Felten 1991; Applegate, Cook, Rohe 2003), and the
//! same once more around it (nested iterated local search, Lourenço, Martin, Stützle 2003).
//!
//! Single kicks rarely leave a local optimum that differs from the best tour in a whole region. So now and then one place
//! is stirred by several kicks at once, settled by kicks near it, and kept if the tour is no longer.
//!
//! To keep slightly longer tours for a while as well (record-to-record travel, Dueck 1993) changed what 20 seeds found in equal
//! time by little more than noise, for better on pcb442 and uniform points and for worse on ch150 and rat783; it is left out.

use super::kick::{below, kick};
use super::lin_kernighan::{Arrays, Search};
use super::neighbours::Neighbours;
use crate::metric::Metric;
use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use std::collections::VecDeque;
use std::ops::ControlFlow;

/// Vertices to be looked at between two questions whether to stop.
const PATIENCE: usize = 256;

/// Improvements per vertex between two kicks, far more than a real descent takes: gains of distances that are not finite
/// or not symmetric, or that drown in rounding, may be imagined without end.
const IMPROVEMENTS: usize = 50;

/// Kicks all over the tour between two stirred places.
const PERIOD: usize = 20;

/// Steps of the random walks that choose the edges of a kick. On 400 to 1000 vertices in equal
/// time, 20 to 50 steps gave shorter tours than 3 to 10; among 20 to 50 the differences were within the noise of ten seeds.
const WALK: usize = 30;

/// Kicks that stir a place at once, and the steps of their walks. Over 60 seeds in equal time, 10 and 20 kicks to stir and to
/// settle, every 20, had a lower mean excess than no stirring on all of ch150, pcb442, rat783, pr1002 and 1000 uniform points;
/// 30 to stir or 50 to settle gained more on some of these and lost on others.
const STIR: usize = 10;
const STIR_WALK: usize = 10;

/// Kicks, one after the other, near a place that has been stirred, and the steps of their walks.
const SETTLE: usize = 20;
const SETTLE_WALK: usize = 20;

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
        let mut chained = Chained {
            search: Search::new(metric, neighbours, &mut self.arrays),
            agenda: &mut self.agenda,
            rng: Xoshiro256PlusPlus::seed_from_u64(effort.seed),
            effort,
            looked: 0,
            improvements: 0,
            gain: 0.0,
        };
        if chained.run().is_break() && chained.gain < 0.0 {
            chained.search.roll_back(0);
        }
        self.arrays = chained.search.into_arrays();
    }
}

/// A running search.
struct Chained<'a, 'e, M> {
    search: Search<'a, M>,
    agenda: &'a mut Agenda,
    rng: Xoshiro256PlusPlus,
    effort: Effort<'e>,
    looked: usize,
    improvements: usize,
    /// The gain since the log was cleared, negative while kicks are not yet repaired.
    gain: f64,
}

impl<M: Metric> Chained<'_, '_, M> {
    /// Descends from the first tour, then kicks; breaks when the kicks are used up or the caller wants no more.
    fn run(&mut self) -> ControlFlow<()> {
        while let Some(v) = self.agenda.pop() {
            self.improve_at(v)?;
            self.keep();
        }
        loop {
            for _ in 0..PERIOD {
                let origin = below(&mut self.rng, self.search.tour.len()) as u32;
                self.attempt(origin, WALK)?;
                self.keep();
            }
            self.stir()?;
            self.keep();
        }
    }

    /// Stirs a place, settles it, and undoes all of it if the tour became longer.
    fn stir(&mut self) -> ControlFlow<()> {
        let origin = below(&mut self.rng, self.search.tour.len()) as u32;
        for _ in 0..STIR {
            self.kick(origin, STIR_WALK)?;
        }
        self.repair()?;
        for _ in 0..SETTLE {
            self.attempt(origin, SETTLE_WALK)?;
        }
        if self.gain < 0.0 {
            self.search.roll_back(0);
        }
        ControlFlow::Continue(())
    }

    /// Kicks near `origin`, repairs, and undoes both if the tour became longer.
    fn attempt(&mut self, origin: u32, walk: usize) -> ControlFlow<()> {
        let (reversals, gain) = (self.search.log.len(), self.gain);
        self.kick(origin, walk)?;
        self.repair()?;
        if self.gain < gain {
            self.search.roll_back(reversals);
            self.gain = gain;
        }
        ControlFlow::Continue(())
    }

    fn kick(&mut self, origin: u32, walk: usize) -> ControlFlow<()> {
        if self.effort.kicks == 0 {
            return ControlFlow::Break(());
        }
        self.effort.kicks -= 1;
        self.improvements = 0;
        self.gain += kick(&mut self.search, &mut self.rng, origin, walk);
        self.search.touched.iter().for_each(|&v| self.agenda.push(v));
        ControlFlow::Continue(())
    }

    fn repair(&mut self) -> ControlFlow<()> {
        while let Some(v) = self.agenda.pop() {
            self.improve_at(v)?;
        }
        ControlFlow::Continue(())
    }

    fn improve_at(&mut self, v: u32) -> ControlFlow<()> {
        self.looked += 1;
        if self.looked.is_multiple_of(PATIENCE) && (self.effort.should_stop)() {
            return ControlFlow::Break(());
        }
        while let Some(gained) = self.search.improve_at(v) {
            self.improvements += 1;
            if self.improvements > IMPROVEMENTS * self.search.tour.len() {
                return ControlFlow::Break(());
            }
            self.gain += gained;
            self.search.touched.iter().for_each(|&u| self.agenda.push(u));
        }
        ControlFlow::Continue(())
    }

    /// Takes the tour as it is for the one to return to.
    fn keep(&mut self) {
        self.search.log.clear();
        self.gain = 0.0;
    }
}
