//! Optimal control by direct transcription: a structure-exploiting interior-point method, mesh refinement and an adaptive
//! integrator.
//!
//! | to | use |
//! |---|---|
//! | state a problem | [`Dynamics`], [`Problem`], [`Bounds`] |
//! | choose a discretisation | [`Mesh`], [`Transcription`] |
//! | solve it | [`solve`], [`solve_with`], [`Guess`], [`Options`] |
//! | use the result | [`Solution`], [`Status`] |
//! | check it independently | [`Solution::integrate`], [`integrate`] |
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod autodiff;
mod bounds;
mod check;
mod dense;
mod dynamics;
mod error;
mod guess;
mod integrate;
mod interpolate;
mod mesh;
mod nlp;
mod options;
mod problem;
mod solution;
mod solve;
mod status;
mod transcription;

pub use nalgebra;

pub use bounds::Bounds;
pub use check::check_derivatives;
pub use dynamics::{Dynamics, Hessian, Jacobian};
pub use error::{BoundKind, Error};
pub use guess::Guess;
pub use integrate::{IntegrateOptions, Trajectory, integrate};
pub use mesh::Mesh;
pub use options::Options;
pub use problem::{Problem, Scales};
pub use solution::{Multipliers, Solution};
pub use solve::{Workspace, solve, solve_with};
pub use status::{Iteration, Residuals, Status};
pub use transcription::Transcription;
