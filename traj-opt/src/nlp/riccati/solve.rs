//! The recursion with vectors: backwards with the right-hand side, forwards with the step.

use super::triangular::{backward_scaled, forward_scaled};
use super::{LONG, Riccati, penalty};
use crate::dense::{Arithmetic, Kernel, LANES, array, array_mut, dispatch, panels, pieces, rows, rows_mut};
use crate::nlp::quadratic::{Quadratic, Rhs, Step};
use nalgebra::SVector;

struct Solve<'a, const NX: usize> {
    riccati: &'a mut Riccati<NX>,
    lq: &'a Quadratic<NX>,
    state_weight: &'a SVector<f64, NX>,
    rhs: &'a Rhs<NX>,
    step: &'a mut Step<NX>,
}

impl<const NX: usize> Kernel for Solve<'_, NX> {
    type Output = ();

    #[inline(always)]
    fn run<A: Arithmetic>(self) {
        if const { NX < LONG || !A::FUSED } {
            return self.run_with::<A, 0, 4, 4>();
        }
        match (self.riccati.m, self.riccati.border_width) {
            (4, 4) => self.run_with::<A, 4, 4, 4>(),
            (4, 12) => self.run_with::<A, 4, 4, 12>(),
            (4, 16) => self.run_with::<A, 4, 4, 16>(),
            (12, 4) => self.run_with::<A, 12, 12, 4>(),
            (12, 12) => self.run_with::<A, 12, 12, 12>(),
            (12, 16) => self.run_with::<A, 12, 12, 16>(),
            _ => self.run_with::<A, 0, 4, 4>(),
        }
    }
}

impl<const NX: usize> Solve<'_, NX> {
    #[inline(always)]
    fn run_with<A: Arithmetic, const M: usize, const C: usize, const W: usize>(self) {
        self.riccati.backward::<A, M, C, W>(self.lq, self.state_weight, self.rhs);
        self.riccati.solve_border(self.step);
        self.riccati.solve_start(self.step);
        self.riccati.forward::<A, M, C, W>(self.lq, self.rhs, self.step);
    }
}

impl<const NX: usize> Riccati<NX> {
    /// Solves for one right-hand side.
    pub fn solve(
        &mut self,
        lq: &Quadratic<NX>,
        state_weight: &SVector<f64, NX>,
        rhs: &Rhs<NX>,
        step: &mut Step<NX>,
    ) {
        #[cfg(feature = "faer")]
        if let Some(sparse) = &mut self.sparse {
            sparse.solve(lq, rhs, step);
            return;
        }
        dispatch(Solve { riccati: self, lq, state_weight, rhs, step });
    }

    #[inline(always)]
    fn backward<A: Arithmetic, const M: usize, const C: usize, const W: usize>(
        &mut self,
        lq: &Quadratic<NX>,
        state_weight: &SVector<f64, NX>,
        rhs: &Rhs<NX>,
    ) {
        let (n, m, nb) = (self.n, self.controls::<M>(), self.n_border);
        let (mc, nc) = (pieces(m), self.border_pieces);
        let mut linear = rhs.gx[n];
        self.border_rhs.fill(0.0);
        self.border_rhs[0] = rhs.gp;
        for j in 1..nb {
            let rho = penalty(self.rho, lq, state_weight, j - 1);
            linear += lq.ef[j - 1] * (rho * rhs.e[j - 1]);
            self.border_rhs[0] += rho * lq.et[j - 1] * rhs.e[j - 1];
            self.border_rhs[j] = rhs.e[j - 1];
        }
        self.linear[n] = linear;
        for k in (0..n).rev() {
            let c = array(&rhs.c[k]);
            let v = A::mul_vec(&self.value[k + 1], &rhs.c[k]) + self.linear[k + 1];
            let columns = &panels::<W, NX>(&self.columns)[(k + 1) * nc..(k + 2) * nc];
            for (sum, panel) in rows_mut::<W>(&mut self.border_rhs).iter_mut().zip(columns) {
                *sum = A::combine(*sum, c, panel);
            }
            self.border_rhs[0] += A::dot(array(&v), array(&lq.ap[k]));
            let row = &mut self.linear_gain[k * m..(k + 1) * m];
            let panels = &self.control_rows[k * mc..(k + 1) * mc];
            row.copy_from_slice(&rhs.gu[k * m..(k + 1) * m]);
            A::add_pieces(row, array(&v), panels);
            for i in self.first_cross[k]..m {
                row[i] += A::dot(array(&lq.cross[k * m + i]), c);
            }
            let factor = &rows::<C>(&self.factor)[k * m * (pieces(m) * LANES / C)..];
            forward_scaled::<A, C>(factor, &self.inverse_pivot[k * m..(k + 1) * m], row);
            let mut own = *array(&rhs.gx[k]);
            for l in 0..NX {
                A::axpy(&mut own, v[l], &self.transposed[k].data.0[l]);
            }
            for (value, gain) in row.iter().zip(&self.gain[k * m..(k + 1) * m]) {
                A::axpy(&mut own, -value, array(gain));
            }
            *array_mut(&mut self.linear[k]) = own;
            let gains = rows::<W>(&self.border_gain)[k * m * nc..(k + 1) * m * nc].chunks_exact(m.max(1));
            for (sum, gains) in rows_mut::<W>(&mut self.border_rhs).iter_mut().zip(gains) {
                for (value, gain) in row.iter().zip(gains) {
                    A::axpy(sum, -value, gain);
                }
            }
        }
    }

    #[inline(always)]
    fn forward<A: Arithmetic, const M: usize, const C: usize, const W: usize>(
        &mut self,
        lq: &Quadratic<NX>,
        rhs: &Rhs<NX>,
        step: &mut Step<NX>,
    ) {
        let (n, m, nc) = (self.n, self.controls::<M>(), self.border_pieces);
        self.weights.fill(0.0);
        self.weights[0] = if self.free_time { step.dp } else { 0.0 };
        self.weights[1..self.n_border].copy_from_slice(&step.boundary);
        let weights = rows::<W>(&self.weights);
        for k in 0..n {
            let dx = step.dx[k];
            let du = &mut step.du[k * m..(k + 1) * m];
            for i in 0..m {
                let mut border = 0.0;
                for (piece, weights) in weights.iter().enumerate() {
                    border += A::dot(&rows::<W>(&self.border_gain)[(k * nc + piece) * m + i], weights);
                }
                let own = A::dot(array(&self.gain[k * m + i]), array(&dx));
                du[i] = -(self.linear_gain[k * m + i] + own + border);
            }
            let factor = &rows::<C>(&self.factor)[k * m * (pieces(m) * LANES / C)..];
            backward_scaled::<A, C>(factor, &self.inverse_pivot[k * m..(k + 1) * m], du);
            let mut next = A::mul_vec(&lq.a[k], &dx) + rhs.c[k] + lq.ap[k] * step.dp;
            for (du, b) in du.iter().zip(&lq.b[k * m..(k + 1) * m]) {
                A::axpy(array_mut(&mut next), *du, array(b));
            }
            let mut costate = self.linear[k + 1];
            for i in self.first_cross[k]..m {
                A::axpy(array_mut(&mut costate), du[i], array(&lq.cross[k * m + i]));
            }
            let columns = &panels::<W, NX>(&self.columns)[(k + 1) * nc..(k + 2) * nc];
            for (panel, weights) in columns.iter().zip(weights) {
                for x in 0..NX {
                    costate[x] += A::dot(&panel[x], weights);
                }
            }
            step.costate[k] = costate + A::mul_vec(&self.value[k + 1], &next);
            step.dx[k + 1] = next;
        }
    }
}
