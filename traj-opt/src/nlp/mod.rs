//! The transcribed problem and its interior-point solver.
//!
//! `layout` numbers the variables, `program` evaluates and differentiates the transcribed problem segment by segment,
//! `riccati` solves the linear-quadratic subproblem, `barrier` treats bounds, `filter` and `interior_point` are the method, and `course`
//! says when it ends.

pub(crate) mod barrier;
pub(crate) mod boundary;
mod course;
pub(crate) mod filter;
pub(crate) mod hermite_simpson;
pub(crate) mod interior_point;
pub(crate) mod kkt;
pub(crate) mod layout;
pub(crate) mod line_search;
pub(crate) mod lu;
mod multipliers;
pub(crate) mod path;
mod prepare;
pub(crate) mod program;
mod prolong;
pub(crate) mod quadratic;
pub(crate) mod radau;
pub(crate) mod restoration;
pub(crate) mod riccati;
pub(crate) mod runge_kutta;
pub(crate) mod running;
pub(crate) mod setup;
#[cfg(feature = "faer")]
pub(crate) mod sparse;
pub(crate) mod stages;
pub(crate) mod tableau;
pub(crate) mod trapezoidal;
pub(crate) mod warm;
