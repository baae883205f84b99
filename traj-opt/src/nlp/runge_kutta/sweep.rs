//! The model at the stages of a segment, and what its second derivatives are weighted with.

use super::{NODE, WEIGHT};
use crate::dense::Arithmetic;
use crate::nlp::layout::Layout;
use crate::nlp::program::Program;
use crate::nlp::running::{self, PointModel};
use crate::{Hessian, Jacobian, Problem};
use nalgebra::SVector;

/// One stage of one step.
#[derive(Clone, Debug)]
pub(crate) struct Stage<const NX: usize, const NU: usize> {
    pub time: f64,
    /// Rate of the time with the final time.
    pub t_rate: f64,
    pub state: SVector<f64, NX>,
    pub model: PointModel<NX, NU>,
    /// Weight of the slope in the Lagrangian, over the step length.
    pub weight: SVector<f64, NX>,
    /// Second derivatives of the Lagrangian by the stage's state, control and time.
    pub hessian: Hessian<NX, NU>,
}

impl<const NX: usize, const NU: usize> Default for Stage<NX, NU> {
    fn default() -> Self {
        Self {
            time: 0.0,
            t_rate: 0.0,
            state: SVector::zeros(),
            model: PointModel { f: Jacobian::zeros(), running: None },
            weight: SVector::zeros(),
            hessian: Hessian::zeros(),
        }
    }
}

/// States and first derivatives of the model at all stages, in order.
#[inline(always)]
pub(super) fn forward<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    substeps: usize,
    k: usize,
    w: &[f64],
    u: &SVector<f64, NU>,
    stages: &mut Vec<Stage<NX, NU>>,
) {
    let tf = w[layout.time];
    let h = program.point_time(k, 0.0, tf).h / substeps as f64;
    let mut x = program.state(layout, w, k);
    stages.resize_with(4 * substeps, Stage::default);
    for (step, stages) in stages.chunks_exact_mut(4).enumerate() {
        let (mut next, mut slope) = (x, SVector::zeros());
        for (i, stage) in stages.iter_mut().enumerate() {
            let at = program.point_time(k, (step as f64 + NODE[i]) / substeps as f64, tf);
            (stage.time, stage.t_rate) = (at.time, at.t_rate);
            stage.state = x + slope * (h * NODE[i]);
            stage.model = running::differentiate(program.problem, at.time, &stage.state, u);
            slope = stage.model.f.value;
            next += slope * (h * WEIGHT[i]);
        }
        x = next;
    }
}

/// Weights and second derivatives at all stages, from the multiplier of the end state.
#[inline(always)]
pub(super) fn backward<A: Arithmetic, const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &P,
    h: f64,
    u: &SVector<f64, NU>,
    lambda: &SVector<f64, NX>,
    stages: &mut [Stage<NX, NU>],
) {
    let mut end_weight = *lambda;
    for step in stages.chunks_exact_mut(4).rev() {
        let mut start_weight = end_weight;
        let mut state_weight = SVector::zeros();
        for i in (0..4).rev() {
            let stage = &mut step[i];
            stage.weight = end_weight * WEIGHT[i];
            if i < 3 {
                stage.weight += state_weight * NODE[i + 1];
            }
            let (weight, weight_l) = (stage.weight * h, WEIGHT[i] * h);
            stage.hessian =
                running::weighted_hessian(problem, stage.time, &stage.state, u, &weight, weight_l);
            state_weight = A::tr_mul_vec(&stage.model.f.state, &weight);
            if let Some(running) = &stage.model.running {
                state_weight += running.x * weight_l;
            }
            start_weight += state_weight;
        }
        end_weight = start_weight;
    }
}
