//! First multipliers of the equality constraints.

use super::interior_point::Memory;
use crate::dense::tr_mul_vec;
use crate::transcription::MAX_DEGREE;
use nalgebra::SVector;

/// Greatest costates, relative to the scale of the cost, that an estimate is trusted with.
const MODERATE: f64 = 1e3;

impl<const NX: usize, const NU: usize> Memory<NX, NU> {
    /// Multipliers that make the gradient of the Lagrangian least in the scaled norm; kept only if moderate.
    pub fn least_squares_multipliers(&mut self) {
        self.lq.copy_from(&self.lin.raw);
        self.lq.clear_hessian();
        for (i, slack) in self.rows.slack.iter().enumerate() {
            if slack.is_some() {
                self.lq.compliance[i] = self.boundary_scale[i] * self.boundary_scale[i];
            }
        }
        self.rhs.c.fill(SVector::zeros());
        self.rhs.e.fill(0.0);
        let layout = &self.layout;
        let net = |i: usize| self.lin.objective[i] - self.bounds.z_lower[i] + self.bounds.z_upper[i];
        for knot in 0..=layout.n_segments {
            self.rhs.gx[knot] = SVector::from_fn(|i, _| net(layout.state(knot) + i));
        }
        for i in 0..layout.n_segments * layout.m {
            self.rhs.gu[i] = net(layout.controls + i);
        }
        self.rhs.gp = net(layout.time);
        let mut riccati = std::mem::take(&mut self.riccati);
        let solved = riccati.factorise(&self.lq, &self.regularisation(1.0)).is_ok();
        if solved {
            riccati.solve(&self.lq, &self.states.weight, &self.rhs, &mut self.step);
        }
        self.riccati = riccati;
        let scale = |v: &SVector<f64, NX>| v.component_mul(&self.states.scale).amax();
        if solved && self.step.costate.iter().map(scale).fold(0.0, f64::max) < MODERATE * self.objective_scale
        {
            for (k, costate) in self.step.costate.iter().enumerate() {
                let resolve = self.lin.resolve.get(k);
                self.duals.defect[k] = resolve.map_or(*costate, |resolve| tr_mul_vec(resolve, costate));
            }
            self.spread_costates();
            self.duals.boundary.copy_from_slice(&self.step.boundary);
        }
    }

    /// Multipliers of the equations of inner states from those of the defects, at the present linearisation.
    pub fn spread_costates(&mut self) {
        let q = self.layout.n_inner;
        for (k, costate) in self.duals.defect.iter_mut().enumerate() {
            if self.lin.stages.is_used() {
                let mut forces = [SVector::zeros(); MAX_DEGREE];
                forces[q] = *costate;
                self.lin.stages.multipliers(k, &mut forces[..=q]);
                self.duals.middle[k * q..(k + 1) * q].copy_from_slice(&forces[..q]);
                *costate = forces[q];
            } else if let Some(middle) = self.lin.middles.get(k) {
                self.duals.middle[k] = tr_mul_vec(&middle.defect_by, costate);
            }
        }
    }
}
