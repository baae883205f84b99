//! Many travelling salesmen: who visits which target in which order, so that all routes together or the longest of them is short.
//!
//! A vehicle's route through targets t1, .., tk costs
//!
//! ```text
//! C = d(depot, t1) + sum d(tj, tj+1) + sum service(tj) [+ d(tk, depot)]
//! ```
//!
//! over any [`Metric`](christofides::Metric), in metres or seconds; the last term if routes are closed. [`Objective::Makespan`] minimises the largest C,
//! [`Objective::Total`] their sum.
//!
//! | wanted | function |
//! |---|---|
//! | good routes | [`solve`], [`solve_with`] (progress, stop), [`solve_from`] (from given routes) |
//! | the fewest vehicles under a limit | [`least_fleet`]; [`Remedy`]: what would suffice where limits cannot be kept |
//! | routes from a clustering | [`assign`] |
//! | routes from a tour | [`split`], [`k_splitour`] (with a proven factor) |
//! | how good they can be | [`lower_bound`], [`Solution::gap`] |
//! | targets that change under way, in the plane or over any metric | [`Fleet`], [`Space`]; [`procedure_1`], [`procedure_2`] (rounds, as in the paper) |
//! | whether routes are valid | [`check`](check()) |
//!
//! # Example
//! ```
//! use mtsp::christofides::Points;
//! use mtsp::{Objective, Options, Problem, solve};
//!
//! let nodes = [[0.0, 0.0], [30.0, 0.0], [0.0, 40.0], [-35.0, 5.0], [10.0, 10.0]]; // the depot first
//! let metric = Points(&nodes);
//! let problem = Problem::new(&metric, 3)?.with_service(vec![0.0, 5.0, 5.0, 5.0, 5.0])?;
//! let solution = solve(&problem, &Options::default().with_iterations(2000))?;
//! assert_eq!(solution.makespan, 85.0); // to the target at (0, 40) and back, with its service
//! assert!(solution.gap(Objective::Makespan) < 1e-9); // proven: no other allocation is shorter
//! # Ok::<(), mtsp::Error>(())
//! ```
//!
//! # Guarantees
//! * Every solution carries lower bounds computed for its own instance; [`lower_bound`] has the table of variants and proofs.
//! * [`k_splitour`], [`split`] and [`solve`] on closed routes from one depot over a metric, without limits: at most 5/2 - 1/m times the
//!   least makespan. Clustering first ([`assign`]) has no factor at all.
//! * Equal input, seed and iterations give equal bits. Every solution has passed the checker.
//!
//! Min-sum without limits lets one vehicle do everything: with closed routes over a metric that is best.
//!
//! # Features
//! `serde`: serialisation of solutions. `columns`: `lower_bound::columns`, the tightest bound of the makespan, by column generation.
//!
//! # References
//! Frederickson, Hecht, Kim 1978; Held and Karp 1970; Jepsen et al. 2008; Baldacci, Mingozzi, Roberti 2011; Christiaens and Vanden Berghe 2020; Gao, Mandal, Bhattacharya 2020.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod check;
mod cluster_first;
mod error;
mod feasibility;
mod fleet;
mod improve;
mod initial;
mod least_fleet;
pub mod lower_bound;
mod objective;
mod problem;
mod procedures;
mod solution;
mod split;

pub use christofides;

pub use check::{LIMIT_TOLERANCE, Measured, check};
pub use cluster_first::assign;
pub use error::{Error, List, Remedy};
pub use fleet::{Absorb, Euclidean, Fleet, Nodes, Revisit, Space, TargetId, VehicleId};
pub use improve::{Options, Progress, solve, solve_from, solve_with};
pub use least_fleet::{LeastFleet, least_fleet};
pub use lower_bound::LowerBounds;
pub use objective::Objective;
pub use problem::{End, Problem};
pub use procedures::{RoundsCost, procedure_1, procedure_2};
pub use solution::Solution;
pub use split::{k_splitour, split};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
