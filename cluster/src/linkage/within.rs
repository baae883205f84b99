//! The complete-linkage cut at a given diameter, without the full distance matrix.
//!
//! Complete linkage merges at a height of at most `h` only clusters all of whose pairs are within `h`, so pairs
//! farther apart never matter: the dissimilarities form a sparse matrix, where a missing entry means "never". A merge intersects
//! two rows and takes the greater entry. The nearest-neighbour chain then finds the merges in any order, since complete
//! linkage is reducible.

use crate::error::{Error, check_finite};
use crate::labels::{by_first_member, clusters};
use crate::linkage::dendrogram::Sets;
use crate::tree::Tree;

/// A partition of points: `labels[i]` is the position of the cluster of point `i` in `clusters`.
#[derive(Debug, Clone, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Partition {
    /// The cluster of each point; clusters are numbered by their first members.
    pub labels: Vec<usize>,
    /// The members of each cluster, in ascending order.
    pub clusters: Vec<Vec<usize>>,
}

/// Merges close points: the true complete-linkage clustering cut at height `diameter`.
///
/// # Arguments
/// * `points`: any number of points, any unit.
/// * `diameter`: greatest distance allowed between two members of a cluster, same unit; infinity is allowed.
///
/// # Guarantee
/// No two members of a cluster are farther apart than `diameter`, and no two clusters could be merged without
/// breaking that. The clusters are those of [`Linkage::Complete`](crate::Linkage::Complete) cut there, up to ties among distances.
///
/// # Errors
/// [`Error::NonFiniteCoordinate`], [`Error::InvalidDiameter`].
///
/// # Complexity
/// O(n log n + p) memory and about as much time, `p` the number of pairs within `diameter`: near-linear when few points
/// are close to each other, as bad as the full matrix when all are.
///
/// # Examples
/// ```
/// let merged = cluster::merge_within(&[[0.0, 0.0], [7.0, 7.0], [0.5, 0.0]], 1.0)?;
/// assert_eq!(merged.clusters, [vec![0, 2], vec![1]]);
/// # Ok::<(), cluster::Error>(())
/// ```
pub fn merge_within<const D: usize>(points: &[[f64; D]], diameter: f64) -> Result<Partition, Error> {
    check_finite(points)?;
    if diameter.is_nan() || diameter < 0.0 {
        return Err(Error::InvalidDiameter { diameter });
    }
    let mut sets = Sets::new(points.len());
    let mut chain = Chain { rows: sparse_rows(points, diameter), stack: Vec::new() };
    for start in 0..points.len() {
        chain.stack.push(start);
        while let Some((a, b)) = chain.next_merge() {
            sets.join(a, b);
        }
    }
    let roots: Vec<usize> = (0..points.len()).map(|i| sets.root(i)).collect();
    let (labels, count) = by_first_member(&roots);
    let clusters = clusters(&labels, count);
    Ok(Partition { labels, clusters })
}

/// Row of a cluster: the clusters wholly within reach, ascending, with the greatest distance between members.
type Row = Vec<(u32, f64)>;

fn sparse_rows<const D: usize>(points: &[[f64; D]], diameter: f64) -> Vec<Row> {
    if points.is_empty() {
        return vec![];
    }
    let tree = Tree::new(points, None);
    let mut rows = Vec::with_capacity(points.len());
    for (i, point) in points.iter().enumerate() {
        let mut row = Row::new();
        tree.within(point, diameter, &mut |j, distance| {
            if j != i {
                row.push((j as u32, distance));
            }
        });
        row.sort_unstable_by_key(|entry| entry.0);
        rows.push(row);
    }
    rows
}

struct Chain {
    rows: Vec<Row>,
    stack: Vec<usize>,
}

impl Chain {
    /// Follows nearest neighbours until two clusters are each other's nearest and merges them; none when the cluster in
    /// which the chain started can merge no more.
    fn next_merge(&mut self) -> Option<(usize, usize)> {
        loop {
            let top = *self.stack.last()?;
            let previous = self.stack.len().checked_sub(2).map(|i| self.stack[i]);
            let Some(nearest) = self.nearest(top, previous) else {
                self.stack.pop();
                continue;
            };
            if Some(nearest) == previous {
                self.stack.truncate(self.stack.len() - 2);
                let (a, b) = (top.min(nearest), top.max(nearest));
                self.merge(a, b);
                if self.stack.is_empty() {
                    self.stack.push(a);
                }
                return Some((a, b));
            }
            self.stack.push(nearest);
        }
    }

    /// The closest cluster; on ties the previous one in the chain (so that it ends), then the lowest number.
    fn nearest(&self, cluster: usize, previous: Option<usize>) -> Option<usize> {
        let row = &self.rows[cluster];
        let least = row.iter().map(|entry| entry.1).fold(f64::INFINITY, f64::min);
        let mut ties = row.iter().filter(|entry| entry.1 <= least).map(|entry| entry.0 as usize);
        let first = ties.next()?;
        Some(previous.filter(|p| *p == first || ties.any(|t| t == *p)).unwrap_or(first))
    }

    /// Merges `b` into `a < b`: the new row is the intersection of both, with the greater entries.
    fn merge(&mut self, a: usize, b: usize) {
        let (row_a, row_b) = (std::mem::take(&mut self.rows[a]), std::mem::take(&mut self.rows[b]));
        let mut merged = Row::with_capacity(row_a.len().min(row_b.len()));
        let mut others = row_b.iter().peekable();
        for &(cluster, distance) in &row_a {
            while others.next_if(|o| o.0 < cluster).is_some() {}
            if let Some(other) = others.next_if(|o| o.0 == cluster) {
                merged.push((cluster, distance.max(other.1)));
            }
        }
        for &(cluster, _) in &row_a {
            remove(&mut self.rows[cluster as usize], a);
        }
        for &(cluster, _) in &row_b {
            remove(&mut self.rows[cluster as usize], b);
        }
        for &(cluster, distance) in &merged {
            let row = &mut self.rows[cluster as usize];
            let position = row.partition_point(|entry| entry.0 < a as u32);
            row.insert(position, (a as u32, distance));
        }
        self.rows[a] = merged;
    }
}

fn remove(row: &mut Row, cluster: usize) {
    if let Ok(position) = row.binary_search_by_key(&(cluster as u32), |entry| entry.0) {
        row.remove(position);
    }
}
