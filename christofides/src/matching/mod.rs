//! Minimum-weight perfect matching in general graphs, exact, with dual variables.
//!
//! Edmonds' primal-dual algorithm (1965) on integer weights: alternating trees grow from all exposed vertices at once, by one
//! clock; the next tight edge comes from a radix heap. A complete graph is searched on candidate edges (Delaunay and nearest
//! neighbours) first; edges that the duals violate are found with a k-d tree, added, and the search resumes from its duals
//! until none is left (Cook and Rohe 1999).
//!
//! The linear program and its dual, with `B` over the odd sets of vertices and `delta(B)` the edges that leave `B`:
//!
//! ```text
//! minimise  sum w(e) x(e)      subject to  x(delta(v)) = 1,  x(delta(B)) >= 1,  x >= 0
//! maximise  sum y(v) + sum z(B)            subject to  y(u) + y(v) + sum of z(B) over uv in delta(B) <= w(uv),  z >= 0
//! ```
//!
//! [`Matching`] holds `x`, `y` and `z`; [`certificate`] checks them.
//!
//! ```
//! use christofides::Points;
//! use christofides::matching::{certificate, min_weight_perfect_matching};
//!
//! let points = [[0.0, 0.0], [9.0, 0.0], [1.0, 0.0], [8.0, 1.0]];
//! let matching = min_weight_perfect_matching(&Points(&points))?;
//! assert_eq!(matching.mates(), [2, 3, 0, 1]);
//! assert!(certificate(&Points(&points), &matching).is_optimal_within(matching.error_bound() + 1e-12));
//! # Ok::<(), christofides::Error>(())
//! ```

mod blossoms;
mod certificate;
mod expand;
mod forest;
mod graph;
mod maximum;
mod pricing;
mod quantise;
mod queue;
mod search;
mod shrink;
mod solver;
mod start;

pub use blossoms::Blossom;
pub use certificate::{Certificate, certificate};
pub use maximum::{PartialMatching, max_cardinality_matching, max_weight_matching};
pub use solver::{Matching, Solver, min_weight_perfect_matching, sparse_min_weight_perfect_matching};
