//! Feasibility restoration: when the line search finds nothing, reduce the violation alone.
//!
//! Each step solves the linearised constraints with the least change in the scaled variables, inside the bounds (a
//! Gauss-Newton step with a proximal term and the barrier), until the filter admits the point.

use super::interior_point::Memory;
use super::kkt::System;
use super::program::Program;
use crate::Problem;

/// Most steps of one restoration.
const MAX_STEPS: usize = 60;
/// Weight of the proximal term.
const ZETA: f64 = 1.0;

impl<const NX: usize, const NU: usize> Memory<NX, NU> {
    /// Reduces the violation until the filter admits the point; false if that is not possible.
    pub fn restore<P: Problem<NX, NU>>(&mut self, program: &Program<NX, NU, P>, reduction: f64) -> bool {
        let origin = self.origin();
        let start = origin.theta;
        if start < 1e-10 {
            return false;
        }
        self.filter.add(&origin);
        let mu = self.mu;
        self.mu = mu.max(1e-4);
        let mut success = false;
        for _ in 0..MAX_STEPS {
            if !self.feasibility_step(program) {
                break;
            }
            let theta = self.theta(&self.values);
            let phi = self.values.objective + self.bounds.value(&self.w, mu);
            if theta <= reduction * start && self.filter.admits(theta, phi) {
                success = true;
                break;
            }
        }
        self.mu = mu;
        if success {
            let n = self.rows.len();
            let layout = std::mem::take(&mut self.layout);
            self.duals.reset(&layout, n);
            self.layout = layout;
            self.bounds.start_multipliers(&self.w, self.mu);
            self.linearise_first_order(program);
            self.least_squares_multipliers();
        }
        success
    }

    /// First derivatives alone at the present point.
    pub fn linearise_first_order<P: Problem<NX, NU>>(&mut self, program: &Program<NX, NU, P>) {
        self.scratch.first_order_only = true;
        program.linearise(&self.layout, &self.rows, &self.w, &self.duals, &mut self.scratch, &mut self.lin);
        self.scratch.first_order_only = false;
    }

    /// One Gauss-Newton step with backtracking on the violation.
    fn feasibility_step<P: Problem<NX, NU>>(&mut self, program: &Program<NX, NU, P>) -> bool {
        let layout = std::mem::take(&mut self.layout);
        self.duals.reset(&layout, self.rows.len());
        self.layout = layout;
        self.bounds.start_multipliers(&self.w, self.mu);
        self.linearise_first_order(program);
        self.lin.raw.clear_hessian();
        self.lin.clear_inner_hessian();
        self.lin.lagrangian.fill(0.0);
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
        let factorised = riccati.factorise(&self.lq, &self.regularisation(ZETA));
        if factorised.is_ok() {
            riccati.solve(&self.lq, &self.states.weight, &self.rhs, &mut self.step);
        }
        self.riccati = riccati;
        if factorised.is_err() {
            return false;
        }
        let system = System {
            layout: &self.layout,
            rows: &self.rows,
            lin: &self.lin,
            w: &self.w,
            bounds: &self.bounds,
            mu: self.mu,
        };
        system.expand(&self.values, &self.step, &mut self.direction);
        self.reduce_violation(program)
    }

    fn reduce_violation<P: Problem<NX, NU>>(&mut self, program: &Program<NX, NU, P>) -> bool {
        let start = self.theta(&self.values);
        let mut alpha = self.primal_step(false);
        while alpha > 1e-10 {
            for i in 0..self.w.len() {
                self.trial[i] = self.w[i] + alpha * self.direction.w[i];
            }
            program.evaluate(
                &self.layout,
                &self.rows,
                &mut self.trial,
                &mut self.scratch,
                &mut self.trial_values,
            );
            let theta = self.theta(&self.trial_values);
            if theta <= (1.0 - 1e-4 * alpha) * start {
                std::mem::swap(&mut self.w, &mut self.trial);
                std::mem::swap(&mut self.values, &mut self.trial_values);
                return true;
            }
            alpha *= 0.5;
        }
        false
    }
}
