//! Backtracking along the Newton direction with the filter and second-order corrections.

use super::barrier::DualStep;
use super::course::FAR_FROM_FEASIBLE;
use super::filter::{Acceptance, Origin};
use super::interior_point::{Memory, Start};
use super::kkt::System;
use super::program::{Duals, Program};
use crate::Problem;

/// Most corrections of one step, and the reduction of the violation that another one needs (kappa_soc).
const MAX_CORRECTIONS: usize = 4;
const KAPPA_SOC: f64 = 0.99;

impl<const NX: usize, const NU: usize> Memory<NX, NU> {
    /// Moves to an acceptable point along the direction and returns the step length; `None` if there is none.
    pub fn advance<P: Problem<NX, NU>>(&mut self, program: &Program<NX, NU, P>) -> Option<f64> {
        let tau = self.tau();
        let greatest = self.primal_step(false);
        let dual = self.dual_step(tau);
        let origin = self.origin();
        let least = self.filter.least_step(&origin).max(1e-14);
        let mut alpha = greatest;
        let mut first = true;
        let mut refused = false;
        while alpha >= least {
            let (theta, acceptance) = self.try_step(program, &origin, alpha, false);
            if acceptance.is_accepted() {
                self.accept(&origin, acceptance, alpha, dual, false);
                self.adapt_damping(alpha / greatest);
                self.heed_filter(refused);
                return Some(alpha);
            }
            if first
                && theta >= origin.theta
                && theta.is_finite()
                && let Some(corrected) = self.correct(program, &origin, greatest, theta)
            {
                self.heed_filter(false);
                return Some(corrected);
            }
            first = false;
            refused = acceptance == Acceptance::Forbidden;
            alpha *= 0.5;
        }
        None
    }

    /// Forgets the filter if it alone cuts step after step short near the feasible set, where it bars the way by a point that happened to
    /// be cheap; far from it that is a case for the restoration.
    fn heed_filter(&mut self, cut_short: bool) {
        if self.filter.is_obstinate(cut_short) && self.primal_residual(&self.values) < FAR_FROM_FEASIBLE {
            self.filter.reset();
        }
    }

    /// Evaluates a trial point along the direction or its correction.
    fn try_step<P: Problem<NX, NU>>(
        &mut self,
        program: &Program<NX, NU, P>,
        origin: &Origin,
        alpha: f64,
        corrected: bool,
    ) -> (f64, Acceptance) {
        let direction = if corrected { &self.correction.w } else { &self.direction.w };
        for i in 0..self.w.len() {
            self.trial[i] = self.w[i] + alpha * direction[i];
        }
        program.evaluate(
            &self.layout,
            &self.rows,
            &mut self.trial,
            &mut self.scratch,
            &mut self.trial_values,
        );
        let theta = self.theta(&self.trial_values);
        let phi = self.phi(&self.trial, &self.trial_values);
        (theta, self.filter.judge(origin, alpha, theta, phi))
    }

    /// Second-order correction: the same linearisation with the violation of the refused point added.
    fn correct<P: Problem<NX, NU>>(
        &mut self,
        program: &Program<NX, NU, P>,
        origin: &Origin,
        alpha: f64,
        mut theta: f64,
    ) -> Option<f64> {
        let mut before = origin.theta;
        self.start_correction();
        let mut scale = alpha;
        for round in 0..MAX_CORRECTIONS {
            if round > 0 && theta > KAPPA_SOC * before {
                return None;
            }
            before = theta;
            self.accumulate_correction(scale);
            self.solve_correction();
            let tau = self.tau();
            scale = self.primal_step(true);
            let (next, acceptance) = self.try_step(program, origin, scale, true);
            if acceptance.is_accepted() {
                self.bounds.directions(&self.w, &self.correction.w, self.mu);
                let dual = self.dual_step(tau);
                self.accept(origin, acceptance, scale, dual, true);
                self.adapt_damping(scale / alpha);
                return Some(scale);
            }
            theta = next;
            if !theta.is_finite() {
                return None;
            }
        }
        None
    }

    fn start_correction(&mut self) {
        let (from, to) = (&self.values, &mut self.corrected);
        to.defect.copy_from_slice(&from.defect);
        to.middle.copy_from_slice(&from.middle);
        to.path.copy_from_slice(&from.path);
        to.boundary.copy_from_slice(&from.boundary);
    }

    /// `c_soc <- alpha c_soc + c(trial)`.
    fn accumulate_correction(&mut self, alpha: f64) {
        let (trial, sum) = (&self.trial_values, &mut self.corrected);
        let vectors =
            sum.defect.iter_mut().zip(&trial.defect).chain(sum.middle.iter_mut().zip(&trial.middle));
        for (s, t) in vectors {
            *s = *s * alpha + t;
        }
        let scalars =
            sum.path.iter_mut().zip(&trial.path).chain(sum.boundary.iter_mut().zip(&trial.boundary));
        for (s, t) in scalars {
            *s = *s * alpha + t;
        }
    }

    fn solve_correction(&mut self) {
        let system = System {
            layout: &self.layout,
            rows: &self.rows,
            lin: &self.lin,
            w: &self.w,
            bounds: &self.bounds,
            mu: self.mu,
        };
        system.right_hand_side(&self.corrected, &mut self.rhs);
        self.riccati.solve(&self.lq, &self.states.weight, &self.rhs, &mut self.step);
        let system = System {
            layout: &self.layout,
            rows: &self.rows,
            lin: &self.lin,
            w: &self.w,
            bounds: &self.bounds,
            mu: self.mu,
        };
        system.expand(&self.corrected, &self.step, &mut self.correction);
    }

    /// The step of the bounds' multipliers. Near a neighbour's solution single ones tell the next iteration which bounds are left and
    /// reached: up to a fifth fewer iterations; far from it they cost some.
    fn dual_step(&self, tau: f64) -> DualStep {
        if self.starts_from == Start::Neighbour { DualStep::SINGLE } else { self.bounds.dual_step(tau) }
    }

    /// Takes the trial point.
    fn accept(
        &mut self,
        origin: &Origin,
        acceptance: Acceptance,
        alpha: f64,
        dual: DualStep,
        corrected: bool,
    ) {
        if acceptance == Acceptance::Filter {
            self.filter.add(origin);
        }
        std::mem::swap(&mut self.w, &mut self.trial);
        std::mem::swap(&mut self.values, &mut self.trial_values);
        let direction = if corrected { &self.correction.duals } else { &self.direction.duals };
        advance_duals(&mut self.duals, direction, alpha);
        self.bounds.update_multipliers(&self.w, dual, self.mu);
    }
}

fn advance_duals<const NX: usize>(duals: &mut Duals<NX>, direction: &Duals<NX>, alpha: f64) {
    for (y, d) in duals.defect.iter_mut().zip(&direction.defect) {
        *y += d * alpha;
    }
    for (y, d) in duals.middle.iter_mut().zip(&direction.middle) {
        *y += d * alpha;
    }
    for (y, d) in duals.path.iter_mut().zip(&direction.path) {
        *y += d * alpha;
    }
    for (y, d) in duals.boundary.iter_mut().zip(&direction.boundary) {
        *y += d * alpha;
    }
}
