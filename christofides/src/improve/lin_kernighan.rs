//! Lin and Kernighan's search in steps of sequential 3-opt exchanges.
//!
//! Notation of Lin and Kernighan (1973): edges `(t1, t2)`, `(t3, t4)`, `(t5, t6)` are removed, `(t2, t3)`, `(t4, t5)` and the
//! closing `(t6, t1)` added. The tour is read so that `t2` follows `t1`. A step takes the best closed exchange if it
//! gains; else the one with the greatest gain before closing is made and the next step starts from its open end, as in
//! Helsgaun (2000).

use super::array_tour::ArrayTour;
use super::neighbours::Neighbours;
use crate::metric::Metric;

/// Most steps in a chain.
const DEPTH: usize = 50;

/// Neighbours of `t4` that are tried: of `t2` all are. Eight gave longer tours in equal time.
const BREADTH: usize = 5;

/// A sequential exchange of two or three edges.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Exchange {
    /// The path `t2..t4` is reversed.
    Two { t4: u32, t3: u32 },
    /// A first reversal, then a second one that leads to `t6`.
    TwoTwo { t4: u32, t3: u32, t5: u32, t6: u32 },
    /// The paths `t2..t5` and `t6..t3` change places.
    Swap { t3: u32, t4: u32, t5: u32, t6: u32 },
    /// The paths `t2..t6` and `t5..t3` are reversed in their places.
    Reverse { t3: u32, t4: u32, t5: u32, t6: u32 },
}

/// The state of a local search: tour, undo log, vertices to look at.
#[derive(Debug)]
pub(crate) struct Search<'a, M> {
    pub metric: &'a M,
    pub neighbours: &'a Neighbours,
    pub tour: ArrayTour,
    /// Ends of the reversed paths, in the order of the reversals and in the direction of reading at the start.
    pub log: Vec<(u32, u32)>,
    /// Whether the tour is read in the other direction than at the start.
    is_turned: bool,
    /// Ends of edges that the last improvement changed.
    pub touched: Vec<u32>,
    added: Vec<(u32, u32)>,
}

/// Storage of a search.
#[derive(Debug, Default)]
pub(crate) struct Arrays {
    pub tour: ArrayTour,
    log: Vec<(u32, u32)>,
    touched: Vec<u32>,
    added: Vec<(u32, u32)>,
}

/// The better of two candidates, by their gain.
fn offer(best: &mut Option<(f64, Exchange)>, gain: f64, exchange: Exchange) {
    if best.is_none_or(|(greatest, _)| gain > greatest) {
        *best = Some((gain, exchange));
    }
}

impl<'a, M: Metric> Search<'a, M> {
    /// A search from the tour in `arrays`, which lends its storage.
    pub fn new(metric: &'a M, neighbours: &'a Neighbours, arrays: &mut Arrays) -> Self {
        let Arrays { tour, mut log, touched, added } = std::mem::take(arrays);
        log.clear();
        Search { metric, neighbours, tour, log, is_turned: false, touched, added }
    }

    /// The storage with the tour as it is.
    pub fn into_arrays(self) -> Arrays {
        Arrays { tour: self.tour, log: self.log, touched: self.touched, added: self.added }
    }

    #[inline]
    pub fn distance(&self, i: u32, j: u32) -> f64 {
        self.metric.distance(i as usize, j as usize)
    }

    pub fn reverse(&mut self, a: u32, b: u32) {
        self.tour.reverse(a, b);
        self.log.push(if self.is_turned { (a, b) } else { (b, a) });
    }

    /// Undoes reversals until `len` are left in the log.
    pub fn roll_back(&mut self, len: usize) {
        while self.log.len() > len {
            if let Some((a, b)) = self.log.pop() {
                let (a, b) = if self.is_turned { (b, a) } else { (a, b) };
                self.tour.reverse(a, b);
            }
        }
    }

    /// Searches chains that remove an edge at `t1`; returns the gain made, with the changed vertices in `touched`.
    pub fn improve_at(&mut self, t1: u32) -> Option<f64> {
        for _ in 0..2 {
            let gain = self.chain(t1);
            if gain.is_some() {
                return gain;
            }
            self.tour.turn();
            self.is_turned = !self.is_turned;
        }
        None
    }

    fn chain(&mut self, t1: u32) -> Option<f64> {
        let start = self.log.len();
        let mut t2 = self.tour.next(t1);
        let mut open = self.distance(t1, t2);
        let least = 1e-10 * open.abs();
        self.touched.clear();
        self.touched.extend([t1, t2]);
        self.added.clear();
        for _ in 0..DEPTH {
            let (closed, best) = self.step(t1, t2, open);
            if let Some((gain, exchange)) = closed.filter(|&(gain, _)| gain > least) {
                self.make(t1, t2, exchange);
                return Some(gain);
            }
            let Some((gain, exchange)) = best else { break };
            t2 = self.make(t1, t2, exchange);
            open = gain;
        }
        self.roll_back(start);
        None
    }

    /// The best closed exchange with its gain, and the best open one with its gain before closing.
    #[allow(clippy::type_complexity)]
    fn step(&self, t1: u32, t2: u32, open: f64) -> (Option<(f64, Exchange)>, Option<(f64, Exchange)>) {
        let (mut closed, mut best) = (None, None);
        let after = self.tour.next(t2);
        for &(length, t3) in self.neighbours.of(t2) {
            let g1 = open - length;
            if g1 <= 0.0 {
                break;
            }
            if t3 == t1 || t3 == after {
                continue;
            }
            self.step_reversing(t1, t2, t3, g1, &mut closed, &mut best);
            self.step_inside(t1, t2, t3, g1, &mut closed, &mut best);
        }
        (closed, best)
    }

    fn is_added(&self, u: u32, v: u32) -> bool {
        self.added.iter().any(|&edge| edge == (u, v) || edge == (v, u))
    }

    /// Offers an exchange that the edge `(last, t1)` closes; its length is measured only if it can matter.
    #[inline]
    fn offer_closed(
        &self,
        closed: &mut Option<(f64, Exchange)>,
        gain: f64,
        last: u32,
        t1: u32,
        exchange: Exchange,
    ) {
        if closed.is_none_or(|(greatest, _)| gain > greatest) {
            offer(closed, gain - self.distance(last, t1), exchange);
        }
    }

    /// `t4` before `t3`: the exchange can be closed after two edges.
    #[inline]
    fn step_reversing(
        &self,
        t1: u32,
        t2: u32,
        t3: u32,
        g1: f64,
        closed: &mut Option<(f64, Exchange)>,
        best: &mut Option<(f64, Exchange)>,
    ) {
        let t4 = self.tour.previous(t3);
        if self.is_added(t3, t4) {
            return;
        }
        let g2 = g1 + self.distance(t3, t4);
        self.offer_closed(closed, g2, t4, t1, Exchange::Two { t4, t3 });
        let after = self.tour.next(t4);
        let before = self.tour.previous(t4);
        for &(length, t5) in self.neighbours.of(t4).iter().take(BREADTH) {
            let g3 = g2 - length;
            if g3 <= 0.0 {
                break;
            }
            if t5 == after || t5 == before || t5 == t1 {
                continue;
            }
            // The path t2..t4 is read backwards after the first reversal.
            let is_inside = self.tour.between(t2, t5, t4);
            let t6 = if is_inside { self.tour.next(t5) } else { self.tour.previous(t5) };
            if self.is_added(t5, t6) {
                continue;
            }
            let exchange = Exchange::TwoTwo { t4, t3, t5, t6 };
            let gain = g3 + self.distance(t5, t6);
            self.offer_closed(closed, gain, t6, t1, exchange);
            offer(best, gain, exchange);
        }
    }

    /// `t4` after `t3`: only a `t5` on the path `t2..t3` makes a tour again.
    #[inline]
    fn step_inside(
        &self,
        t1: u32,
        t2: u32,
        t3: u32,
        g1: f64,
        closed: &mut Option<(f64, Exchange)>,
        best: &mut Option<(f64, Exchange)>,
    ) {
        let t4 = self.tour.next(t3);
        if self.is_added(t3, t4) {
            return;
        }
        let g2 = g1 + self.distance(t3, t4);
        for &(length, t5) in self.neighbours.of(t4).iter().take(BREADTH) {
            let g3 = g2 - length;
            if g3 <= 0.0 {
                break;
            }
            if t5 == t3 || t5 == t1 || !self.tour.between(t2, t5, t3) {
                continue;
            }
            let next = self.tour.next(t5);
            if !self.is_added(t5, next) {
                let exchange = Exchange::Swap { t3, t4, t5, t6: next };
                let gain = g3 + self.distance(t5, next);
                self.offer_closed(closed, gain, next, t1, exchange);
                offer(best, gain, exchange);
            }
            if t5 != t2 {
                let previous = self.tour.previous(t5);
                if !self.is_added(t5, previous) {
                    let exchange = Exchange::Reverse { t3, t4, t5, t6: previous };
                    let gain = g3 + self.distance(t5, previous);
                    self.offer_closed(closed, gain, previous, t1, exchange);
                    offer(best, gain, exchange);
                }
            }
        }
    }

    /// Makes an exchange and returns the vertex that follows `t1` then.
    fn make(&mut self, t1: u32, t2: u32, exchange: Exchange) -> u32 {
        match exchange {
            Exchange::Two { t4, t3 } => {
                self.reverse(t2, t4);
                self.touched.extend([t3, t4]);
                t4
            }
            Exchange::TwoTwo { t4, t3, t5, t6 } => {
                self.reverse(t2, t4);
                self.reverse(t4, t6);
                self.note(t2, [t3, t4, t5, t6])
            }
            Exchange::Swap { t3, t4, t5, t6 } => {
                self.reverse(t2, t3);
                self.reverse(t3, t6);
                self.reverse(t5, t2);
                debug_assert!(t1 == t4 || self.tour.next(t1) == t6);
                self.note(t2, [t3, t4, t5, t6])
            }
            Exchange::Reverse { t3, t4, t5, t6 } => {
                self.reverse(t2, t6);
                self.reverse(t5, t3);
                self.note(t2, [t3, t4, t5, t6])
            }
        }
    }

    fn note(&mut self, t2: u32, [t3, t4, t5, t6]: [u32; 4]) -> u32 {
        self.touched.extend([t3, t4, t5, t6]);
        self.added.extend([(t2, t3), (t4, t5)]);
        t6
    }
}
