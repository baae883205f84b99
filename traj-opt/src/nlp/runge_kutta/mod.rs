//! Multiple shooting with the classic Runge-Kutta method and a constant control on each segment.
//!
//! Three passes over the stages of a segment: [`sweep`] evaluates the model forwards and the weights of its second derivatives
//! backwards (second-order adjoint); [`sensitivity`] carries the derivatives of the state forwards and adds up the second
//! derivatives on the way, so that a stage costs one contracted Hessian and half a congruence.

mod sensitivity;
mod sweep;

pub(crate) use sensitivity::Sensitivity;
pub(crate) use sweep::Stage;

use super::layout::Layout;
use super::program::{Duals, Linearisation, Program, Scratch, Values};
use crate::dense::Arithmetic;
use crate::{Dynamics, Problem};
use nalgebra::SVector;
use sensitivity::{Segment, idle_states};

const NODE: [f64; 4] = [0.0, 0.5, 0.5, 1.0];
const WEIGHT: [f64; 4] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];

/// Defect of segment `k`; returns its running cost.
pub(crate) fn evaluate<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    substeps: usize,
    k: usize,
    w: &[f64],
    out: &mut Values<NX>,
) -> f64 {
    let tf = w[layout.time];
    let u = program.control(layout, w, k, 0);
    let mut x = program.state(layout, w, k);
    let h = program.point_time(k, 0.0, tf).h / substeps as f64;
    let mut cost = 0.0;
    for step in 0..substeps {
        let t = program.point_time(k, step as f64 / substeps as f64, tf).time;
        let mut slope = SVector::zeros();
        let mut sum = SVector::zeros();
        for i in 0..4 {
            let stage = x + slope * (h * NODE[i]);
            let time = t + NODE[i] * h;
            slope = program.problem.dynamics().derivative(time, &stage, &u);
            sum += slope * WEIGHT[i];
            cost += program.problem.lagrange(time, &stage, &u).unwrap_or(0.0) * WEIGHT[i] * h;
        }
        x += sum * h;
    }
    out.defect[k] = x - program.state(layout, w, k + 1);
    cost
}

/// States at the ends of the steps of a segment, for interpolation.
pub(crate) fn step_states<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    substeps: usize,
    k: usize,
    w: &[f64],
    mut visit: impl FnMut(f64, SVector<f64, NX>),
) {
    let tf = w[layout.time];
    let u = program.control(layout, w, k, 0);
    let mut x = program.state(layout, w, k);
    let h = program.point_time(k, 0.0, tf).h / substeps as f64;
    for step in 0..substeps {
        let t = program.point_time(k, step as f64 / substeps as f64, tf).time;
        let f = |t: f64, x: &SVector<f64, NX>| program.problem.dynamics().derivative(t, x, &u);
        let k1 = f(t, &x);
        let k2 = f(t + 0.5 * h, &(x + k1 * (0.5 * h)));
        let k3 = f(t + 0.5 * h, &(x + k2 * (0.5 * h)));
        let k4 = f(t + h, &(x + k3 * h));
        x += (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0);
        visit(t + h, x);
    }
}

/// Derivatives of segment `k`.
#[expect(clippy::too_many_arguments, reason = "the inputs of one step of one algorithm")]
#[inline(always)]
pub(crate) fn linearise<A: Arithmetic, const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    substeps: usize,
    k: usize,
    w: &[f64],
    duals: &Duals<NX>,
    scratch: &mut Scratch<NX, NU>,
    out: &mut Linearisation<NX, NU>,
) {
    let u = program.control(layout, w, k, 0);
    let lambda = duals.defect[k];
    let at = program.point_time(k, 0.0, w[layout.time]);
    let (h, h_rate) = (at.h / substeps as f64, at.h_rate / substeps as f64);
    let second = !scratch.first_order_only;
    let Scratch { stages, sensitivity, .. } = scratch;
    sweep::forward(program, layout, substeps, k, w, &u, stages);
    if second {
        sweep::backward::<A, NX, NU, P>(program.problem, h, &u, &lambda, stages);
    }
    let segment = Segment { stages, h, h_rate, second, idle: idle_states(stages, second) };
    sensitivity.propagate::<A>(&segment);
    out.add_gradient(layout.state(k + 1), (-lambda).as_slice());
    sensitivity.write::<A>(&segment, layout, k, &lambda, out);
}
