//! Minimum-weight perfect matching in general graphs, exact, with dual variables.

mod blossoms;
mod certificate;
mod expand;
mod forest;
mod graph;
mod pricing;
mod quantise;
mod queue;
mod search;
mod shrink;
mod solver;
mod start;

pub use blossoms::Blossom;
pub use certificate::{Certificate, certificate};
pub use solver::{Matching, Solver, min_weight_perfect_matching, sparse_min_weight_perfect_matching};
