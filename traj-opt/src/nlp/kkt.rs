//! From bounds, slacks and linearisation to the linear-quadratic subproblem, and back to a full Newton direction.

use super::barrier::Box;
use super::boundary::BoundaryRows;
use super::layout::{Layout, Place};
use super::program::{Duals, Linearisation, Values};
use super::quadratic::{Quadratic, Rhs, Step};
use crate::dense::{Arithmetic, Kernel, LANES, array, fill_panels, pieces};
use crate::dense::{axpy, dispatch, rank_one, vector};
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
    fn assemble_here<A: Arithmetic>(&self, lq: &mut Quadratic<NX>) {
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
        self.add_middles::<A>(lq);
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
    fn add_middles<A: Arithmetic>(&self, lq: &mut Quadratic<NX>) {
        // the layout's number, but known at compile time
        let m = 3 * NU;
        for (k, middle) in self.lin.middles.iter().enumerate() {
            let (hxx, hxu, hxp) = self.middle_hessian(k);
            let su = &self.lin.middle_su[k * m..(k + 1) * m];
            // in memory, not in registers, number by number
            lq.transposed[0] = middle.sx.transpose();
            let st = &lq.transposed[0];
            let hx = A::mul(&hxx, &middle.sx);
            lq.q[k] += A::mul(st, &hx);
            let hp = A::mul_vec(&hxx, &middle.sp) + hxp;
            lq.qp[k] += A::mul_vec(st, &hp);
            lq.hpp += middle.sp.dot(&(hp + hxp));
            let panels = &mut lq.panels;
            let mc = pieces(m);
            let (panels, own_panels) = panels.split_at_mut(mc);
            fill_panels(su, panels);
            for i in 0..NU {
                let (piece, lane) = ((NU + i) / LANES, (NU + i) % LANES);
                for row in 0..NX {
                    own_panels[piece][row][lane] = hxu[(row, i)];
                }
            }
            // products with all columns of su at a time: single dot products would not be vectorised
            A::add_pieces(&mut lq.rp[k * m..(k + 1) * m], array(&hp), panels);
            let own_pieces = NU / LANES..pieces(2 * NU);
            for j in 0..m {
                let mut column = A::mul_vec(&hxx, &su[j]);
                if (NU..2 * NU).contains(&j) {
                    let own = hxu.column(j - NU).into_owned();
                    column += own;
                    lq.rp[k * m + j] += A::dot(array(&own), array(&middle.sp));
                }
                lq.s[k * m + j] += A::mul_vec(st, &column);
                let r = &mut lq.r[(k * m + j) * m..(k * m + j + 1) * m];
                A::add_pieces(r, array(&column), panels);
                let r = &mut r[own_pieces.start * LANES..(own_pieces.end * LANES).min(m)];
                A::add_pieces(r, array(&su[j]), &own_panels[own_pieces.clone()]);
            }
        }
    }

    /// Gradient of the barrier Lagrangian with respect to variable `i`.
    #[inline(always)]
    pub(super) fn gradient(&self, i: usize) -> f64 {
        self.lin.lagrangian[i] + self.bounds.gradient(self.w, i, self.mu)
    }

    /// Middle state's direction with all other variables held, and the end state's residual.
    #[inline(always)]
    fn offsets<A: Arithmetic>(&self, values: &Values<NX>, k: usize) -> (SVector<f64, NX>, SVector<f64, NX>) {
        if self.layout.has_middle {
            let middle = &self.lin.middles[k];
            let c = A::mul_vec(
                &self.lin.resolve[k],
                &(values.defect[k] + A::mul_vec(&middle.defect_by, &values.middle[k])),
            );
            (values.middle[k] + A::mul_vec(&middle.by_next, &c), c)
        } else if self.lin.resolve.is_empty() {
            (SVector::zeros(), values.defect[k])
        } else {
            (SVector::zeros(), A::mul_vec(&self.lin.resolve[k], &values.defect[k]))
        }
    }

    /// Right-hand side for the given constraint residuals.
    pub fn right_hand_side(&self, values: &Values<NX>, rhs: &mut Rhs<NX>) {
        dispatch(Gather { system: self, values, rhs });
    }

    #[inline(always)]
    fn right_hand_side_here<A: Arithmetic>(&self, values: &Values<NX>, rhs: &mut Rhs<NX>) {
        let layout = self.layout;
        let m = layout.m;
        for knot in 0..=layout.n_segments {
            for i in 0..NX {
                rhs.gx[knot][i] = self.gradient(layout.state(knot) + i);
            }
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
            let (offset, c) = self.offsets::<A>(values, k);
            rhs.c[k] = c;
            if layout.has_middle {
                self.add_middle_gradient::<A>(values, k, &offset, rhs);
            }
        }
    }

    /// Change of a path multiplier when its point does not move.
    #[inline(always)]
    pub(super) fn slack_force(&self, values: &Values<NX>, row: usize) -> f64 {
        let index = self.layout.path_slacks + row;
        self.bounds.sigma(self.w, index) * values.path[row] + self.gradient(index)
    }

    /// Gradient with respect to the middle state, including path constraints there.
    #[inline(always)]
    fn middle_gradient(&self, values: &Values<NX>, k: usize) -> SVector<f64, NX> {
        let layout = self.layout;
        let mut g = SVector::zeros();
        for i in 0..NX {
            g[i] = self.gradient(layout.middle(k) + i);
        }
        let n = layout.n_path;
        for row in (3 * k + 1) * n..(3 * k + 2) * n {
            g += self.lin.path_x[row] * self.slack_force(values, row);
        }
        g
    }

    #[inline(always)]
    fn add_middle_gradient<A: Arithmetic>(
        &self,
        values: &Values<NX>,
        k: usize,
        offset: &SVector<f64, NX>,
        rhs: &mut Rhs<NX>,
    ) {
        let m = self.layout.m;
        let middle = &self.lin.middles[k];
        let (hxx, hxu, hxp) = self.middle_hessian(k);
        let g = self.middle_gradient(values, k) + A::mul_vec(&hxx, offset);
        rhs.gx[k] += A::tr_mul_vec(&middle.sx, &g);
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
        dispatch(Expand { system: self, values, step, out });
    }

    #[inline(always)]
    fn expand_here<A: Arithmetic>(&self, values: &Values<NX>, step: &Step<NX>, out: &mut Direction<NX>) {
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
            self.expand_segment::<A>(values, step, k, out);
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
    #[inline(always)]
    fn expand_segment<A: Arithmetic>(
        &self,
        values: &Values<NX>,
        step: &Step<NX>,
        k: usize,
        out: &mut Direction<NX>,
    ) {
        let layout = self.layout;
        if self.lin.stages.is_used() {
            self.expand_stages(values, step, k, out);
            return;
        }
        let mut costate = step.costate[k];
        if !layout.has_middle {
            out.duals.defect[k] =
                self.lin.resolve.get(k).map_or(costate, |resolve| A::tr_mul_vec(resolve, &costate));
            return;
        }
        let m = layout.m;
        let middle = &self.lin.middles[k];
        let (offset, _) = self.offsets::<A>(values, k);
        let mut dm = offset + A::mul_vec(&middle.sx, &step.dx[k]) + middle.sp * step.dp;
        for j in 0..m {
            dm += self.lin.middle_su[k * m + j] * step.du[k * m + j];
        }
        out.w[layout.middle(k)..layout.middle(k) + NX].copy_from_slice(dm.as_slice());
        let (hxx, hxu, hxp) = self.middle_hessian(k);
        let du: SVector<f64, NU> = vector(&step.du, k * m + NU);
        let force =
            self.middle_gradient(values, k) + A::mul_vec(&hxx, &dm) + A::mul_vec(&hxu, &du) + hxp * step.dp;
        costate += A::tr_mul_vec(&middle.by_next, &force);
        let defect = A::tr_mul_vec(&self.lin.resolve[k], &costate);
        out.duals.middle[k] = force + A::tr_mul_vec(&middle.defect_by, &defect);
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
    fn run<A: Arithmetic>(self) {
        self.system.assemble_here::<A>(self.lq);
    }
}

struct Gather<'a, 'b, const NX: usize, const NU: usize> {
    system: &'a System<'b, NX, NU>,
    values: &'a Values<NX>,
    rhs: &'a mut Rhs<NX>,
}

impl<const NX: usize, const NU: usize> Kernel for Gather<'_, '_, NX, NU> {
    type Output = ();

    #[inline(always)]
    fn run<A: Arithmetic>(self) {
        self.system.right_hand_side_here::<A>(self.values, self.rhs);
    }
}

struct Expand<'a, 'b, const NX: usize, const NU: usize> {
    system: &'a System<'b, NX, NU>,
    values: &'a Values<NX>,
    step: &'a Step<NX>,
    out: &'a mut Direction<NX>,
}

impl<const NX: usize, const NU: usize> Kernel for Expand<'_, '_, NX, NU> {
    type Output = ();

    #[inline(always)]
    fn run<A: Arithmetic>(self) {
        self.system.expand_here::<A>(self.values, self.step, self.out);
    }
}
