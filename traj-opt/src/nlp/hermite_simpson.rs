//! Hermite-Simpson collocation: middle state `xm = (x0 + x1)/2 + h/8 (f0 - f1)` and `x1 = x0 + h/6 (f0 + 4 fm + f1)`,
//! one control vector at either end and in the middle (C. R. Hargraves, S. W. Paris, *Direct trajectory optimization using
//! nonlinear programming and collocation*, J. Guidance 10, 1987; separated form: J. T. Betts, *Practical Methods for Optimal
//! Control*, section 4.5). The middle state and the implicit end state are eliminated from the linearised equations.
//!
//! The separated form has the middle states as variables; the compressed form sets them to the interpolant at every point that is
//! tried. Both have the same Newton system.

use super::layout::Layout;
use super::program::{Duals, Linearisation, Program, Values, add_control_block};
use super::running::{self, PointModel, PointTerms};
use super::trapezoidal::add_end;
use crate::dense::{Arithmetic, vector};
use crate::{Dynamics, Problem};
use nalgebra::{SMatrix, SVector};

const POINT: [f64; 3] = [0.0, 0.5, 1.0];
const WEIGHT: [f64; 3] = [1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0];
/// Coefficients of the slopes in the middle state.
const HERMITE: [f64; 3] = [1.0 / 8.0, 0.0, -1.0 / 8.0];

fn states<const NX: usize>(layout: &Layout, w: &[f64], k: usize) -> [SVector<f64, NX>; 3] {
    [layout.state(k), layout.middle(k), layout.state(k + 1)].map(|offset| vector(w, offset))
}

/// Sets the middle states to the Hermite interpolants of the knots: the compressed form.
pub(crate) fn set_middles<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    w: &mut [f64],
) {
    for k in 0..layout.n_segments {
        let ends = [0, 1].map(|end| {
            let at = program.point_time(k, end as f64, w[layout.time]);
            let x = program.state(layout, w, k + end);
            let u = program.control(layout, w, k, 2 * end);
            (x, program.problem.dynamics().derivative(at.time, &x, &u) * at.h)
        });
        let middle = (ends[0].0 + ends[1].0) * 0.5 + ends[0].1 * HERMITE[0] + ends[1].1 * HERMITE[2];
        let at = layout.middle(k);
        w[at..at + NX].copy_from_slice(middle.as_slice());
    }
}

/// Defects of segment `k`; returns its running cost.
pub(crate) fn evaluate<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    k: usize,
    w: &[f64],
    out: &mut Values<NX>,
) -> f64 {
    let x = states::<NX>(layout, w, k);
    let (mut simpson, mut hermite, mut cost) = (SVector::zeros(), SVector::zeros(), 0.0);
    let h = program.point_time(k, 0.0, w[layout.time]).h;
    for i in 0..3 {
        let t = program.point_time(k, POINT[i], w[layout.time]).time;
        let u = program.control(layout, w, k, i);
        let slope = program.problem.dynamics().derivative(t, &x[i], &u);
        simpson += slope * WEIGHT[i];
        hermite += slope * HERMITE[i];
        cost += program.problem.lagrange(t, &x[i], &u).unwrap_or(0.0) * WEIGHT[i];
    }
    out.defect[k] = x[0] + simpson * h - x[2];
    out.middle[k] = (x[0] + x[2]) * 0.5 + hermite * h - x[1];
    cost * h
}

/// Derivatives of segment `k`.
#[inline(always)]
pub(crate) fn linearise<A: Arithmetic, const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    k: usize,
    w: &[f64],
    duals: &Duals<NX>,
    second: bool,
    out: &mut Linearisation<NX, NU>,
) {
    let (lambda, eta) = (duals.defect[k], duals.middle[k]);
    let at = POINT.map(|s| program.point_time(k, s, w[layout.time]));
    let x = states::<NX>(layout, w, k);
    let u = [0, 1, 2].map(|local| program.control(layout, w, k, local));
    let model = [0, 1, 2].map(|i| running::differentiate(program.problem, at[i].time, &x[i], &u[i]));
    out.add_gradient(layout.state(k), (lambda + eta * 0.5).as_slice());
    out.add_gradient(layout.state(k + 1), (eta * 0.5 - lambda).as_slice());
    out.add_gradient(layout.middle(k), (-eta).as_slice());
    let state_offsets = [layout.state(k), layout.middle(k), layout.state(k + 1)];
    for i in 0..3 {
        let omega = lambda * WEIGHT[i] + eta * HERMITE[i];
        let terms =
            PointTerms::new(program.problem, &model[i], &at[i], (&x[i], &u[i], second), &omega, WEIGHT[i]);
        out.add_point_gradient(layout, (state_offsets[i], layout.control(k, i)), &terms);
        if i == 1 {
            add_middle(layout, k, &terms, out);
        } else {
            add_end(&mut out.raw, layout.m, k, i / 2, i, &terms);
        }
    }
    eliminate::<A, NX, NU>(layout, k, &at, &model, out);
}

#[inline(always)]
fn add_middle<const NX: usize, const NU: usize>(
    layout: &Layout,
    k: usize,
    terms: &PointTerms<NX, NU>,
    out: &mut Linearisation<NX, NU>,
) {
    let middle = &mut out.middles[k];
    middle.hxx = terms.hessian.state_state;
    middle.hxu = terms.hessian.state_control;
    middle.hxp = terms.xp;
    out.raw.hpp += terms.pp;
    add_control_block(&mut out.raw, layout.m, k, 1, &terms.hessian.control_control);
    for j in 0..NU {
        out.raw.rp[k * layout.m + NU + j] += terms.up[j];
    }
}

/// Resolves the linearised defects for the middle and end states.
#[inline(always)]
fn eliminate<A: Arithmetic, const NX: usize, const NU: usize>(
    layout: &Layout,
    k: usize,
    at: &[running::PointTime; 3],
    model: &[PointModel<NX, NU>; 3],
    out: &mut Linearisation<NX, NU>,
) {
    let (h, h_rate) = (at[0].h, at[0].h_rate);
    let one = SMatrix::<f64, NX, NX>::identity();
    let by_first = one * 0.5 + model[0].f.state * (h * HERMITE[0]);
    let by_next = one * 0.5 + model[2].f.state * (h * HERMITE[2]);
    let defect_by = model[1].f.state * (h * WEIGHT[1]);
    let implicit = one - model[2].f.state * (h * WEIGHT[2]) - A::mul_thin(&defect_by, &by_next);
    let resolve = A::inverse(&implicit).unwrap_or_else(SMatrix::identity);
    let explicit = one + model[0].f.state * (h * WEIGHT[0]) + A::mul_thin(&defect_by, &by_first);
    let a = A::mul_units(&resolve, &explicit);
    let (mut defect_p, mut middle_p) = (SVector::zeros(), SVector::zeros());
    for i in 0..3 {
        let rate = model[i].f.value * h_rate + model[i].f.time * (h * at[i].t_rate);
        defect_p += rate * WEIGHT[i];
        middle_p += rate * HERMITE[i];
    }
    let ap = A::mul_vec(&resolve, &(defect_p + A::mul_vec(&defect_by, &middle_p)));
    for i in 0..3 {
        let g = &model[i].f.control;
        let direct = g * (h * HERMITE[i]);
        let b = A::mul(&resolve, &(g * (h * WEIGHT[i]) + A::mul_thin(&defect_by, &direct)));
        let su = direct + A::mul(&by_next, &b);
        for j in 0..NU {
            out.raw.b[k * layout.m + i * NU + j] = b.column(j).into_owned();
            out.middle_su[k * layout.m + i * NU + j] = su.column(j).into_owned();
        }
    }
    let middle = &mut out.middles[k];
    middle.sx = by_first + A::mul_units(&by_next, &a);
    middle.sp = middle_p + A::mul_vec(&by_next, &ap);
    (middle.by_next, middle.defect_by) = (by_next, defect_by);
    (out.raw.a[k], out.raw.ap[k], out.resolve[k]) = (a, ap, resolve);
}
