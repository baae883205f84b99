//! Where targets and vehicles can be: points, or the nodes of any metric.

use crate::error::Error;
use christofides::Metric;

/// The places of a [`Fleet`](crate::Fleet) and the distances between them.
///
/// Open trait. Distances are symmetric, finite and not negative; a trip over others is refused with [`Error::Tour`].
pub trait Space {
    /// A place where a target or a vehicle can be.
    type Place: Clone + std::fmt::Debug;

    /// The distance between two places.
    fn distance(&self, a: &Self::Place, b: &Self::Place) -> f64;

    /// How far a place is from a cluster, of which there is at least one member: by default the mean distance to the members, as
    /// average linkage has it.
    fn distance_to_cluster(&self, place: &Self::Place, members: &[Self::Place]) -> f64 {
        members.iter().map(|member| self.distance(place, member)).sum::<f64>() / members.len() as f64
    }

    /// Refuses what is no place.
    ///
    /// # Errors
    /// Any; events with such a place change nothing and return it.
    fn check(&self, place: &Self::Place) -> Result<(), Error>;
}

/// Points with `D` coordinates; a cluster is as far as its centroid (the paper's Algorithm 3).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Euclidean<const D: usize>;

impl<const D: usize> Space for Euclidean<D> {
    type Place = [f64; D];

    fn distance(&self, a: &[f64; D], b: &[f64; D]) -> f64 {
        a.iter().zip(b).fold(0.0, |sum: f64, (x, y)| sum.hypot(x - y))
    }

    fn distance_to_cluster(&self, place: &[f64; D], members: &[[f64; D]]) -> f64 {
        let mut centroid = [0.0; D];
        for member in members {
            for (sum, x) in centroid.iter_mut().zip(member) {
                *sum += x / members.len() as f64;
            }
        }
        self.distance(place, &centroid)
    }

    fn check(&self, place: &[f64; D]) -> Result<(), Error> {
        match place.iter().position(|x| !x.is_finite()) {
            Some(axis) => Err(Error::NonFinitePosition { axis }),
            None => Ok(()),
        }
    }
}

/// The nodes of a metric: roads, flight times around obstacles, whatever has distances but no coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Nodes<M>(
    /// The metric.
    pub M,
);

impl<M: Metric> Space for Nodes<M> {
    type Place = usize;

    fn distance(&self, a: &usize, b: &usize) -> f64 {
        self.0.distance(*a, *b)
    }

    fn check(&self, place: &usize) -> Result<(), Error> {
        let (node, nodes) = (*place, self.0.len());
        if node < nodes { Ok(()) } else { Err(Error::UnknownNode { node, nodes }) }
    }
}
