//! A closed walk becomes a tour: of each vertex' visits one stays.

use crate::error::Error;
use crate::metric::Metric;
use crate::tour::Tour;

/// Shortcuts a closed walk that visits every vertex at least once.
///
/// The bound of Christofides' algorithm allows to drop visits in any order; each vertex keeps the visit whose removal
/// would save least, in the order of the vertices. In a metric the tour is no longer than the walk.
///
/// # Errors
/// [`Error::VertexOutOfRange`], or [`Error::NotAPermutation`] with a vertex that the walk misses.
///
/// # Complexity
/// `O(length of the walk)`.
pub fn shortcut(metric: &impl Metric, walk: &[usize]) -> Result<Tour, Error> {
    let n = metric.len();
    let mut visits: Vec<(usize, usize)> = Vec::with_capacity(walk.len());
    for (position, &vertex) in walk.iter().enumerate() {
        if vertex >= n {
            return Err(Error::VertexOutOfRange { vertex, n });
        }
        visits.push((vertex, position));
    }
    visits.sort_unstable();
    let mut ring = Ring::new(walk);
    let mut expected = 0;
    for group in visits.chunk_by(|a, b| a.0 == b.0) {
        if group[0].0 != expected {
            break;
        }
        expected += 1;
        ring.keep_one(metric, group);
    }
    if expected < n {
        return Err(Error::NotAPermutation { vertex: expected });
    }
    Ok(Tour::measured(metric, ring.into_order(visits.first().map_or(0, |visit| visit.1))))
}

/// The walk as a doubly linked list of positions.
struct Ring<'a> {
    walk: &'a [usize],
    next: Vec<usize>,
    previous: Vec<usize>,
    is_removed: Vec<bool>,
}

impl<'a> Ring<'a> {
    fn new(walk: &'a [usize]) -> Self {
        let len = walk.len();
        let next = (1..len).chain((len > 0).then_some(0)).collect();
        let previous = (len > 0).then(|| len - 1).into_iter().chain(0..len.saturating_sub(1)).collect();
        Ring { walk, next, previous, is_removed: vec![false; len] }
    }

    fn keep_one(&mut self, metric: &impl Metric, visits: &[(usize, usize)]) {
        if visits.len() == 1 {
            return;
        }
        let mut kept = visits[0].1;
        let mut least = f64::INFINITY;
        for &(vertex, position) in visits {
            let before = self.walk[self.previous[position]];
            let after = self.walk[self.next[position]];
            let saving = metric.distance(before, vertex) + metric.distance(vertex, after)
                - metric.distance(before, after);
            if saving < least {
                (kept, least) = (position, saving);
            }
        }
        for &(_, position) in visits.iter().filter(|visit| visit.1 != kept) {
            let (previous, next) = (self.previous[position], self.next[position]);
            self.next[previous] = next;
            self.previous[next] = previous;
            self.is_removed[position] = true;
        }
    }

    fn into_order(self, start: usize) -> Vec<usize> {
        let remaining =
            (start..self.walk.len()).chain(0..start).filter(|&position| !self.is_removed[position]);
        remaining.map(|position| self.walk[position]).collect()
    }
}
