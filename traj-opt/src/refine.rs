//! Mesh refinement with an independent estimate of the error.
//!
//! The controls of every segment are integrated by the adaptive integrator from the segment's first state; what its last state
//! misses is the segment's error. It includes what no collocation residual shows: controls that switch inside a segment, and
//! false optima of a coarse mesh. Segments above the tolerance are divided (bisection as in J. T. Betts, *Practical Methods for
//! Optimal Control*, section 4.7, with the integration in place of his quadrature of the residual).

use crate::solve::{SAMPLES, solve_on_mesh};
use crate::violation::segment_violations;
use crate::{
    Dynamics, Error, Guess, IntegrateOptions, Iteration, Mesh, Options, Problem, Solution, Status,
    Transcription, Workspace, solve_with,
};
use nalgebra::SVector;
use std::ops::ControlFlow;

/// Settings of [`solve_refined`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct RefineOptions {
    /// Error of a segment, relative to `1 + max |x_i|`, above which it is divided. Default 1e-6.
    pub tolerance: f64,
    /// How far bounds on states and path constraints may be left between the knots, relative to `1 + |bound|`; segments that
    /// leave them further are divided. Default 1e-5. A polynomial control overshoots its bounds where it should switch inside a
    /// segment, however short that is: bounds on controls count with their excess times the segment's share of the flight, which
    /// is what the state can gain from it.
    pub violation_tolerance: f64,
    /// Relative change of the cost between two meshes, the second with every segment halved, that is taken as converged; infinite,
    /// the default, to refine for the trajectory alone. Errors of the trajectory say nothing of controls that the transcription
    /// cannot follow: multiple shooting flies its constant controls exactly, yet its cost converges with order 2 only.
    pub cost_tolerance: f64,
    /// Limit of solves after the first. Default 8.
    pub max_rounds: usize,
    /// Limit of segments. Default 2000.
    pub max_segments: usize,
}

impl Default for RefineOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            violation_tolerance: 1e-5,
            cost_tolerance: f64::INFINITY,
            max_rounds: 8,
            max_segments: 2000,
        }
    }
}

impl RefineOptions {
    /// Sets [`tolerance`](Self::tolerance).
    #[must_use]
    pub fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.tolerance = tolerance;
        self
    }

    /// Sets [`violation_tolerance`](Self::violation_tolerance); infinite to refine for accuracy alone.
    #[must_use]
    pub fn with_violation_tolerance(mut self, tolerance: f64) -> Self {
        self.violation_tolerance = tolerance;
        self
    }

    /// Sets [`cost_tolerance`](Self::cost_tolerance).
    #[must_use]
    pub fn with_cost_tolerance(mut self, tolerance: f64) -> Self {
        self.cost_tolerance = tolerance;
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

impl RefineOptions {
    fn validate(&self) -> Result<(), Error> {
        for (option, value) in [
            ("tolerance", self.tolerance),
            ("violation_tolerance", self.violation_tolerance),
            ("cost_tolerance", self.cost_tolerance),
        ] {
            if value.is_nan() || value <= 0.0 {
                return Err(Error::InvalidOption { option, value });
            }
        }
        Ok(())
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
    /// Greatest violation between the knots, as in [`RefineOptions::violation_tolerance`].
    pub violation: f64,
    /// Relative change of the cost from the mesh of twice as long segments; `None` if the last round did not halve them all.
    pub cost_change: Option<f64>,
    /// True if error, violation and, if asked for, the change of the cost are below their tolerances.
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

/// Solves, estimates the error of every segment independently, divides the segments that are not accurate or leave their
/// constraints, and repeats from the trajectory and the multipliers that it has, with the barrier parameter
/// [`Options::warm_mu`]. A mesh on which the solve fails, coarse ones have optima that fly away, is halved and begun again from the
/// guess.
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
    refine.validate()?;
    let workspace = Workspace::new();
    let mut attempts = Attempts { workspace, problem, transcription, options, iterations: 0 };
    let mut solution = attempts.first(mesh, guess, refine.max_segments)?;
    let (mut rounds, mut cost_change) = (0, None);
    loop {
        let judged = judge(&solution, problem, refine)?;
        let settled = cost_change.unwrap_or(f64::INFINITY) <= refine.cost_tolerance;
        let mesh = if judged.converged {
            halved(solution.mesh())
        } else {
            refined_mesh(solution.mesh(), &judged.errors, refine.tolerance, transcription.order())
        };
        let spent = rounds >= refine.max_rounds || mesh.n_segments() > refine.max_segments;
        let done = spent || (judged.converged && settled);
        if !done && solution.status.is_success() {
            let next = attempts.refine(&mesh, &solution, guess)?;
            if next.status.is_success() {
                let size = next.objective.abs().max(f64::MIN_POSITIVE);
                let change = (next.objective - solution.objective).abs() / size;
                cost_change = judged.converged.then_some(change);
                (solution, rounds) = (next, rounds + 1);
                continue;
            }
        }
        let Judged { error, violation, .. } = judged;
        let converged = judged.converged && settled;
        let iterations = attempts.iterations;
        return Ok(Refined { solution, error, violation, cost_change, converged, rounds, iterations });
    }
}

/// Solves of one problem, with the iterations that they took.
struct Attempts<'a, const NX: usize, const NU: usize, P> {
    workspace: Workspace<NX, NU>,
    problem: &'a P,
    transcription: Transcription,
    options: &'a Options,
    iterations: usize,
}

impl<const NX: usize, const NU: usize, P: Problem<NX, NU>> Attempts<'_, NX, NU, P> {
    fn begin_at(
        &mut self,
        mesh: &Mesh,
        guess: &Guess<NX, NU>,
        options: &Options,
    ) -> Result<Solution<NX, NU>, Error> {
        let proceed = |_: &Iteration| ControlFlow::Continue(());
        let Self { workspace, problem, transcription, .. } = self;
        let solution = solve_with(workspace, *problem, mesh, *transcription, guess, options, proceed)?;
        self.iterations += solution.iterations;
        Ok(solution)
    }

    /// On the given mesh, or a finer one where that does not succeed; with patience only if it is needed.
    fn first(
        &mut self,
        mesh: &Mesh,
        guess: &Guess<NX, NU>,
        max_segments: usize,
    ) -> Result<Solution<NX, NU>, Error> {
        let patient = self.options;
        let impatient = patient.clone().with_max_iterations(patient.max_iterations.min(IMPATIENT));
        let mut solution = self.halve_until_solved(mesh, guess, &impatient, max_segments)?;
        if solution.status == Status::IterationLimit && impatient != *patient {
            solution = self.halve_until_solved(mesh, guess, patient, max_segments)?;
        }
        Ok(solution)
    }

    fn halve_until_solved(
        &mut self,
        mesh: &Mesh,
        guess: &Guess<NX, NU>,
        options: &Options,
        max_segments: usize,
    ) -> Result<Solution<NX, NU>, Error> {
        let mut solution = self.begin_at(mesh, guess, options)?;
        for _ in 0..MAX_HALVINGS {
            if solution.status.is_success() || 2 * solution.mesh().n_segments() > max_segments {
                break;
            }
            solution = self.begin_at(&halved(solution.mesh()), guess, options)?;
        }
        Ok(solution)
    }

    /// From the multipliers of a coarser mesh; if that fails from its trajectory, then on from where that got, then from the first guess.
    fn refine(
        &mut self,
        mesh: &Mesh,
        coarser: &Solution<NX, NU>,
        guess: &Guess<NX, NU>,
    ) -> Result<Solution<NX, NU>, Error> {
        let proceed = |_: &Iteration| ControlFlow::Continue(());
        let Self { workspace, problem, transcription, options, .. } = self;
        let mut next = solve_on_mesh(workspace, *problem, coarser, mesh, *transcription, options, proceed)?;
        self.iterations += next.iterations;
        if !next.status.is_success() {
            next = self.begin_at(mesh, &Guess::from_solution(&next, SAMPLES), self.options)?;
        }
        if !next.status.is_success() {
            next = self.begin_at(mesh, guess, self.options)?;
        }
        Ok(next)
    }
}

/// Iterations after which a first mesh is taken to be too coarse: it may have an optimum that flies away, which takes long to find,
/// and a finer one few. Only if all finer ones take as long are they solved to the end.
const IMPATIENT: usize = 150;
/// Halvings of a mesh on which the first solve fails.
const MAX_HALVINGS: usize = 3;
/// Points of a segment at which its constraints are looked at.
const LOOKS: usize = 8;

/// What is still wrong with a solution.
struct Judged {
    /// Errors of the segments, raised where constraints are left so that the segment is divided into three, its
    /// neighbours into two.
    errors: Vec<f64>,
    error: f64,
    violation: f64,
    converged: bool,
}

fn judge<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    solution: &Solution<NX, NU>,
    problem: &P,
    refine: &RefineOptions,
) -> Result<Judged, Error> {
    let order = solution.transcription().order();
    let mut errors = segment_errors(solution, problem.dynamics())?;
    let error = errors.iter().copied().fold(0.0, f64::max);
    let violations = segment_violations(solution, problem, LOOKS);
    let violation = violations.iter().copied().fold(0.0, f64::max);
    let last = errors.len() - 1;
    for k in (0..=last).filter(|&k| violations[k] > refine.violation_tolerance) {
        // the switch that it is about moves with the mesh, and shall not get into a longer segment
        for near in k.saturating_sub(1)..=(k + 1).min(last) {
            let parts: f64 = if near == k { 3.0 } else { 2.0 };
            errors[near] = errors[near].max(refine.tolerance * parts.powi(order as i32 + 1));
        }
    }
    let converged = error <= refine.tolerance && violation <= refine.violation_tolerance;
    Ok(Judged { errors, error, violation, converged })
}

fn halved(mesh: &Mesh) -> Mesh {
    refined_mesh(mesh, &vec![f64::MIN_POSITIVE; mesh.n_segments()], 0.9 * f64::MIN_POSITIVE, 1)
}
