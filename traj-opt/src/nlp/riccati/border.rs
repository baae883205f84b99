//! Start state, final time and boundary multipliers: the small systems that couple both ends.

use super::triangular::{backward, cholesky, cholesky_repaired, forward};
use super::{NotConvex, Riccati};
use crate::nlp::quadratic::{Quadratic, Step};

impl<const NX: usize> Riccati<NX> {
    /// First column of the border that is in use.
    pub(super) fn first_column(&self) -> usize {
        usize::from(!self.free_time)
    }

    /// Eliminates the free components of the start state.
    pub(super) fn start_state(&mut self, lq: &Quadratic<NX>) -> Result<(), NotConvex> {
        let (ns, nb, width) = (self.free_start.len(), self.n_border, self.border_width);
        for j in 1..nb {
            for i in 0..NX {
                self.columns[(j / width * NX + i) * width + j % width] += lq.e0[j - 1][i];
            }
        }
        for (i, &row) in self.free_start.iter().enumerate() {
            for (j, &column) in self.free_start.iter().enumerate() {
                self.start_factor[i * ns + j] = self.value[0][(row, column)];
            }
            for column in 0..nb {
                self.start_gain[i * nb + column] =
                    self.columns[(column / width * NX + row) * width + column % width];
            }
        }
        cholesky(&mut self.start_factor, ns)?;
        for column in self.first_column()..nb {
            for i in 0..ns {
                for j in 0..i {
                    let known = self.start_gain[j * nb + column];
                    self.start_gain[i * nb + column] -= self.start_factor[i * ns + j] * known;
                }
                self.start_gain[i * nb + column] /= self.start_factor[i * ns + i];
            }
        }
        for row in self.first_column()..nb {
            for column in row..nb {
                let gain = &self.start_gain;
                let sum: f64 = (0..ns).map(|i| gain[i * nb + row] * gain[i * nb + column]).sum();
                self.border[(column / width * nb + row) * width + column % width] -= sum;
            }
        }
        Ok(())
    }

    /// Cholesky of the (negated) boundary block, then the pivot of the final time.
    pub(super) fn factorise_border(&mut self) -> Result<(), NotConvex> {
        let shape = (self.n_border, self.border_width);
        let mc = self.n_border - 1;
        for i in 0..mc {
            for j in 0..=i {
                self.border_factor[i * mc + j] = -border_entry(&self.border, shape, j + 1, i + 1);
            }
        }
        cholesky_repaired(&mut self.border_factor[..mc * mc], mc);
        if !self.free_time {
            return Ok(());
        }
        // pivot of dp: M_pp + M_pb S^-1 M_bp
        for j in 0..mc {
            self.solution[j] = border_entry(&self.border, shape, 0, j + 1);
        }
        forward(&self.border_factor, mc, &mut self.solution[..mc]);
        self.time_pivot = self.border[0] + self.solution[..mc].iter().map(|v| v * v).sum::<f64>();
        if self.time_pivot > 0.0 { Ok(()) } else { Err(NotConvex) }
    }

    /// Final time and multipliers from `[[M_pp, M_pb], [M_bp, -S]] (dp, nu) = -rhs`.
    pub(super) fn solve_border(&mut self, step: &mut Step<NX>) {
        let (ns, nb) = (self.free_start.len(), self.n_border);
        let (mc, shape) = (nb - 1, (nb, self.border_width));
        for (i, &row) in self.free_start.iter().enumerate() {
            self.start_linear[i] = self.linear[0][row];
        }
        forward(&self.start_factor, ns, &mut self.start_linear);
        for j in 0..nb {
            let sum: f64 = (0..ns).map(|i| self.start_gain[i * nb + j] * self.start_linear[i]).sum();
            self.border_rhs[j] -= sum;
        }
        step.dp = 0.0;
        let z = &mut self.solution[..mc];
        if self.free_time {
            for (j, z) in z.iter_mut().enumerate() {
                *z = self.border_rhs[j + 1];
            }
            forward(&self.border_factor, mc, z);
            backward(&self.border_factor, mc, z);
            let coupled: f64 =
                z.iter().enumerate().map(|(j, z)| border_entry(&self.border, shape, 0, j + 1) * z).sum();
            step.dp = -(self.border_rhs[0] + coupled) / self.time_pivot;
        }
        for (j, z) in z.iter_mut().enumerate() {
            let coupled =
                if self.free_time { border_entry(&self.border, shape, 0, j + 1) * step.dp } else { 0.0 };
            *z = self.border_rhs[j + 1] + coupled;
        }
        forward(&self.border_factor, mc, z);
        backward(&self.border_factor, mc, z);
        step.boundary.copy_from_slice(z);
    }

    /// The start state's step.
    pub(super) fn solve_start(&mut self, step: &mut Step<NX>) {
        let (ns, nb) = (self.free_start.len(), self.n_border);
        for i in 0..ns {
            for j in self.first_column()..nb {
                let weight = if j == 0 { step.dp } else { step.boundary[j - 1] };
                self.start_linear[i] += self.start_gain[i * nb + j] * weight;
            }
            self.start_linear[i] = -self.start_linear[i];
        }
        backward(&self.start_factor, ns, &mut self.start_linear);
        step.dx[0].fill(0.0);
        for (i, &row) in self.free_start.iter().enumerate() {
            step.dx[0][row] = self.start_linear[i];
        }
    }
}

/// Entry of the border's Schur complement, `n` rows of pieces of a width; `column >= row`.
fn border_entry(border: &[f64], (n, width): (usize, usize), row: usize, column: usize) -> f64 {
    border[(column / width * n + row) * width + column % width]
}
