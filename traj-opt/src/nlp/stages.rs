//! Elimination of the inner states of collocated segments from a Newton step, and their recovery.
//!
//! With `X` the inner states and the end state of a segment, the linearised defects are `M dX = 1 dx0 + B du + p dp + r`. They are
//! resolved for `dX`; the second derivatives at the inner states are mapped to `(dx0, du, dp)` by those solutions. The multipliers
//! follow from `M' dy = (forces on the inner states, costate)`.

use super::kkt::{Direction, System};
use super::layout::Layout;
use super::lu;
use super::program::Values;
use super::quadratic::{Quadratic, Rhs, Step};
use crate::transcription::MAX_DEGREE;
use nalgebra::{SMatrix, SVector};

/// An inner state as a function of the segment's other variables, and the Lagrangian's second derivatives there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inner<const NX: usize, const NU: usize> {
    pub sx: SMatrix<f64, NX, NX>,
    pub sp: SVector<f64, NX>,
    pub hxx: SMatrix<f64, NX, NX>,
    pub hxu: SMatrix<f64, NX, NU>,
    pub hxp: SVector<f64, NX>,
}

/// Derivatives of all inner states; empty for transcriptions without.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stages<const NX: usize, const NU: usize> {
    degree: usize,
    /// `degree - 1` a segment.
    pub inner: Vec<Inner<NX, NU>>,
    /// Columns by the controls: `m` an inner state.
    pub su: Vec<SVector<f64, NX>>,
    factors: Vec<f64>,
    pivots: Vec<usize>,
}

type Collocated<const NX: usize> = [SVector<f64, NX>; MAX_DEGREE];

impl<const NX: usize, const NU: usize> Stages<NX, NU> {
    pub fn resize(&mut self, layout: &Layout) {
        self.degree = layout.tableau.degree;
        let n_inner = if self.degree > 0 { layout.n_segments * layout.n_inner } else { 0 };
        let zero = Inner {
            sx: SMatrix::zeros(),
            sp: SVector::zeros(),
            hxx: SMatrix::zeros(),
            hxu: SMatrix::zeros(),
            hxp: SVector::zeros(),
        };
        self.inner.resize(n_inner, zero);
        self.su.resize(n_inner * layout.m, SVector::zeros());
        let size = self.degree * NX;
        self.factors.resize(layout.n_segments * size * size, 0.0);
        self.pivots.resize(layout.n_segments * size, 0);
    }

    pub fn is_used(&self) -> bool {
        self.degree > 0
    }

    pub fn segment_mut(&mut self, k: usize) -> &mut [Inner<NX, NU>] {
        let q = self.degree - 1;
        &mut self.inner[k * q..(k + 1) * q]
    }

    pub fn factors_mut(&mut self, k: usize) -> (&mut [f64], &mut [usize]) {
        let size = self.degree * NX;
        (
            &mut self.factors[k * size * size..(k + 1) * size * size],
            &mut self.pivots[k * size..(k + 1) * size],
        )
    }

    fn factors(&self, k: usize) -> (&[f64], &[usize]) {
        let size = self.degree * NX;
        (&self.factors[k * size * size..(k + 1) * size * size], &self.pivots[k * size..(k + 1) * size])
    }

    /// `M^-1` times the given residuals of segment `k`, in place.
    pub fn resolve(&self, k: usize, x: &mut [SVector<f64, NX>]) {
        let (factors, pivot) = self.factors(k);
        lu::solve(factors, pivot, x);
    }

    /// Multipliers of the inner states' equations and of the defect that balance `forces` on the inner states and the costate.
    pub fn multipliers(&self, k: usize, forces: &mut [SVector<f64, NX>]) {
        let (factors, pivot) = self.factors(k);
        lu::solve_transposed(factors, pivot, forces);
    }

    /// Sets all second derivatives to zero.
    pub fn clear_hessian(&mut self) {
        for inner in &mut self.inner {
            inner.hxx.fill(0.0);
            inner.hxu.fill(0.0);
            inner.hxp.fill(0.0);
        }
    }
}

impl<const NX: usize, const NU: usize> System<'_, NX, NU> {
    /// Second derivatives at inner state `i` of segment `k` with bounds and path constraints.
    fn inner_hessian(&self, k: usize, i: usize) -> Inner<NX, NU> {
        let layout = self.layout;
        let mut inner = self.lin.stages.inner[k * layout.n_inner + i];
        for r in 0..NX {
            inner.hxx[(r, r)] += self.bounds.sigma(self.w, layout.inner(k, i) + r);
        }
        for row in layout.inner_path_rows(k, i) {
            let sigma = self.bounds.sigma(self.w, layout.path_slacks + row);
            let (gx, gu) = (&self.lin.path_x[row], &self.lin.path_u[row]);
            inner.hxx += gx * gx.transpose() * sigma;
            inner.hxu += gx * gu.transpose() * sigma;
            inner.hxp += gx * (sigma * self.lin.path_p[row]);
        }
        inner
    }

    /// Columns of inner state `i` by the controls of segment `k`.
    fn inner_columns(&self, k: usize, i: usize) -> &[SVector<f64, NX>] {
        let m = self.layout.m;
        let first = (k * self.layout.n_inner + i) * m;
        &self.lin.stages.su[first..first + m]
    }

    /// Maps the second derivatives at the inner states to the segments' other variables.
    pub(super) fn add_stages(&self, lq: &mut Quadratic<NX>) {
        let (m, q) = (self.layout.m, self.layout.n_inner);
        for k in 0..self.layout.n_segments {
            for i in 0..q {
                let inner = self.inner_hessian(k, i);
                let su = self.inner_columns(k, i);
                let own = i * NU..(i + 1) * NU;
                lq.q[k] += inner.sx.transpose() * (inner.hxx * inner.sx);
                let hp = inner.hxx * inner.sp + inner.hxp;
                lq.qp[k] += inner.sx.transpose() * hp;
                lq.hpp += inner.sp.dot(&(hp + inner.hxp));
                for j in 0..m {
                    let mut column = inner.hxx * su[j];
                    lq.rp[k * m + j] += su[j].dot(&hp);
                    if own.contains(&j) {
                        column += inner.hxu.column(j - own.start);
                        lq.rp[k * m + j] += inner.hxu.column(j - own.start).dot(&inner.sp);
                    }
                    lq.s[k * m + j] += inner.sx.transpose() * column;
                    for row in 0..m {
                        let mut value = su[row].dot(&column);
                        if own.contains(&row) {
                            value += inner.hxu.column(row - own.start).dot(&su[j]);
                        }
                        lq.r[(k * m + row) * m + j] += value;
                    }
                }
            }
        }
    }

    /// Directions of the inner states and of the end state with all other variables held.
    pub(super) fn stage_offsets(&self, values: &Values<NX>, k: usize) -> Collocated<NX> {
        let q = self.layout.n_inner;
        let mut x = [SVector::zeros(); MAX_DEGREE];
        x[..q].copy_from_slice(&values.middle[k * q..(k + 1) * q]);
        x[q] = values.defect[k];
        self.lin.stages.resolve(k, &mut x[..=q]);
        x
    }

    /// Gradient with respect to an inner state, including path constraints there.
    fn inner_gradient(&self, values: &Values<NX>, k: usize, i: usize) -> SVector<f64, NX> {
        let mut g = SVector::from_fn(|r, _| self.gradient(self.layout.inner(k, i) + r));
        for row in self.layout.inner_path_rows(k, i) {
            g += self.lin.path_x[row] * self.slack_force(values, row);
        }
        g
    }

    /// Adds the inner states' part of the right-hand side of segment `k`.
    pub(super) fn add_stage_gradients(&self, values: &Values<NX>, k: usize, rhs: &mut Rhs<NX>) {
        let (m, q) = (self.layout.m, self.layout.n_inner);
        let offsets = self.stage_offsets(values, k);
        rhs.c[k] = offsets[q];
        for i in 0..q {
            let inner = self.inner_hessian(k, i);
            let g = self.inner_gradient(values, k, i) + inner.hxx * offsets[i];
            rhs.gx[k] += inner.sx.transpose() * g;
            rhs.gp += inner.sp.dot(&g) + inner.hxp.dot(&offsets[i]);
            for (j, column) in self.inner_columns(k, i).iter().enumerate() {
                rhs.gu[k * m + j] += column.dot(&g);
            }
            for j in 0..NU {
                rhs.gu[k * m + i * NU + j] += inner.hxu.column(j).dot(&offsets[i]);
            }
        }
    }

    /// Inner states and multipliers of one segment.
    pub(super) fn expand_stages(
        &self,
        values: &Values<NX>,
        step: &Step<NX>,
        k: usize,
        out: &mut Direction<NX>,
    ) {
        let (m, q) = (self.layout.m, self.layout.n_inner);
        let offsets = self.stage_offsets(values, k);
        let mut forces = [SVector::zeros(); MAX_DEGREE];
        for i in 0..q {
            let inner = self.inner_hessian(k, i);
            let mut dx = offsets[i] + inner.sx * step.dx[k] + inner.sp * step.dp;
            for (j, column) in self.inner_columns(k, i).iter().enumerate() {
                dx += column * step.du[k * m + j];
            }
            let at = self.layout.inner(k, i);
            out.w[at..at + NX].copy_from_slice(dx.as_slice());
            let du: SVector<f64, NU> = crate::dense::vector(&step.du, k * m + i * NU);
            forces[i] =
                self.inner_gradient(values, k, i) + inner.hxx * dx + inner.hxu * du + inner.hxp * step.dp;
        }
        forces[q] = step.costate[k];
        self.lin.stages.multipliers(k, &mut forces[..=q]);
        out.duals.middle[k * q..(k + 1) * q].copy_from_slice(&forces[..q]);
        out.duals.defect[k] = forces[q];
    }
}
