//! The Newton system as one sparse symmetric matrix, factorised by `faer` without regard to its stages.
//!
//! The same subproblem as that of the Riccati recursion, written as
//!
//! ```text
//! [ H + delta W + e   A'       E'      ] (dx, du, dp)     [ g ]
//! [ A                 -e               ] (costates)   = - [ c ]
//! [ E                      -(compl + e)] (boundary)       [ e ]
//! ```
//!
//! in scaled variables and factorised as `L D L'` in an order of minimum degree that knows nothing of time. Without pivots of size two
//! such a factorisation needs quasi-definite matrices (R. J. Vanderbei, *Symmetric quasidefinite matrices*, SIAM J. Optim. 5, 1995), so
//! `e` is small and its error is taken out by iterative refinement. The inertia is read off `D` (Sylvester): as many positive
//! pivots as variables, as many negative ones as constraints, or the Hessian is not positive definite on the constraints'
//! null space. faer is given no signs: it would repair them silently.

use super::quadratic::{Quadratic, Rhs, Step};
use super::riccati::{NotConvex, Regularisation};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// Regularisation of both blocks, in scaled variables.
const EPSILON: f64 = 1e-9;
/// Most steps of refinement, and the relative residual at which it ends.
const REFINEMENTS: usize = 8;
const ACCURATE: f64 = 1e-13;

/// What depends on the shape alone.
struct Analysis {
    symbolic: SymbolicCholesky<usize>,
    memory: MemBuffer,
}

/// The matrix, its factors and the scratch of a solve.
#[derive(Default)]
pub(crate) struct Sparse {
    shape: [usize; 4],
    /// Upper triangle by columns; `slots` says where each entry of `visit` goes.
    column_starts: Vec<usize>,
    rows: Vec<usize>,
    slots: Vec<usize>,
    values: Vec<f64>,
    diagonal: Vec<usize>,
    scale: Vec<f64>,
    pinned: Vec<bool>,
    analysis: Option<Analysis>,
    factors: Vec<f64>,
    right: Vec<f64>,
    residual: Vec<f64>,
    solution: Vec<f64>,
}

impl std::fmt::Debug for Sparse {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Sparse {{ shape: {:?} }}", self.shape)
    }
}

impl Clone for Sparse {
    /// An empty one: everything is rebuilt by the next factorisation.
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// Offsets of the unknowns: knot states, controls, final time, costates, boundary multipliers.
#[derive(Clone, Copy)]
struct Order<const NX: usize> {
    n: usize,
    m: usize,
    nb: usize,
}

impl<const NX: usize> Order<NX> {
    fn of(lq: &Quadratic<NX>) -> Self {
        let n = lq.a.len();
        Self { n, m: lq.b.len() / n.max(1), nb: lq.e0.len() }
    }

    fn control(self, k: usize) -> usize {
        (self.n + 1) * NX + k * self.m
    }

    fn time(self) -> usize {
        self.control(self.n)
    }

    fn costate(self, k: usize) -> usize {
        self.time() + 1 + k * NX
    }

    fn boundary(self) -> usize {
        self.costate(self.n)
    }

    fn len(self) -> usize {
        self.boundary() + self.nb
    }

    /// Every entry of the upper triangle, always in the same sequence; none twice.
    fn visit(self, lq: &Quadratic<NX>, mut see: impl FnMut(usize, usize, f64)) {
        let (n, m, time) = (self.n, self.m, self.time());
        for k in 0..=n {
            for j in 0..NX {
                for i in 0..=j {
                    see(k * NX + i, k * NX + j, lq.q[k][(i, j)]);
                }
                see(k * NX + j, time, lq.qp[k][j]);
            }
        }
        see(time, time, lq.hpp);
        for k in 0..n {
            let (at, costate) = (self.control(k), self.costate(k));
            for j in 0..m {
                for i in 0..=j {
                    see(at + i, at + j, lq.r[(k * m + j) * m + i]);
                }
                see(at + j, time, lq.rp[k * m + j]);
                for i in 0..NX {
                    see(k * NX + i, at + j, lq.s[k * m + j][i]);
                    see((k + 1) * NX + i, at + j, lq.cross[k * m + j][i]);
                    see(at + j, costate + i, lq.b[k * m + j][i]);
                }
            }
            for i in 0..NX {
                for j in 0..NX {
                    see(k * NX + j, costate + i, lq.a[k][(i, j)]);
                }
                see((k + 1) * NX + i, costate + i, -1.0);
                see(time, costate + i, lq.ap[k][i]);
                see(costate + i, costate + i, 0.0);
            }
        }
        for b in 0..self.nb {
            let row = self.boundary() + b;
            for i in 0..NX {
                see(i, row, lq.e0[b][i]);
                see(n * NX + i, row, lq.ef[b][i]);
            }
            see(time, row, lq.et[b]);
            see(row, row, -lq.compliance[b]);
        }
    }
}

impl Sparse {
    /// Lays the pattern out and orders it, unless the shape is that of the last call.
    fn analyse<const NX: usize>(&mut self, lq: &Quadratic<NX>, order: Order<NX>) -> Result<(), NotConvex> {
        let shape = [NX, order.n, order.m, order.nb];
        if self.shape == shape && self.analysis.is_some() {
            return Ok(());
        }
        let size = order.len();
        let mut entries = vec![];
        order.visit(lq, |i, j, _| entries.push((j.max(i), j.min(i))));
        let mut sequence: Vec<usize> = (0..entries.len()).collect();
        sequence.sort_by_key(|&e| entries[e]);
        self.slots = vec![0; entries.len()];
        self.rows = sequence.iter().map(|&e| entries[e].1).collect();
        self.column_starts = vec![0; size + 1];
        self.diagonal = vec![0; size];
        for (slot, &e) in sequence.iter().enumerate() {
            let (column, row) = entries[e];
            self.slots[e] = slot;
            self.column_starts[column + 1] = slot + 1;
            if row == column {
                self.diagonal[row] = slot;
            }
        }
        self.values = vec![0.0; entries.len()];
        let pattern = SymbolicSparseColMatRef::new_checked(size, size, &self.column_starts, None, &self.rows);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
            ..Default::default()
        };
        let symbolic = factorize_symbolic_cholesky(pattern, Side::Upper, SymmetricOrdering::Amd, params)
            .map_err(|_| NotConvex)?;
        let need =
            symbolic
                .factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default())
                .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let memory = MemBuffer::try_new(need).map_err(|_| NotConvex)?;
        self.factors = vec![0.0; symbolic.len_val()];
        for v in [&mut self.right, &mut self.residual, &mut self.solution] {
            *v = vec![0.0; size];
        }
        self.analysis = Some(Analysis { symbolic, memory });
        self.shape = shape;
        Ok(())
    }

    /// Scales of the unknowns, and which of them are fixed.
    fn prepare<const NX: usize>(
        &mut self,
        lq: &Quadratic<NX>,
        order: Order<NX>,
        reg: &Regularisation<NX>,
        free_start: &[usize],
        free_time: bool,
    ) {
        let size = order.len();
        self.scale.clear();
        self.scale.resize(size, 1.0);
        self.pinned.clear();
        self.pinned.resize(size, false);
        for i in 0..NX {
            let scale = reg.state_weight[i].sqrt();
            for k in 0..=order.n {
                self.scale[k * NX + i] = 1.0 / scale;
            }
            for k in 0..order.n {
                self.scale[order.costate(k) + i] = scale;
            }
            self.pinned[i] = !free_start.contains(&i);
        }
        for j in 0..order.n * order.m {
            self.scale[order.control(0) + j] = 1.0 / reg.control_weight[j % order.m].sqrt();
        }
        self.scale[order.time()] = 1.0 / reg.time_weight.sqrt();
        self.pinned[order.time()] = !free_time;
        for b in 0..order.nb {
            let squares = (0..NX).map(|i| (lq.e0[b][i].powi(2) + lq.ef[b][i].powi(2)) / reg.state_weight[i]);
            let length = (squares.sum::<f64>() + lq.et[b].powi(2) / reg.time_weight).sqrt();
            self.scale[order.boundary() + b] = if length > 0.0 { 1.0 / length } else { 1.0 };
        }
    }

    /// Factorises.
    ///
    /// # Errors
    /// [`NotConvex`] if the inertia is not that of a minimum.
    pub fn factorise<const NX: usize>(
        &mut self,
        lq: &Quadratic<NX>,
        reg: &Regularisation<NX>,
        free_start: &[usize],
        free_time: bool,
    ) -> Result<(), NotConvex> {
        let order = Order::of(lq);
        self.analyse(lq, order)?;
        self.prepare(lq, order, reg, free_start, free_time);
        let mut entry = 0;
        let (scale, pinned, values, slots) = (&self.scale, &self.pinned, &mut self.values, &self.slots);
        order.visit(lq, |i, j, value| {
            let free = !(pinned[i] || pinned[j]);
            values[slots[entry]] = if free { value * scale[i] * scale[j] } else { 0.0 };
            entry += 1;
        });
        let n_primal = order.costate(0);
        // the scaled weights of the regularisation are one
        for i in 0..order.len() {
            let more = if i >= n_primal {
                0.0
            } else if pinned[i] {
                1.0
            } else {
                reg.delta
            };
            values[self.diagonal[i]] += more;
        }
        self.shift(n_primal, EPSILON);
        let result = self.decompose();
        self.shift(n_primal, -EPSILON);
        result?;
        (self.positive() == n_primal).then_some(()).ok_or(NotConvex)
    }

    /// Adds to the variables' diagonal and subtracts from the constraints'.
    fn shift(&mut self, n_primal: usize, by: f64) {
        for (i, &slot) in self.diagonal.iter().enumerate() {
            self.values[slot] += if i < n_primal { by } else { -by };
        }
    }

    fn decompose(&mut self) -> Result<(), NotConvex> {
        let size = self.diagonal.len();
        let Some(Analysis { symbolic, memory }) = &mut self.analysis else { return Err(NotConvex) };
        let pattern = SymbolicSparseColMatRef::new_checked(size, size, &self.column_starts, None, &self.rows);
        if self.values.iter().any(|v| !v.is_finite()) {
            return Err(NotConvex);
        }
        symbolic
            .factorize_numeric_ldlt(
                &mut self.factors,
                SparseColMatRef::new(pattern, &self.values),
                Side::Upper,
                LdltRegularization::default(),
                Par::Seq,
                MemStack::new(memory),
                Default::default(),
            )
            .map(|_| ())
            .map_err(|_| NotConvex)
    }

    /// Positive pivots; 0 if one is not a number.
    fn positive(&self) -> usize {
        let Some(Analysis { symbolic, .. }) = &self.analysis else { return 0 };
        let SymbolicCholeskyRaw::Simplicial(raw) = symbolic.raw() else { return 0 };
        let pivots = raw.col_ptr()[..raw.ncols()].iter().map(|&start| self.factors[start]);
        if pivots.clone().any(f64::is_nan) { 0 } else { pivots.filter(|d| *d > 0.0).count() }
    }

    /// Solves for one right-hand side, with refinement.
    pub fn solve<const NX: usize>(&mut self, lq: &Quadratic<NX>, rhs: &Rhs<NX>, step: &mut Step<NX>) {
        let order = Order::of(lq);
        self.gather(order, rhs);
        self.solution.fill(0.0);
        self.residual.copy_from_slice(&self.right);
        let size = self.right.iter().fold(0.0_f64, |s, v| s.max(v.abs()));
        let mut last = f64::INFINITY;
        for _ in 0..REFINEMENTS {
            let worst = self.residual.iter().fold(0.0_f64, |s, v| s.max(v.abs()));
            if worst <= ACCURATE * size || worst >= 0.5 * last {
                break;
            }
            last = worst;
            self.correct();
        }
        for (k, dx) in step.dx.iter_mut().enumerate() {
            for i in 0..NX {
                dx[i] = self.unscaled(k * NX + i);
            }
        }
        for (j, du) in step.du.iter_mut().enumerate() {
            *du = self.unscaled(order.control(0) + j);
        }
        step.dp = self.unscaled(order.time());
        for (k, costate) in step.costate.iter_mut().enumerate() {
            for i in 0..NX {
                costate[i] = self.unscaled(order.costate(k) + i);
            }
        }
        for (b, multiplier) in step.boundary.iter_mut().enumerate() {
            *multiplier = self.unscaled(order.boundary() + b);
        }
    }

    fn unscaled(&self, i: usize) -> f64 {
        self.solution[i] * self.scale[i]
    }

    /// The scaled right-hand side.
    fn gather<const NX: usize>(&mut self, order: Order<NX>, rhs: &Rhs<NX>) {
        let states = rhs.gx.iter().flat_map(|g| g.iter().copied());
        let defects = rhs.c.iter().flat_map(|c| c.iter().copied());
        let all =
            states.chain(rhs.gu.iter().copied()).chain([rhs.gp]).chain(defects).chain(rhs.e.iter().copied());
        for (i, value) in all.enumerate().take(order.len()) {
            self.right[i] = if self.pinned[i] { 0.0 } else { -value * self.scale[i] };
        }
    }

    /// Adds the factors' answer to the residual, and measures it anew.
    fn correct(&mut self) {
        let size = self.diagonal.len();
        let Some(Analysis { symbolic, memory }) = &mut self.analysis else { return };
        LdltRef::new(symbolic, &self.factors).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut self.residual, size, 1),
            Par::Seq,
            MemStack::new(memory),
        );
        for (x, d) in self.solution.iter_mut().zip(&self.residual) {
            *x += d;
        }
        self.residual.copy_from_slice(&self.right);
        for j in 0..size {
            for slot in self.column_starts[j]..self.column_starts[j + 1] {
                let (i, value) = (self.rows[slot], self.values[slot]);
                self.residual[i] -= value * self.solution[j];
                if i != j {
                    self.residual[j] -= value * self.solution[i];
                }
            }
        }
    }
}
