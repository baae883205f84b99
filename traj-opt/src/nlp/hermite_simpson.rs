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
use crate::dense::{Arithmetic, array, vector, zero_columns};
use crate::{Dynamics, Hessian, Problem};
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
    // three variables, not an array made by `map`, which would copy each several times
    let differentiate = |i: usize| running::differentiate(program.problem, at[i].time, &x[i], &u[i]);
    let (first, middle, last) = (differentiate(0), differentiate(1), differentiate(2));
    let model = [&first, &middle, &last];
    out.add_gradient(layout.state(k), (lambda + eta * 0.5).as_slice());
    out.add_gradient(layout.state(k + 1), (eta * 0.5 - lambda).as_slice());
    out.add_gradient(layout.middle(k), (-eta).as_slice());
    let state_offsets = [layout.state(k), layout.middle(k), layout.state(k + 1)];
    for i in 0..3 {
        let omega = lambda * WEIGHT[i] + eta * HERMITE[i];
        let hessian = running::hessian(program.problem, &at[i], (&x[i], &u[i], second), &omega, WEIGHT[i]);
        let terms = PointTerms::new::<A>(model[i], &at[i], &omega, WEIGHT[i], &hessian);
        out.add_point_gradient(layout, (state_offsets[i], layout.control(k, i)), &terms);
        if i == 1 {
            add_middle(layout, k, (&terms, &hessian), out);
        } else {
            add_end(&mut out.raw, layout.m, k, i / 2, i, (&terms, &hessian));
        }
    }
    eliminate::<A, NX, NU>(layout, k, &at, &model, out);
}

#[inline(always)]
fn add_middle<const NX: usize, const NU: usize>(
    layout: &Layout,
    k: usize,
    (terms, hessian): (&PointTerms<NX, NU>, &Hessian<NX, NU>),
    out: &mut Linearisation<NX, NU>,
) {
    let middle = &mut out.middles[k];
    middle.hxx = hessian.state_state;
    middle.hxu = hessian.state_control;
    middle.hxp = terms.xp;
    out.raw.hpp += terms.pp;
    add_control_block(&mut out.raw, layout.m, k, 1, &hessian.control_control);
    for j in 0..NU {
        out.raw.rp[k * layout.m + NU + j] += terms.up[j];
    }
}

/// Resolves the linearised defects for the middle and end states, column by column: those of a state that the dynamics do not
/// depend on are columns of the identity.
#[inline(always)]
fn eliminate<A: Arithmetic, const NX: usize, const NU: usize>(
    layout: &Layout,
    k: usize,
    at: &[running::PointTime; 3],
    model: &[&PointModel<NX, NU>; 3],
    out: &mut Linearisation<NX, NU>,
) {
    let h = at[0].h;
    let (simpson, hermite) = (WEIGHT.map(|c| h * c), HERMITE.map(|c| h * c));
    let (first, last) = (&model[0].f.state, &model[2].f.state);
    let middle = &mut out.middles[k];
    middle.defect_by = model[1].f.state * simpson[1];
    middle.by_next = identity_plus(0.5, hermite[2], last);
    middle.sx = identity_plus(0.5, hermite[0], first);
    let unused = zero_columns(&middle.defect_by);
    let (unused_first, unused_last) = (zero_columns(first), zero_columns(last));
    let end = (-simpson[2], -hermite[2], -1.0);
    let implicit = end_map::<A, NX>(end, (last, &unused_last), (&middle.defect_by, &unused));
    let start = (simpson[0], hermite[0], 1.0);
    let explicit = end_map::<A, NX>(start, (first, &unused_first), (&middle.defect_by, &unused));
    let idle: [bool; NX] = std::array::from_fn(|j| unused[j] && unused_last[j]);
    let resolve = A::inverse(&implicit, &idle).unwrap_or_else(SMatrix::identity);
    for j in 0..NX {
        let mut column = SVector::from(resolve.data.0[j]);
        if !(unused[j] && unused_first[j]) {
            column = A::mul_vec(&resolve, &SVector::from(explicit.data.0[j]));
        }
        A::axpy(&mut middle.sx.data.0[j], 1.0, array(&A::mul_vec(&middle.by_next, &column)));
        out.raw.a[k].data.0[j] = *array(&column);
    }
    let (mut defect_p, mut middle_p) = (SVector::zeros(), SVector::zeros());
    for i in 0..3 {
        let rate = model[i].f.value * at[i].h_rate + model[i].f.time * (h * at[i].t_rate);
        defect_p += rate * WEIGHT[i];
        middle_p += rate * HERMITE[i];
    }
    let ap = A::mul_vec(&resolve, &(defect_p + A::mul_vec(&middle.defect_by, &middle_p)));
    middle.sp = middle_p + A::mul_vec(&middle.by_next, &ap);
    for i in 0..3 {
        for j in 0..NU {
            let control = &model[i].f.control.column(j);
            let direct = control * hermite[i];
            let mut defect = control * simpson[i];
            if HERMITE[i] != 0.0 {
                defect += A::mul_vec(&middle.defect_by, &direct);
            }
            let column = A::mul_vec(&resolve, &defect);
            out.middle_su[k * layout.m + i * NU + j] = direct + A::mul_vec(&middle.by_next, &column);
            out.raw.b[k * layout.m + i * NU + j] = column;
        }
    }
    (out.raw.ap[k], out.resolve[k]) = (ap, resolve);
}

/// `diagonal I + factor f`.
#[inline(always)]
fn identity_plus<const NX: usize>(
    diagonal: f64,
    factor: f64,
    f: &SMatrix<f64, NX, NX>,
) -> SMatrix<f64, NX, NX> {
    let mut out = SMatrix::zeros();
    for j in 0..NX {
        for i in 0..NX {
            // not added to the diagonal afterwards, on whose single stores the wide loads that follow would wait
            out.data.0[j][i] = factor * f.data.0[j][i] + if i == j { diagonal } else { 0.0 };
        }
    }
    out
}

/// The identity and what a state at one end adds to the defect, directly and through the middle state: `direct f` and
/// `defect_by (share / 2 I + through f)`. Both matrices with their columns of zeros.
#[inline(always)]
fn end_map<A: Arithmetic, const NX: usize>(
    (direct, through, share): (f64, f64, f64),
    (f, unused): (&SMatrix<f64, NX, NX>, &[bool; NX]),
    (defect_by, unused_middle): (&SMatrix<f64, NX, NX>, &[bool; NX]),
) -> SMatrix<f64, NX, NX> {
    let mut out = identity_plus(1.0, direct, f);
    for j in 0..NX {
        let column = &mut out.data.0[j];
        if !unused_middle[j] {
            A::axpy(column, 0.5 * share, &defect_by.data.0[j]);
        }
        if !unused[j] {
            let moved = A::mul_vec(defect_by, &SVector::from(f.data.0[j]));
            A::axpy(column, through, array(&moved));
        }
    }
    out
}
