//! Riccati recursion with a regularised border.
//!
//! The recursion eliminates the segments backwards in O(n (nx + m)^3). Final time and boundary multipliers form a border: each
//! is one more column of the value function's linear term, and a small Schur complement couples them at the end. End conditions
//! enter twice: exactly, through their multipliers, and as a penalty `rho |E dx + e|^2 / 2` that is zero at the solution and
//! makes the recursion positive definite where only the end conditions make the problem convex (G. Debreu, *Definite and
//! semidefinite quadratic forms*, Econometrica 20, 1952).
//!
//! `factorise` goes backwards with the matrices, `solve` backwards and forwards with vectors, `border` couples the two ends,
//! `triangular` has the small factorisations. Rows over controls or over the border, whose lengths are known at run time only,
//! are padded with zeros and cut into pieces of four; pieces of many rows that belong to the same four columns are stored one
//! after another (panels), so that the inner loops run over registers and contiguous numbers.

mod border;
mod factorise;
mod solve;
mod triangular;

use super::quadratic::Quadratic;
use crate::dense::{LANES, Panel, is_fused, pieces};
use nalgebra::{SMatrix, SVector};

/// The reduced Hessian is not positive definite.
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
    /// Pieces of a row over the controls of a segment, and of a row over the border, and how long the latter are.
    control_pieces: usize,
    border_pieces: usize,
    border_width: usize,
    rho: f64,
    /// Value function's Hessian at every knot.
    value: Vec<SMatrix<f64, NX, NX>>,
    /// Value function's border columns: `NX` rows for every knot and piece of the border.
    columns: Vec<f64>,
    /// Upper factor `U` of one reduced control Hessian after another (for every piece `m` rows; below the diagonal anything), and
    /// inverse pivots.
    factor: Vec<f64>,
    inverse_pivot: Vec<f64>,
    /// Rows of `U'^-1 S'`, `m` a segment.
    gain: Vec<SVector<f64, NX>>,
    /// `U'^-1` times border columns: for every segment and piece of the border `m` rows.
    border_gain: Vec<f64>,
    /// The border's Schur complement: `n_border` rows for every piece; and the factor of its boundary part.
    border: Vec<f64>,
    border_factor: Vec<f64>,
    start_factor: Vec<f64>,
    start_gain: Vec<f64>,
    free_start: Vec<usize>,
    free_time: bool,
    time_pivot: f64,
    /// Linear term of the value function.
    linear: Vec<SVector<f64, NX>>,
    /// `U'^-1` times the linear term of the controls, `m` a segment.
    linear_gain: Vec<f64>,
    start_linear: Vec<f64>,
    border_rhs: Vec<f64>,
    solution: Vec<f64>,
    /// Weights of the border columns in a solve.
    weights: Vec<f64>,
    /// Transposes of the dynamics and, in panels of pieces, of the control columns.
    transposed: Vec<SMatrix<f64, NX, NX>>,
    control_rows: Vec<Panel<NX>>,
    /// Scratch of one segment: panels of `cross`, `P b + cross`, first terms of the border's columns, first piece of the next ones.
    cross_rows: Vec<Panel<NX>>,
    work: Vec<SVector<f64, NX>>,
    border_start: Vec<f64>,
    timed_columns: Vec<f64>,
    /// Control of every segment from which on `cross` may be other than zero.
    first_cross: Vec<usize>,
    /// The general factorisation that takes the recursion's place where it is asked for.
    #[cfg(feature = "faer")]
    pub sparse: Option<crate::nlp::sparse::Sparse>,
}

impl<const NX: usize> Riccati<NX> {
    /// Prepares for problems of a given shape; `free_start` lists the components of the start state that are free.
    pub fn resize(&mut self, n: usize, m: usize, n_boundary: usize, free_start: &[usize], free_time: bool) {
        let nb = n_boundary + 1;
        let width = if NX >= LONG && is_fused() { border_width(m, nb) } else { LANES };
        let (mc, nc) = (pieces(m), nb.div_ceil(width));
        (self.n, self.m, self.n_border, self.free_time) = (n, m, nb, free_time);
        (self.control_pieces, self.border_pieces, self.border_width) = (mc, nc, width);
        self.value.resize(n + 1, SMatrix::zeros());
        self.gain.resize(n * m, SVector::zeros());
        self.inverse_pivot.resize(n * m, 0.0);
        self.free_start.clear();
        self.free_start.extend_from_slice(free_start);
        let ns = free_start.len();
        for (v, length) in [
            (&mut self.factor, n * m * mc * LANES),
            (&mut self.linear_gain, n * m),
            (&mut self.border_factor, (nb - 1) * (nb - 1)),
            (&mut self.start_factor, ns * ns),
            (&mut self.start_gain, ns * nb),
            (&mut self.start_linear, ns),
            (&mut self.solution, nb),
            (&mut self.columns, (n + 1) * nc * NX * width),
            (&mut self.border_gain, n * m * nc * width),
            (&mut self.border, nb * nc * width),
            (&mut self.border_rhs, nc * width),
            (&mut self.weights, nc * width),
            (&mut self.border_start, (m + NX) * width),
            (&mut self.timed_columns, NX * width),
        ] {
            v.clear();
            v.resize(length, 0.0);
        }
        for (v, length) in [(&mut self.control_rows, n * mc), (&mut self.cross_rows, mc)] {
            v.clear();
            v.resize(length, [[0.0; LANES]; NX]);
        }
        self.linear.resize(n + 1, SVector::zeros());
        self.transposed.resize(n, SMatrix::zeros());
        self.first_cross.resize(n, m);
        self.work.resize(m, SVector::zeros());
    }
}

/// Number of states from which on the recursion is also compiled for the numbers of controls and lengths of borders of quadcopters,
/// with fused arithmetic. Elsewhere it gains little, and every caller would wait for the compiler.
const LONG: usize = 8;

/// Length of the pieces of a row over a border of `n` columns: one piece where the kernels are compiled for it, because a number
/// that multiplies a long row is loaded once.
fn border_width(m: usize, n: usize) -> usize {
    match (m, pieces(n)) {
        (4 | 12, 3) => 12,
        (4 | 12, 4) => 16,
        _ => LANES,
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
