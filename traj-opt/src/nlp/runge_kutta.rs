//! Multiple shooting with the classic Runge-Kutta method and a constant control on each segment.
//!
//! Sensitivities are propagated forwards through the stages, the weights of the second derivatives backwards (second-order
//! adjoint), so that a stage costs one contracted Hessian and one congruence.

use super::layout::Layout;
use super::program::{Duals, Linearisation, Program, Scratch, Values, add_control_block};
use super::running::{self, PointModel};
use crate::dense::{mul_thin, mul_vec, tr_mul, tr_mul_vec};
use crate::{Dynamics, Hessian, Problem};
use nalgebra::{SMatrix, SVector};

const NODE: [f64; 4] = [0.0, 0.5, 0.5, 1.0];
const WEIGHT: [f64; 4] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];

/// One stage of one step: model, sensitivities of the stage's state and slope to (x, u, p).
#[derive(Clone, Debug)]
pub(crate) struct Stage<const NX: usize, const NU: usize> {
    time: f64,
    t_rate: f64,
    state: SVector<f64, NX>,
    model: PointModel<NX, NU>,
    by_state: Sensitivity<NX, NU>,
    slope: Sensitivity<NX, NU>,
}

#[derive(Clone, Copy, Debug)]
struct Sensitivity<const NX: usize, const NU: usize> {
    x: SMatrix<f64, NX, NX>,
    u: SMatrix<f64, NX, NU>,
    p: SVector<f64, NX>,
}

impl<const NX: usize, const NU: usize> Sensitivity<NX, NU> {
    fn identity() -> Self {
        Self { x: SMatrix::identity(), u: SMatrix::zeros(), p: SVector::zeros() }
    }

    fn add(&mut self, factor: f64, other: &Self) {
        self.x += other.x * factor;
        self.u += other.u * factor;
        self.p += other.p * factor;
    }
}

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
pub(crate) fn linearise<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
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
    let stages = &mut scratch.stages;
    let total = propagate(program, layout, substeps, k, w, &u, stages);
    let lambda = duals.defect[k];
    out.raw.a[k] = total.x;
    out.raw.ap[k] = total.p;
    for j in 0..NU {
        out.raw.b[k * layout.m + j] = total.u.column(j).into_owned();
    }
    out.add_gradient(layout.state(k), tr_mul_vec(&total.x, &lambda).as_slice());
    out.add_gradient(layout.state(k + 1), (-lambda).as_slice());
    out.add_gradient(layout.control(k, 0), tr_mul_vec(&total.u, &lambda).as_slice());
    out.lagrangian[layout.time] += total.p.dot(&lambda);
    if scratch.first_order_only {
        return;
    }
    let (h, h_rate) = step_length(program, layout, substeps, k, w);
    adjoint(program, layout, k, (h, h_rate), &u, &lambda, stages, out);
}

fn step_length<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    substeps: usize,
    k: usize,
    w: &[f64],
) -> (f64, f64) {
    let at = program.point_time(k, 0.0, w[layout.time]);
    (at.h / substeps as f64, at.h_rate / substeps as f64)
}

/// Forward sweep: fills `stages` and returns the sensitivity of the end state.
#[inline(always)]
fn propagate<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    substeps: usize,
    k: usize,
    w: &[f64],
    u: &SVector<f64, NU>,
    stages: &mut Vec<Stage<NX, NU>>,
) -> Sensitivity<NX, NU> {
    let (h, h_rate) = step_length(program, layout, substeps, k, w);
    let mut x = program.state(layout, w, k);
    let mut total = Sensitivity::identity();
    stages.clear();
    for step in 0..substeps {
        let mut end = total;
        let mut next = x;
        for i in 0..4 {
            let s = (step as f64 + NODE[i]) / substeps as f64;
            let at = program.point_time(k, s, w[layout.time]);
            let mut by_state = total;
            let mut state = x;
            if i > 0 {
                let previous = &stages[stages.len() - 1];
                by_state.add(h * NODE[i], &previous.slope);
                by_state.p += previous.model.f.value * (NODE[i] * h_rate);
                state += previous.model.f.value * (h * NODE[i]);
            }
            let model = running::differentiate(program.problem, at.time, &state, u);
            let slope = Sensitivity {
                x: mul_thin(&model.f.state, &by_state.x),
                u: mul_thin(&model.f.state, &by_state.u) + model.f.control,
                p: mul_vec(&model.f.state, &by_state.p) + model.f.time * at.t_rate,
            };
            end.add(h * WEIGHT[i], &slope);
            end.p += model.f.value * (WEIGHT[i] * h_rate);
            next += model.f.value * (h * WEIGHT[i]);
            stages.push(Stage { time: at.time, t_rate: at.t_rate, state, model, by_state, slope });
        }
        total = end;
        x = next;
    }
    total
}

/// Backward sweep: adds second derivatives and the gradient of the running cost.
#[expect(clippy::too_many_arguments, reason = "the inputs of one step of one algorithm")]
#[inline(always)]
fn adjoint<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    k: usize,
    (h, h_rate): (f64, f64),
    u: &SVector<f64, NU>,
    lambda: &SVector<f64, NX>,
    stages: &[Stage<NX, NU>],
    out: &mut Linearisation<NX, NU>,
) {
    let mut end_weight = *lambda;
    for step in stages.chunks_exact(4).rev() {
        let mut start_weight = end_weight;
        let mut state_weight = SVector::zeros();
        for i in (0..4).rev() {
            let stage = &step[i];
            // weight of the slope, over the step length
            let mut slope_weight = end_weight * WEIGHT[i];
            if i < 3 {
                slope_weight += state_weight * NODE[i + 1];
            }
            add_rates(layout, k, (h, h_rate), i, stage, &slope_weight, out);
            let (weight, weight_l) = (slope_weight * h, WEIGHT[i] * h);
            let hess =
                running::weighted_hessian(program.problem, stage.time, &stage.state, u, &weight, weight_l);
            add_hessian(layout, k, stage, &hess, out);
            state_weight = tr_mul_vec(&stage.model.f.state, &slope_weight) * h;
            if let Some(running) = &stage.model.running {
                state_weight += running.x * (h * WEIGHT[i]);
            }
            start_weight += state_weight;
        }
        end_weight = start_weight;
    }
}

/// Second derivatives that involve the step length, and gradients of the running cost, at one stage.
#[inline(always)]
fn add_rates<const NX: usize, const NU: usize>(
    layout: &Layout,
    k: usize,
    (h, h_rate): (f64, f64),
    i: usize,
    stage: &Stage<NX, NU>,
    slope_weight: &SVector<f64, NX>,
    out: &mut Linearisation<NX, NU>,
) {
    let s = &stage.by_state;
    let mut up = tr_mul_vec(&stage.slope.u, slope_weight) * h_rate;
    let mut qp = tr_mul_vec(&stage.slope.x, slope_weight) * h_rate;
    let mut pp = 2.0 * h_rate * stage.slope.p.dot(slope_weight);
    if let Some(r) = &stage.model.running {
        let wl = WEIGHT[i] * h;
        let (rx, ru) = (tr_mul_vec(&s.x, &r.x), tr_mul_vec(&s.u, &r.x) + r.u);
        let rp = r.x.dot(&s.p) + r.t * stage.t_rate;
        let b = WEIGHT[i] * h_rate;
        qp += rx * b;
        up += ru * b;
        pp += 2.0 * rp * b;
        let gp = wl * rp + b * r.value;
        out.add_objective(layout.state(k), (rx * wl).as_slice());
        out.add_objective(layout.control(k, 0), (ru * wl).as_slice());
        out.objective[layout.time] += gp;
        out.add_gradient(layout.state(k), (rx * wl).as_slice());
        out.add_gradient(layout.control(k, 0), (ru * wl).as_slice());
        out.lagrangian[layout.time] += gp;
    }
    for j in 0..NU {
        out.raw.rp[k * layout.m + j] += up[j];
    }
    out.raw.qp[k] += qp;
    out.raw.hpp += pp;
}

/// Maps the second derivatives at a stage to (x, u, p) of the segment.
#[inline(always)]
fn add_hessian<const NX: usize, const NU: usize>(
    layout: &Layout,
    k: usize,
    stage: &Stage<NX, NU>,
    hess: &Hessian<NX, NU>,
    out: &mut Linearisation<NX, NU>,
) {
    let s = &stage.by_state;
    let xu = mul_thin(&hess.state_state, &s.u) + hess.state_control;
    let xp = mul_vec(&hess.state_state, &s.p) + hess.state_time * stage.t_rate;
    let up = tr_mul_vec(&s.u, &xp) + tr_mul_vec(&hess.state_control, &s.p) + hess.control_time * stage.t_rate;
    let raw = &mut out.raw;
    raw.hpp += s.p.dot(&(xp + hess.state_time * stage.t_rate)) + hess.time_time * stage.t_rate * stage.t_rate;
    raw.qp[k] += tr_mul_vec(&s.x, &xp);
    raw.q[k] += tr_mul(&s.x, &mul_thin(&hess.state_state, &s.x));
    let su = tr_mul(&s.x, &xu);
    let uu = tr_mul(&s.u, &xu) + tr_mul(&hess.state_control, &s.u) + hess.control_control;
    add_control_block(raw, layout.m, k, 0, &uu);
    for j in 0..NU {
        raw.s[k * layout.m + j] += su.column(j);
        raw.rp[k * layout.m + j] += up[j];
    }
}
