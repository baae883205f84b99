//! Optimal control by direct transcription.
//!
//! ```text
//! minimise    mayer(x(t0), x(tf), tf) + integral of lagrange(t, x, u) dt
//! subject to  dx/dt = f(t, x, u),  bounds,  path constraints,  boundary conditions
//! ```
//!
//! The trajectory becomes finitely many numbers (a [`Transcription`] on a [`Mesh`]), the problem a nonlinear program of stages, and
//! a primal-dual interior-point method solves it: inequality constraints by logarithmic barriers, global convergence by a filter
//! line search (Waechter and Biegler 2006), each Newton step by a Riccati recursion over the segments on dense blocks whose
//! sizes are known at compile time. Final time and end conditions are a border of that recursion, made well-posed by a penalty on
//! the end conditions that is zero at the solution. Time and memory grow linearly with the number of segments. Dynamics are
//! written once, generic over the scalar; derivatives are automatic (num-dual) or the user's own.
//!
//! | to | use |
//! |---|---|
//! | state a problem | [`Dynamics`], [`Problem`], [`Bounds`] |
//! | choose a discretisation | [`Mesh`], [`Transcription`] |
//! | solve it | [`solve`], [`solve_with`], [`Guess`], [`Options`] |
//! | solve a neighbour of a solved problem | [`solve_from`] |
//! | use the result | [`Solution`], [`Status`] |
//! | check it independently | [`Solution::integrate`], [`integrate`], [`segment_errors`], [`check_derivatives`] |
//! | see what it leaves between the knots | [`Solution::greatest_violation`] |
//! | refine the mesh | [`solve_refined`], [`refined_mesh`] |
//!
//! # Example
//! A block moves by one metre in the least time with an acceleration of at most 1 m/s^2; the exact answer is 2 s.
//! ```
//! use traj_opt::nalgebra::{RealField, SVector};
//! use traj_opt::{Bounds, Dynamics, Guess, IntegrateOptions, Mesh, Options, Problem, Transcription, solve};
//!
//! struct Block;
//! impl Dynamics<2, 1> for Block {
//!     fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
//!         SVector::from([x[1], u[0]])
//!     }
//! }
//! impl Problem<2, 1> for Block {
//!     type Dynamics = Self;
//!     fn dynamics(&self) -> &Self {
//!         self
//!     }
//!     fn bounds(&self) -> Bounds<2, 1> {
//!         Bounds::free()
//!             .with_control([-1.0].into(), [1.0].into())
//!             .with_initial_state([0.0, 0.0].into())
//!             .with_terminal_state([1.0, 0.0].into())
//!     }
//!     fn mayer<T: RealField + Copy>(&self, _: &SVector<T, 2>, _: &SVector<T, 2>, final_time: T) -> T {
//!         final_time
//!     }
//! }
//! let guess = Guess::line([0.0, 0.0].into(), [1.0, 0.0].into(), [0.0].into(), 1.0);
//! let solution = solve(&Block, &Mesh::uniform(20), Transcription::default(), &guess, &Options::default())?;
//! assert!(solution.status.is_success());
//! assert!((solution.final_time() - 2.0).abs() < 1e-5);
//! let flown = solution.integrate(&Block, &IntegrateOptions::default())?;
//! assert!((flown.end_state()[0] - 1.0).abs() < 1e-6);
//! # Ok::<(), traj_opt::Error>(())
//! ```
//!
//! # What is guaranteed
//! `Status::Solved` means that the scaled KKT residuals of the *transcribed* problem are below the tolerance: a stationary point
//! that the line search reached by descent, usually a local minimum. Same input, same bits. Malformed input is an `Err`.
//!
//! # What is not
//! A global minimum; accuracy in continuous time (a coarse mesh can be better than the truth: see [`segment_errors`]); constraints
//! between the collocation points. `Status::Infeasible` means that no step reduced the violation any further, which for a
//! nonconvex problem is no proof. Bounds are relaxed by 1e-8 of their size, and flat directions of the Hessian are damped in
//! the step, which changes the way to the solution but not the conditions that it meets.
//!
//! # How it is tested
//! Derivatives against automatic ones, costs against analytic switch times and the Riccati equation on generated problems, defects
//! recomputed from what a solution reports, observed orders of convergence, twenty-five classic problems, fifty
//! minimum-time quadcopter transitions for two models, each flown by the integrator.
//!
//! # References
//! - A. Waechter, L. T. Biegler, *On the implementation of an interior-point filter line-search algorithm for large-scale
//!   nonlinear programming*, Math. Program. 106, 2006.
//! - J. T. Betts, *Practical Methods for Optimal Control and Estimation Using Nonlinear Programming*, SIAM, 2010.
//! - L. Vanroye, A. Sathya, J. De Schutter, W. Decre, *FATROP: a fast constrained optimal control problem solver for robot
//!   trajectory optimization and control*, IROS 2023.
//! - E. Hairer, S. P. Norsett, G. Wanner, *Solving Ordinary Differential Equations I*, Springer, 1993.
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
mod linked;
mod mesh;
mod nlp;
mod options;
mod problem;
mod refine;
mod solution;
mod solve;
mod status;
mod transcription;
mod violation;

pub use nalgebra;

pub use bounds::Bounds;
pub use check::check_derivatives;
pub use dynamics::{Dynamics, Hessian, Jacobian};
pub use error::{BoundKind, Error};
pub use guess::Guess;
pub use integrate::{IntegrateOptions, Trajectory, integrate};
pub use linked::{Continuous, FreeInitialTime, Linkage, Linked};
pub use mesh::Mesh;
pub use options::Options;
pub use problem::{Problem, Scales};
pub use refine::{RefineOptions, Refined, refined_mesh, segment_errors, solve_refined};
pub use solution::{Multipliers, Solution};
pub use solve::{Workspace, solve, solve_from, solve_with};
pub use status::{Iteration, Residuals, Status};
pub use transcription::Transcription;
pub use violation::{ConstraintKind, Violation};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
