//! Successive convexification: problems with second-order cones, by a sequence of cone programs.
//!
//! The transcribed problem (any [`Transcription`], the very equations that [`solve`](crate::solve) treats) is, over all its variables w,
//!
//! ```text
//! minimise f(w)  subject to  c(w) = 0,  l <= w <= u,  |A w + a| <= b' w + g  at every collocation point
//! ```
//!
//! Each iteration solves the convex subproblem for the step d from the iterate w,
//!
//! ```text
//! minimise   f'd + d'Hd/2 + penalty (sum of |v| + sum of s)
//! subject to c + J d = v,  l <= w + d <= u,  |A (w + d) + a| <= b'(w + d) + g + s,  s >= 0,  |d| <= radius
//! ```
//!
//! with *virtual controls* v, without which a linearisation can be infeasible where the problem is not, and the final time as a variable, on which
//! lengths of segments depend (time dilation). The step is taken if the penalised cost falls by at least a small part of what the subproblem
//! predicts; the radius grows or shrinks by that ratio (Y. Mao, M. Szmuk, B. Acikmese, *Successive convexification of non-convex optimal
//! control problems and its convergence properties*, IEEE CDC 2016, and *Successive convexification: a superlinearly convergent algorithm*,
//! arXiv 1804.06539, 2018; the penalty is the exact one of R. Fletcher's Sl1QP, *Practical Methods of Optimization*, 1987). Two things go
//! beyond these sources. H is the Lagrangian's second derivative with its negative eigenvalues cut off, block by block. And a step of
//! which the penalised cost makes too little is tried again with the constraints' values at its end (second-order correction).
//!
//! Near singular arcs and curved optima it is slow: what is cut off H is missing there, and some take more than a hundred cone programs.
//!
//! `Solved` means the same as for the interior-point method: scaled KKT residuals below the tolerance, those of the cones included.

mod cones;
mod jacobian;
mod options;
mod subproblem;

pub use cones::{Affine, Cone, Conic};
pub use options::ConicOptions;

use crate::dense::vector;
use crate::nlp::interior_point::{Memory, Outcome};
use crate::nlp::program::Program;
use crate::nlp::setup;
use crate::solve::extract;
use crate::violation::Violation;
use crate::{
    ConstraintKind, Error, Guess, Iteration, Mesh, Options, Problem, Residuals, Solution, Status,
    Transcription,
};
use jacobian::{Triplets, derivatives, n_rows};
use nalgebra::SVector;
use std::ops::ControlFlow;
use subproblem::{Answer, Placed, Subproblem};

/// Least ratio of actual to predicted reduction at which a step is taken, and bounds between which the radius stays.
const TAKEN: f64 = 1e-4;
const POOR: f64 = 0.25;
const GOOD: f64 = 0.7;
/// By how much the radius shrinks and grows, and where it ends.
const SHRINK: f64 = 0.3;
const GROW: f64 = 2.5;
const LEAST_RADIUS: f64 = 1e-9;
const GREATEST_RADIUS: f64 = 1e3;
const GREATEST_PENALTY: f64 = 1e6;
/// Predicted reductions below this part of the penalised cost are rounding.
const ROUNDING: f64 = 1e-11;

/// Solves a problem with second-order cones by successive convexification.
///
/// # Arguments
/// As [`solve`](crate::solve). [`Transcription::CompressedHermiteSimpson`] is solved in its separated form, which has the same answers.
///
/// # Returns
/// The same outcome as the other solvers: status, KKT residuals, log, multipliers (those of the cones in
/// [`Multipliers::cones`](crate::Multipliers::cones)), diagnosis, interpolation, [`Solution::integrate`]. In its log
/// [`Iteration::trust_radius`] is the radius and `step_length` 1 for a step that was taken, 0 for one that was refused.
///
/// # Guarantee
/// The penalised cost never rises. Like every local method it may end in a local minimum, or infeasible where the problem is not.
///
/// # Errors
/// Those of [`solve`](crate::solve), [`Error::InvalidOption`] for options out of range, [`Error::NonFiniteCone`].
///
/// # Complexity
/// An iteration is one cone program with some ten numbers a variable, sparse; it allocates. Several times as slow as
/// [`solve`](crate::solve), which is the better choice where smooth path constraints serve.
pub fn solve_conic<const NX: usize, const NU: usize, P: Conic<NX, NU>>(
    problem: &P,
    mesh: &Mesh,
    transcription: Transcription,
    guess: &Guess<NX, NU>,
    options: &ConicOptions,
) -> Result<Solution<NX, NU>, Error> {
    solve_conic_with(problem, mesh, transcription, guess, options, |_| ControlFlow::Continue(()))
}

/// [`solve_conic`] with a monitor that sees every iteration and may stop the solve by returning `ControlFlow::Break(())`.
///
/// # Errors
/// Those of [`solve_conic`].
pub fn solve_conic_with<const NX: usize, const NU: usize, P: Conic<NX, NU>>(
    problem: &P,
    mesh: &Mesh,
    transcription: Transcription,
    guess: &Guess<NX, NU>,
    options: &ConicOptions,
    monitor: impl FnMut(&Iteration) -> ControlFlow<()>,
) -> Result<Solution<NX, NU>, Error> {
    options.validate()?;
    let bounds = problem.bounds();
    setup::validate(problem, &bounds)?;
    guess.validate(bounds.initial_time)?;
    let cones = problem.cones();
    if let Some(cone) = cones.iter().position(|cone| !cone.is_finite()) {
        return Err(Error::NonFiniteCone { cone });
    }
    let transcription = match transcription.valid() {
        Transcription::CompressedHermiteSimpson => Transcription::HermiteSimpson,
        other => other,
    };
    let scales = problem.scales().unwrap_or_else(|| setup::default_scales(&bounds, guess));
    let free_time = bounds.final_time_lower != bounds.final_time_upper;
    let program = Program { problem, mesh, transcription, bounds, scales, free_time };
    let mut memory = Memory::default();
    let inner = Options::default().with_max_iterations(options.max_iterations);
    memory.start(&program, guess, guess.final_time(), &inner);
    let mut method = Method {
        cones,
        program,
        memory,
        answer: Answer::default(),
        penalty: options.penalty,
        radius: options.trust_radius,
    };
    method.settle_slacks();
    let outcome = method.run(options, monitor);
    let mut solution = extract(&method.program, &method.memory, &outcome);
    solution.multipliers.cones = method.answer.cones.concat();
    method.diagnose(&mut solution);
    Ok(solution)
}

/// The state of a solve.
struct Method<'a, const NX: usize, const NU: usize, P> {
    program: Program<'a, NX, NU, P>,
    memory: Memory<NX, NU>,
    cones: Vec<Cone<NX, NU>>,
    /// Of the last subproblem; its multipliers are those of the solve.
    answer: Answer,
    penalty: f64,
    radius: f64,
}

impl<const NX: usize, const NU: usize, P: Problem<NX, NU>> Method<'_, NX, NU, P> {
    fn run(
        &mut self,
        options: &ConicOptions,
        mut monitor: impl FnMut(&Iteration) -> ControlFlow<()>,
    ) -> Outcome {
        let (mut jacobian, mut curvature) = (Triplets::default(), Triplets::default());
        let mut step_length = 1.0;
        let mut ended = false;
        let mut iteration = 0;
        loop {
            self.memory.linearise_first_order(&self.program);
            let placed = self.place_cones();
            let residuals = self.residuals(&placed);
            let entry = Iteration {
                iteration,
                objective: self.memory.values.objective,
                lagrangian: self.memory.lagrangian(),
                residuals,
                mu: 0.0,
                regularisation: 0.0,
                step_length,
                trust_radius: self.radius,
            };
            self.memory.log.push(entry);
            let spent = iteration >= options.max_iterations;
            let status = judge(&residuals, options, ended, spent)
                .or_else(|| monitor(&entry).is_break().then_some(Status::Stopped));
            if let Some(status) = status {
                return Outcome { status, iterations: iteration, residuals };
            }
            derivatives(&self.program, &self.memory, &mut jacobian, &mut curvature);
            let step = self.step(&jacobian, &curvature, &placed, options);
            step_length = if step == Step::Taken { 1.0 } else { 0.0 };
            ended = step == Step::None;
            iteration += 1;
        }
    }

    /// One subproblem, and what follows from its answer.
    fn step(
        &mut self,
        jacobian: &Triplets,
        curvature: &Triplets,
        placed: &[Placed],
        options: &ConicOptions,
    ) -> Step {
        let memory = &self.memory;
        let n_trusted = memory.layout.path_slacks;
        let range: Vec<(f64, f64)> = (0..memory.w.len())
            .map(|i| (memory.bounds.lower[i] - memory.w[i], memory.bounds.upper[i] - memory.w[i]))
            .collect();
        let (scale, gradient) = (memory.variable_scale.clone(), memory.lin.objective.clone());
        let (residual, row_scale) = (residual_vector(memory, &memory.values), row_scales(memory));
        let before = self.merit();
        let model = Subproblem {
            gradient: &gradient,
            curvature,
            jacobian,
            residual: &residual,
            row_scale: &row_scale,
            scale: &scale,
            range: &range,
            n_trusted,
            cones: placed,
            cost_scale: memory.objective_scale,
        };
        let Some(answer) = model.solve(self.penalty, self.radius) else {
            self.radius *= SHRINK;
            return if self.radius < LEAST_RADIUS { Step::None } else { Step::Refused };
        };
        let zero = vec![0.0; scale.len()];
        let (value, left) = model.model(&answer.step, self.penalty);
        let (now, violation) = model.model(&zero, self.penalty);
        let predicted = now - value;
        let held = model.length(&answer.step) > 0.9 * self.radius;
        let stuck = predicted <= ROUNDING * (1.0 + before.abs());
        if left > options.tolerance
            && left > 0.5 * violation
            && (!held || stuck)
            && self.penalty < GREATEST_PENALTY
        {
            self.penalty *= 10.0;
            return Step::Refused;
        }
        if stuck {
            self.adopt(answer);
            return Step::None;
        }
        let origin = self.memory.w.clone();
        let (ratio, taken) = self.tried(&model, answer, &origin, (before, predicted));
        self.adapt_radius(ratio, model.length(&taken.step), held);
        if ratio > TAKEN {
            self.adopt(taken);
            return Step::Taken;
        }
        self.memory.w.copy_from_slice(&origin);
        self.evaluate();
        if self.radius < LEAST_RADIUS { Step::None } else { Step::Refused }
    }

    /// By the ratio of actual to predicted reduction of a step of some length, which the radius held back or not.
    fn adapt_radius(&mut self, ratio: f64, length: f64, held: bool) {
        if ratio < POOR || ratio.is_nan() {
            self.radius = SHRINK * self.radius.min(length);
        } else if ratio > GOOD && held {
            self.radius = (GROW * self.radius).min(GREATEST_RADIUS);
        }
    }

    /// Moves along the step of a subproblem, or along its second-order correction where the merit falls far less than predicted and that one
    /// does better; returns the ratio of reductions and the step.
    fn tried(
        &mut self,
        model: &Subproblem,
        answer: Answer,
        origin: &[f64],
        (before, predicted): (f64, f64),
    ) -> (f64, Answer) {
        let ratio = (before - self.try_step(origin, &answer.step)) / predicted;
        if ratio >= POOR || ratio.is_nan() {
            return (ratio, answer);
        }
        // the residual at the end of the step, less what the linearisation says of it, stands for the curvature
        let mut residual = residual_vector(&self.memory, &self.memory.values);
        model.jacobian.iter().for_each(|(row, column, v)| residual[row] -= v * answer.step[column]);
        let corrected = Subproblem { residual: &residual, ..*model };
        let Some(second) = corrected.solve(self.penalty, self.radius) else { return (ratio, answer) };
        let other = (before - self.try_step(origin, &second.step)) / predicted;
        if other > ratio {
            return (other, second);
        }
        self.try_step(origin, &answer.step);
        (ratio, answer)
    }

    /// Moves to `origin + d`, with slacks at the values of their functions; returns the merit there.
    fn try_step(&mut self, origin: &[f64], d: &[f64]) -> f64 {
        for (w, (o, d)) in self.memory.w.iter_mut().zip(origin.iter().zip(d)) {
            *w = o + d;
        }
        self.settle_slacks();
        self.merit()
    }

    fn evaluate(&mut self) {
        let m = &mut self.memory;
        self.program.evaluate(&m.layout, &m.rows, &mut m.w, &mut m.scratch, &mut m.values);
    }

    /// Sets every slack to the value of its function, within its bounds: the violation is then the true one.
    fn settle_slacks(&mut self) {
        self.evaluate();
        let m = &mut self.memory;
        let mut moved =
            |i: usize, by: f64| m.w[i] = (m.w[i] + by).clamp(m.bounds.lower[i], m.bounds.upper[i]);
        for (row, value) in m.values.path.iter().enumerate() {
            moved(m.layout.path_slacks + row, *value);
        }
        for (row, slack) in m.rows.slack.iter().enumerate() {
            if let Some(slack) = slack {
                moved(m.layout.boundary_slacks + slack, m.values.boundary[row]);
            }
        }
        self.evaluate();
    }

    /// The cost, divided by its scale, and the weighted violation; infinite where one is not a number.
    fn merit(&self) -> f64 {
        let m = &self.memory;
        let rows = residual_vector(m, &m.values);
        let violation: f64 = rows.iter().zip(row_scales(m)).map(|(v, s)| v.abs() / s).sum();
        let cones: f64 = self.excesses().map(|(_, _, excess)| excess.max(0.0)).sum();
        let merit = m.values.objective / m.objective_scale + self.penalty * (violation + cones);
        if merit.is_nan() { f64::INFINITY } else { merit }
    }

    /// Point, cone and excess of every cone.
    fn excesses(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let m = &self.memory;
        m.layout.points.iter().enumerate().flat_map(move |(i, point)| {
            let x: SVector<f64, NX> = vector(&m.w, m.layout.point_state(point));
            let u: SVector<f64, NU> = vector(&m.w, m.layout.control(point.segment, point.local));
            self.cones.iter().enumerate().map(move |(j, cone)| (i, j, cone.excess(&x, &u)))
        })
    }

    /// Every cone at every collocation point.
    fn place_cones(&self) -> Vec<Placed> {
        let m = &self.memory;
        let mut placed = vec![];
        for point in &m.layout.points {
            let (state, control) =
                (m.layout.point_state(point), m.layout.control(point.segment, point.local));
            let (x, u) = (vector::<NX>(&m.w, state), vector::<NU>(&m.w, control));
            let row = |affine: &Affine<NX, NU>| {
                let states = (0..NX).map(|i| (state + i, affine.state[i]));
                let controls = (0..NU).map(|i| (control + i, affine.control[i]));
                (states.chain(controls).filter(|(_, v)| *v != 0.0).collect(), affine.at(&x, &u))
            };
            for cone in &self.cones {
                let rows = std::iter::once(&cone.radius).chain(&cone.rows).map(row).collect();
                placed.push(Placed { rows });
            }
        }
        placed
    }

    /// Takes over the multipliers of a subproblem.
    fn adopt(&mut self, answer: Answer) {
        let m = &mut self.memory;
        let (n, inner) = (m.duals.defect.len(), m.duals.middle.len());
        for (k, chunk) in answer.rows.chunks_exact(NX).take(n + inner).enumerate() {
            let y = SVector::from_column_slice(chunk);
            if k < n { m.duals.defect[k] = y } else { m.duals.middle[k - n] = y }
        }
        let (path, boundary) = answer.rows[(n + inner) * NX..].split_at(m.duals.path.len());
        m.duals.path.copy_from_slice(path);
        m.duals.boundary.copy_from_slice(boundary);
        m.bounds.z_lower.copy_from_slice(&answer.lower);
        m.bounds.z_upper.copy_from_slice(&answer.upper);
        self.answer = answer;
    }

    /// Scaled KKT residuals with the last multipliers; the cones' enter the gradient, the violation and the products.
    fn residuals(&mut self, placed: &[Placed]) -> Residuals {
        let m = &mut self.memory;
        let mut product: f64 = 0.0;
        for (cone, z) in placed.iter().zip(&self.answer.cones) {
            let mut sum = 0.0;
            for ((terms, at), z) in cone.rows.iter().zip(z) {
                sum += at * z;
                terms.iter().for_each(|&(i, factor)| m.lin.lagrangian[i] -= factor * z);
            }
            product = product.max(sum.abs());
        }
        for i in 0..m.w.len() {
            // what the trust region pushes back is not a multiplier of the problem, and shows as an open gradient
            let (low, high) = (m.bounds.lower[i].is_finite(), m.bounds.upper[i].is_finite());
            m.bounds.z_lower[i] = if low { m.bounds.z_lower[i] } else { 0.0 };
            m.bounds.z_upper[i] = if high { m.bounds.z_upper[i] } else { 0.0 };
        }
        let outside = self.excesses().map(|(_, _, e)| e).fold(0.0, f64::max);
        let mut residuals = self.memory.residuals(0.0);
        residuals.primal = residuals.primal.max(outside);
        residuals.complementarity = residuals.complementarity.max(product / self.memory.objective_scale);
        residuals
    }

    /// Names the worst cone of a failed solve if it is left further than any other constraint.
    fn diagnose(&self, solution: &mut Solution<NX, NU>) {
        if solution.status.is_success() {
            return;
        }
        let worst = self.excesses().fold((0, 0, 0.0), |a, b| if b.2 > a.2 { b } else { a });
        if worst.2 > self.memory.primal_residual(&self.memory.values) {
            let point = &self.memory.layout.points[worst.0];
            let x = vector(&self.memory.w, self.memory.layout.point_state(point));
            let time = self.program.time_at(point.fraction, self.memory.w[self.memory.layout.time]);
            let location = self.program.problem.locate(ConstraintKind::Cone, worst.1, time, &x);
            solution.diagnosis = Some(Violation::at(location, worst.2));
        }
    }
}

/// How the solve ends at an iterate, if it does: `ended` where no step reduces the penalised cost, `spent` at the limit of iterations.
fn judge(residuals: &Residuals, options: &ConicOptions, ended: bool, spent: bool) -> Option<Status> {
    let worst = residuals.primal.max(residuals.dual).max(residuals.complementarity);
    if worst <= options.tolerance {
        return Some(Status::Solved);
    }
    if !ended && !spent {
        return None;
    }
    Some(if worst <= options.acceptable_tolerance {
        Status::Acceptable
    } else if !ended {
        Status::IterationLimit
    } else if residuals.primal > options.acceptable_tolerance {
        Status::Infeasible
    } else {
        Status::Stalled
    })
}

/// What became of a subproblem's step.
#[derive(Clone, Copy, PartialEq)]
enum Step {
    Taken,
    Refused,
    /// There is none that reduces the penalised cost.
    None,
}

/// All constraint residuals in the order of the Jacobian's rows.
fn residual_vector<const NX: usize, const NU: usize>(
    memory: &Memory<NX, NU>,
    values: &crate::nlp::program::Values<NX>,
) -> Vec<f64> {
    let mut out = Vec::with_capacity(n_rows(memory));
    values.defect.iter().chain(&values.middle).for_each(|v| out.extend(v.iter()));
    out.extend(values.path.iter().chain(&values.boundary));
    out
}

/// Their scales.
fn row_scales<const NX: usize, const NU: usize>(memory: &Memory<NX, NU>) -> Vec<f64> {
    let v = &memory.values;
    let states = (0..(v.defect.len() + v.middle.len()) * NX).map(|i| memory.states.scale[i % NX]);
    let path = (0..v.path.len()).map(|i| memory.path_scale[i % memory.layout.n_path]);
    states.chain(path).chain(memory.boundary_scale.iter().copied()).collect()
}
