//! The recursion backwards over the segments, with matrices.

use super::triangular::factorise_pieces;
use super::{NotConvex, Regularisation, Riccati, penalty};
use crate::dense::{Arithmetic, Kernel, LANES, array, array_mut, dispatch, pieces, rank_one};
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
        match self.riccati.m {
            4 => self.riccati.factorise_here::<A, 4>(self.lq, self.reg),
            12 => self.riccati.factorise_here::<A, 12>(self.lq, self.reg),
            _ => self.riccati.factorise_here::<A, 0>(self.lq, self.reg),
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
    fn factorise_here<A: Arithmetic, const M: usize>(
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
            self.control_hessian::<A, M>(k, lq, reg)?;
            self.control_gain::<A, M>(k, lq, &product);
            self.knot::<A, M>(k, lq, reg, &product);
            self.border_columns::<A, M>(k, lq);
        }
        self.start_state(lq)?;
        self.factorise_border()
    }

    /// Value function at the last knot: cost, penalty of the end conditions, border columns.
    #[inline(always)]
    fn terminal(&mut self, lq: &Quadratic<NX>, reg: &Regularisation<NX>) {
        let (n, nb, nc) = (self.n, self.n_border, self.border_pieces);
        let mut p = lq.q[n];
        for i in 0..NX {
            p[(i, i)] += reg.delta * reg.state_weight[i];
        }
        self.border.fill([0.0; LANES]);
        self.border[0][0] = lq.hpp + reg.delta * reg.time_weight;
        let mut time_column = lq.qp[n];
        for j in 1..nb {
            let row = lq.ef[j - 1];
            let et = lq.et[j - 1];
            let rho = penalty(reg.rho, lq, reg.state_weight, j - 1);
            rank_one(&mut p, rho, &row);
            time_column += row * (rho * et);
            self.border[0][0] += rho * et * et;
            let (piece, lane) = (j / LANES, j % LANES);
            self.border[piece * nb][lane] = et;
            self.border[piece * nb + j][lane] = -lq.compliance[j - 1] - reg.delta_c;
            for i in 0..NX {
                self.columns[n * nc + piece][i][lane] = row[i];
            }
        }
        for i in 0..NX {
            self.columns[n * nc][i][0] = if self.free_time { time_column[i] } else { 0.0 };
        }
        self.value[n] = p;
    }

    #[inline(always)]
    fn transpose(&mut self, k: usize, lq: &Quadratic<NX>) {
        let (m, mc) = (self.m, self.control_pieces);
        self.transposed[k] = lq.a[k].transpose();
        for (columns, panel) in
            lq.b[k * m..(k + 1) * m].chunks(LANES).zip(&mut self.control_rows[k * mc..(k + 1) * mc])
        {
            for (lane, column) in columns.iter().enumerate() {
                for i in 0..NX {
                    panel[i][lane] = column[i];
                }
            }
        }
        let crossed = |v: &SVector<f64, NX>| v.iter().any(|&v| v != 0.0);
        self.first_cross[k] = lq.cross[k * m..(k + 1) * m].iter().position(crossed).unwrap_or(m);
    }

    /// `R~ = r + b' P b + b' cross + cross' b`, factorised.
    #[inline(always)]
    fn control_hessian<A: Arithmetic, const M: usize>(
        &mut self,
        k: usize,
        lq: &Quadratic<NX>,
        reg: &Regularisation<NX>,
    ) -> Result<(), NotConvex> {
        let m = self.controls::<M>();
        let mc = pieces(m);
        let panels = &self.control_rows[k * mc..(k + 1) * mc];
        for j in 0..m {
            let work = A::mul_vec(&self.value[k + 1], &lq.b[k * m + j]);
            let r = &lq.r[(k * m + j) * m..(k * m + j + 1) * m];
            for piece in j / LANES..mc {
                let mut start = [0.0; LANES];
                for (start, r) in start.iter_mut().zip(&r[piece * LANES..]) {
                    *start = *r;
                }
                self.hessian[piece * m + j] = A::combine(start, array(&work), &panels[piece]);
            }
        }
        for j in self.first_cross[k]..m {
            let cross = array(&lq.cross[k * m + j]);
            for (piece, panel) in panels.iter().enumerate() {
                let products = A::combine([0.0; LANES], cross, panel);
                for (i, product) in (piece * LANES..m).zip(products) {
                    let (low, high) = (i.min(j), i.max(j));
                    let twice = if i == j { 2.0 } else { 1.0 };
                    self.hessian[high / LANES * m + low][high % LANES] += twice * product;
                }
            }
        }
        for i in 0..m {
            self.hessian[i / LANES * m + i][i % LANES] += reg.delta * reg.control_weight[i];
        }
        let factor = &mut self.factor[k * m * m..(k + 1) * m * m];
        factorise_pieces::<A>(&mut self.hessian, m, factor, &mut self.inverse_pivot[k * m..(k + 1) * m])
    }

    /// `L^-1 (s + A' (P b + cross))'`.
    #[inline(always)]
    fn control_gain<A: Arithmetic, const M: usize>(
        &mut self,
        k: usize,
        lq: &Quadratic<NX>,
        product: &SMatrix<f64, NX, NX>,
    ) {
        let m = self.controls::<M>();
        let factor = &self.factor[k * m * m..(k + 1) * m * m];
        for i in 0..m {
            let (done, rest) = self.gain[k * m..(k + 1) * m].split_at_mut(i);
            let mut row = *array(&lq.s[k * m + i]);
            let b = &lq.b[k * m + i];
            for l in 0..NX {
                A::axpy(&mut row, b[l], &product.data.0[l]);
            }
            if i >= self.first_cross[k] {
                let cross = &lq.cross[k * m + i];
                for l in 0..NX {
                    A::axpy(&mut row, cross[l], &self.transposed[k].data.0[l]);
                }
            }
            for (l, done) in factor[i * m..].iter().zip(done) {
                A::axpy(&mut row, -l, array(done));
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
            for l in 0..NX {
                A::axpy(&mut column, lq.a[k].data.0[c][l], &product.data.0[l]);
            }
            for gain in gains {
                A::axpy(&mut column, -gain[c], array(gain));
            }
            value.data.0[c] = column;
        }
        let mut value = (value + value.transpose()) * 0.5;
        for i in 0..NX {
            value[(i, i)] += reg.delta * reg.state_weight[i];
        }
        self.value[k] = value;
    }

    /// Border columns at knot `k` and what the segment adds to the border's Schur complement.
    #[inline(always)]
    fn border_columns<A: Arithmetic, const M: usize>(&mut self, k: usize, lq: &Quadratic<NX>) {
        let (m, nb, nc) = (self.controls::<M>(), self.n_border, self.border_pieces);
        let gains = &mut self.border_gain[k * m * nc..(k + 1) * m * nc];
        let factor = &self.factor[k * m * m..(k + 1) * m * m];
        let ap = array(&lq.ap[k]);
        for piece in 0..nc {
            let mut next = self.columns[(k + 1) * nc + piece];
            let timed = piece == 0 && self.free_time;
            if self.free_time {
                self.border[piece * nb] = A::combine(self.border[piece * nb], ap, &next);
            }
            if timed {
                let moved = A::mul_vec(&self.value[k + 1], &lq.ap[k]);
                for i in 0..NX {
                    next[i][0] += moved[i];
                    self.border[0][0] = A::madd(ap[i], next[i][0], self.border[0][0]);
                }
            }
            let rows = &mut gains[piece * m..(piece + 1) * m];
            for i in 0..m {
                let (done, rest) = rows.split_at_mut(i);
                let mut start = [0.0; LANES];
                if timed {
                    start[0] = lq.rp[k * m + i];
                    if i >= self.first_cross[k] {
                        start[0] += A::dot(array(&lq.cross[k * m + i]), ap);
                    }
                }
                let start = A::combine(start, array(&lq.b[k * m + i]), &next);
                let row = A::subtract(start, factor[i * m..].iter().copied(), done);
                rest[0] = row.map(|v| v * self.inverse_pivot[k * m + i]);
            }
            let own = &mut self.columns[k * nc + piece];
            for x in 0..NX {
                let start = [if timed { lq.qp[k][x] } else { 0.0 }, 0.0, 0.0, 0.0];
                let start = A::combine(start, &lq.a[k].data.0[x], &next);
                own[x] = A::subtract(start, self.gain[k * m..(k + 1) * m].iter().map(|gain| gain[x]), rows);
            }
        }
        for r in 0..nb {
            let (from, lane) = (r / LANES, r % LANES);
            for piece in from..nc {
                let weights = gains[from * m..(from + 1) * m].iter().map(|gain| gain[lane]);
                let rows = &gains[piece * m..(piece + 1) * m];
                let place = &mut self.border[piece * nb + r];
                *place = A::subtract(*place, weights, rows);
            }
        }
    }
}
