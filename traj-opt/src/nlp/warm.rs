//! Starting from the primal and dual variables of a neighbouring problem's solution.

use super::interior_point::{Memory, Start};
use super::program::{Duals, Program};
use crate::{Options, Problem};

/// Primal and dual variables of an iterate.
#[derive(Clone, Debug, Default)]
pub(crate) struct Point<const NX: usize> {
    pub w: Vec<f64>,
    pub duals: Duals<NX>,
    pub z_lower: Vec<f64>,
    pub z_upper: Vec<f64>,
}

/// Most of its range that a variable is moved away from a bound at which the neighbour's lies.
const FARTHEST: f64 = 0.05;

impl<const NX: usize, const NU: usize> Memory<NX, NU> {
    /// The present iterate.
    pub fn point(&self) -> Point<NX> {
        Point {
            w: self.w.clone(),
            duals: self.duals.clone(),
            z_lower: self.bounds.z_lower.clone(),
            z_upper: self.bounds.z_upper.clone(),
        }
    }

    /// Starts at a neighbour's solution; false if its shape is another.
    pub fn start_at<P: Problem<NX, NU>>(
        &mut self,
        program: &Program<NX, NU, P>,
        point: &Point<NX>,
        options: &Options,
    ) -> bool {
        self.prepare(program, options);
        let same = |a: usize, b: usize| a == b;
        let fits = same(point.w.len(), self.layout.n_variables)
            && same(point.duals.defect.len(), self.duals.defect.len())
            && same(point.duals.middle.len(), self.duals.middle.len())
            && same(point.duals.path.len(), self.duals.path.len())
            && same(point.duals.boundary.len(), self.duals.boundary.len());
        if !fits {
            return false;
        }
        self.w.clear();
        self.w.extend_from_slice(&point.w);
        let b = &program.bounds;
        for i in 0..NX {
            if b.initial_lower[i] == b.initial_upper[i] {
                self.w[i] = b.initial_lower[i];
            }
        }
        if !program.free_time {
            self.w[self.layout.time] = b.final_time_lower;
        }
        self.measure(program);
        self.duals.clone_from(&point.duals);
        self.mu = options.warm_mu * self.objective_scale;
        self.approach_centre(&point.z_lower, &point.z_upper);
        self.starts_from = Start::Neighbour;
        // another barrier problem would cost as many iterations as the first
        self.least_mu = self.least_mu.max(options.warm_mu.min(options.tolerance / 3.0));
        program.evaluate(&self.layout, &self.rows, &mut self.w, &mut self.scratch, &mut self.values);
        true
    }

    /// Moves every variable and its multipliers to where their products are mu: of a pair the one that is small in its scale is
    /// replaced, since the other says more.
    pub fn approach_centre(&mut self, z_lower: &[f64], z_upper: &[f64]) {
        let mu = self.mu;
        for i in 0..self.w.len() {
            let (lower, upper) = (self.bounds.lower[i], self.bounds.upper[i]);
            let scale = self.variable_scale[i].max(1e-12);
            let farthest =
                if (upper - lower).is_finite() { FARTHEST * (upper - lower) } else { FARTHEST * scale };
            let weight = scale * scale / self.objective_scale;
            let (zl, zu) = (z_lower[i], z_upper[i]);
            if lower.is_finite() && zl * weight > self.w[i] - lower {
                self.w[i] = lower + (mu / zl).min(farthest);
            } else if upper.is_finite() && zu * weight > upper - self.w[i] {
                self.w[i] = upper - (mu / zu).min(farthest);
            }
            let inside = (1e-6 * farthest).max(f64::MIN_POSITIVE);
            if lower.is_finite() {
                self.w[i] = self.w[i].max(lower + inside);
            }
            if upper.is_finite() {
                self.w[i] = self.w[i].min(upper - inside);
            }
        }
        self.bounds.start_multipliers(&self.w, mu);
    }
}
