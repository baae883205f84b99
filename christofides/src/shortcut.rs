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
    let mut ring = Ring::default();
    ring.shortcut(metric, walk)?;
    Ok(Tour::measured(metric, ring.order(walk).collect()))
}

/// The walk as a doubly linked list of positions.
#[derive(Debug, Default)]
pub(crate) struct Ring {
    visits: Vec<(usize, usize)>,
    next: Vec<usize>,
    previous: Vec<usize>,
    is_removed: Vec<bool>,
}

impl Ring {
    /// See [`shortcut`].
    pub fn shortcut(&mut self, metric: &impl Metric, walk: &[usize]) -> Result<(), Error> {
        self.close(metric.len(), walk)?;
        let visits = std::mem::take(&mut self.visits);
        let mut expected = 0;
        for group in visits.chunk_by(|a, b| a.0 == b.0) {
            if group[0].0 != expected {
                break;
            }
            expected += 1;
            self.keep_one(metric, walk, group);
        }
        self.visits = visits;
        if expected < metric.len() { Err(Error::NotAPermutation { vertex: expected }) } else { Ok(()) }
    }

    /// Links every position with the next one, the last with the first.
    fn close(&mut self, n: usize, walk: &[usize]) -> Result<(), Error> {
        let len = walk.len();
        self.visits.clear();
        for (position, &vertex) in walk.iter().enumerate() {
            if vertex >= n {
                return Err(Error::VertexOutOfRange { vertex, n });
            }
            self.visits.push((vertex, position));
        }
        self.visits.sort_unstable();
        self.next.clear();
        self.next.extend((1..len).chain((len > 0).then_some(0)));
        self.previous.clear();
        self.previous.extend((len > 0).then(|| len - 1).into_iter().chain(0..len.saturating_sub(1)));
        self.is_removed.clear();
        self.is_removed.resize(len, false);
        Ok(())
    }

    fn keep_one(&mut self, metric: &impl Metric, walk: &[usize], visits: &[(usize, usize)]) {
        if visits.len() == 1 {
            return;
        }
        let mut kept = visits[0].1;
        let mut least = f64::INFINITY;
        for &(vertex, position) in visits {
            let before = walk[self.previous[position]];
            let after = walk[self.next[position]];
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

    /// The remaining visits, from the first one of vertex 0 on.
    pub fn order<'a>(&'a self, walk: &'a [usize]) -> impl Iterator<Item = usize> + 'a {
        let start = self.visits.first().map_or(0, |visit| visit.1);
        let positions = (start..walk.len()).chain(0..start);
        positions.filter(|&position| !self.is_removed[position]).map(|position| walk[position])
    }
}
