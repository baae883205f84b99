//! Agglomerative clustering: single, complete, average and Ward linkage.

mod clink;
mod dendrogram;
mod within;

pub use clink::clink;
pub use dendrogram::{Dendrogram, Step};
pub use within::{Partition, merge_within};

use crate::error::{Error, check_finite};
use crate::geometry::{distance, power_of_two};

/// How the dissimilarity of two clusters follows from those of their members.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Linkage {
    /// The least over all pairs: chains of close points become clusters.
    Single,
    /// The greatest over all pairs: the diameter of a merged cluster is its height in the dendrogram.
    Complete,
    /// The mean over all pairs (UPGMA).
    Average,
    /// The square root of twice the increase in the sum of squared distances to the centroids.
    Ward,
}

impl From<Linkage> for kodama::Method {
    fn from(linkage: Linkage) -> Self {
        match linkage {
            Linkage::Single => kodama::Method::Single,
            Linkage::Complete => kodama::Method::Complete,
            Linkage::Average => kodama::Method::Average,
            Linkage::Ward => kodama::Method::Ward,
        }
    }
}

/// Hierarchical clustering of points under the Euclidean distance.
///
/// The nearest-neighbour chain (Murtagh 1983; Müllner 2011, arXiv:1109.2378) for complete, average and Ward linkage, the
/// minimum spanning tree for single linkage, both as implemented by kodama.
///
/// # Guarantee
/// The steps are those of the textbook algorithm that merges the two closest clusters again and again; where distances
/// tie, one of the possible outcomes.
///
/// # Errors
/// [`Error::NonFiniteCoordinate`]; [`Error::TooManyPoints`] above 65 536, whose distances take 16 GiB.
///
/// # Complexity
/// O(n^2) time and memory (n (n - 1) / 2 distances). For a cut at a given diameter of very many points use [`merge_within`], for complete
/// linkage in linear memory [`clink`].
///
/// # Examples
/// ```
/// use cluster::{Linkage, linkage};
///
/// let dendrogram = linkage(&[[0.0], [1.0], [5.0]], Linkage::Complete)?;
/// assert_eq!(dendrogram.steps()[0].dissimilarity, 1.0);
/// assert_eq!(dendrogram.cut(2.0), [0, 0, 1]);
/// # Ok::<(), cluster::Error>(())
/// ```
pub fn linkage<const D: usize>(points: &[[f64; D]], linkage: Linkage) -> Result<Dendrogram, Error> {
    check_finite(points)?;
    let n = points.len();
    if n > MOST_POINTS {
        return Err(Error::TooManyPoints { points: n, limit: MOST_POINTS });
    }
    let mut condensed = Vec::with_capacity(n * n.saturating_sub(1) / 2);
    for i in 0..n {
        condensed.extend(points[i + 1..].iter().map(|q| distance(&points[i], q)));
    }
    linkage_condensed(&mut condensed, n, linkage)
}

const MOST_POINTS: usize = 1 << 16;

/// Hierarchical clustering of `n` observations from their condensed dissimilarities, which are overwritten.
///
/// `condensed` holds the upper triangle by rows: d(0, 1), d(0, 2), .., d(n - 2, n - 1), as SciPy's `pdist` does. For
/// [`Linkage::Ward`] they must be Euclidean distances for the heights to mean anything.
///
/// # Errors
/// [`Error::CondensedLength`], [`Error::InvalidDissimilarity`].
///
/// # Complexity
/// O(n^2) time, no further matrix.
pub fn linkage_condensed(condensed: &mut [f64], n: usize, linkage: Linkage) -> Result<Dendrogram, Error> {
    let expected = n.saturating_mul(n.saturating_sub(1)) / 2;
    if condensed.len() != expected {
        return Err(Error::CondensedLength { observations: n, expected, found: condensed.len() });
    }
    if let Some(index) = condensed.iter().position(|d| !(d.is_finite() && *d >= 0.0)) {
        return Err(Error::InvalidDissimilarity { index, value: condensed[index] });
    }
    if n < 2 {
        return Ok(Dendrogram::new(n, vec![]));
    }
    // Sums and squares of extreme numbers leave the range, and kodama panics on what is no number: a power of two brings them back.
    let scale = power_of_two(condensed.iter().fold(0.0, |m: f64, d| m.max(*d)));
    condensed.iter_mut().for_each(|d| *d *= scale);
    let found = kodama::linkage(condensed, n, linkage.into());
    let steps = found
        .steps()
        .iter()
        .map(|s| Step {
            cluster1: s.cluster1.min(s.cluster2),
            cluster2: s.cluster1.max(s.cluster2),
            dissimilarity: s.dissimilarity / scale,
            size: s.size,
        })
        .collect();
    Ok(Dendrogram::new(n, steps))
}
