//! The linear-quadratic subproblem of a Newton step, stage by stage.

use crate::dense::{LANES, Panel, pieces};
use nalgebra::{SMatrix, SVector};

/// Matrices of the subproblem. With `dx` the knot states, `du` the `m` controls of a segment and `dp` the final time:
///
/// ```text
/// dx[k+1] = a dx[k] + b du[k] + ap dp + c
/// cost    = 1/2 dx' q dx + dx' qp dp                       at every knot
///         + dx[k]' s du + 1/2 du' r du + du' rp dp + dx[k+1]' cross du   on every segment
///         + 1/2 hpp dp^2
/// boundary: e0 dx[0] + ef dx[n] + et dp + e = slack terms
/// ```
#[derive(Clone, Debug, Default)]
pub(crate) struct Quadratic<const NX: usize> {
    pub a: Vec<SMatrix<f64, NX, NX>>,
    /// Columns of b, `m` a segment.
    pub b: Vec<SVector<f64, NX>>,
    pub ap: Vec<SVector<f64, NX>>,
    pub q: Vec<SMatrix<f64, NX, NX>>,
    /// Columns of s, `m` a segment.
    pub s: Vec<SVector<f64, NX>>,
    /// `m x m` a segment, symmetric, both triangles.
    pub r: Vec<f64>,
    pub qp: Vec<SVector<f64, NX>>,
    pub rp: Vec<f64>,
    pub hpp: f64,
    pub cross: Vec<SVector<f64, NX>>,
    pub e0: Vec<SVector<f64, NX>>,
    pub ef: Vec<SVector<f64, NX>>,
    pub et: Vec<f64>,
    /// Inverse barrier curvature of each boundary slack; 0 for an equality.
    pub compliance: Vec<f64>,
    /// Scratch: the columns of one segment side by side, and second derivatives of its middle control in the same places.
    pub panels: Vec<Panel<NX>>,
    /// Scratch, one: the transpose of the middle state's derivative.
    pub transposed: Vec<SMatrix<f64, NX, NX>>,
}

impl<const NX: usize> Quadratic<NX> {
    pub fn resize(&mut self, n: usize, m: usize, n_boundary: usize) {
        self.a.resize(n, SMatrix::zeros());
        self.b.resize(n * m, SVector::zeros());
        self.ap.resize(n, SVector::zeros());
        self.q.resize(n + 1, SMatrix::zeros());
        self.s.resize(n * m, SVector::zeros());
        self.r.resize(n * m * m, 0.0);
        self.qp.resize(n + 1, SVector::zeros());
        self.rp.resize(n * m, 0.0);
        self.cross.resize(n * m, SVector::zeros());
        self.e0.resize(n_boundary, SVector::zeros());
        self.ef.resize(n_boundary, SVector::zeros());
        self.et.resize(n_boundary, 0.0);
        self.compliance.resize(n_boundary, 0.0);
        self.transposed.resize(1, SMatrix::zeros());
        self.panels.clear();
        self.panels.resize(2 * pieces(m), [[0.0; LANES]; NX]);
    }

    /// Sets all second derivatives to zero.
    pub fn clear_hessian(&mut self) {
        self.q.fill(SMatrix::zeros());
        self.s.fill(SVector::zeros());
        self.r.fill(0.0);
        self.qp.fill(SVector::zeros());
        self.rp.fill(0.0);
        self.hpp = 0.0;
        self.cross.fill(SVector::zeros());
    }

    /// Copies without allocating, given equal sizes.
    pub fn copy_from(&mut self, other: &Self) {
        self.a.copy_from_slice(&other.a);
        self.b.copy_from_slice(&other.b);
        self.ap.copy_from_slice(&other.ap);
        self.q.copy_from_slice(&other.q);
        self.s.copy_from_slice(&other.s);
        self.r.copy_from_slice(&other.r);
        self.qp.copy_from_slice(&other.qp);
        self.rp.copy_from_slice(&other.rp);
        self.hpp = other.hpp;
        self.cross.copy_from_slice(&other.cross);
        self.e0.copy_from_slice(&other.e0);
        self.ef.copy_from_slice(&other.ef);
        self.et.copy_from_slice(&other.et);
        self.compliance.copy_from_slice(&other.compliance);
    }
}

/// Gradients and residuals: the right-hand side of a Newton step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rhs<const NX: usize> {
    pub gx: Vec<SVector<f64, NX>>,
    pub gu: Vec<f64>,
    pub gp: f64,
    pub c: Vec<SVector<f64, NX>>,
    pub e: Vec<f64>,
}

impl<const NX: usize> Rhs<NX> {
    pub fn resize(&mut self, n: usize, m: usize, n_boundary: usize) {
        self.gx.resize(n + 1, SVector::zeros());
        self.gu.resize(n * m, 0.0);
        self.c.resize(n, SVector::zeros());
        self.e.resize(n_boundary, 0.0);
    }
}

/// Solution of the subproblem.
#[derive(Clone, Debug, Default)]
pub(crate) struct Step<const NX: usize> {
    pub dx: Vec<SVector<f64, NX>>,
    pub du: Vec<f64>,
    pub dp: f64,
    /// Multipliers of the resolved dynamics.
    pub costate: Vec<SVector<f64, NX>>,
    pub boundary: Vec<f64>,
}

impl<const NX: usize> Step<NX> {
    pub fn resize(&mut self, n: usize, m: usize, n_boundary: usize) {
        self.dx.resize(n + 1, SVector::zeros());
        self.du.resize(n * m, 0.0);
        self.costate.resize(n, SVector::zeros());
        self.boundary.resize(n_boundary, 0.0);
    }
}
