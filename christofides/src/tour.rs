//! A closed tour and an open path, with what is known about them.

use crate::error::Error;
use crate::metric::Metric;

/// A cyclic tour: every vertex once, the closing edge implied.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use]
pub struct Tour {
    order: Vec<usize>,
    cost: f64,
    lower_bound: Option<f64>,
}

/// An open path: every vertex once, no closing edge.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use]
pub struct Path {
    order: Vec<usize>,
    cost: f64,
    lower_bound: Option<f64>,
}

/// Which ends of a path are given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Ends {
    /// The path may start and end anywhere.
    #[default]
    Free,
    /// The path starts here and may end anywhere.
    Start(usize),
    /// The path starts at the first and ends at the second vertex.
    Both(usize, usize),
}

impl Ends {
    /// Whether the named vertices exist and fit a path over `n` vertices.
    pub(crate) fn validate(self, n: usize) -> Result<(), Error> {
        let named = match self {
            Ends::Free => [None, None],
            Ends::Start(start) => [Some(start), None],
            Ends::Both(start, end) => [Some(start), Some(end)],
        };
        if let Some(vertex) = named.into_iter().flatten().find(|&vertex| vertex >= n) {
            return Err(Error::VertexOutOfRange { vertex, n });
        }
        match self {
            Ends::Both(start, end) if start == end && n > 1 => Err(Error::EqualEnds { vertex: start, n }),
            _ => Ok(()),
        }
    }
}

macro_rules! ordered {
    ($name:ident, $edges:ident) => {
        impl $name {
            /// Measures an order of all vertices.
            ///
            /// # Errors
            /// [`Error::NotAPermutation`], [`Error::VertexOutOfRange`] or [`Error::DimensionMismatch`].
            pub fn new(metric: &impl Metric, order: Vec<usize>) -> Result<Self, Error> {
                validate_permutation(&order, metric.len())?;
                Ok(Self::measured(metric, order))
            }

            pub(crate) fn measured(metric: &impl Metric, order: Vec<usize>) -> Self {
                let cost = $edges(&order).map(|(i, j)| metric.distance(i, j)).sum();
                Self { order, cost, lower_bound: None }
            }

            pub(crate) fn with_lower_bound(self, lower_bound: f64) -> Self {
                // A bound of an equally tight instance may be computed an ulp above a cost summed in another order.
                Self { lower_bound: Some(lower_bound.min(self.cost)), ..self }
            }

            /// The vertices in the order of the visit.
            #[must_use]
            pub fn order(&self) -> &[usize] {
                &self.order
            }

            /// The vertices in the order of the visit, taken out.
            #[must_use]
            pub fn into_order(self) -> Vec<usize> {
                self.order
            }

            /// The sum of the distances along the order.
            #[must_use]
            pub fn cost(&self) -> f64 {
                self.cost
            }

            /// A proven lower bound on the least cost, if one was computed.
            #[must_use]
            pub fn lower_bound(&self) -> Option<f64> {
                self.lower_bound
            }

            /// `cost / lower_bound - 1`, if a bound was computed; zero proves that no cheaper one exists.
            #[must_use]
            pub fn gap(&self) -> Option<f64> {
                let gap = |bound: f64| if self.cost <= bound { 0.0 } else { self.cost / bound - 1.0 };
                self.lower_bound.map(gap)
            }
        }
    };
}

impl Tour {
    /// Takes over an order of all vertices into the storage of this one.
    pub(crate) fn replace(&mut self, metric: &impl Metric, order: impl Iterator<Item = usize>) {
        self.order.clear();
        self.order.extend(order);
        self.cost = tour_edges(&self.order).map(|(i, j)| metric.distance(i, j)).sum();
        self.lower_bound = None;
    }
}

ordered!(Tour, tour_edges);
ordered!(Path, path_edges);

/// Consecutive pairs of `order`, the closing one included.
pub(crate) fn tour_edges(order: &[usize]) -> impl Iterator<Item = (usize, usize)> + '_ {
    let closing = order.last().copied().into_iter().zip(order.first().copied());
    path_edges(order).chain(closing)
}

/// Consecutive pairs of `order`.
pub(crate) fn path_edges(order: &[usize]) -> impl Iterator<Item = (usize, usize)> + '_ {
    order.windows(2).map(|pair| (pair[0], pair[1]))
}

pub(crate) fn validate_permutation(order: &[usize], n: usize) -> Result<(), Error> {
    if order.len() != n {
        return Err(Error::DimensionMismatch { expected: n, found: order.len() });
    }
    let mut seen = vec![false; n];
    for &vertex in order {
        match seen.get_mut(vertex) {
            None => return Err(Error::VertexOutOfRange { vertex, n }),
            Some(true) => return Err(Error::NotAPermutation { vertex }),
            Some(slot) => *slot = true,
        }
    }
    Ok(())
}
