//! Paths as tours: one more vertex joins the ends.

use crate::error::Error;
use crate::metric::Metric;
use crate::tour::Ends;

/// A metric with one more vertex, the joint, at distance zero from everything and at a large negative distance from the
/// ends that are fixed: the best tour opened at the joint is the best path, and no improvement removes a fixed end.
#[derive(Debug)]
pub(crate) struct Pinned<'a, M> {
    metric: &'a M,
    ends: Ends,
    bond: f64,
}

impl<'a, M: Metric> Pinned<'a, M> {
    /// `reach` is at least the length of the path to improve: a bond of twice that is never worth breaking.
    pub fn new(metric: &'a M, ends: Ends, reach: f64) -> Self {
        Pinned { metric, ends, bond: -2.0 * reach }
    }

    fn joint(&self) -> usize {
        self.metric.len()
    }

    /// What the fixed ends add to the length of every path when it is closed.
    pub fn offset(&self) -> f64 {
        match self.ends {
            Ends::Free => 0.0,
            Ends::Start(_) => self.bond,
            Ends::Both(..) => 2.0 * self.bond,
        }
    }

    /// The tour of a path.
    pub fn close(&self, mut order: Vec<usize>) -> Vec<usize> {
        order.push(self.joint());
        order
    }

    /// The path of a tour, in the direction that starts at the fixed start.
    pub fn open(&self, order: Vec<usize>) -> Vec<usize> {
        let joint = order.iter().position(|&v| v == self.joint()).unwrap_or(0);
        let mut path: Vec<usize> = order[joint + 1..].iter().chain(&order[..joint]).copied().collect();
        let is_backward = match self.ends {
            Ends::Free => false,
            Ends::Start(start) | Ends::Both(start, _) => path.first() != Some(&start),
        };
        if is_backward {
            path.reverse();
        }
        path
    }
}

impl<M: Metric> Metric for Pinned<'_, M> {
    fn len(&self) -> usize {
        self.metric.len() + 1
    }

    #[inline]
    fn distance(&self, i: usize, j: usize) -> f64 {
        let (low, high) = (i.min(j), i.max(j));
        if high < self.joint() {
            return self.metric.distance(i, j);
        }
        let is_fixed = match self.ends {
            Ends::Free => false,
            Ends::Start(start) => low == start,
            Ends::Both(start, end) => low == start || low == end,
        };
        if is_fixed { self.bond } else { 0.0 }
    }

    fn is_metric(&self) -> bool {
        false
    }
}

/// Refuses a path that has not the ends it should have.
pub(crate) fn check_ends(order: &[usize], ends: Ends) -> Result<(), Error> {
    let (first, last) = (order.first().copied(), order.last().copied());
    match ends {
        Ends::Start(start) | Ends::Both(start, _) if first != Some(start) => {
            Err(Error::NotAPermutation { vertex: start })
        }
        Ends::Both(_, end) if last != Some(end) => Err(Error::NotAPermutation { vertex: end }),
        _ => Ok(()),
    }
}
