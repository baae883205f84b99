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
//! | solve a solved problem on another mesh | [`solve_on_mesh`] |
//! | solve many problems of one kind | [`solve_batch`] |
//! | use the result | [`Solution`], [`Status`] |
//! | check it independently | [`Solution::integrate`], [`integrate`], [`segment_errors`], [`check_derivatives`], [`check_path_derivatives`] |
//! | see what it leaves between the knots, or why it failed | [`Solution::greatest_violation`], [`Solution::diagnosis`] |
//! | free the start time, link phases | [`FreeInitialTime`], [`Linked`] |
//! | factorise without regard to stages | [`LinearAlgebra`] (feature `faer`) |
//! | keep second-order cones (limits of a thrust vector, glide slopes) | `Conic`, `solve_conic` (feature `clarabel`) |
//! | bound the minimum time from below | `least_time_bound` (feature `clarabel`) |
//! | refine the mesh | [`solve_refined`], [`refined_mesh`] |
//!
//! # From the problem to the Newton system
//! 1. *Transcription.* Segment k of length h has control vectors `u` and end states `x_k, x_{k+1}`. Every transcription is a set of
//!    residuals `r_i = x_k + h sum_j a_ij f(t_j, X_j, u_j) - X_i = 0` at its points: explicit stages inside the segment
//!    ([`Transcription::RungeKutta`]; Hairer, Norsett, Wanner 1993), the end alone (trapezoidal), middle and end (Hermite-Simpson;
//!    Hargraves and Paris 1987, Betts 2010 section 4.5), or Radau's points (Garg et al. 2010).
//! 2. *Barrier.* Path constraints and boundary inequalities get slacks, and bounds a term `-mu ln(distance)`; mu falls to zero
//!    (Fiacco and McCormick; Waechter and Biegler 2006, section 2.1).
//! 3. *Newton's method* on the conditions `grad f + grad c' y - z = 0, c = 0, z distance = mu`. Bound multipliers z and slacks are
//!    eliminated into the diagonal `Sigma = z / distance`, as are the inner states of a segment: the linearised residuals give
//!    them as linear functions of `(dx_k, du, dp)`, p the final time. What is left has the form
//!    `dx_{k+1} = a dx_k + b du + ap dp + c` with a quadratic cost.
//! 4. *Riccati recursion* over the segments; p and the multipliers of the end conditions form a border of a few columns. If a
//!    reduced Hessian is not positive definite, a multiple of the identity (in scaled variables) is added and the recursion
//!    repeated (inertia correction). [`LinearAlgebra`] chooses a sparse `L D L'` of the same system instead, whose pivots tell the inertia.
//! 5. *Filter line search* with second-order corrections; restoration by Gauss-Newton steps on the violation alone.
//!
//! The conic path (`solve_conic`) treats the equations of step 1 by a sequence of cone programs instead: trust region, virtual
//! controls with an exact penalty, the Lagrangian's curvature made convex (Mao, Szmuk, Acikmese 2016, 2018).
//!
//! Static parameters, a free start time and the durations of phases are components of the state whose derivative is zero.
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
//! between the collocation points (but see [`solve_refined`]). `Status::Infeasible` means that no step reduced the violation any further, which for a
//! nonconvex problem is no proof. Bounds are relaxed by 1e-8 of their size, and flat directions of the Hessian are damped in
//! the step, which changes the way to the solution but not the conditions that it meets.
//!
//! # How it is tested
//! Derivatives against automatic ones and central differences, costs against analytic switch times and the Riccati equation on
//! generated problems, a counting allocator that sees none between iterations, the conditions of optimality written out by hand from what a solution reports, guesses of time over eight
//! decades, infeasible problems, observed orders of convergence, twenty-five classic problems with every transcription, the recursion
//! against a sparse factorisation, fifty
//! minimum-time quadcopter transitions for two models, each flown by the integrator.
//!
//! # References
//! - A. Waechter, L. T. Biegler, *On the implementation of an interior-point filter line-search algorithm for large-scale
//!   nonlinear programming*, Math. Program. 106, 2006.
//! - J. T. Betts, *Practical Methods for Optimal Control and Estimation Using Nonlinear Programming*, SIAM, 2010.
//! - L. Vanroye, A. Sathya, J. De Schutter, W. Decre, *FATROP: a fast constrained optimal control problem solver for robot
//!   trajectory optimization and control*, IROS 2023.
//! - C. R. Hargraves, S. W. Paris, *Direct trajectory optimization using nonlinear programming and collocation*, J. Guidance 10, 1987.
//! - D. Garg et al., *A unified framework for the numerical solution of optimal control problems using pseudospectral methods*,
//!   Automatica 46, 2010.
//! - E. Hairer, S. P. Norsett, G. Wanner, *Solving Ordinary Differential Equations I*, Springer, 1993.
//!
//! - Y. Mao, M. Szmuk, B. Acikmese, *Successive convexification of non-convex optimal control problems and its convergence
//!   properties*, IEEE CDC 2016.
//!
//! # Features
//! `serde`: (de)serialisation of data types. `rayon`: batches over threads. `clarabel`: lower bounds by conic programming, and
//! successive convexification.
//! `faer`: sparse factorisation of the whole Newton system instead of the recursion over its stages.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod autodiff;
mod batch;
mod bounds;
mod check;
#[cfg(feature = "clarabel")]
mod convexify;
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
#[cfg(feature = "clarabel")]
mod relaxation;
mod solution;
mod solve;
mod status;
mod transcription;
mod violation;

pub use nalgebra;

pub use batch::solve_batch;
pub use bounds::Bounds;
pub use check::{check_derivatives, check_path_derivatives};
#[cfg(feature = "clarabel")]
pub use convexify::{Affine, Cone, Conic, ConicOptions, solve_conic, solve_conic_with};
pub use dynamics::{Dynamics, Hessian, Jacobian};
pub use error::{BoundKind, Error};
pub use guess::Guess;
pub use integrate::{IntegrateOptions, Trajectory, integrate};
pub use linked::{Continuous, FreeInitialTime, Linkage, Linked};
pub use mesh::Mesh;
pub use options::{LinearAlgebra, Options};
pub use problem::{Problem, Scales};
pub use refine::{RefineOptions, Refined, refined_mesh, segment_errors, solve_refined};
#[cfg(feature = "clarabel")]
pub use relaxation::{BoundOptions, PointMass, least_time_bound};
pub use solution::{Multipliers, Solution};
pub use solve::{Workspace, solve, solve_from, solve_on_mesh, solve_with};
pub use status::{Iteration, Residuals, Status};
pub use transcription::Transcription;
pub use violation::{ConstraintKind, Location, Violation};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
