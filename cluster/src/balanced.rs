//! k-means with a greatest size for each cluster.

use crate::error::{Error, check_finite};
use crate::geometry::{safe_scale, scaled, squared_distance};
use crate::kmeans::{KMeansOptions, KMeansStatus, kmeans};
use crate::labels;

/// A clustering found by [`balanced_kmeans`]: no cluster is larger than its capacity.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Balanced<const D: usize> {
    /// The cluster of each point.
    pub labels: Vec<usize>,
    /// The mean of each cluster; of an empty one (possible only with capacity to spare) the centroid it had last.
    pub centroids: Vec<[f64; D]>,
    /// Sum of squared distances to the centroids.
    pub inertia: f64,
    /// Assignments made.
    pub iterations: usize,
    /// How the iteration ended.
    pub status: KMeansStatus,
}

impl<const D: usize> Balanced<D> {
    /// The members of each cluster, in ascending order.
    #[must_use]
    pub fn clusters(&self) -> Vec<Vec<usize>> {
        labels::clusters(&self.labels, self.centroids.len())
    }
}

/// `n` shared out among `k` as evenly as possible: capacities that fix every size to n / k, rounded down or up.
#[must_use]
pub fn equal_shares(n: usize, k: usize) -> Vec<usize> {
    (0..k).map(|j| n / k + usize::from(j < n % k)).collect()
}

/// Clusters of at most the given sizes whose sum of squared distances to their centroids is (locally) least.
///
/// From the centroids of [`kmeans`](crate::kmeans()), assignments and means alternate. Each assignment is an optimal transport of the
/// points to the clusters (minimum-cost flow by successive shortest paths over the clusters; Ahuja, Magnanti, Orlin 1993,
/// section 9.7), so that neither step ever raises the inertia.
///
/// # Arguments
/// * `capacities`: the greatest size of each cluster; [`equal_shares`] for equal ones.
///
/// # Errors
/// [`Error::CapacityTooSmall`], [`Error::TooManyClusters`] above 4096, and those of [`kmeans`](crate::kmeans()).
///
/// # Complexity
/// O(n (n + k^3)) an assignment at worst, O((n + k) k) memory.
///
/// # Examples
/// ```
/// use cluster::{KMeansOptions, balanced_kmeans, equal_shares};
///
/// let points = [[0.0], [1.0], [2.0], [9.0]];
/// let found = balanced_kmeans(&points, &equal_shares(4, 2), &KMeansOptions::default())?;
/// assert_eq!(found.labels[0], found.labels[1]);
/// assert_eq!(found.labels[2], found.labels[3]);
/// # Ok::<(), cluster::Error>(())
/// ```
pub fn balanced_kmeans<const D: usize>(
    points: &[[f64; D]],
    capacities: &[usize],
    options: &KMeansOptions,
) -> Result<Balanced<D>, Error> {
    options.validate()?;
    check_finite(points)?;
    let clusters = capacities.len();
    if clusters > MOST_CLUSTERS {
        return Err(Error::TooManyClusters { clusters, limit: MOST_CLUSTERS });
    }
    let capacity = capacities.iter().fold(0_usize, |sum, c| sum.saturating_add(*c));
    if capacity < points.len() {
        return Err(Error::CapacityTooSmall { capacity, points: points.len() });
    }
    let scale = safe_scale(points);
    let points = &scaled(points, scale);
    let mut centroids = kmeans(points, clusters, options)?.centroids;
    let last = centroids.last().copied().unwrap_or([0.0; D]);
    centroids.resize(clusters, last);
    let mut found = Balanced {
        labels: vec![],
        centroids,
        inertia: f64::INFINITY,
        iterations: 0,
        status: KMeansStatus::IterationLimit,
    };
    while found.iterations < options.max_iterations {
        found.iterations += 1;
        let labels = Transport::new(points, &found.centroids, capacities).solve();
        let centroids = means(points, &labels, &found.centroids);
        let inertia = points.iter().zip(&labels).map(|(p, &l)| squared_distance(p, &centroids[l])).sum();
        let improved = inertia < found.inertia;
        if improved {
            (found.labels, found.centroids, found.inertia) = (labels, centroids, inertia);
        }
        if !improved || inertia == 0.0 {
            found.status = KMeansStatus::Converged;
            break;
        }
    }
    found.centroids = found.centroids.iter().map(|c| c.map(|x| x / scale)).collect();
    found.inertia = if points.is_empty() { 0.0 } else { found.inertia / scale / scale };
    Ok(found)
}

/// The cheapest moves between any two of so many clusters take a quarter of a gibibyte.
const MOST_CLUSTERS: usize = 4096;

fn means<const D: usize>(points: &[[f64; D]], labels: &[usize], old: &[[f64; D]]) -> Vec<[f64; D]> {
    let mut sums = vec![([0.0; D], 0.0); old.len()];
    for (point, &label) in points.iter().zip(labels) {
        sums[label].1 += 1.0;
        for axis in 0..D {
            sums[label].0[axis] += point[axis];
        }
    }
    sums.iter()
        .zip(old)
        .map(|((sum, count), old)| if *count > 0.0 { sum.map(|x| x / count) } else { *old })
        .collect()
}

/// Points come in one by one; each takes the cheapest chain of moves that ends in a cluster with room.
struct Transport<'a> {
    k: usize,
    capacities: &'a [usize],
    /// Squared distance of each point to each centroid, by rows.
    cost: Vec<f64>,
    members: Vec<Vec<usize>>,
    /// `cheapest[a * k + b]`: the least extra cost of moving a member of a to b, and that member.
    cheapest: Vec<(f64, usize)>,
}

impl<'a> Transport<'a> {
    fn new<const D: usize>(points: &[[f64; D]], centroids: &[[f64; D]], capacities: &'a [usize]) -> Self {
        let k = centroids.len();
        let cost = points.iter().flat_map(|p| centroids.iter().map(|c| squared_distance(p, c))).collect();
        let cheapest = vec![(f64::INFINITY, usize::MAX); k * k];
        Self { k, capacities, cost, members: vec![vec![]; k], cheapest }
    }

    fn solve(mut self) -> Vec<usize> {
        let n = self.cost.len().checked_div(self.k).unwrap_or(0);
        for point in 0..n {
            self.insert(point);
        }
        let mut labels = vec![0; n];
        for (label, members) in self.members.iter().enumerate() {
            for &point in members {
                labels[point] = label;
            }
        }
        labels
    }

    fn insert(&mut self, point: usize) {
        let k = self.k;
        let mut cost: Vec<f64> = self.cost[point * k..(point + 1) * k].to_vec();
        let mut from = vec![usize::MAX; k];
        // Bellman-Ford: moving on can be cheaper than staying, but no cycle is negative. At most k rounds.
        for _ in 0..k {
            let mut changed = false;
            for a in (0..k).filter(|&a| self.members[a].len() >= self.capacities[a]) {
                for b in 0..k {
                    let through = cost[a] + self.cheapest[a * k + b].0;
                    if through < cost[b] - 1e-12 * through.abs() {
                        (cost[b], from[b]) = (through, a);
                        changed = true;
                    }
                }
            }
            if !changed {
                break;
            }
        }
        let room = |&j: &usize| self.members[j].len() < self.capacities[j];
        let Some(mut end) = (0..k).filter(room).min_by(|&a, &b| cost[a].total_cmp(&cost[b])) else { return };
        let mut touched = vec![end];
        // Rounding could close a cycle in `from`: k steps are enough for any path.
        for _ in 0..k {
            let before = from[end];
            if before == usize::MAX {
                break;
            }
            let moved = self.cheapest[before * k + end].1;
            self.members[before].retain(|&p| p != moved);
            self.members[end].push(moved);
            touched.push(before);
            end = before;
        }
        self.members[end].push(point);
        for cluster in touched {
            self.refresh(cluster);
        }
    }

    /// Finds the cheapest member to move from a cluster to each other; only full ones are asked.
    fn refresh(&mut self, a: usize) {
        let k = self.k;
        self.cheapest[a * k..(a + 1) * k].fill((f64::INFINITY, usize::MAX));
        if self.members[a].len() < self.capacities[a] {
            return;
        }
        for &point in &self.members[a] {
            let row = &self.cost[point * k..(point + 1) * k];
            for b in (0..k).filter(|&b| b != a) {
                if row[b] - row[a] < self.cheapest[a * k + b].0 {
                    self.cheapest[a * k + b] = (row[b] - row[a], point);
                }
            }
        }
    }
}
