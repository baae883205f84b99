//! Entry points: sparse graphs, and complete graphs by pricing.

use super::blossoms::Blossom;
use super::forest::Forest;
use super::pricing::{Index, Prices, find_violated};
use super::quantise::Scale;
use super::search::Exposed;
use crate::candidates::Candidates;
use crate::error::Error;
use crate::metric::Metric;
use crate::validate::{check_count, validate_finite};

/// A perfect matching with the dual solution that proves it optimal.
#[derive(Debug, Clone, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use]
pub struct Matching {
    pub(crate) mates: Vec<usize>,
    pub(crate) weight: f64,
    pub(crate) error_bound: f64,
    pub(crate) duals: Vec<f64>,
    pub(crate) blossoms: Vec<Blossom>,
}

impl Matching {
    /// The partner of every vertex.
    #[must_use]
    pub fn mates(&self) -> &[usize] {
        &self.mates
    }

    /// The matched edges, smaller vertex first.
    pub fn edges(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.mates.iter().enumerate().filter(|&(u, &v)| u < v).map(|(u, &v)| (u, v))
    }

    /// The sum of the weights of the matched edges.
    #[must_use]
    pub fn weight(&self) -> f64 {
        self.weight
    }

    /// By how much the weight can exceed the optimum, because weights are rounded to integers inside.
    #[must_use]
    pub fn error_bound(&self) -> f64 {
        self.error_bound
    }

    /// The dual variables of the vertices, of either sign.
    #[must_use]
    pub fn duals(&self) -> &[f64] {
        &self.duals
    }

    /// The blossoms, inner ones first.
    #[must_use]
    pub fn blossoms(&self) -> &[Blossom] {
        &self.blossoms
    }
}

/// A minimum-weight perfect matching of the complete graph of a metric (or of any symmetric distance).
///
/// # Errors
/// [`Error::OddVertexCount`], and distances that are not finite, symmetric and non-negative.
pub fn min_weight_perfect_matching(metric: &impl Metric) -> Result<Matching, Error> {
    Solver::default().complete(metric)
}

/// A minimum-weight perfect matching of a sparse graph on `n` vertices; weights may be of either sign.
///
/// # Errors
/// [`Error::OddVertexCount`], [`Error::VertexOutOfRange`], [`Error::NonFiniteDistance`], [`Error::NoPerfectMatching`],
/// [`Error::TooManyVertices`] above 2^30.
pub fn sparse_min_weight_perfect_matching(
    n: usize,
    edges: &[(usize, usize, f64)],
) -> Result<Matching, Error> {
    Solver::default().sparse(n, edges)
}

/// A solver whose storage is reused from call to call.
#[derive(Debug, Default)]
pub struct Solver {
    forest: Forest,
    edges: Vec<(u32, u32, i64)>,
    candidates: Candidates,
    prices: Prices,
}

impl Solver {
    /// See [`min_weight_perfect_matching`].
    ///
    /// # Errors
    /// As there.
    pub fn complete(&mut self, metric: &impl Metric) -> Result<Matching, Error> {
        validate_finite(metric)?;
        self.complete_unchecked(metric)
    }

    fn complete_unchecked(&mut self, metric: &impl Metric) -> Result<Matching, Error> {
        let scale = self.search(metric)?;
        let mut matching = self.export(scale);
        matching.weight = matching.edges().map(|(u, v)| metric.distance(u, v)).sum();
        Ok(matching)
    }

    /// The matched edges alone, without a check of the distances.
    pub(crate) fn pairs_unchecked(
        &mut self,
        metric: &impl Metric,
    ) -> Result<impl Iterator<Item = (usize, usize)> + '_, Error> {
        self.search(metric)?;
        self.forest.match_inside();
        let mate = |v: usize| self.forest.nodes[v].mate.outer as usize;
        Ok((0..metric.len()).map(move |v| (v, mate(v))).filter(|&(u, v)| u < v))
    }

    fn search(&mut self, metric: &impl Metric) -> Result<Scale, Error> {
        let n = metric.len();
        if n % 2 == 1 {
            return Err(Error::OddVertexCount { n });
        }
        let candidates = self.candidates.for_matching(metric);
        let length = |&(u, v): &(u32, u32)| metric.distance(u as usize, v as usize);
        let scale = Scale::new(candidates.iter().map(length).fold(0.0, f64::max));
        self.edges.clear();
        self.edges.extend(candidates.iter().map(|edge| (edge.0, edge.1, scale.weight(length(edge)))));
        self.forest.graph.rebuild(n, &self.edges);
        self.forest.start_greedily();
        let index = Index::new(metric);
        loop {
            self.forest.run().map_err(|Exposed(exposed)| Error::NoPerfectMatching { exposed })?;
            find_violated(&self.forest, metric, scale, &index, &mut self.prices);
            if self.prices.found.is_empty() {
                return Ok(scale);
            }
            self.edges.extend(&self.prices.found);
            self.forest.graph.rebuild(n, &self.edges);
            self.forest.restart(&self.prices.found);
        }
    }

    /// See [`sparse_min_weight_perfect_matching`].
    ///
    /// # Errors
    /// As there.
    pub fn sparse(&mut self, n: usize, edges: &[(usize, usize, f64)]) -> Result<Matching, Error> {
        if n % 2 == 1 {
            return Err(Error::OddVertexCount { n });
        }
        check_edges(n, edges)?;
        // Also keeps the memory linear in the edges, whatever the number of vertices.
        if edges.len() < n / 2 {
            return Err(Error::NoPerfectMatching { exposed: n - 2 * edges.len() });
        }
        let greatest = edges.iter().map(|edge| edge.2.abs()).fold(0.0, f64::max);
        let scale = Scale::new(greatest);
        self.edges.clear();
        let scaled = edges.iter().filter(|edge| edge.0 != edge.1);
        self.edges.extend(scaled.map(|&(u, v, weight)| (u as u32, v as u32, scale.weight(weight))));
        self.forest.graph.rebuild(n, &self.edges);
        self.forest.start_greedily();
        self.forest.run().map_err(|Exposed(exposed)| Error::NoPerfectMatching { exposed })?;
        let mut matching = self.export(scale);
        matching.weight = matched_weight(&matching.mates, edges);
        Ok(matching)
    }

    fn export(&mut self, scale: Scale) -> Matching {
        self.forest.match_inside();
        let n = self.forest.n_vertices();
        let blossoms = self.forest.export(scale);
        Matching {
            mates: (0..n).map(|v| self.forest.nodes[v].mate.outer as usize).collect(),
            weight: 0.0,
            error_bound: scale.error_bound(n),
            duals: (0..n).map(|v| scale.real(self.forest.nodes[v].dual)).collect(),
            blossoms,
        }
    }
}

/// Refuses ends that do not exist, weights that are not finite, and more vertices than the solver can number.
pub(super) fn check_edges(n: usize, edges: &[(usize, usize, f64)]) -> Result<(), Error> {
    check_count(n)?;
    for &(i, j, weight) in edges {
        if let Some(vertex) = [i, j].into_iter().find(|&vertex| vertex >= n) {
            return Err(Error::VertexOutOfRange { vertex, n });
        }
        if !weight.is_finite() {
            return Err(Error::NonFiniteDistance { i, j });
        }
    }
    Ok(())
}

/// The weight of a matching; of parallel edges the lightest counts.
fn matched_weight(mates: &[usize], edges: &[(usize, usize, f64)]) -> f64 {
    let mut lightest = vec![f64::INFINITY; mates.len()];
    for &(u, v, weight) in edges.iter().filter(|edge| mates[edge.0] == edge.1) {
        let end = u.min(v);
        lightest[end] = lightest[end].min(weight);
    }
    mates.iter().enumerate().filter(|&(u, &v)| u < v).map(|(u, _)| lightest[u]).sum()
}
