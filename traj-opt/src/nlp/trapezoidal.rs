//! Trapezoidal collocation: `x[k+1] = x[k] + h/2 (f0 + f1)` with one control vector at each end of the segment.

use super::layout::Layout;
use super::program::{Duals, Linearisation, Program, Values, add_control_block};
use super::running::{self, PointTerms};
use crate::dense::{Separate, mul, mul_vec};
use crate::{Dynamics, Hessian, Problem};
use nalgebra::{SMatrix, SVector};

/// Defect of segment `k`; returns its running cost.
pub(crate) fn evaluate<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    k: usize,
    w: &[f64],
    out: &mut Values<NX>,
) -> f64 {
    let mut slope = SVector::zeros();
    let mut cost = 0.0;
    let h = program.point_time(k, 0.0, w[layout.time]).h;
    for end in 0..2 {
        let t = program.point_time(k, end as f64, w[layout.time]).time;
        let (x, u) = (program.state(layout, w, k + end), program.control(layout, w, k, end));
        slope += program.problem.dynamics().derivative(t, &x, &u);
        cost += program.problem.lagrange(t, &x, &u).unwrap_or(0.0);
    }
    out.defect[k] = program.state(layout, w, k) + slope * (0.5 * h) - program.state(layout, w, k + 1);
    cost * 0.5 * h
}

/// Derivatives of segment `k`.
#[inline(always)]
pub(crate) fn linearise<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    k: usize,
    w: &[f64],
    duals: &Duals<NX>,
    second: bool,
    out: &mut Linearisation<NX, NU>,
) {
    let lambda = duals.defect[k];
    let m = layout.m;
    let at = [0.0, 1.0].map(|s| program.point_time(k, s, w[layout.time]));
    let x = [k, k + 1].map(|knot| program.state(layout, w, knot));
    let u = [0, 1].map(|local| program.control(layout, w, k, local));
    let model = [0, 1].map(|i| running::differentiate(program.problem, at[i].time, &x[i], &u[i]));
    let half = 0.5 * at[0].h;
    let implicit = SMatrix::identity() - model[1].f.state * half;
    let resolve = implicit.try_inverse().unwrap_or_else(SMatrix::identity);
    let slope_sum = model[0].f.value + model[1].f.value;
    let by_p = slope_sum * (0.5 * at[0].h_rate)
        + (model[0].f.time * at[0].t_rate + model[1].f.time * at[1].t_rate) * half;
    out.raw.a[k] = mul(&resolve, &(SMatrix::identity() + model[0].f.state * half));
    out.raw.ap[k] = mul_vec(&resolve, &by_p);
    out.resolve[k] = resolve;
    out.add_gradient(layout.state(k), lambda.as_slice());
    out.add_gradient(layout.state(k + 1), (-lambda).as_slice());
    for i in 0..2 {
        let omega = lambda * 0.5;
        let hessian = running::hessian(program.problem, &at[i], (&x[i], &u[i], second), &omega, 0.5);
        let terms = PointTerms::new::<Separate>(&model[i], &at[i], &omega, 0.5, &hessian);
        out.add_point_gradient(layout, (layout.state(k + i), layout.control(k, i)), &terms);
        let columns = mul(&resolve, &(model[i].f.control * half));
        for j in 0..NU {
            out.raw.b[k * m + i * NU + j] = columns.column(j).into_owned();
        }
        add_end(&mut out.raw, m, k, i, i, (&terms, &hessian));
    }
}

/// Adds the second derivatives of a point at the left (`end` 0) or right (1) knot of segment `k`.
#[inline(always)]
pub(crate) fn add_end<const NX: usize, const NU: usize>(
    raw: &mut super::quadratic::Quadratic<NX>,
    m: usize,
    k: usize,
    end: usize,
    local: usize,
    (terms, hessian): (&PointTerms<NX, NU>, &Hessian<NX, NU>),
) {
    let knot = k + end;
    raw.q[knot] += hessian.state_state;
    raw.qp[knot] += terms.xp;
    raw.hpp += terms.pp;
    add_control_block(raw, m, k, local, &hessian.control_control);
    for j in 0..NU {
        let column = k * m + local * NU + j;
        raw.rp[column] += terms.up[j];
        let target = if end == 0 { &mut raw.s[column] } else { &mut raw.cross[column] };
        *target += hessian.state_control.column(j);
    }
}
