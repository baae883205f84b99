//! The tree of merges, in SciPy's numbering.

use crate::labels::by_first_member;

/// One merge: clusters `cluster1 < cluster2` become one.
///
/// Cluster `i < n` is the observation `i`; the merge at position `k` makes cluster `n + k`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Step {
    /// The lower number of the two clusters merged.
    pub cluster1: usize,
    /// The higher number of the two clusters merged.
    pub cluster2: usize,
    /// Their dissimilarity: the height of the merge.
    pub dissimilarity: f64,
    /// The number of observations in the merged cluster.
    pub size: usize,
}

/// `n - 1` merges by ascending height, numbered as in SciPy's linkage matrix.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Dendrogram {
    observations: usize,
    steps: Vec<Step>,
}

impl Dendrogram {
    pub(crate) fn new(observations: usize, steps: Vec<Step>) -> Self {
        Self { observations, steps }
    }

    /// From merges of observations `(a, b, height)`, each joining the clusters that hold `a` and `b`, in any order.
    pub(crate) fn from_merges(observations: usize, mut merges: Vec<(usize, usize, f64)>) -> Self {
        merges.sort_by(|x, y| x.2.total_cmp(&y.2));
        let mut sets = Sets::new(observations);
        // The number and size of the cluster of each root.
        let mut number: Vec<(usize, usize)> = (0..observations).map(|i| (i, 1)).collect();
        let mut steps = Vec::with_capacity(merges.len());
        for (a, b, dissimilarity) in merges {
            let (x, y) = (number[sets.root(a)], number[sets.root(b)]);
            let root = sets.join(a, b);
            let size = x.1 + y.1;
            number[root] = (observations + steps.len(), size);
            steps.push(Step { cluster1: x.0.min(y.0), cluster2: x.0.max(y.0), dissimilarity, size });
        }
        Self { observations, steps }
    }

    /// The number of observations.
    #[must_use]
    pub fn observations(&self) -> usize {
        self.observations
    }

    /// The merges by ascending height.
    #[must_use]
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// Labels of the clusters that result from all merges of height at most `height` (SciPy's `fcluster` with criterion
    /// `distance`), numbered by their first members. O(n).
    #[must_use]
    pub fn cut(&self, height: f64) -> Vec<usize> {
        self.after(self.steps.partition_point(|s| s.dissimilarity <= height))
    }

    /// Labels of `k` clusters, or of as many as there can be, numbered by their first members. O(n).
    #[must_use]
    pub fn cut_into(&self, k: usize) -> Vec<usize> {
        self.after(self.observations.saturating_sub(k.max(1)).min(self.steps.len()))
    }

    fn after(&self, n_steps: usize) -> Vec<usize> {
        let mut sets = Sets::new(self.observations + n_steps);
        for (k, step) in self.steps[..n_steps].iter().enumerate() {
            sets.join(step.cluster1, self.observations + k);
            sets.join(step.cluster2, self.observations + k);
        }
        let roots: Vec<usize> = (0..self.observations).map(|i| sets.root(i)).collect();
        by_first_member(&roots).0
    }
}

/// Disjoint sets with path halving.
pub(crate) struct Sets {
    parent: Vec<usize>,
}

impl Sets {
    pub(crate) fn new(n: usize) -> Self {
        Self { parent: (0..n).collect() }
    }

    pub(crate) fn root(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    /// Joins the sets of both; returns the root of the union.
    pub(crate) fn join(&mut self, a: usize, b: usize) -> usize {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b)] = a.min(b);
        a.min(b)
    }
}
