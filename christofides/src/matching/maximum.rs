//! Matchings of greatest weight or of greatest size, by a perfect matching of two copies of the graph.

use super::solver::{Solver, check_edges};
use crate::error::Error;

/// A matching that may leave vertices alone.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use]
pub struct PartialMatching {
    mates: Vec<Option<usize>>,
    weight: f64,
    error_bound: f64,
}

impl PartialMatching {
    /// The partner of every vertex that has one.
    #[must_use]
    pub fn mates(&self) -> &[Option<usize>] {
        &self.mates
    }

    /// The matched edges, smaller vertex first.
    pub fn edges(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.mates.iter().enumerate().filter_map(|(u, &mate)| mate.filter(|&v| u < v).map(|v| (u, v)))
    }

    /// The sum of the weights of the matched edges.
    #[must_use]
    pub fn weight(&self) -> f64 {
        self.weight
    }

    /// By how much the weight can be below the optimum, because weights are rounded to integers inside.
    #[must_use]
    pub fn error_bound(&self) -> f64 {
        self.error_bound
    }
}

/// A matching of greatest weight, whatever its size; edges of negative weight are never used.
///
/// Of two copies of the graph, each vertex joined to its copy by an edge of weight zero, a perfect matching of greatest weight
/// consists of two matchings of greatest weight: both copies leave the same vertices alone, so either may repeat the other.
///
/// # Errors
/// [`Error::VertexOutOfRange`], [`Error::NonFiniteDistance`], [`Error::TooManyVertices`].
///
/// # Examples
/// ```
/// use christofides::matching::{max_cardinality_matching, max_weight_matching};
///
/// let path = [(0, 1, 2.0), (1, 2, 5.0), (2, 3, 2.0)];
/// assert_eq!(max_weight_matching(4, &path)?.weight(), 5.0);
/// assert_eq!(max_cardinality_matching(4, &path)?.weight(), 4.0);
/// # Ok::<(), christofides::Error>(())
/// ```
pub fn max_weight_matching(n: usize, edges: &[(usize, usize, f64)]) -> Result<PartialMatching, Error> {
    check_edges(n, edges)?;
    doubled(n, edges, 0.0)
}

/// Of the matchings with most edges one of greatest weight; weights may be of either sign.
///
/// As [`max_weight_matching`], with so heavy a price for vertices left alone that none is in vain. The price takes
/// `log2(n)` of the digits of the weights: [`error_bound`](PartialMatching::error_bound) grows with `n^2`. The number of edges is exact.
///
/// # Errors
/// As [`max_weight_matching`]; [`Error::Overflow`] if the price is not finite.
pub fn max_cardinality_matching(n: usize, edges: &[(usize, usize, f64)]) -> Result<PartialMatching, Error> {
    check_edges(n, edges)?;
    let greatest = edges.iter().map(|edge| edge.2.abs()).fold(0.0, f64::max);
    let unit = if greatest > 0.0 { greatest } else { 1.0 };
    // Two matchings of n / 2 edges each differ by at most 2 n units in weight, and by two vertices or more in size.
    let price = unit * (n as f64 + 1.0);
    if price.is_finite() { doubled(n, edges, price) } else { Err(Error::Overflow) }
}

/// The heavier half of a least perfect matching of the doubled graph, where vertices left alone cost `price`.
fn doubled(n: usize, edges: &[(usize, usize, f64)], price: f64) -> Result<PartialMatching, Error> {
    let copies = |&(u, v, weight): &(usize, usize, f64)| [(u, v, -weight), (u + n, v + n, -weight)];
    let alone = (0..n).map(|v| (v, v + n, price));
    let all: Vec<_> = edges.iter().flat_map(copies).chain(alone).collect();
    let both = Solver::default().sparse(2 * n, &all)?;
    let half = |first: usize| PartialMatching {
        mates: both.mates()[first..first + n]
            .iter()
            .map(|&mate| (first..first + n).contains(&mate).then(|| mate - first))
            .collect(),
        weight: 0.0,
        error_bound: both.error_bound() / 2.0,
    };
    let halves = [half(0), half(n)].map(|half| half.weighed(edges));
    let [first, second] = halves;
    Ok(if first.weight >= second.weight { first } else { second })
}

impl PartialMatching {
    /// Sums the weights; of parallel edges the heaviest counts.
    fn weighed(mut self, edges: &[(usize, usize, f64)]) -> Self {
        let mut heaviest = vec![f64::NEG_INFINITY; self.mates.len()];
        for &(u, v, weight) in edges.iter().filter(|edge| self.mates[edge.0] == Some(edge.1)) {
            let end = u.min(v);
            heaviest[end] = heaviest[end].max(weight);
        }
        self.weight = self.edges().map(|(u, _)| heaviest[u]).sum();
        self
    }
}
