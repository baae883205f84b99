//! Path constraints at the collocation points, with slacks.

use super::layout::{Layout, Place, Point};
use super::program::{Duals, Linearisation, Program, Scratch, add_control_block};
use crate::Problem;
use crate::autodiff::{
    constant, constant2, gradient, hessian_part, mixed_part, seed, seed_columns, seed_rows, seed2,
};
use crate::dense::vector;
use crate::{Hessian, autodiff};
use nalgebra::{SMatrix, SVector};
use num_dual::{Derivative, Dual2SVec64, Dual64, DualSVec64, HyperDual64, HyperDualSVec64};

/// `path - slack` at every point.
pub(crate) fn evaluate<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    w: &[f64],
    scratch: &mut [f64],
    out: &mut [f64],
) {
    let n = layout.n_path;
    if n == 0 {
        return;
    }
    for (i, point) in layout.points.iter().enumerate() {
        let (x, u) = variables::<NX, NU>(layout, w, point);
        let t = program.time_at(point.fraction, w[layout.time]);
        program.problem.path(t, &x, &u, &mut scratch[..n]);
        for j in 0..n {
            out[i * n + j] = scratch[j] - w[layout.path_slacks + i * n + j];
        }
    }
}

fn variables<const NX: usize, const NU: usize>(
    layout: &Layout,
    w: &[f64],
    point: &Point,
) -> (SVector<f64, NX>, SVector<f64, NU>) {
    (vector(w, layout.point_state(point)), vector(w, layout.control(point.segment, point.local)))
}

/// Jacobian rows, gradient and second derivatives of all path constraints.
pub(crate) fn linearise<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    w: &[f64],
    duals: &Duals<NX>,
    scratch: &mut Scratch<NX, NU>,
    out: &mut Linearisation<NX, NU>,
) {
    let n = layout.n_path;
    if n == 0 {
        return;
    }
    for (i, point) in layout.points.iter().enumerate() {
        let (x, u) = variables::<NX, NU>(layout, w, point);
        let t = program.time_at(point.fraction, w[layout.time]);
        let rate = if program.free_time { point.fraction } else { 0.0 };
        let timed = !program.problem.is_autonomous() && rate != 0.0;
        jacobian(program.problem, (t, &x, &u), timed, &mut out_rows(out, i, n), scratch);
        for j in 0..n {
            let row = i * n + j;
            out.path_p[row] *= rate;
            let y = duals.path[row];
            let (gx, gu, gp) = (out.path_x[row] * y, out.path_u[row] * y, out.path_p[row] * y);
            out.add_gradient(layout.point_state(point), gx.as_slice());
            out.add_gradient(layout.control(point.segment, point.local), gu.as_slice());
            out.lagrangian[layout.time] += gp;
            out.lagrangian[layout.path_slacks + row] -= y;
        }
        let weights = &duals.path[i * n..(i + 1) * n];
        if weights.iter().any(|&y| y != 0.0) {
            let hessian = hessian(program.problem, (t, &x, &u), timed, weights, scratch);
            add_hessian(layout, point, rate, &hessian, out);
        }
    }
}

/// Gradients of the path functions at one point.
pub(crate) struct Rows<'a, const NX: usize, const NU: usize> {
    pub x: &'a mut [SVector<f64, NX>],
    pub u: &'a mut [SVector<f64, NU>],
    pub t: &'a mut [f64],
}

fn out_rows<const NX: usize, const NU: usize>(
    out: &mut Linearisation<NX, NU>,
    i: usize,
    n: usize,
) -> Rows<'_, NX, NU> {
    let range = i * n..(i + 1) * n;
    Rows { x: &mut out.path_x[range.clone()], u: &mut out.path_u[range.clone()], t: &mut out.path_p[range] }
}

type At<'a, const NX: usize, const NU: usize> = (f64, &'a SVector<f64, NX>, &'a SVector<f64, NU>);

fn jacobian<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &P,
    (t, x, u): At<NX, NU>,
    timed: bool,
    rows: &mut Rows<NX, NU>,
    scratch: &mut Scratch<NX, NU>,
) {
    if !timed && problem.path_gradients(x, u, rows.x, rows.u) {
        rows.t.fill(0.0);
        return;
    }
    automatic_jacobian(problem, (t, x, u), timed, rows, scratch);
}

/// Gradients by automatic differentiation.
pub(crate) fn automatic_jacobian<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &P,
    (t, x, u): At<NX, NU>,
    timed: bool,
    rows: &mut Rows<NX, NU>,
    scratch: &mut Scratch<NX, NU>,
) {
    let n = rows.x.len();
    problem.path(DualSVec64::from_re(t), &seed(x), &constant::<NU, NX>(u), &mut scratch.x[..n]);
    problem.path(DualSVec64::from_re(t), &constant::<NX, NU>(x), &seed(u), &mut scratch.u[..n]);
    if timed {
        let time = Dual64::from_re(t).derivative();
        problem.path(time, &x.map(Dual64::from_re), &u.map(Dual64::from_re), &mut scratch.t[..n]);
    }
    for j in 0..n {
        rows.x[j] = gradient(&scratch.x[j]);
        rows.u[j] = gradient(&scratch.u[j]);
        rows.t[j] = if timed { scratch.t[j].eps } else { 0.0 };
    }
}

/// Second derivatives of the weighted sum of the path functions.
fn hessian<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &P,
    (t, x, u): At<NX, NU>,
    timed: bool,
    weights: &[f64],
    scratch: &mut Scratch<NX, NU>,
) -> Hessian<NX, NU> {
    let mut sum = Hessian::zeros();
    if !timed && problem.path_hessian(x, u, weights, &mut sum) {
        return sum;
    }
    automatic_hessian(problem, (t, x, u), timed, weights, scratch)
}

/// Second derivatives by automatic differentiation.
pub(crate) fn automatic_hessian<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &P,
    (t, x, u): At<NX, NU>,
    timed: bool,
    weights: &[f64],
    scratch: &mut Scratch<NX, NU>,
) -> Hessian<NX, NU> {
    let n = weights.len();
    let mut sum = Hessian::zeros();
    problem.path(Dual2SVec64::from_re(t), &seed2(x), &constant2::<NU, NX>(u), &mut scratch.xx[..n]);
    problem.path(Dual2SVec64::from_re(t), &constant2::<NX, NU>(x), &seed2(u), &mut scratch.uu[..n]);
    let (rows, columns) = (seed_rows::<NX, NU>(x), seed_columns::<NX, NU>(u));
    problem.path(HyperDualSVec64::from_re(t), &rows, &columns, &mut scratch.xu[..n]);
    for j in 0..n {
        sum.state_state += hessian_part(&scratch.xx[j]) * weights[j];
        sum.control_control += hessian_part(&scratch.uu[j]) * weights[j];
        sum.state_control += mixed_part(&scratch.xu[j]) * weights[j];
    }
    if timed {
        let one = || Derivative::some(SMatrix::<f64, 1, 1>::repeat(1.0));
        let mut tx = HyperDualSVec64::<NX, 1>::from_re(t);
        tx.eps2 = one();
        let xs = autodiff::seed_rows::<NX, 1>(x);
        problem.path(tx, &xs, &u.map(HyperDualSVec64::from_re), &mut scratch.xt[..n]);
        let mut tu = HyperDualSVec64::<NU, 1>::from_re(t);
        tu.eps2 = one();
        let us = autodiff::seed_rows::<NU, 1>(u);
        problem.path(tu, &x.map(HyperDualSVec64::from_re), &us, &mut scratch.ut[..n]);
        let tt = HyperDual64::new(t, 1.0, 1.0, 0.0);
        problem.path(tt, &x.map(HyperDual64::from_re), &u.map(HyperDual64::from_re), &mut scratch.tt[..n]);
        for j in 0..n {
            sum.state_time += mixed_part(&scratch.xt[j]) * weights[j];
            sum.control_time += mixed_part(&scratch.ut[j]) * weights[j];
            sum.time_time += scratch.tt[j].eps1eps2 * weights[j];
        }
    }
    sum
}

fn add_hessian<const NX: usize, const NU: usize>(
    layout: &Layout,
    point: &Point,
    rate: f64,
    h: &Hessian<NX, NU>,
    out: &mut Linearisation<NX, NU>,
) {
    let (k, m) = (point.segment, layout.m);
    let (xp, up) = (h.state_time * rate, h.control_time * rate);
    add_control_block(&mut out.raw, m, k, point.local, &h.control_control);
    out.raw.hpp += h.time_time * rate * rate;
    for j in 0..NU {
        out.raw.rp[k * m + point.local * NU + j] += up[j];
    }
    match point.place {
        Place::Middle => {
            if out.stages.is_used() {
                let inner = &mut out.stages.inner[k * layout.n_inner + point.local];
                inner.hxx += h.state_state;
                inner.hxu += h.state_control;
                inner.hxp += xp;
                return;
            }
            out.middles[k].hxx += h.state_state;
            out.middles[k].hxu += h.state_control;
            out.middles[k].hxp += xp;
        }
        Place::Left | Place::Right => {
            let right = point.place == Place::Right;
            let knot = k + usize::from(right);
            out.raw.q[knot] += h.state_state;
            out.raw.qp[knot] += xp;
            for j in 0..NU {
                let column = k * m + point.local * NU + j;
                let target = if right { &mut out.raw.cross[column] } else { &mut out.raw.s[column] };
                *target += h.state_control.column(j);
            }
        }
    }
}
