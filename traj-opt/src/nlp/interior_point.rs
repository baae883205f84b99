//! The primal-dual interior-point method with filter line search (A. Waechter, L. T. Biegler, Math. Program. 106, 2006) on the
//! stage-structured problem.

use super::barrier::Box;
use super::boundary::BoundaryRows;
use super::course::{Course, worst_of};
use super::filter::{Filter, Origin};
use super::kkt::{Direction, System};
use super::layout::Layout;
use super::program::{Duals, Linearisation, Program, Scratch, Values};
use super::quadratic::{Quadratic, Rhs, Step};
use super::riccati::{NotConvex, Regularisation, Riccati};
use crate::{Iteration, Options, Problem, Residuals, Status};
use nalgebra::SVector;
use std::ops::ControlFlow;

/// Factor of the barrier error below which mu falls (kappa_epsilon), linear and superlinear decrease (kappa_mu, theta_mu), least
/// fraction to the boundary (tau_min) and scaling threshold of residuals (s_max), as in IPOPT but for the decrease: IPOPT's 0.2
/// and 1.5 cost 6 % more iterations on the reference transitions.
const KAPPA_EPSILON: f64 = 10.0;
const KAPPA_MU: f64 = 0.1;
const THETA_MU: f64 = 1.7;
const TAU_MIN: f64 = 0.99;
const S_MAX: f64 = 100.0;
/// Penalty on end conditions in the recursion, relative to the scaled length of their gradients.
const RHO: f64 = 1e3;
/// Range of the damping relative to the squared scales of the variables.
pub(super) const LEAST_DAMPING: f64 = 1e-10;
const GREATEST_DAMPING: f64 = 0.1;
/// Damping that a shortened step starts with, and up to which a failed line search is repeated with more.
const DAMPING_STEP: f64 = 1e-8;
const RETRY_DAMPING: f64 = 1e-4;
/// Most that one step may shorten or lengthen the flight.
const SHORTEN: f64 = 0.5;
const LENGTHEN: f64 = 3.0;
/// A guess that violates the constraints by more is first moved towards feasibility.
const INFEASIBLE_GUESS: f64 = 0.1;
/// Regularisation above which it is tried before none.
const SKIP_TRIAL: f64 = 1e-4;
/// The first one of a solve, if convexity needs any.
const FIRST_DELTA: f64 = 1e-4;
/// By how much it grows until the first one of a solve suffices; IPOPT's 100 takes 5 to 15 % more time on the slowest transitions.
const FIRST_GROWTH: f64 = 300.0;
/// By how much the regularisation falls from one iteration to the next, and grows while it does not suffice; faster than IPOPT's 3, which
/// costs iterations here.
const RELIEF: f64 = 8.0;
const MAX_RESTORATIONS: usize = 4;
/// Reductions of the violation that a restoration aims at when the method jams and when the line search fails.
const RESTORED: f64 = 0.1;
const ADMITTED: f64 = 0.9;

/// What a solve starts from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Start {
    /// A trajectory alone.
    #[default]
    Guess,
    /// A neighbour's solution with its multipliers.
    Neighbour,
    /// The solution on a coarser mesh with its multipliers.
    CoarserMesh,
}

/// All memory of a solve.
#[derive(Clone, Debug, Default)]
pub(crate) struct Memory<const NX: usize, const NU: usize> {
    pub layout: Layout,
    pub rows: BoundaryRows,
    pub w: Vec<f64>,
    pub trial: Vec<f64>,
    pub bounds: Box,
    pub duals: Duals<NX>,
    pub values: Values<NX>,
    pub trial_values: Values<NX>,
    pub corrected: Values<NX>,
    pub lin: Linearisation<NX, NU>,
    pub lq: Quadratic<NX>,
    pub rhs: Rhs<NX>,
    pub step: Step<NX>,
    pub direction: Direction<NX>,
    pub correction: Direction<NX>,
    pub riccati: Riccati<NX>,
    pub scratch: Scratch<NX, NU>,
    pub filter: Filter,
    pub variable_scale: Vec<f64>,
    pub path_scale: Vec<f64>,
    pub boundary_scale: Vec<f64>,
    pub control_weight: Vec<f64>,
    pub free_start: Vec<usize>,
    pub log: Vec<Iteration>,
    pub states: StateScale<NX>,
    pub time_weight: f64,
    /// Least regularisation, Levenberg-Marquardt damping of flat directions: grows when the line search shortens steps, falls when it
    /// does not.
    pub damping: f64,
    /// Last regularisation that was needed.
    pub delta: f64,
    pub objective_scale: f64,
    pub initial_time: f64,
    pub mu: f64,
    /// The last barrier parameter, relative to the scale of the cost.
    pub least_mu: f64,
    pub starts_from: Start,
}

/// Magnitudes of the states and their inverse squares.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StateScale<const NX: usize> {
    pub scale: SVector<f64, NX>,
    pub weight: SVector<f64, NX>,
}

impl<const NX: usize> Default for StateScale<NX> {
    fn default() -> Self {
        Self { scale: SVector::repeat(1.0), weight: SVector::repeat(1.0) }
    }
}

/// How a solve ended.
pub(crate) struct Outcome {
    pub status: Status,
    pub iterations: usize,
    pub residuals: Residuals,
}

impl<const NX: usize, const NU: usize> Memory<NX, NU> {
    /// Scaled 1-norm of the constraint violation.
    pub fn theta(&self, values: &Values<NX>) -> f64 {
        let mut sum = 0.0;
        for v in values.defect.iter().chain(&values.middle) {
            for i in 0..NX {
                sum += v[i].abs() / self.states.scale[i];
            }
        }
        for (i, v) in values.path.iter().enumerate() {
            sum += v.abs() / self.path_scale[i % self.layout.n_path];
        }
        for (v, s) in values.boundary.iter().zip(&self.boundary_scale) {
            sum += v.abs() / s;
        }
        sum
    }

    /// Scaled greatest violation.
    pub fn primal_residual(&self, values: &Values<NX>) -> f64 {
        let mut worst: f64 = 0.0;
        for v in values.defect.iter().chain(&values.middle) {
            for i in 0..NX {
                worst = worst.max(v[i].abs() / self.states.scale[i]);
            }
        }
        for (i, v) in values.path.iter().enumerate() {
            worst = worst.max(v.abs() / self.path_scale[i % self.layout.n_path]);
        }
        for (v, s) in values.boundary.iter().zip(&self.boundary_scale) {
            worst = worst.max(v.abs() / s);
        }
        worst
    }

    /// Scaled greatest entry of the Lagrangian's gradient, bound multipliers included.
    pub fn dual_residual(&self) -> f64 {
        let mut worst: f64 = 0.0;
        for i in 0..self.w.len() {
            let r = self.lin.lagrangian[i] - self.bounds.z_lower[i] + self.bounds.z_upper[i];
            worst = worst.max((r * self.variable_scale[i]).abs());
        }
        worst / self.objective_scale
    }

    /// KKT residuals with the barrier parameter `mu` and IPOPT's scaling by the size of the multipliers.
    pub fn residuals(&self, mu: f64) -> Residuals {
        let scale = self.multiplier_scale();
        Residuals {
            primal: self.primal_residual(&self.values),
            dual: self.dual_residual() / scale,
            complementarity: self.bounds.complementarity(&self.w, mu) / (scale * self.objective_scale),
        }
    }

    /// IPOPT's scaling by the size of the multipliers.
    fn multiplier_scale(&self) -> f64 {
        let (sum, count) = self.bounds.multiplier_sum();
        let mean = if count > 0 { sum / count as f64 } else { 0.0 };
        mean.max(S_MAX) / S_MAX
    }

    /// Cost plus multipliers times residuals.
    pub fn lagrangian(&self) -> f64 {
        let (values, duals) = (&self.values, &self.duals);
        let vectors = duals.defect.iter().zip(&values.defect).chain(duals.middle.iter().zip(&values.middle));
        let scalars = duals.path.iter().zip(&values.path).chain(duals.boundary.iter().zip(&values.boundary));
        let products = vectors.map(|(y, c)| y.dot(c)).chain(scalars.map(|(y, c)| y * c));
        values.objective + products.sum::<f64>()
    }

    /// Barrier cost of a point.
    pub fn phi(&self, w: &[f64], values: &Values<NX>) -> f64 {
        values.objective + self.bounds.value(w, self.mu)
    }

    /// Runs to the end.
    pub fn run<P: Problem<NX, NU>>(
        &mut self,
        program: &Program<NX, NU, P>,
        options: &Options,
        give_up_early: bool,
        mut monitor: impl FnMut(&Iteration) -> ControlFlow<()>,
    ) -> Outcome {
        self.begin(program);
        let mut course = Course::new();
        for iteration in 0..=options.max_iterations {
            program.linearise(
                &self.layout,
                &self.rows,
                &self.w,
                &self.duals,
                &mut self.scratch,
                &mut self.lin,
            );
            let entry = self.entry(iteration, course.step_length);
            self.log.push(entry);
            let residuals = entry.residuals;
            let finish = |status| Outcome { status, iterations: iteration, residuals };
            if let Some(status) = course.conclusion(&entry, options, &mut monitor) {
                return finish(status);
            }
            if course.is_stuck(&residuals) {
                // multipliers grow without bound when the method jams: reduce the violation alone and begin anew
                let restored = course.restorations < MAX_RESTORATIONS && self.restore(program, RESTORED);
                if !restored && give_up_early {
                    return finish(Status::Infeasible);
                }
                course.restorations += 1;
                if restored {
                    course.step_length = 1.0;
                    continue;
                }
            }
            self.update_barrier(residuals);
            if self.newton_direction().is_err() {
                return finish(course.fallback(Status::Stalled));
            }
            match self.advance(program) {
                Some(alpha) => course.step_length = alpha,
                None if self.damping < RETRY_DAMPING => {
                    self.damping = (self.damping * 100.0).max(DAMPING_STEP);
                    course.step_length = 0.0;
                }
                None if self.restore(program, ADMITTED) => course.step_length = 1.0,
                None if residuals.primal > options.acceptable_tolerance => {
                    return finish(course.fallback(Status::Infeasible));
                }
                None => return finish(course.fallback(Status::Stalled)),
            }
        }
        unreachable_outcome()
    }

    /// Readies filter and multipliers; a guess that is far from feasible is moved towards it.
    fn begin<P: Problem<NX, NU>>(&mut self, program: &Program<NX, NU, P>) {
        self.filter.start(self.theta(&self.values));
        if self.starts_from == Start::Guess {
            let far = self.primal_residual(&self.values) > INFEASIBLE_GUESS;
            let restored = far && self.restore(program, RESTORED);
            self.filter.start(self.theta(&self.values));
            if !restored {
                self.least_squares_multipliers();
            }
        }
    }

    /// What the log says of the present iterate, to which a step of this length has led.
    fn entry(&self, iteration: usize, step_length: f64) -> Iteration {
        Iteration {
            iteration,
            objective: self.values.objective,
            lagrangian: self.lagrangian(),
            residuals: self.residuals(0.0),
            mu: self.mu,
            regularisation: self.delta,
            step_length,
            trust_radius: 0.0,
        }
    }

    /// Monotone decrease of mu (Fiacco and McCormick) once the barrier problem is solved well enough.
    fn update_barrier(&mut self, mut residuals: Residuals) {
        let least = self.least_mu * self.objective_scale;
        let scale = self.multiplier_scale() * self.objective_scale;
        // the violation is compared with mu itself, whatever the scale of the cost
        residuals.primal /= self.objective_scale;
        while self.mu > least {
            residuals.complementarity = self.bounds.complementarity(&self.w, self.mu) / scale;
            if worst_of(&residuals) > KAPPA_EPSILON * self.mu / self.objective_scale {
                break;
            }
            self.mu = (KAPPA_MU * self.mu).min(self.mu.powf(THETA_MU)).max(least);
            self.filter.clear();
        }
    }

    /// Greatest step along a direction that respects the bounds and changes the length of the flight moderately.
    pub fn primal_step(&self, corrected: bool) -> f64 {
        let dw = if corrected { &self.correction.w } else { &self.direction.w };
        let alpha = self.bounds.primal_step(&self.w, dw, self.tau());
        let (length, change) = (self.w[self.layout.time] - self.initial_time, dw[self.layout.time]);
        let limit = if change < 0.0 { (1.0 - SHORTEN) * length } else { (LENGTHEN - 1.0) * length };
        if change.abs() * alpha > limit { limit / change.abs() } else { alpha }
    }

    /// Damps more after a step that the line search cut to `fraction`, less after one that it did not. More is more than the step had:
    /// the regularisation that barely makes a Hessian convex leaves directions in which the next step is as much too long.
    pub fn adapt_damping(&mut self, fraction: f64) {
        if fraction < 0.1 {
            let regularisation = self.damping.max(self.delta);
            self.damping = (10.0 * regularisation).clamp(DAMPING_STEP, GREATEST_DAMPING);
        } else if fraction > 0.5 {
            self.damping = (self.damping * 0.1).max(LEAST_DAMPING);
        }
    }

    /// Fraction to the boundary.
    pub fn tau(&self) -> f64 {
        TAU_MIN.max(1.0 - self.mu)
    }

    pub fn regularisation(&self, delta: f64) -> Regularisation<'_, NX> {
        Regularisation {
            delta,
            delta_c: 0.0,
            rho: RHO,
            state_weight: &self.states.weight,
            control_weight: &self.control_weight,
            time_weight: self.time_weight,
        }
    }

    /// Factorises with as little regularisation as convexity needs (IPOPT's algorithm IC) and computes the direction.
    fn newton_direction(&mut self) -> Result<(), NotConvex> {
        std::mem::swap(&mut self.lin.raw, &mut self.lq);
        let system = System {
            layout: &self.layout,
            rows: &self.rows,
            lin: &self.lin,
            w: &self.w,
            bounds: &self.bounds,
            mu: self.mu,
        };
        system.assemble(&mut self.lq);
        system.right_hand_side(&self.values, &mut self.rhs);
        let mut riccati = std::mem::take(&mut self.riccati);
        let factorised = self.factorise(&mut riccati);
        self.riccati = riccati;
        factorised?;
        self.solve_for_direction()
    }

    fn factorise(&mut self, riccati: &mut Riccati<NX>) -> Result<(), NotConvex> {
        let least = self.damping;
        // a Hessian that was indefinite usually still is: do not factorise it in vain
        let relieved = self.delta / RELIEF;
        let skips = relieved > SKIP_TRIAL;
        let first = if skips { relieved.max(least) } else { least };
        if riccati.factorise(&self.lq, &self.regularisation(first)).is_ok() {
            self.delta = if skips { first } else { 0.0 };
            return Ok(());
        }
        let last = self.last_delta();
        let growth = if last > 0.0 { RELIEF } else { FIRST_GROWTH };
        let next = if last > 0.0 { last / RELIEF } else { FIRST_DELTA };
        // the first has failed
        let mut delta = if skips { 0.0 } else { next }.max(RELIEF * first);
        while delta < 1e40 {
            if riccati.factorise(&self.lq, &self.regularisation(delta)).is_ok() {
                self.delta = delta;
                return Ok(());
            }
            delta *= growth;
        }
        Err(NotConvex)
    }

    /// The last regularisation that was not zero.
    fn last_delta(&self) -> f64 {
        self.log.iter().rev().map(|e| e.regularisation).find(|d| *d > 0.0).unwrap_or(0.0)
    }

    fn solve_for_direction(&mut self) -> Result<(), NotConvex> {
        self.riccati.solve(&self.lq, &self.states.weight, &self.rhs, &mut self.step);
        let system = System {
            layout: &self.layout,
            rows: &self.rows,
            lin: &self.lin,
            w: &self.w,
            bounds: &self.bounds,
            mu: self.mu,
        };
        system.expand(&self.values, &self.step, &mut self.direction);
        self.bounds.directions(&self.w, &self.direction.w, self.mu);
        if self.direction.w.iter().all(|v| v.is_finite()) { Ok(()) } else { Err(NotConvex) }
    }

    /// Violation, barrier cost and its slope along the direction.
    pub fn origin(&self) -> Origin {
        let mut slope = 0.0;
        for i in 0..self.w.len() {
            slope +=
                (self.lin.objective[i] + self.bounds.gradient(&self.w, i, self.mu)) * self.direction.w[i];
        }
        Origin { theta: self.theta(&self.values), phi: self.phi(&self.w, &self.values), slope }
    }
}

/// The loop above always returns from inside; this is its formal end.
fn unreachable_outcome() -> Outcome {
    let infinite = f64::INFINITY;
    let residuals = Residuals { primal: infinite, dual: infinite, complementarity: infinite };
    Outcome { status: Status::IterationLimit, iterations: 0, residuals }
}
