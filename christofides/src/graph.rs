//! The metric closure of a weighted graph.

use crate::error::Error;
use crate::matrix::Matrix;
use petgraph::graph::UnGraph;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A non-negative distance in the order of the numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Distance(f64);

impl Eq for Distance {}

impl PartialOrd for Distance {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Distance {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl Matrix {
    /// Shortest path lengths between all nodes of an undirected graph (feature `petgraph`), `weight` giving the length of
    /// an edge; Dijkstra's algorithm (1959) from every node.
    ///
    /// # Errors
    /// [`Error::Disconnected`] with the component of every node; [`Error::NonFiniteDistance`] and
    /// [`Error::NegativeDistance`] with the ends of the edge.
    ///
    /// # Complexity
    /// `O(n (n + m) log n)` time, `O(n^2)` memory.
    ///
    /// # Examples
    /// ```
    /// use christofides::{Matrix, Metric};
    /// use petgraph::graph::UnGraph;
    ///
    /// let graph = UnGraph::<(), f64>::from_edges([(0, 1, 1.0), (1, 2, 2.0), (0, 2, 9.0)]);
    /// let closure = Matrix::closure(&graph, |length| *length)?;
    /// assert_eq!(closure.distance(0, 2), 3.0);
    /// # Ok::<(), christofides::Error>(())
    /// ```
    pub fn closure<N, E>(graph: &UnGraph<N, E>, weight: impl Fn(&E) -> f64) -> Result<Self, Error> {
        let n = graph.node_count();
        let mut rows: Vec<Vec<(usize, f64)>> = vec![Vec::new(); n];
        for edge in graph.raw_edges() {
            let (i, j, length) = (edge.source().index(), edge.target().index(), weight(&edge.weight));
            if !length.is_finite() {
                return Err(Error::NonFiniteDistance { i, j });
            }
            if length < 0.0 {
                return Err(Error::NegativeDistance { i, j });
            }
            rows[i].push((j, length));
            rows[j].push((i, length));
        }
        check_connected(&rows)?;
        let mut distances = Vec::with_capacity(n * n);
        for source in 0..n {
            distances.extend(shortest_paths(&rows, source));
        }
        // Sums taken in opposite directions may differ in the last digit.
        for i in 0..n {
            for j in 0..i {
                distances[i * n + j] = distances[j * n + i];
            }
        }
        Ok(Self::symmetric(n, distances)?.promised())
    }
}

fn shortest_paths(rows: &[Vec<(usize, f64)>], source: usize) -> Vec<f64> {
    let mut distances = vec![f64::INFINITY; rows.len()];
    distances[source] = 0.0;
    let mut heap = BinaryHeap::from([(Reverse(Distance(0.0)), source)]);
    while let Some((Reverse(Distance(distance)), v)) = heap.pop() {
        if distance > distances[v] {
            continue;
        }
        for &(w, length) in &rows[v] {
            let candidate = distance + length;
            if candidate < distances[w] {
                distances[w] = candidate;
                heap.push((Reverse(Distance(candidate)), w));
            }
        }
    }
    distances
}

fn check_connected(rows: &[Vec<(usize, f64)>]) -> Result<(), Error> {
    const UNSEEN: usize = usize::MAX;
    let mut components = vec![UNSEEN; rows.len()];
    let mut n_components = 0;
    let mut second = 0;
    for root in 0..rows.len() {
        if components[root] != UNSEEN {
            continue;
        }
        second = root;
        components[root] = n_components;
        let mut stack = vec![root];
        while let Some(v) = stack.pop() {
            for &(w, _) in &rows[v] {
                if components[w] == UNSEEN {
                    components[w] = n_components;
                    stack.push(w);
                }
            }
        }
        n_components += 1;
    }
    if n_components < 2 {
        Ok(())
    } else {
        Err(Error::Disconnected { n_components, first: 0, second, components })
    }
}
