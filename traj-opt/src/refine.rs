//! Mesh refinement with an independent estimate of the error.
//!
//! The controls of every segment are integrated by the adaptive integrator from the segment's first state; what its last state
//! misses is the segment's error. It includes what no collocation residual shows: controls that switch inside a segment, and
//! false optima of a coarse mesh. Segments above the tolerance are divided (bisection as in J. T. Betts, *Practical Methods for
//! Optimal Control*, section 4.7, with the integration in place of his quadrature of the residual).

use crate::{
    Dynamics, Error, Guess, IntegrateOptions, Iteration, Mesh, Options, Problem, Solution, Transcription,
    Workspace, solve_with,
};
use nalgebra::SVector;
use std::ops::ControlFlow;

/// Settings of [`solve_refined`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RefineOptions {
    /// Error of a segment, relative to `1 + max |x_i|`, above which it is divided. Default 1e-6.
    pub tolerance: f64,
    /// Limit of solves after the first. Default 8.
    pub max_rounds: usize,
    /// Limit of segments. Default 2000.
    pub max_segments: usize,
}

impl Default for RefineOptions {
    fn default() -> Self {
        Self { tolerance: 1e-6, max_rounds: 8, max_segments: 2000 }
    }
}

impl RefineOptions {
    /// Sets [`tolerance`](Self::tolerance).
    #[must_use]
    pub fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Sets [`max_rounds`](Self::max_rounds).
    #[must_use]
    pub fn with_max_rounds(mut self, n: usize) -> Self {
        self.max_rounds = n;
        self
    }

    /// Sets [`max_segments`](Self::max_segments).
    #[must_use]
    pub fn with_max_segments(mut self, n: usize) -> Self {
        self.max_segments = n;
        self
    }
}

/// A refined solution.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Refined<const NX: usize, const NU: usize> {
    /// The solution on the last mesh.
    pub solution: Solution<NX, NU>,
    /// Its greatest segment error, relative as in [`RefineOptions::tolerance`].
    pub error: f64,
    /// True if that error is below the tolerance.
    pub converged: bool,
    /// Solves after the first.
    pub rounds: usize,
    /// Iterations of all solves.
    pub iterations: usize,
}

/// Error of every segment: what integrating its controls from its first state misses at its last, relative to `1 + max |x_i|`.
///
/// # Errors
/// Those of the integrator.
pub fn segment_errors<const NX: usize, const NU: usize>(
    solution: &Solution<NX, NU>,
    dynamics: &impl Dynamics<NX, NU>,
) -> Result<Vec<f64>, Error> {
    let options = IntegrateOptions::default().with_tolerance(1e-11);
    let mut size = SVector::<f64, NX>::repeat(1.0);
    for x in solution.states() {
        size = size.zip_map(x, |s, v| s.max(1.0 + v.abs()));
    }
    let times = solution.times();
    let mut errors = Vec::with_capacity(times.len() - 1);
    for k in 0..times.len() - 1 {
        let mut flown = crate::Trajectory::starting_at(times[k], solution.states()[k]);
        let rhs =
            |t: f64, x: &SVector<f64, NX>| dynamics.derivative(t, x, &solution.control_in_segment(k, t));
        flown.extend(rhs, times[k + 1], &options)?;
        let miss = flown.end_state() - solution.states()[k + 1];
        errors.push(miss.component_div(&size).amax());
    }
    Ok(errors)
}

/// Divides every segment whose error exceeds `tolerance`: into 2, or into up to 4 where the error is far above.
#[must_use]
pub fn refined_mesh(mesh: &Mesh, errors: &[f64], tolerance: f64, order: usize) -> Mesh {
    let f = mesh.fractions();
    let mut fractions = vec![0.0];
    for (k, error) in errors.iter().enumerate().take(mesh.n_segments()) {
        // an error of order p + 1 in the length falls by parts^(p + 1)
        let parts = if *error > tolerance {
            (error / tolerance).powf(1.0 / (order as f64 + 1.0)).ceil().clamp(2.0, 4.0) as usize
        } else {
            1
        };
        for j in 1..=parts {
            fractions.push(if j == parts {
                f[k + 1]
            } else {
                f[k] + (f[k + 1] - f[k]) * j as f64 / parts as f64
            });
        }
    }
    Mesh::from_fractions(fractions).unwrap_or_else(|_| mesh.clone())
}

/// Solves, estimates the error of every segment independently, divides the segments that are not accurate, and repeats.
///
/// # Errors
/// Those of [`solve`](crate::solve) and of the integrator.
pub fn solve_refined<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &P,
    mesh: &Mesh,
    transcription: Transcription,
    guess: &Guess<NX, NU>,
    options: &Options,
    refine: &RefineOptions,
) -> Result<Refined<NX, NU>, Error> {
    if refine.tolerance.is_nan() || refine.tolerance <= 0.0 {
        return Err(Error::InvalidOption { option: "tolerance", value: refine.tolerance });
    }
    let proceed = |_: &Iteration| ControlFlow::Continue(());
    let mut workspace = Workspace::new();
    let mut solution = solve_with(&mut workspace, problem, mesh, transcription, guess, options, proceed)?;
    let mut iterations = solution.iterations;
    for rounds in 0.. {
        let errors = segment_errors(&solution, problem.dynamics())?;
        let error = errors.iter().copied().fold(0.0, f64::max);
        let mesh = refined_mesh(solution.mesh(), &errors, refine.tolerance, transcription.order());
        let converged = error <= refine.tolerance;
        if converged || rounds >= refine.max_rounds || mesh.n_segments() > refine.max_segments {
            return Ok(Refined { solution, error, converged, rounds, iterations });
        }
        let guess = Guess::from_solution(&solution, 4);
        let next = solve_with(&mut workspace, problem, &mesh, transcription, &guess, options, proceed)?;
        iterations += next.iterations;
        if !next.status.is_success() && solution.status.is_success() {
            return Ok(Refined { solution, error, converged, rounds, iterations });
        }
        solution = next;
    }
    Err(Error::InvalidOption { option: "max_rounds", value: refine.max_rounds as f64 })
}
