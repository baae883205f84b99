//! From bounds, slacks and linearisation to the linear-quadratic subproblem, and back to a full Newton direction.

use super::barrier::Box;
use super::boundary::BoundaryRows;
use super::layout::{Layout, Place};
use super::program::{Duals, Linearisation, Values};
use super::quadratic::{Quadratic, Rhs, Step};
use crate::dense::Kernel;
use crate::dense::{axpy, dispatch, mul_thin, mul_vec, rank_one, tr_mul, tr_mul_vec, vector};
use nalgebra::{SMatrix, SVector};

/// Newton direction of all variables and multipliers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Direction<const NX: usize> {
    pub w: Vec<f64>,
    pub duals: Duals<NX>,
}

/// Data that one Newton system is built from.
pub(crate) struct System<'a, const NX: usize, const NU: usize> {
    pub layout: &'a Layout,
    pub rows: &'a BoundaryRows,
    pub lin: &'a Linearisation<NX, NU>,
    pub w: &'a [f64],
    pub bounds: &'a Box,
    pub mu: f64,
}

impl<const NX: usize, const NU: usize> System<'_, NX, NU> {
    /// Adds bounds, path constraints and middle states to `lq`, which holds the raw derivatives.
    pub fn assemble(&self, lq: &mut Quadratic<NX>) {
        dispatch(Assemble { system: self, lq });
    }

    #[inline(always)]
    fn assemble_here(&self, lq: &mut Quadratic<NX>) {
        let layout = self.layout;
        for knot in 0..=layout.n_segments {
            for i in 0..NX {
                lq.q[knot][(i, i)] += self.bounds.sigma(self.w, layout.state(knot) + i);
            }
        }
        let m = layout.m;
        for k in 0..layout.n_segments {
            for i in 0..m {
                lq.r[(k * m + i) * m + i] += self.bounds.sigma(self.w, layout.controls + k * m + i);
            }
        }
        lq.hpp += self.bounds.sigma(self.w, layout.time);
        for (i, slack) in self.rows.slack.iter().enumerate() {
            if let Some(slack) = slack {
                lq.compliance[i] = 1.0 / self.bounds.sigma(self.w, layout.boundary_slacks + slack);
            }
        }
        self.add_path(lq);
        self.add_middles(lq);
        if self.lin.stages.is_used() {
            self.add_stages(lq);
        }
    }

    /// `J' Sigma J` of path constraints at the knots.
    fn add_path(&self, lq: &mut Quadratic<NX>) {
        let layout = self.layout;
        let (n, m) = (layout.n_path, layout.m);
        for (i, point) in layout.points.iter().enumerate() {
            let k = point.segment;
            for row in i * n..(i + 1) * n {
                let sigma = self.bounds.sigma(self.w, layout.path_slacks + row);
                let (gx, gu, gp) = (&self.lin.path_x[row], &self.lin.path_u[row], self.lin.path_p[row]);
                let first = k * m + point.local * NU;
                for a in 0..NU {
                    if gu[a] == 0.0 {
                        continue;
                    }
                    for b in 0..NU {
                        lq.r[(first + a) * m + point.local * NU + b] += sigma * gu[a] * gu[b];
                    }
                    lq.rp[first + a] += sigma * gu[a] * gp;
                    match point.place {
                        Place::Left => lq.s[first + a] += gx * (sigma * gu[a]),
                        Place::Right => lq.cross[first + a] += gx * (sigma * gu[a]),
                        Place::Middle => {}
                    }
                }
                lq.hpp += sigma * gp * gp;
                if point.place != Place::Middle {
                    let knot = k + usize::from(point.place == Place::Right);
                    rank_one(&mut lq.q[knot], sigma, gx);
                    lq.qp[knot] += gx * (sigma * gp);
                }
            }
        }
    }

    /// Second derivatives at the middle of segment `k` with bounds and path constraints.
    #[inline(always)]
    fn middle_hessian(&self, k: usize) -> (SMatrix<f64, NX, NX>, SMatrix<f64, NX, NU>, SVector<f64, NX>) {
        let layout = self.layout;
        let middle = &self.lin.middles[k];
        let (mut hxx, mut hxu, mut hxp) = (middle.hxx, middle.hxu, middle.hxp);
        for i in 0..NX {
            hxx[(i, i)] += self.bounds.sigma(self.w, layout.middle(k) + i);
        }
        let n = layout.n_path;
        // the middle is the second of the three points of a segment
        for row in (3 * k + 1) * n..(3 * k + 2) * n {
            let sigma = self.bounds.sigma(self.w, layout.path_slacks + row);
            let (gx, gu) = (&self.lin.path_x[row], &self.lin.path_u[row]);
            rank_one(&mut hxx, sigma, gx);
            for j in 0..NU {
                axpy(&mut hxu.data.0[j], sigma * gu[j], &gx.data.0[0]);
            }
            hxp += gx * (sigma * self.lin.path_p[row]);
        }
        (hxx, hxu, hxp)
    }

    /// Maps the second derivatives at the middle states to the segments' other variables.
    #[inline(always)]
    fn add_middles(&self, lq: &mut Quadratic<NX>) {
        let m = self.layout.m;
        for (k, middle) in self.lin.middles.iter().enumerate() {
            let (hxx, hxu, hxp) = self.middle_hessian(k);
            let su = &self.lin.middle_su[k * m..(k + 1) * m];
            let hx = mul_thin(&hxx, &middle.sx);
            lq.q[k] += tr_mul(&middle.sx, &hx);
            let hp = mul_vec(&hxx, &middle.sp) + hxp;
            lq.qp[k] += tr_mul_vec(&middle.sx, &hp);
            lq.hpp += middle.sp.dot(&(hp + hxp));
            for j in 0..m {
                let mut column = mul_vec(&hxx, &su[j]);
                lq.rp[k * m + j] += su[j].dot(&hp);
                if (NU..2 * NU).contains(&j) {
                    column += hxu.column(j - NU);
                    lq.rp[k * m + j] += hxu.column(j - NU).dot(&middle.sp);
                }
                lq.s[k * m + j] += tr_mul_vec(&middle.sx, &column);
                for i in 0..m {
                    let mut value = su[i].dot(&column);
                    if (NU..2 * NU).contains(&i) {
                        value += hxu.column(i - NU).dot(&su[j]);
                    }
                    lq.r[(k * m + i) * m + j] += value;
                }
            }
        }
    }

    /// Gradient of the barrier Lagrangian with respect to variable `i`.
    pub(super) fn gradient(&self, i: usize) -> f64 {
        self.lin.lagrangian[i] + self.bounds.gradient(self.w, i, self.mu)
    }

    /// Middle state's direction with all other variables held, and the end state's residual.
    fn offsets(&self, values: &Values<NX>, k: usize) -> (SVector<f64, NX>, SVector<f64, NX>) {
        if self.layout.has_middle {
            let middle = &self.lin.middles[k];
            let c = mul_vec(
                &self.lin.resolve[k],
                &(values.defect[k] + mul_vec(&middle.defect_by, &values.middle[k])),
            );
            (values.middle[k] + mul_vec(&middle.by_next, &c), c)
        } else if self.lin.resolve.is_empty() {
            (SVector::zeros(), values.defect[k])
        } else {
            (SVector::zeros(), mul_vec(&self.lin.resolve[k], &values.defect[k]))
        }
    }

    /// Right-hand side for the given constraint residuals.
    pub fn right_hand_side(&self, values: &Values<NX>, rhs: &mut Rhs<NX>) {
        let layout = self.layout;
        let m = layout.m;
        for knot in 0..=layout.n_segments {
            rhs.gx[knot] = SVector::from_fn(|i, _| self.gradient(layout.state(knot) + i));
        }
        for i in 0..layout.n_segments * m {
            rhs.gu[i] = self.gradient(layout.controls + i);
        }
        rhs.gp = self.gradient(layout.time);
        for i in 0..self.rows.len() {
            rhs.e[i] = values.boundary[i];
            if let Some(slack) = self.rows.slack.get(i).copied().flatten() {
                let index = layout.boundary_slacks + slack;
                rhs.e[i] += self.gradient(index) / self.bounds.sigma(self.w, index);
            }
        }
        let n = layout.n_path;
        for (i, point) in layout.points.iter().enumerate() {
            let (k, local) = (point.segment, point.local);
            for row in i * n..(i + 1) * n {
                let force = self.slack_force(values, row);
                for j in 0..NU {
                    rhs.gu[k * m + local * NU + j] += self.lin.path_u[row][j] * force;
                }
                rhs.gp += self.lin.path_p[row] * force;
                match point.place {
                    Place::Left => rhs.gx[k] += self.lin.path_x[row] * force,
                    Place::Right => rhs.gx[k + 1] += self.lin.path_x[row] * force,
                    Place::Middle => {}
                }
            }
        }
        for k in 0..layout.n_segments {
            if self.lin.stages.is_used() {
                self.add_stage_gradients(values, k, rhs);
                continue;
            }
            let (offset, c) = self.offsets(values, k);
            rhs.c[k] = c;
            if layout.has_middle {
                self.add_middle_gradient(values, k, &offset, rhs);
            }
        }
    }

    /// Change of a path multiplier when its point does not move.
    pub(super) fn slack_force(&self, values: &Values<NX>, row: usize) -> f64 {
        let index = self.layout.path_slacks + row;
        self.bounds.sigma(self.w, index) * values.path[row] + self.gradient(index)
    }

    /// Gradient with respect to the middle state, including path constraints there.
    fn middle_gradient(&self, values: &Values<NX>, k: usize) -> SVector<f64, NX> {
        let layout = self.layout;
        let mut g = SVector::from_fn(|i, _| self.gradient(layout.middle(k) + i));
        let n = layout.n_path;
        for row in (3 * k + 1) * n..(3 * k + 2) * n {
            g += self.lin.path_x[row] * self.slack_force(values, row);
        }
        g
    }

    fn add_middle_gradient(
        &self,
        values: &Values<NX>,
        k: usize,
        offset: &SVector<f64, NX>,
        rhs: &mut Rhs<NX>,
    ) {
        let m = self.layout.m;
        let middle = &self.lin.middles[k];
        let (hxx, hxu, hxp) = self.middle_hessian(k);
        let g = self.middle_gradient(values, k) + mul_vec(&hxx, offset);
        rhs.gx[k] += tr_mul_vec(&middle.sx, &g);
        rhs.gp += middle.sp.dot(&g) + hxp.dot(offset);
        for j in 0..m {
            rhs.gu[k * m + j] += self.lin.middle_su[k * m + j].dot(&g);
        }
        for j in 0..NU {
            rhs.gu[k * m + NU + j] += hxu.column(j).dot(offset);
        }
    }

    /// Expands a solution of the subproblem to all variables and multipliers.
    pub fn expand(&self, values: &Values<NX>, step: &Step<NX>, out: &mut Direction<NX>) {
        let layout = self.layout;
        for knot in 0..=layout.n_segments {
            out.w[layout.state(knot)..layout.state(knot + 1)].copy_from_slice(step.dx[knot].as_slice());
        }
        out.w[layout.controls..layout.middles].copy_from_slice(&step.du);
        out.w[layout.time] = step.dp;
        out.duals.boundary.copy_from_slice(&step.boundary);
        for (i, slack) in self.rows.slack.iter().enumerate() {
            if let Some(slack) = slack {
                let index = layout.boundary_slacks + slack;
                out.w[index] = (step.boundary[i] - self.gradient(index)) / self.bounds.sigma(self.w, index);
            }
        }
        for k in 0..layout.n_segments {
            self.expand_segment(values, step, k, out);
        }
        let n = layout.n_path;
        for (i, point) in layout.points.iter().enumerate() {
            for row in i * n..(i + 1) * n {
                let dx: SVector<f64, NX> = vector(&out.w, layout.point_state(point));
                let du: SVector<f64, NU> = vector(&out.w, layout.control(point.segment, point.local));
                let ds = self.lin.path_x[row].dot(&dx)
                    + self.lin.path_u[row].dot(&du)
                    + self.lin.path_p[row] * step.dp
                    + values.path[row];
                let index = layout.path_slacks + row;
                out.w[index] = ds;
                out.duals.path[row] = self.bounds.sigma(self.w, index) * ds + self.gradient(index);
            }
        }
    }

    /// Middle state and defect multipliers of one segment.
    fn expand_segment(&self, values: &Values<NX>, step: &Step<NX>, k: usize, out: &mut Direction<NX>) {
        let layout = self.layout;
        if self.lin.stages.is_used() {
            self.expand_stages(values, step, k, out);
            return;
        }
        let mut costate = step.costate[k];
        if !layout.has_middle {
            out.duals.defect[k] =
                self.lin.resolve.get(k).map_or(costate, |resolve| tr_mul_vec(resolve, &costate));
            return;
        }
        let m = layout.m;
        let middle = &self.lin.middles[k];
        let (offset, _) = self.offsets(values, k);
        let mut dm = offset + mul_vec(&middle.sx, &step.dx[k]) + middle.sp * step.dp;
        for j in 0..m {
            dm += self.lin.middle_su[k * m + j] * step.du[k * m + j];
        }
        out.w[layout.middle(k)..layout.middle(k) + NX].copy_from_slice(dm.as_slice());
        let (hxx, hxu, hxp) = self.middle_hessian(k);
        let du: SVector<f64, NU> = vector(&step.du, k * m + NU);
        let force = self.middle_gradient(values, k) + mul_vec(&hxx, &dm) + mul_vec(&hxu, &du) + hxp * step.dp;
        costate += tr_mul_vec(&middle.by_next, &force);
        let defect = tr_mul_vec(&self.lin.resolve[k], &costate);
        out.duals.middle[k] = force + tr_mul_vec(&middle.defect_by, &defect);
        out.duals.defect[k] = defect;
    }
}

struct Assemble<'a, 'b, const NX: usize, const NU: usize> {
    system: &'a System<'b, NX, NU>,
    lq: &'a mut Quadratic<NX>,
}

impl<const NX: usize, const NU: usize> Kernel for Assemble<'_, '_, NX, NU> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.system.assemble_here(self.lq);
    }
}
