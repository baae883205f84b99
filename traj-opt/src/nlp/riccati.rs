//! Riccati recursion with a regularised border.
//!
//! The recursion eliminates the segments backwards in O(n (nx + m)^3). Final time and boundary multipliers form a border: each
//! is one more column of the value function's linear term, and a small Schur complement couples them at the end. End conditions
//! enter twice: exactly, through their multipliers, and as a penalty `rho |E dx + e|^2 / 2` that is zero at the solution and
//! makes the recursion positive definite where only the end conditions make the problem convex (G. Debreu, *Definite and
//! semidefinite quadratic forms*, Econometrica 20, 1952).

use super::quadratic::{Quadratic, Rhs, Step};
use crate::dense::{Kernel, array, array_mut, axpy, dispatch, dot, mul, mul_vec, rank_one};
use nalgebra::{SMatrix, SVector};

/// The reduced Hessian is not positive definite at the given segment (`n` for the border).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NotConvex;

/// Regularisation of a factorisation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Regularisation<'a, const NX: usize> {
    /// Added to the Hessian's diagonal, divided by the squared scale of the variable.
    pub delta: f64,
    /// Added to the border's diagonal for dependent end conditions.
    pub delta_c: f64,
    /// Penalty on the end conditions.
    pub rho: f64,
    pub state_weight: &'a SVector<f64, NX>,
    /// Weights of the controls, repeated over the `m` controls of a segment.
    pub control_weight: &'a [f64],
    pub time_weight: f64,
}

/// Factors of the subproblem. Columns of the border: 0 the final time, then the boundary constraints.
#[derive(Clone, Debug, Default)]
pub(crate) struct Riccati<const NX: usize> {
    n: usize,
    m: usize,
    n_border: usize,
    rho: f64,
    /// Value function's Hessian at every knot.
    value: Vec<SMatrix<f64, NX, NX>>,
    /// Value function's border columns at every knot, `n_border` a knot.
    columns: Vec<SVector<f64, NX>>,
    /// Cholesky factor of the reduced control Hessian (lower, row-major) of every segment.
    factor: Vec<f64>,
    /// Rows of `L^-1 S'`, `m` a segment.
    gain: Vec<SVector<f64, NX>>,
    /// `L^-1` times border columns, `m` rows of `n_border`.
    border_gain: Vec<f64>,
    /// The border's Schur complement and its factor.
    border: Vec<f64>,
    border_factor: Vec<f64>,
    start_factor: Vec<f64>,
    start_gain: Vec<f64>,
    free_start: Vec<usize>,
    free_time: bool,
    time_pivot: f64,
    /// Linear term of the value function.
    linear: Vec<SVector<f64, NX>>,
    /// `L^-1` times the linear term of the controls.
    linear_gain: Vec<f64>,
    start_linear: Vec<f64>,
    border_rhs: Vec<f64>,
    solution: Vec<f64>,
    work: Vec<SVector<f64, NX>>,
    /// Transposes of the dynamics, so that products with them run along columns.
    transposed: Vec<SMatrix<f64, NX, NX>>,
}

impl<const NX: usize> Riccati<NX> {
    /// Prepares for problems of a given shape; `free_start` lists the components of the start state that are free.
    pub fn resize(&mut self, n: usize, m: usize, n_boundary: usize, free_start: &[usize], free_time: bool) {
        let nb = n_boundary + 1;
        (self.n, self.m, self.n_border, self.free_time) = (n, m, nb, free_time);
        self.value.resize(n + 1, SMatrix::zeros());
        self.columns.resize((n + 1) * nb, SVector::zeros());
        self.factor.resize(n * m * m, 0.0);
        self.gain.resize(n * m, SVector::zeros());
        self.border_gain.resize(n * m * nb, 0.0);
        self.border.resize(nb * nb, 0.0);
        self.border_factor.resize(nb * nb, 0.0);
        self.free_start.clear();
        self.free_start.extend_from_slice(free_start);
        let ns = free_start.len();
        self.start_factor.resize(ns * ns, 0.0);
        self.start_gain.resize(ns * nb, 0.0);
        self.start_linear.resize(ns, 0.0);
        self.linear.resize(n + 1, SVector::zeros());
        self.linear_gain.resize(n * m, 0.0);
        self.border_rhs.resize(nb, 0.0);
        self.solution.resize(nb, 0.0);
        self.work.resize(m, SVector::zeros());
        self.transposed.resize(n, SMatrix::zeros());
    }

    /// Factorises.
    ///
    /// # Errors
    /// [`NotConvex`] if the Hessian is not positive definite on the null space of the constraints.
    pub fn factorise(&mut self, lq: &Quadratic<NX>, reg: &Regularisation<NX>) -> Result<(), NotConvex> {
        dispatch(Factorise { riccati: self, lq, reg })
    }

    #[inline(always)]
    fn factorise_here(&mut self, lq: &Quadratic<NX>, reg: &Regularisation<NX>) -> Result<(), NotConvex> {
        self.rho = reg.rho;
        self.terminal(lq, reg);
        for k in (0..self.n).rev() {
            self.transposed[k] = lq.a[k].transpose();
            self.control_hessian(k, lq, reg);
            self.cholesky_and_gain(k)?;
            self.eliminate(k, lq, reg);
        }
        self.start_state(lq)?;
        self.factorise_border(reg)
    }

    /// Value function at the last knot: cost, penalty of the end conditions, border columns.
    #[inline(always)]
    fn terminal(&mut self, lq: &Quadratic<NX>, reg: &Regularisation<NX>) {
        let (n, nb) = (self.n, self.n_border);
        let mut p = lq.q[n];
        for i in 0..NX {
            p[(i, i)] += reg.delta * reg.state_weight[i];
        }
        self.border.fill(0.0);
        self.border[0] = lq.hpp + reg.delta * reg.time_weight;
        let mut time_column = lq.qp[n];
        for j in 1..nb {
            let row = lq.ef[j - 1];
            let et = lq.et[j - 1];
            let rho = penalty(reg.rho, lq, reg.state_weight, j - 1);
            rank_one(&mut p, rho, &row);
            time_column += row * (rho * et);
            self.border[0] += rho * et * et;
            self.border[j] = et;
            self.border[j * nb + j] = -lq.compliance[j - 1] - reg.delta_c;
            self.columns[n * nb + j] = row;
        }
        self.columns[n * nb] = time_column;
        self.value[n] = p;
    }

    /// `R~ = r + b' P b + b' cross + cross' b` into `factor`, `S~ = s + A' (P b + cross)` into `gain`.
    #[inline(always)]
    fn control_hessian(&mut self, k: usize, lq: &Quadratic<NX>, reg: &Regularisation<NX>) {
        let m = self.m;
        let p = &self.value[k + 1];
        let b = &lq.b[k * m..(k + 1) * m];
        let cross = &lq.cross[k * m..(k + 1) * m];
        for j in 0..m {
            self.work[j] = mul_vec(p, &b[j]) + cross[j];
            self.gain[k * m + j] = lq.s[k * m + j] + mul_vec(&self.transposed[k], &self.work[j]);
        }
        for i in 0..m {
            for j in 0..=i {
                let product = dot(array(&b[i]), array(&self.work[j])) + dot(array(&cross[i]), array(&b[j]));
                self.factor[(k * m + i) * m + j] = lq.r[(k * m + i) * m + j] + product;
            }
            self.factor[(k * m + i) * m + i] += reg.delta * reg.control_weight[i];
        }
    }

    /// Factorises `R~ = L L'` in place and turns `S~'` into `L^-1 S~'`.
    #[inline(always)]
    fn cholesky_and_gain(&mut self, k: usize) -> Result<(), NotConvex> {
        let m = self.m;
        cholesky(&mut self.factor[k * m * m..(k + 1) * m * m], m)?;
        let l = &self.factor[k * m * m..(k + 1) * m * m];
        for i in 0..m {
            let (done, rest) = self.gain[k * m..(k + 1) * m].split_at_mut(i);
            let row = array_mut(&mut rest[0]);
            for j in 0..i {
                axpy(row, -l[i * m + j], array(&done[j]));
            }
            let inverse = 1.0 / l[i * m + i];
            row.iter_mut().for_each(|v| *v *= inverse);
        }
        Ok(())
    }

    /// Value function at knot `k`.
    #[inline(always)]
    fn eliminate(&mut self, k: usize, lq: &Quadratic<NX>, reg: &Regularisation<NX>) {
        let (m, nb) = (self.m, self.n_border);
        let p = &self.value[k + 1];
        let pa = mul(p, &lq.a[k]);
        let mut value = lq.q[k] + mul(&self.transposed[k], &pa);
        for i in 0..NX {
            value[(i, i)] += reg.delta * reg.state_weight[i];
        }
        for j in 0..m {
            rank_one(&mut value, -1.0, &self.gain[k * m + j]);
        }
        for column in usize::from(!self.free_time)..nb {
            self.eliminate_column(k, column, lq);
        }
        self.value[k] = symmetric(&value);
        for row in usize::from(!self.free_time)..nb {
            for column in row..nb {
                let mut sum = 0.0;
                for j in 0..m {
                    let gain = &self.border_gain[(k * m + j) * nb..(k * m + j + 1) * nb];
                    sum += gain[row] * gain[column];
                }
                self.border[row * nb + column] -= sum;
            }
        }
    }

    #[inline(always)]
    fn eliminate_column(&mut self, k: usize, column: usize, lq: &Quadratic<NX>) {
        let (m, nb) = (self.m, self.n_border);
        let next = self.columns[(k + 1) * nb + column];
        let ap = &lq.ap[k];
        let mut v = next;
        if column == 0 {
            let pap = mul_vec(&self.value[k + 1], ap);
            v += pap;
            self.border[0] += ap.dot(&pap) + 2.0 * ap.dot(&next);
        } else if self.free_time {
            self.border[column] += ap.dot(&next);
        }
        let l = &self.factor[k * m * m..(k + 1) * m * m];
        let mut own = mul_vec(&self.transposed[k], &v);
        if column == 0 {
            own += lq.qp[k];
        }
        for i in 0..m {
            let mut value = dot(array(&lq.b[k * m + i]), array(&v));
            if column == 0 {
                value += lq.rp[k * m + i] + lq.cross[k * m + i].dot(ap);
            }
            for j in 0..i {
                value -= l[i * m + j] * self.border_gain[(k * m + j) * nb + column];
            }
            value /= l[i * m + i];
            self.border_gain[(k * m + i) * nb + column] = value;
            axpy(array_mut(&mut own), -value, array(&self.gain[k * m + i]));
        }
        self.columns[k * nb + column] = own;
    }

    /// Eliminates the free components of the start state.
    #[inline(always)]
    fn start_state(&mut self, lq: &Quadratic<NX>) -> Result<(), NotConvex> {
        let (ns, nb) = (self.free_start.len(), self.n_border);
        for j in 1..nb {
            self.columns[j] += lq.e0[j - 1];
        }
        for (i, &row) in self.free_start.iter().enumerate() {
            for (j, &column) in self.free_start.iter().enumerate() {
                self.start_factor[i * ns + j] = self.value[0][(row, column)];
            }
            for column in 0..nb {
                self.start_gain[i * nb + column] = self.columns[column][row];
            }
        }
        cholesky(&mut self.start_factor, ns)?;
        for column in usize::from(!self.free_time)..nb {
            for i in 0..ns {
                for j in 0..i {
                    let known = self.start_gain[j * nb + column];
                    self.start_gain[i * nb + column] -= self.start_factor[i * ns + j] * known;
                }
                self.start_gain[i * nb + column] /= self.start_factor[i * ns + i];
            }
        }
        for row in usize::from(!self.free_time)..nb {
            for column in row..nb {
                let sum: f64 =
                    (0..ns).map(|i| self.start_gain[i * nb + row] * self.start_gain[i * nb + column]).sum();
                self.border[row * nb + column] -= sum;
            }
        }
        Ok(())
    }

    /// Cholesky of the (negated) boundary block, then the pivot of the final time.
    fn factorise_border(&mut self, reg: &Regularisation<NX>) -> Result<(), NotConvex> {
        let nb = self.n_border;
        let mc = nb - 1;
        for i in 0..mc {
            for j in 0..=i {
                self.border_factor[i * mc + j] = -self.border[(j + 1) * nb + i + 1];
            }
        }
        cholesky_repaired(&mut self.border_factor[..mc * mc], mc, reg.delta_c);
        if !self.free_time {
            return Ok(());
        }
        // pivot of dp: M_pp + M_pb S^-1 M_bp
        self.solution[..mc].copy_from_slice(&self.border[1..nb]);
        forward(&self.border_factor, mc, &mut self.solution[..mc]);
        self.time_pivot = self.border[0] + self.solution[..mc].iter().map(|v| v * v).sum::<f64>();
        if self.time_pivot > 0.0 { Ok(()) } else { Err(NotConvex) }
    }

    /// Solves for one right-hand side.
    pub fn solve(
        &mut self,
        lq: &Quadratic<NX>,
        state_weight: &SVector<f64, NX>,
        rhs: &Rhs<NX>,
        step: &mut Step<NX>,
    ) {
        dispatch(Solve { riccati: self, lq, state_weight, rhs, step });
    }

    #[inline(always)]
    fn backward(&mut self, lq: &Quadratic<NX>, state_weight: &SVector<f64, NX>, rhs: &Rhs<NX>) {
        let (n, m, nb) = (self.n, self.m, self.n_border);
        let mut linear = rhs.gx[n];
        self.border_rhs[0] = rhs.gp;
        for j in 1..nb {
            let rho = penalty(self.rho, lq, state_weight, j - 1);
            linear += lq.ef[j - 1] * (rho * rhs.e[j - 1]);
            self.border_rhs[0] += rho * lq.et[j - 1] * rhs.e[j - 1];
            self.border_rhs[j] = rhs.e[j - 1];
        }
        self.linear[n] = linear;
        for k in (0..n).rev() {
            let c = &rhs.c[k];
            let next = self.linear[k + 1];
            let v = mul_vec(&self.value[k + 1], c) + next;
            let columns = &self.columns[(k + 1) * nb..(k + 2) * nb];
            self.border_rhs[0] += v.dot(&lq.ap[k]) + c.dot(&columns[0]);
            for j in 1..nb {
                self.border_rhs[j] += c.dot(&columns[j]);
            }
            let l = &self.factor[k * m * m..(k + 1) * m * m];
            let mut own = rhs.gx[k] + mul_vec(&self.transposed[k], &v);
            for i in 0..m {
                let mut value = rhs.gu[k * m + i] + lq.b[k * m + i].dot(&v) + lq.cross[k * m + i].dot(c);
                for j in 0..i {
                    value -= l[i * m + j] * self.linear_gain[k * m + j];
                }
                value /= l[i * m + i];
                self.linear_gain[k * m + i] = value;
                axpy(array_mut(&mut own), -value, array(&self.gain[k * m + i]));
                let gain = &self.border_gain[(k * m + i) * nb..(k * m + i + 1) * nb];
                for j in 0..nb {
                    self.border_rhs[j] -= gain[j] * value;
                }
            }
            self.linear[k] = own;
        }
    }

    fn solve_border(&mut self, step: &mut Step<NX>) {
        let (ns, nb) = (self.free_start.len(), self.n_border);
        let mc = nb - 1;
        for (i, &row) in self.free_start.iter().enumerate() {
            self.start_linear[i] = self.linear[0][row];
        }
        forward(&self.start_factor, ns, &mut self.start_linear);
        for j in 0..nb {
            let sum: f64 = (0..ns).map(|i| self.start_gain[i * nb + j] * self.start_linear[i]).sum();
            self.border_rhs[j] -= sum;
        }
        // (dp, nu) from [[M_pp, M_pb], [M_bp, -S]] (dp, nu) = -rhs
        step.dp = 0.0;
        let z = &mut self.solution;
        if self.free_time {
            z[..mc].copy_from_slice(&self.border_rhs[1..nb]);
            forward(&self.border_factor, mc, &mut z[..mc]);
            backward_substitute(&self.border_factor, mc, &mut z[..mc]);
            let coupled: f64 = (0..mc).map(|i| self.border[1 + i] * z[i]).sum();
            step.dp = -(self.border_rhs[0] + coupled) / self.time_pivot;
        }
        for i in 0..mc {
            z[i] = self.border_rhs[1 + i] + if self.free_time { self.border[1 + i] * step.dp } else { 0.0 };
        }
        forward(&self.border_factor, mc, &mut z[..mc]);
        backward_substitute(&self.border_factor, mc, &mut z[..mc]);
        step.boundary.copy_from_slice(&z[..mc]);
    }

    #[inline(always)]
    fn forward(&mut self, lq: &Quadratic<NX>, rhs: &Rhs<NX>, step: &mut Step<NX>) {
        let (n, m, nb, ns) = (self.n, self.m, self.n_border, self.free_start.len());
        let first = usize::from(!self.free_time);
        let weight = |j: usize| if j == 0 { step.dp } else { step.boundary[j - 1] };
        for i in 0..ns {
            for j in first..nb {
                self.start_linear[i] += self.start_gain[i * nb + j] * weight(j);
            }
            self.start_linear[i] = -self.start_linear[i];
        }
        backward_substitute(&self.start_factor, ns, &mut self.start_linear);
        step.dx[0] = SVector::zeros();
        for (i, &row) in self.free_start.iter().enumerate() {
            step.dx[0][row] = self.start_linear[i];
        }
        for k in 0..n {
            let dx = step.dx[k];
            let l = &self.factor[k * m * m..(k + 1) * m * m];
            for i in 0..m {
                let gain = &self.border_gain[(k * m + i) * nb..(k * m + i + 1) * nb];
                let mut value = self.linear_gain[k * m + i] + dot(array(&self.gain[k * m + i]), array(&dx));
                for j in first..nb {
                    value += gain[j] * weight(j);
                }
                step.du[k * m + i] = -value;
            }
            backward_substitute(l, m, &mut step.du[k * m..(k + 1) * m]);
            let mut next = mul_vec(&lq.a[k], &dx) + rhs.c[k] + lq.ap[k] * step.dp;
            let mut costate = self.linear[k + 1];
            for i in 0..m {
                axpy(array_mut(&mut next), step.du[k * m + i], array(&lq.b[k * m + i]));
                axpy(array_mut(&mut costate), step.du[k * m + i], array(&lq.cross[k * m + i]));
            }
            for j in first..nb {
                axpy(array_mut(&mut costate), weight(j), array(&self.columns[(k + 1) * nb + j]));
            }
            step.costate[k] = costate + mul_vec(&self.value[k + 1], &next);
            step.dx[k + 1] = next;
        }
    }
}

struct Factorise<'a, 'b, const NX: usize> {
    riccati: &'a mut Riccati<NX>,
    lq: &'a Quadratic<NX>,
    reg: &'a Regularisation<'b, NX>,
}

impl<const NX: usize> Kernel for Factorise<'_, '_, NX> {
    type Output = Result<(), NotConvex>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        self.riccati.factorise_here(self.lq, self.reg)
    }
}

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
    fn run(self) {
        self.riccati.backward(self.lq, self.state_weight, self.rhs);
        self.riccati.solve_border(self.step);
        self.riccati.forward(self.lq, self.rhs, self.step);
    }
}

/// Penalty of boundary row `j`: `rho` over the squared scaled length of the row. Zero for inequalities and for rows that
/// involve the start state, to which the recursion cannot add it.
fn penalty<const NX: usize>(rho: f64, lq: &Quadratic<NX>, weight: &SVector<f64, NX>, j: usize) -> f64 {
    if lq.compliance[j] > 0.0 || lq.e0[j].iter().any(|&v| v != 0.0) {
        return 0.0;
    }
    let length: f64 = (0..NX).map(|i| lq.ef[j][i] * lq.ef[j][i] / weight[i]).sum();
    if length > 0.0 { rho / length } else { 0.0 }
}

/// In-place Cholesky factorisation of a row-major matrix's lower triangle.
#[inline(always)]
fn cholesky(a: &mut [f64], n: usize) -> Result<(), NotConvex> {
    for j in 0..n {
        let original = a[j * n + j];
        let mut pivot = original;
        for k in 0..j {
            pivot -= a[j * n + k] * a[j * n + k];
        }
        // a pivot that is rounding of the original entry says nothing about the sign
        if pivot.is_nan() || pivot <= 1e-15 * original.abs() {
            return Err(NotConvex);
        }
        let root = pivot.sqrt();
        a[j * n + j] = root;
        for i in j + 1..n {
            let mut sum = a[i * n + j];
            for k in 0..j {
                sum -= a[i * n + k] * a[j * n + k];
            }
            a[i * n + j] = sum / root;
        }
    }
    Ok(())
}

/// Cholesky factorisation that replaces vanishing pivots (dependent end conditions) so that their multiplier does not move.
fn cholesky_repaired(a: &mut [f64], n: usize, _delta: f64) {
    for j in 0..n {
        let original = a[j * n + j];
        let mut pivot = original;
        for k in 0..j {
            pivot -= a[j * n + k] * a[j * n + k];
        }
        if pivot.is_nan() || pivot <= 1e-13 * original.abs() || pivot <= 0.0 {
            pivot = 1e100;
        }
        let root = pivot.sqrt();
        a[j * n + j] = root;
        for i in j + 1..n {
            let mut sum = a[i * n + j];
            for k in 0..j {
                sum -= a[i * n + k] * a[j * n + k];
            }
            a[i * n + j] = sum / root;
        }
    }
}

/// Solves `L y = x` in place.
fn forward(l: &[f64], n: usize, x: &mut [f64]) {
    for i in 0..n {
        let mut sum = x[i];
        for j in 0..i {
            sum -= l[i * n + j] * x[j];
        }
        x[i] = sum / l[i * n + i];
    }
}

/// Solves `L' y = x` in place.
fn backward_substitute(l: &[f64], n: usize, x: &mut [f64]) {
    for i in (0..n).rev() {
        let mut sum = x[i];
        for j in i + 1..n {
            sum -= l[j * n + i] * x[j];
        }
        x[i] = sum / l[i * n + i];
    }
}

fn symmetric<const N: usize>(m: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    (m + m.transpose()) * 0.5
}
