//! Legendre-Gauss-Radau collocation in integral form: `x_i = x_0 + h sum_j a_ij f(t_j, x_j, u_j)` at the points `i = 1..d` of a
//! segment, the last of which is its end (D. Garg et al., *A unified framework for the numerical solution of optimal control
//! problems using pseudospectral methods*, Automatica 46, 2010; as a Runge-Kutta method Radau IIA: E. Hairer, G. Wanner,
//! *Solving Ordinary Differential Equations II*, section IV.5). The inner states are variables; they and the end state are
//! eliminated from the linearised equations.

use super::layout::Layout;
use super::lu;
use super::program::{Duals, Linearisation, Program, Values, add_control_block};
use super::running::{self, PointModel, PointTerms, PointTime};
use super::trapezoidal::add_end;
use crate::dense::{Separate, vector};
use crate::transcription::MAX_DEGREE;
use crate::{Dynamics, Hessian, Problem};
use nalgebra::SVector;

/// Offset of the state at collocation point `i` of segment `k`.
fn state_offset(layout: &Layout, k: usize, i: usize) -> usize {
    if i < layout.n_inner { layout.inner(k, i) } else { layout.state(k + 1) }
}

/// Defects of segment `k`; returns its running cost.
pub(crate) fn evaluate<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    k: usize,
    w: &[f64],
    out: &mut Values<NX>,
) -> f64 {
    let (table, points) = (&layout.tableau, program.transcription.control_points());
    let (d, q) = (table.degree, layout.n_inner);
    let start = program.state(layout, w, k);
    let mut residual: [SVector<f64, NX>; MAX_DEGREE] = [start; MAX_DEGREE];
    let mut cost = 0.0;
    let h = program.point_time(k, 0.0, w[layout.time]).h;
    for j in 0..d {
        let t = program.point_time(k, points[j], w[layout.time]).time;
        let x: SVector<f64, NX> = vector(w, state_offset(layout, k, j));
        let u = program.control(layout, w, k, j);
        let slope = program.problem.dynamics().derivative(t, &x, &u) * h;
        for (i, r) in residual.iter_mut().enumerate().take(d) {
            *r += slope * table.weight(i, j);
        }
        residual[j] -= x;
        cost += program.problem.lagrange(t, &x, &u).unwrap_or(0.0) * table.weight(d - 1, j);
    }
    out.middle[k * q..(k + 1) * q].copy_from_slice(&residual[..q]);
    out.defect[k] = residual[q];
    cost * h
}

/// Derivatives of segment `k`.
pub(crate) fn linearise<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    k: usize,
    w: &[f64],
    duals: &Duals<NX>,
    second: bool,
    out: &mut Linearisation<NX, NU>,
) {
    let (table, points) = (&layout.tableau, program.transcription.control_points());
    let (d, q) = (table.degree, layout.n_inner);
    let eta = |i: usize| if i < q { duals.middle[k * q + i] } else { duals.defect[k] };
    let at: [PointTime; MAX_DEGREE] =
        std::array::from_fn(|i| program.point_time(k, points.get(i).copied().unwrap_or(1.0), w[layout.time]));
    let model: [Option<PointModel<NX, NU>>; MAX_DEGREE] = std::array::from_fn(|j| {
        (j < d).then(|| {
            let (x, u) = (vector(w, state_offset(layout, k, j)), program.control(layout, w, k, j));
            running::differentiate(program.problem, at[j].time, &x, &u)
        })
    });
    for (j, point) in model.iter().flatten().enumerate() {
        out.add_gradient(layout.state(k), eta(j).as_slice());
        out.add_gradient(state_offset(layout, k, j), (-eta(j)).as_slice());
        let mut omega = SVector::zeros();
        for i in 0..d {
            omega += eta(i) * table.weight(i, j);
        }
        let (x, u) = (vector(w, state_offset(layout, k, j)), program.control(layout, w, k, j));
        let weight = table.weight(d - 1, j);
        let hessian = running::hessian(program.problem, &at[j], (&x, &u, second), &omega, weight);
        let terms = PointTerms::new::<Separate>(point, &at[j], &omega, weight, &hessian);
        out.add_point_gradient(layout, (state_offset(layout, k, j), layout.control(k, j)), &terms);
        if j < q {
            add_inner(layout, k, j, (&terms, &hessian), out);
        } else {
            add_end(&mut out.raw, layout.m, k, 1, j, (&terms, &hessian));
        }
    }
    eliminate(layout, k, &at, &model, out);
}

fn add_inner<const NX: usize, const NU: usize>(
    layout: &Layout,
    k: usize,
    j: usize,
    (terms, hessian): (&PointTerms<NX, NU>, &Hessian<NX, NU>),
    out: &mut Linearisation<NX, NU>,
) {
    let inner = &mut out.stages.inner[k * layout.n_inner + j];
    inner.hxx = hessian.state_state;
    inner.hxu = hessian.state_control;
    inner.hxp = terms.xp;
    out.raw.hpp += terms.pp;
    add_control_block(&mut out.raw, layout.m, k, j, &hessian.control_control);
    for i in 0..NU {
        out.raw.rp[k * layout.m + j * NU + i] += terms.up[i];
    }
}

/// Resolves the linearised defects for the inner states and the end state.
fn eliminate<const NX: usize, const NU: usize>(
    layout: &Layout,
    k: usize,
    at: &[PointTime; MAX_DEGREE],
    model: &[Option<PointModel<NX, NU>>; MAX_DEGREE],
    out: &mut Linearisation<NX, NU>,
) {
    let (d, m, table) = (layout.tableau.degree, layout.m, &layout.tableau);
    let (h, h_rate) = (at[0].h, at[0].h_rate);
    let size = d * NX;
    let (matrix, pivot) = out.stages.factors_mut(k);
    for (j, point) in model.iter().flatten().enumerate() {
        for i in 0..d {
            let scale = h * table.weight(i, j);
            for c in 0..NX {
                for r in 0..NX {
                    let unit = if i == j && r == c { 1.0 } else { 0.0 };
                    matrix[(i * NX + r) * size + j * NX + c] = unit - scale * point.f.state[(r, c)];
                }
            }
        }
    }
    lu::factorise(matrix, pivot);
    let mut column = [SVector::zeros(); MAX_DEGREE];
    for c in 0..NX {
        let unit = SVector::from_fn(|r, _| if r == c { 1.0 } else { 0.0 });
        column[..d].fill(unit);
        out.stages.resolve(k, &mut column[..d]);
        out.raw.a[k].set_column(c, &column[d - 1]);
        for (inner, value) in out.stages.segment_mut(k).iter_mut().zip(&column) {
            inner.sx.set_column(c, value);
        }
    }
    let mut by_time = [SVector::zeros(); MAX_DEGREE];
    for (j, point) in model.iter().flatten().enumerate() {
        let rate = point.f.value * h_rate + point.f.time * (h * at[j].t_rate);
        for (i, value) in by_time.iter_mut().enumerate().take(d) {
            *value += rate * table.weight(i, j);
        }
        for c in 0..NU {
            for (i, value) in column.iter_mut().enumerate().take(d) {
                *value = point.f.control.column(c) * (h * table.weight(i, j));
            }
            out.stages.resolve(k, &mut column[..d]);
            out.raw.b[k * m + j * NU + c] = column[d - 1];
            for (i, value) in column.iter().enumerate().take(d - 1) {
                out.stages.su[(k * (d - 1) + i) * m + j * NU + c] = *value;
            }
        }
    }
    out.stages.resolve(k, &mut by_time[..d]);
    out.raw.ap[k] = by_time[d - 1];
    for (inner, value) in out.stages.segment_mut(k).iter_mut().zip(&by_time) {
        inner.sp = *value;
    }
}
