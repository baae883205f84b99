//! The travelling salesman in a metric: Christofides' algorithm with every step exact, then a better tour, and a proof of
//! how good it is.
//!
//! Given `n` vertices and a distance `d` that obeys the triangle inequality, find the order of least cost
//!
//! ```text
//! cost(v) = d(v1, v2) + d(v2, v3) + ... + d(vn-1, vn) + d(vn, v1)
//! ```
//!
//! # The algorithm
//!
//! 1. A [minimum spanning tree](minimum_spanning_tree) costs at most the optimum: a tour less one edge is a spanning tree.
//! 2. The vertices of odd degree in the tree are even in number. A [minimum-weight perfect matching](matching) of them
//!    costs at most half the optimum: the best tour, shortcut to these vertices, is the union of two matchings.
//! 3. In tree and matching together every degree is even, so there is an [Euler circuit](euler_circuit).
//! 4. [Shortcutting](shortcut) repeated visits does not make it longer: a tour of at most 3/2 times the optimum.
//!
//! The factor needs the *minimum* matching, not a greedy one. Here it is found by Edmonds' blossom algorithm in integers,
//! and [`matching::certificate`] proves it on the complete graph by code of its own.
//!
//! The tour is then shortened by [chained Lin-Kernighan](chained_improve), which keeps the factor, and bounded from below
//! by the [Held-Karp bound](held_karp), so that every tour can say how far from the optimum it is at most.
//!
//! | To get | call | cost |
//! |---|---|---|
//! | a tour of at most 3/2 optimum | [`christofides`], [`christofides_with`] | `O(n log n)` typically for points, `O(n^2)` and more otherwise |
//! | a short tour with its gap | [`solve`], [`solve_with`] | by the budget in [`Options`] |
//! | a short open path | [`solve_path`] | by the budget |
//! | a proven optimum | [`exact_tour`], [`exact_path`] | some 10 ms for 40 points of the plane |
//! | a better tour or path | [`improve`], [`chained_improve`], [`improve_path`], [`chained_improve_path`] | by the kicks |
//! | a lower bound | [`held_karp`] | by the iterations |
//! | a matching with its duals | [`matching::min_weight_perfect_matching`], [`matching::Solver`] | |
//! | a matching of most weight or most edges | [`matching::max_weight_matching`], [`matching::max_cardinality_matching`] | |
//! | single steps | [`minimum_spanning_tree`], [`euler_circuit`], [`shortcut`] | |
//!
//! # Example
//!
//! ```
//! use christofides::{Options, Points, christofides, solve};
//!
//! let targets = [[0.0, 0.0], [3.0, 1.0], [1.0, 4.0], [5.0, 5.0], [4.0, 2.0], [2.0, 6.0]];
//! let quick = christofides(&Points(&targets))?;
//! let short = solve(&Points(&targets), &Options::default(), &mut || false)?;
//! assert_eq!(short.gap(), Some(0.0)); // so few vertices are solved to proof
//! assert!(short.cost() <= quick.cost() && quick.cost() <= 1.5 * short.cost());
//! # Ok::<(), christofides::Error>(())
//! ```
//!
//! Distances come as [`Points`], a [`Matrix`], a function ([`FromFn`]), a file of TSPLIB ([`tsplib`]) or your own [`Metric`].
//!
//! # What is guaranteed
//!
//! * [`christofides`] costs at most 3/2 times the optimum if the distance is a metric; what does not promise to be one is
//!   checked, and refused with the vertices that break it.
//! * A matching weighs at most [`error_bound`](Matching::error_bound) more than the optimum, because weights are rounded to
//!   46 bits of the longest candidate edge; on the rounded weights it is exact.
//! * `lower_bound()` never exceeds the optimum: it is the value of the least 1-tree of the complete graph, rounded down.
//! * Equal input, seed and budget give equal bits. No input makes a function panic; [`Metric`] implementors may.
//!
//! # What is not
//!
//! * [`solve`] takes symmetric distances that are no metric; the factor 3/2 then does not hold, the lower bound does.
//! * [`solve_path`] has its lower bound, but no factor. The times above are typical, not worst cases:
//!   [`exact_tour`] is exponential in the worst case.
//! * Asymmetric distances are always refused.
//!
//! # Features
//!
//! * `serde`: `Serialize` and `Deserialize` for results and options.
//! * `petgraph`: `Matrix::closure`, the metric closure of a weighted graph.
//!
//! # How it is tested
//!
//! Every inequality of the proof on generated metrics against exhaustive optima; matchings against exhaustive ones, against
//! known optima of two independent solvers, and by their certificates; three spanning-tree algorithms and two exact
//! algorithms against each other; TSPLIB optima in all its forms of symmetric distances; invariance under relabelling, motion and
//! scaling; every public function on coordinates and weights that are huge, tiny, infinite or no numbers.
//!
//! # References
//!
//! N. Christofides (1976), *Worst-case analysis of a new heuristic for the travelling salesman problem*. J. Edmonds (1965),
//! *Paths, trees, and flowers*. V. Kolmogorov (2009), *Blossom V*. O. Higgott and C. Gidney (2023), *Sparse Blossom* (trees
//! that all grow by one clock). W. Cook and A. Rohe (1999), *Computing minimum-weight perfect matchings* (pricing). S. Lin and
//! B. Kernighan (1973), *An effective heuristic algorithm for the traveling-salesman problem*. D. Applegate, W. Cook and
//! A. Rohe (2003), *Chained Lin-Kernighan for large traveling salesman problems*. M. Held and R. Karp (1970, 1971), *The
//! traveling-salesman problem and minimum spanning trees*. T. Volgenant and R. Jonker (1982), *A branch and bound algorithm
//! for the symmetric traveling salesman problem based on the 1-tree relaxation*. G. Reinelt (1991), *TSPLIB*.

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
pub mod tsplib;
mod validate;
mod workspace;

pub use algorithm::{Options, christofides, christofides_with, solve, solve_path, solve_with};
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
pub use workspace::Workspace;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
