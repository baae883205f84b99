//! Lloyd's k-means with greedy k-means++ seeding and exact filtering by a k-d tree.

mod exchange;
mod filter;
mod lloyd;
mod options;
mod seeding;

pub use options::KMeansOptions;

use crate::error::{Error, check_finite};
use crate::geometry::{safe_scale, scaled};
use crate::tree::Tree;
use lloyd::Run;
use rand::{SeedableRng, rngs::Xoshiro256PlusPlus};

/// A clustering found by [`kmeans`].
///
/// Invariants: every label is below `centroids.len()`, every cluster has a member.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct KMeans<const D: usize>
where
    [f64; D]: Sized,
{
    /// The cluster of each point: the one with the nearest centroid, the lowest index on ties.
    pub labels: Vec<usize>,
    /// One centroid a cluster; as many as clusters were asked for, or as there are distinct points if those are fewer.
    #[cfg_attr(feature = "serde", serde(serialize_with = "serialize_points"))]
    pub centroids: Vec<[f64; D]>,
    /// Sum over the points of weight times squared distance to their centroid.
    pub inertia: f64,
    /// Lloyd iterations of the best run.
    pub iterations: usize,
    /// How the best run ended.
    pub status: KMeansStatus,
}

#[cfg(feature = "serde")]
fn serialize_points<S: serde::Serializer, const D: usize>(
    points: &[[f64; D]],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(points.iter().map(|p| p.as_slice()))
}

impl<const D: usize> KMeans<D> {
    /// The members of each cluster, in ascending order.
    #[must_use]
    pub fn clusters(&self) -> Vec<Vec<usize>> {
        crate::labels::clusters(&self.labels, self.centroids.len())
    }
}

/// How a k-means run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum KMeansStatus {
    /// The centroids moved less than the tolerance.
    Converged,
    /// The iteration limit came first; the clustering is valid, though not a local minimum.
    IterationLimit,
    /// There are fewer distinct points than clusters asked for: each distinct point is a cluster of its own and
    /// the inertia is zero.
    FewerDistinctPoints,
}

/// Partitions points into `k` clusters so that the sum of squared distances to the centroids is (locally) least.
///
/// Lloyd's iteration (Lloyd 1982, doi:10.1109/TIT.1982.1056489) from greedy k-means++ seeds (Arthur and
/// Vassilvitskii 2007), the best of [`n_init`](KMeansOptions::n_init) runs. The nearest centroids are found exactly by
/// filtering candidates through a k-d tree (Pelleg and Moore 1999, doi:10.1145/312129.312248; Kanungo et al. 2002,
/// doi:10.1109/TPAMI.2002.1017616). A cluster that loses all its points is restarted at the point farthest from its centroid.
/// Where it rests and clusters are small, single points are exchanged as long as that helps (Hartigan 1975).
///
/// # Arguments
/// * `points`: any number of points, any unit.
/// * `k`: the number of clusters, at least 1 unless there are no points.
///
/// # Returns
/// Labels and centroids. With fewer distinct points than `k` there are as many clusters as distinct points, and the
/// status says so. No points give no clusters.
///
/// # Guarantee
/// Each point is labelled with its nearest centroid. The expected inertia of the seeds is within a factor
/// O(log k) of the least (plain k-means++; the greedy variant: O(log^3 k)), and no iteration makes it worse.
///
/// # Errors
/// [`Error::NonFiniteCoordinate`], [`Error::NoClusters`], [`Error::OptionTooSmall`].
///
/// # Complexity
/// O(n k) a run and iteration at worst, far less in two or three dimensions; O(n + k) memory.
///
/// # Examples
/// ```
/// use cluster::{KMeansOptions, kmeans};
///
/// let points = [[0.0, 0.0], [0.0, 1.0], [9.0, 0.0], [9.0, 1.0]];
/// let found = kmeans(&points, 2, &KMeansOptions::default())?;
/// assert_eq!(found.labels[0], found.labels[1]);
/// assert_ne!(found.labels[0], found.labels[2]);
/// assert_eq!(found.inertia, 1.0);
/// # Ok::<(), cluster::Error>(())
/// ```
pub fn kmeans<const D: usize>(
    points: &[[f64; D]],
    k: usize,
    options: &KMeansOptions,
) -> Result<KMeans<D>, Error> {
    run(points, None, k, options)
}

/// [`kmeans`] of points that count `weights[i]` times; weights are positive and finite.
///
/// # Errors
/// Those of [`kmeans`], [`Error::WeightCount`], [`Error::InvalidWeight`].
pub fn kmeans_weighted<const D: usize>(
    points: &[[f64; D]],
    weights: &[f64],
    k: usize,
    options: &KMeansOptions,
) -> Result<KMeans<D>, Error> {
    if weights.len() != points.len() {
        return Err(Error::WeightCount { expected: points.len(), found: weights.len() });
    }
    if let Some(point) = weights.iter().position(|&w| !(w.is_finite() && w > 0.0)) {
        return Err(Error::InvalidWeight { point, weight: weights[point] });
    }
    run(points, Some(weights), k, options)
}

fn run<const D: usize>(
    points: &[[f64; D]],
    weights: Option<&[f64]>,
    k: usize,
    options: &KMeansOptions,
) -> Result<KMeans<D>, Error> {
    options.validate()?;
    check_finite(points)?;
    if points.is_empty() {
        let status = KMeansStatus::Converged;
        return Ok(KMeans { labels: vec![], centroids: vec![], inertia: 0.0, iterations: 0, status });
    }
    if k == 0 {
        return Err(Error::NoClusters);
    }
    let scale = safe_scale(points);
    let tree =
        if scale == 1.0 { Tree::new(points, weights) } else { Tree::new(&scaled(points, scale), weights) };
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(options.seed);
    let mut best: Option<Run<D>> = None;
    for _ in 0..options.n_init {
        let seeds = seeding::greedy(&tree, k, &mut rng);
        let all_distinct_used = seeds.len() < k;
        let run = lloyd::run(&tree, seeds, options);
        if best.as_ref().is_none_or(|b| run.inertia < b.inertia) {
            best = Some(run);
        }
        if all_distinct_used {
            break; // every run would end here: one cluster a distinct point
        }
    }
    Ok(finish(&tree, best.unwrap_or_default(), k, scale))
}

/// Brings a run on the tree's permuted, scaled points back to the caller's.
fn finish<const D: usize>(tree: &Tree<D>, run: Run<D>, k: usize, scale: f64) -> KMeans<D> {
    let status = if run.centroids.len() < k { KMeansStatus::FewerDistinctPoints } else { run.status };
    let labels = tree.in_original_order(&run.labels);
    let centroids = run.centroids.iter().map(|c| unscaled(tree, c, scale)).collect();
    KMeans { labels, centroids, inertia: run.inertia / scale / scale, iterations: run.iterations, status }
}

/// A centroid among the caller's points. Means of weights that are no normal numbers round beyond the points, and there may be no number there.
fn unscaled<const D: usize>(tree: &Tree<D>, centroid: &[f64; D], scale: f64) -> [f64; D] {
    if scale == 1.0 {
        return *centroid;
    }
    let (low, high) = (&tree.nodes[0].low, &tree.nodes[0].high);
    std::array::from_fn(|axis| centroid[axis].max(low[axis]).min(high[axis]) / scale)
}
