//! A clustering that is kept current while points come, go and move.

use crate::error::{Error, check_finite};
use crate::geometry::squared_distance;
use std::collections::BTreeMap;

/// Clusters with current centroids, and how far they have drifted from a fresh clustering.
///
/// A new point is absorbed by the cluster with the nearest centroid (the lowest index on ties), which then moves; MacQueen's
/// update (1967). Points already there keep their cluster, so the clustering ages: see [`drift`](Self::drift).
#[derive(Debug, Clone)]
pub struct Online<const D: usize> {
    points: BTreeMap<usize, ([f64; D], usize)>,
    centroids: Vec<[f64; D]>,
    counts: Vec<usize>,
    next_id: usize,
    /// Mean squared distance to the centroids when the clustering was fresh.
    fresh: f64,
}

impl<const D: usize> Online<D> {
    /// Starts from a fresh clustering; point `i` gets the handle `i`. Centroids are computed anew from the labels.
    ///
    /// # Errors
    /// [`Error::NonFiniteCoordinate`]; [`Error::NoClusters`] without centroids; [`Error::UnknownLabel`]; [`Error::WeightCount`] if there are not as many
    /// labels as points.
    pub fn new(points: &[[f64; D]], labels: &[usize], centroids: &[[f64; D]]) -> Result<Self, Error> {
        check_finite(points)?;
        check_finite(centroids)?;
        if labels.len() != points.len() {
            return Err(Error::WeightCount { expected: points.len(), found: labels.len() });
        }
        let clusters = centroids.len();
        if clusters == 0 {
            return Err(Error::NoClusters);
        }
        let mut online = Self {
            points: BTreeMap::new(),
            centroids: centroids.to_vec(),
            counts: vec![0; clusters],
            next_id: points.len(),
            fresh: 0.0,
        };
        for (point, &label) in labels.iter().enumerate() {
            if label >= clusters {
                return Err(Error::UnknownLabel { point, label, clusters });
            }
            online.points.insert(point, (points[point], label));
            online.add(points[point], label);
        }
        online.fresh = online.mean_square();
        Ok(online)
    }

    /// Absorbs a point into the nearest cluster; returns its handle and label. O(k + log n).
    ///
    /// # Errors
    /// [`Error::NonFiniteCoordinate`].
    pub fn absorb(&mut self, point: [f64; D]) -> Result<(usize, usize), Error> {
        check_finite(&[point])?;
        let id = self.next_id;
        self.next_id += 1;
        Ok((id, self.put(id, point)))
    }

    /// Takes a point out; returns the label it had. The last point's centroid stays where it is.
    ///
    /// # Errors
    /// [`Error::UnknownPoint`].
    pub fn remove(&mut self, id: usize) -> Result<usize, Error> {
        let (point, label) = self.points.remove(&id).ok_or(Error::UnknownPoint { id })?;
        self.counts[label] -= 1;
        let count = self.counts[label] as f64;
        if count > 0.0 {
            for axis in 0..D {
                moved(&mut self.centroids[label][axis], point[axis], -count);
            }
        }
        Ok(label)
    }

    /// Moves a point, which is then absorbed anew under its old handle; returns its label.
    ///
    /// # Errors
    /// [`Error::UnknownPoint`], [`Error::NonFiniteCoordinate`].
    pub fn shift(&mut self, id: usize, to: [f64; D]) -> Result<usize, Error> {
        check_finite(&[to])?;
        self.remove(id)?;
        Ok(self.put(id, to))
    }

    /// The current centroids.
    #[must_use]
    pub fn centroids(&self) -> &[[f64; D]] {
        &self.centroids
    }

    /// The label of a point, if it is there.
    #[must_use]
    pub fn label(&self, id: usize) -> Option<usize> {
        self.points.get(&id).map(|entry| entry.1)
    }

    /// The handles of a cluster's points, ascending.
    #[must_use]
    pub fn members(&self, label: usize) -> Vec<usize> {
        self.points.iter().filter(|(_, entry)| entry.1 == label).map(|(id, _)| *id).collect()
    }

    /// How much looser the clusters are than when they were fresh: the mean squared distance to the centroids over what it
    /// was, less 1. Infinite if it was 0 and is not any more. O(n).
    #[must_use]
    pub fn drift(&self) -> f64 {
        let now = self.mean_square();
        if now <= self.fresh { 0.0 } else { now / self.fresh - 1.0 }
    }

    /// The share of points that are nearer to another cluster's centroid than to their own's, in 0..=1. O(n k).
    #[must_use]
    pub fn misplaced(&self) -> f64 {
        let wrong = |(point, label): &&([f64; D], usize)| self.nearest(point) != *label;
        self.points.values().filter(wrong).count() as f64 / self.points.len().max(1) as f64
    }

    /// Whether a fresh clustering would be worth it: the clusters are looser by a quarter, or a tenth of the points misplaced.
    #[must_use]
    pub fn is_stale(&self) -> bool {
        self.drift() > 0.25 || self.misplaced() > 0.1
    }

    fn put(&mut self, id: usize, point: [f64; D]) -> usize {
        let label = self.nearest(&point);
        self.points.insert(id, (point, label));
        self.add(point, label);
        label
    }

    fn add(&mut self, point: [f64; D], label: usize) {
        self.counts[label] += 1;
        let count = self.counts[label] as f64;
        if count == 1.0 {
            self.centroids[label] = point;
            return;
        }
        for axis in 0..D {
            moved(&mut self.centroids[label][axis], point[axis], count);
        }
    }

    fn nearest(&self, point: &[f64; D]) -> usize {
        let squared = |j: usize| squared_distance(point, &self.centroids[j]);
        (1..self.centroids.len()).fold(0, |best, j| if squared(j) < squared(best) { j } else { best })
    }

    fn mean_square(&self) -> f64 {
        let sum: f64 =
            self.points.values().map(|(p, label)| squared_distance(p, &self.centroids[*label])).sum();
        sum / self.points.len().max(1) as f64
    }
}

/// Moves a mean towards a coordinate by one part in `count`, away from it if that is negative. Divided first, for the difference of two
/// finite numbers may be none, and kept from rounding beyond the greatest number.
fn moved(mean: &mut f64, coordinate: f64, count: f64) {
    *mean = (*mean + (coordinate / count - *mean / count)).clamp(f64::MIN, f64::MAX);
}
