//! Minimum-weight perfect matching in general graphs, exact, with dual variables.

mod blossoms;
mod expand;
mod forest;
mod graph;
mod quantise;
mod queue;
mod search;
mod shrink;
mod solver;
#[allow(dead_code)] // the restart serves pricing, which follows
mod start;

pub use blossoms::Blossom;
pub use solver::{Matching, Solver, min_weight_perfect_matching, sparse_min_weight_perfect_matching};
