//! Metric travelling salesman: Christofides' algorithm with exact minimum-weight perfect matching, tour improvement and
//! certified lower bounds.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod algorithm;
mod candidates;
mod delaunay;
mod error;
mod euler;
mod exact;
#[cfg(feature = "petgraph")]
mod graph;
mod improve;
mod kd_tree;
mod lower_bound;
pub mod matching;
mod matrix;
mod metric;
mod points;
mod shortcut;
mod spanning_tree;
mod tour;
mod validate;

pub use algorithm::{Options, christofides, solve, solve_path};
pub use error::Error;
pub use euler::euler_circuit;
pub use exact::{exact_path, exact_tour};
pub use improve::{chained_improve, chained_improve_path, improve, improve_path};
pub use lower_bound::{LowerBound, held_karp};
pub use matching::{Matching, min_weight_perfect_matching};
pub use matrix::{FromFn, Matrix};
pub use metric::{Geometry, Metric};
pub use points::Points;
pub use shortcut::shortcut;
pub use spanning_tree::minimum_spanning_tree;
pub use tour::{Ends, Path, Tour};
pub use validate::validate;
