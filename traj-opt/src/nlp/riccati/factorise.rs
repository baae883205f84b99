//! The recursion backwards over the segments, with matrices.

use super::triangular::factorise_pieces;
use super::{LONG, NotConvex, Regularisation, Riccati, penalty};
use crate::dense::{
    Arithmetic, Kernel, LANES, array, array_mut, dispatch, fill_panels, is_unit, panels_mut, piece_of,
    pieces, rank_one, rows, rows_mut,
};
use crate::nlp::quadratic::Quadratic;
use nalgebra::{SMatrix, SVector};

struct Factorise<'a, 'b, const NX: usize> {
    riccati: &'a mut Riccati<NX>,
    lq: &'a Quadratic<NX>,
    reg: &'a Regularisation<'b, NX>,
}

impl<const NX: usize> Kernel for Factorise<'_, '_, NX> {
    type Output = Result<(), NotConvex>;

    #[inline(always)]
    fn run<A: Arithmetic>(self) -> Self::Output {
        if const { NX < LONG || !A::FUSED } {
            return self.riccati.factorise_here::<A, 0, 4, 4>(self.lq, self.reg);
        }
        match (self.riccati.m, self.riccati.border_width) {
            (4, 4) => self.riccati.factorise_here::<A, 4, 4, 4>(self.lq, self.reg),
            (4, 12) => self.riccati.factorise_here::<A, 4, 4, 12>(self.lq, self.reg),
            (4, 16) => self.riccati.factorise_here::<A, 4, 4, 16>(self.lq, self.reg),
            (12, 4) => self.riccati.factorise_here::<A, 12, 12, 4>(self.lq, self.reg),
            (12, 12) => self.riccati.factorise_here::<A, 12, 12, 12>(self.lq, self.reg),
            (12, 16) => self.riccati.factorise_here::<A, 12, 12, 16>(self.lq, self.reg),
            _ => self.riccati.factorise_here::<A, 0, 4, 4>(self.lq, self.reg),
        }
    }
}

impl<const NX: usize> Riccati<NX> {
    /// Factorises.
    ///
    /// # Errors
    /// [`NotConvex`] if the Hessian is not positive definite on the null space of the constraints.
    pub fn factorise(&mut self, lq: &Quadratic<NX>, reg: &Regularisation<NX>) -> Result<(), NotConvex> {
        #[cfg(feature = "faer")]
        if let Some(sparse) = &mut self.sparse {
            return sparse.factorise(lq, reg, &self.free_start, self.free_time);
        }
        dispatch(Factorise { riccati: self, lq, reg })
    }

    /// Controls of a segment: `M`, or the number that is known at run time only if `M` is 0.
    #[inline(always)]
    pub(super) fn controls<const M: usize>(&self) -> usize {
        if M > 0 { M } else { self.m }
    }

    #[inline(always)]
    fn factorise_here<A: Arithmetic, const M: usize, const C: usize, const W: usize>(
        &mut self,
        lq: &Quadratic<NX>,
        reg: &Regularisation<NX>,
    ) -> Result<(), NotConvex> {
        self.rho = reg.rho;
        self.terminal(lq, reg);
        for k in (0..self.n).rev() {
            self.transpose(k, lq);
            // row j of A' P is column j of P A
            let product = A::mul(&self.transposed[k], &self.value[k + 1]);
            self.control_hessian::<A, M, C>(k, lq, reg)?;
            self.control_gain::<A, M, C>(k, lq);
            self.knot::<A, M>(k, lq, reg, &product);
            self.border_columns::<A, M, C, W>(k, lq);
            self.border_complement::<A, M, W>(k);
        }
        self.start_state(lq)?;
        self.factorise_border()
    }

    /// Value function at the last knot: cost, penalty of the end conditions, border columns.
    #[inline(always)]
    fn terminal(&mut self, lq: &Quadratic<NX>, reg: &Regularisation<NX>) {
        let (n, nb, nc, width) = (self.n, self.n_border, self.border_pieces, self.border_width);
        let mut p = lq.q[n];
        for i in 0..NX {
            p[(i, i)] += reg.delta * reg.state_weight[i];
        }
        self.border.fill(0.0);
        let mut pivot = lq.hpp + reg.delta * reg.time_weight;
        let mut time_column = lq.qp[n];
        for j in 1..nb {
            let row = lq.ef[j - 1];
            let et = lq.et[j - 1];
            let rho = penalty(reg.rho, lq, reg.state_weight, j - 1);
            rank_one(&mut p, rho, &row);
            time_column += row * (rho * et);
            pivot += rho * et * et;
            let (piece, lane) = (j / width, j % width);
            self.border[piece * nb * width + lane] = et;
            self.border[(piece * nb + j) * width + lane] = -lq.compliance[j - 1] - reg.delta_c;
            for i in 0..NX {
                self.columns[((n * nc + piece) * NX + i) * width + lane] = row[i];
            }
        }
        self.border[0] = pivot;
        for i in 0..NX {
            self.columns[(n * nc * NX + i) * width] = if self.free_time { time_column[i] } else { 0.0 };
        }
        self.value[n] = p;
    }

    #[inline(always)]
    fn transpose(&mut self, k: usize, lq: &Quadratic<NX>) {
        let (m, mc) = (self.m, self.control_pieces);
        self.transposed[k] = lq.a[k].transpose();
        fill_panels(&lq.b[k * m..(k + 1) * m], &mut self.control_rows[k * mc..(k + 1) * mc]);
        let crossed = |v: &SVector<f64, NX>| v.iter().any(|&v| v != 0.0);
        self.first_cross[k] = lq.cross[k * m..(k + 1) * m].iter().position(crossed).unwrap_or(m);
    }

    /// `R~ = r + b' P b + b' cross + cross' b`, factorised into `U' U`.
    #[inline(always)]
    fn control_hessian<A: Arithmetic, const M: usize, const C: usize>(
        &mut self,
        k: usize,
        lq: &Quadratic<NX>,
        reg: &Regularisation<NX>,
    ) -> Result<(), NotConvex> {
        let m = self.controls::<M>();
        let mc = pieces(m);
        let factor = &mut self.factor[k * m * mc * LANES..(k + 1) * m * mc * LANES];
        let hessian = rows_mut::<LANES>(factor);
        // where a piece of a row is among rows of all pieces or of the one piece that is compiled for
        let place = |j: usize, piece: usize| if C > LANES { j * mc + piece } else { piece * m + j };
        let panels = &self.control_rows[k * mc..(k + 1) * mc];
        let cross = &lq.cross[k * m..(k + 1) * m];
        let first = self.first_cross[k];
        if first < m {
            fill_panels(cross, &mut self.cross_rows);
        }
        for j in 0..m {
            // P b + cross, whose products with b are all but cross with the row's own b
            let mut work = A::mul_vec(&self.value[k + 1], &lq.b[k * m + j]);
            if j >= first {
                work += cross[j];
            }
            let r = &lq.r[(k * m + j) * m..(k * m + j + 1) * m];
            for piece in j / LANES..mc {
                let mut row = A::combine(piece_of(r, piece), array(&work), &panels[piece]);
                if first < (piece + 1) * LANES {
                    row = A::combine(row, array(&lq.b[k * m + j]), &self.cross_rows[piece]);
                }
                hessian[place(j, piece)] = row;
            }
            self.work[j] = work;
        }
        for i in 0..m {
            hessian[place(i, i / LANES)][i % LANES] += reg.delta * reg.control_weight[i];
        }
        factorise_pieces::<A, C>(rows_mut(factor), &mut self.inverse_pivot[k * m..(k + 1) * m])
    }

    /// `U'^-1 (s + A' (P b + cross))'`.
    #[inline(always)]
    fn control_gain<A: Arithmetic, const M: usize, const C: usize>(&mut self, k: usize, lq: &Quadratic<NX>) {
        let m = self.controls::<M>();
        let factor = &rows::<C>(&self.factor)[k * m * (pieces(m) * LANES / C)..];
        let gains = &mut self.gain[k * m..(k + 1) * m];
        for i in 0..m {
            let (done, rest) = gains.split_at_mut(i);
            let mut row = *array(&lq.s[k * m + i]);
            for l in 0..NX {
                A::axpy(&mut row, self.work[i][l], &self.transposed[k].data.0[l]);
            }
            for (upper, done) in factor[i / C * m..].iter().zip(done) {
                A::axpy(&mut row, -upper[i % C], array(done));
            }
            let inverse = self.inverse_pivot[k * m + i];
            row.iter_mut().for_each(|v| *v *= inverse);
            *array_mut(&mut rest[0]) = row;
        }
    }

    /// Value function's Hessian at knot `k`.
    #[inline(always)]
    fn knot<A: Arithmetic, const M: usize>(
        &mut self,
        k: usize,
        lq: &Quadratic<NX>,
        reg: &Regularisation<NX>,
        product: &SMatrix<f64, NX, NX>,
    ) {
        let m = self.controls::<M>();
        let gains = &self.gain[k * m..(k + 1) * m];
        let mut value = SMatrix::<f64, NX, NX>::zeros();
        for c in 0..NX {
            let mut column = lq.q[k].data.0[c];
            let by = &lq.a[k].data.0[c];
            if is_unit(by, c) {
                for i in 0..NX {
                    column[i] += product.data.0[c][i];
                }
            } else {
                for l in 0..NX {
                    A::axpy(&mut column, by[l], &product.data.0[l]);
                }
            }
            for gain in gains {
                A::axpy(&mut column, -gain[c], array(gain));
            }
            value.data.0[c] = column;
        }
        // symmetric to the bit: rounding must not make the triangles differ more and more
        let mut value = (value + value.transpose()) * 0.5;
        for i in 0..NX {
            value[(i, i)] += reg.delta * reg.state_weight[i];
        }
        self.value[k] = value;
    }

    /// Border columns at knot `k`, and what the final time alone adds to the border's Schur complement.
    #[inline(always)]
    fn border_columns<A: Arithmetic, const M: usize, const C: usize, const W: usize>(
        &mut self,
        k: usize,
        lq: &Quadratic<NX>,
    ) {
        let (m, nb, nc) = (self.controls::<M>(), self.n_border, self.border_pieces);
        let (own, next) = panels_mut::<W, NX>(&mut self.columns).split_at_mut((k + 1) * nc);
        let gains = &mut rows_mut::<W>(&mut self.border_gain)[k * m * nc..(k + 1) * m * nc];
        let border = rows_mut::<W>(&mut self.border);
        let first = rows_mut::<W>(&mut self.border_start);
        let timed = &mut panels_mut::<W, NX>(&mut self.timed_columns)[0];
        let factor = &rows::<C>(&self.factor)[k * m * (pieces(m) * LANES / C)..];
        let pivots = &self.inverse_pivot[k * m..(k + 1) * m];
        let state_gains = &self.gain[k * m..(k + 1) * m];
        let ap = array(&lq.ap[k]);
        for piece in 0..nc {
            let mut next = &next[piece];
            first.fill([0.0; W]);
            if self.free_time {
                border[piece * nb] = A::combine(border[piece * nb], ap, next);
            }
            if self.free_time && piece == 0 {
                // the final time moves the next state: its column gains what that costs
                let moved = A::mul_vec(&self.value[k + 1], &lq.ap[k]);
                for i in 0..NX {
                    timed[i] = next[i];
                    timed[i][0] += moved[i];
                    border[0][0] = A::madd(ap[i], timed[i][0], border[0][0]);
                    first[m + i][0] = lq.qp[k][i];
                }
                for i in 0..m {
                    let cross = &lq.cross[k * m + i];
                    let crossed = if i >= self.first_cross[k] { A::dot(array(cross), ap) } else { 0.0 };
                    first[i][0] = lq.rp[k * m + i] + crossed;
                }
                next = timed;
            }
            let rows = &mut gains[piece * m..(piece + 1) * m];
            for i in 0..m {
                let (done, rest) = rows.split_at_mut(i);
                let mut row = A::combine(first[i], array(&lq.b[k * m + i]), next);
                for (upper, done) in factor[i / C * m..].iter().zip(done) {
                    A::axpy(&mut row, -upper[i % C], done);
                }
                row.iter_mut().for_each(|v| *v *= pivots[i]);
                rest[0] = row;
            }
            for x in 0..NX {
                let mut row = A::combine(first[m + x], &lq.a[k].data.0[x], next);
                for (gain, done) in state_gains.iter().zip(&*rows) {
                    A::axpy(&mut row, -gain[x], done);
                }
                own[k * nc + piece][x] = row;
            }
        }
    }

    /// What the segment adds to the border's Schur complement.
    #[inline(always)]
    fn border_complement<A: Arithmetic, const M: usize, const W: usize>(&mut self, k: usize) {
        let (m, nb, nc) = (self.controls::<M>(), self.n_border, self.border_pieces);
        let gains = &rows::<W>(&self.border_gain)[k * m * nc..(k + 1) * m * nc];
        let border = rows_mut::<W>(&mut self.border);
        for r in 0..nb {
            let (from, lane) = (r / W, r % W);
            for piece in from..nc {
                let mut row = border[piece * nb + r];
                for i in 0..m {
                    A::axpy(&mut row, -gains[from * m + i][lane], &gains[piece * m + i]);
                }
                border[piece * nb + r] = row;
            }
        }
    }
}
