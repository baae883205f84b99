//! The transcribed problem: evaluation and linearisation over all segments.

use super::boundary::BoundaryRows;
use super::layout::Layout;
use super::quadratic::Quadratic;
use super::running::{PointTerms, PointTime};
use super::stages::Stages;
use super::{boundary, hermite_simpson, path, radau, runge_kutta, trapezoidal};
use crate::dense::{Arithmetic, Kernel, dispatch, vector};
use crate::{Bounds, Mesh, Problem, Scales, Transcription};
use nalgebra::{SMatrix, SVector};
use num_dual::{Dual2SVec64, Dual64, DualSVec64, HyperDual64, HyperDualSVec64};

/// A problem on a mesh.
pub(crate) struct Program<'a, const NX: usize, const NU: usize, P> {
    pub problem: &'a P,
    pub mesh: &'a Mesh,
    pub transcription: Transcription,
    pub bounds: Bounds<NX, NU>,
    pub scales: Scales<NX, NU>,
    pub free_time: bool,
}

/// Constraint residuals and cost at an iterate.
#[derive(Clone, Debug, Default)]
pub(crate) struct Values<const NX: usize> {
    pub objective: f64,
    pub defect: Vec<SVector<f64, NX>>,
    pub middle: Vec<SVector<f64, NX>>,
    /// Path function minus slack.
    pub path: Vec<f64>,
    /// Boundary function minus target or slack.
    pub boundary: Vec<f64>,
}

/// Multipliers of the constraints.
#[derive(Clone, Debug, Default)]
pub(crate) struct Duals<const NX: usize> {
    pub defect: Vec<SVector<f64, NX>>,
    pub middle: Vec<SVector<f64, NX>>,
    pub path: Vec<f64>,
    pub boundary: Vec<f64>,
}

/// The middle state of a Hermite-Simpson segment as a function of the segment's other variables, and the Lagrangian's second
/// derivatives there.
#[derive(Clone, Debug)]
pub(crate) struct Middle<const NX: usize, const NU: usize> {
    /// `d xm / d x` with the next state eliminated.
    pub sx: SMatrix<f64, NX, NX>,
    pub sp: SVector<f64, NX>,
    /// `d xm / d x_next`.
    pub by_next: SMatrix<f64, NX, NX>,
    /// `d defect / d xm`.
    pub defect_by: SMatrix<f64, NX, NX>,
    pub hxx: SMatrix<f64, NX, NX>,
    pub hxu: SMatrix<f64, NX, NU>,
    pub hxp: SVector<f64, NX>,
}

/// First and second derivatives at an iterate, before bounds and slacks enter.
#[derive(Clone, Debug, Default)]
pub(crate) struct Linearisation<const NX: usize, const NU: usize> {
    pub raw: Quadratic<NX>,
    /// Inverse of the derivative of each defect with respect to the segment's end state, negated; empty for explicit methods.
    pub resolve: Vec<SMatrix<f64, NX, NX>>,
    pub middles: Vec<Middle<NX, NU>>,
    pub stages: Stages<NX, NU>,
    /// Columns `d xm / d u`, m a segment.
    pub middle_su: Vec<SVector<f64, NX>>,
    pub path_x: Vec<SVector<f64, NX>>,
    pub path_u: Vec<SVector<f64, NU>>,
    pub path_p: Vec<f64>,
    /// Gradient of the cost over all variables.
    pub objective: Vec<f64>,
    /// Gradient of the Lagrangian without the multipliers of bounds, over all variables.
    pub lagrangian: Vec<f64>,
}

/// Scratch for functions that write into slices of dual numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch<const NX: usize, const NU: usize> {
    /// Leaves second derivatives out.
    pub first_order_only: bool,
    pub f: Vec<f64>,
    pub x: Vec<DualSVec64<NX>>,
    pub u: Vec<DualSVec64<NU>>,
    pub t: Vec<Dual64>,
    pub xx: Vec<Dual2SVec64<NX>>,
    pub uu: Vec<Dual2SVec64<NU>>,
    pub xu: Vec<HyperDualSVec64<NX, NU>>,
    pub xt: Vec<HyperDualSVec64<NX, 1>>,
    pub ut: Vec<HyperDualSVec64<NU, 1>>,
    pub tt: Vec<HyperDual64>,
    pub stages: Vec<runge_kutta::Stage<NX, NU>>,
    pub sensitivity: runge_kutta::Sensitivity<NX, NU>,
}

impl<const NX: usize, const NU: usize> Scratch<NX, NU> {
    pub fn resize(&mut self, n: usize) {
        self.f.resize(n, 0.0);
        self.x.resize(n, DualSVec64::from_re(0.0));
        self.u.resize(n, DualSVec64::from_re(0.0));
        self.t.resize(n, Dual64::from_re(0.0));
        self.xx.resize(n, Dual2SVec64::from_re(0.0));
        self.uu.resize(n, Dual2SVec64::from_re(0.0));
        self.xu.resize(n, HyperDualSVec64::from_re(0.0));
        self.xt.resize(n, HyperDualSVec64::from_re(0.0));
        self.ut.resize(n, HyperDualSVec64::from_re(0.0));
        self.tt.resize(n, HyperDual64::from_re(0.0));
    }
}

impl<const NX: usize> Values<NX> {
    pub fn resize(&mut self, layout: &Layout, n_boundary: usize) {
        let n = layout.n_segments;
        self.defect.resize(n, SVector::zeros());
        self.middle.resize(n * layout.n_inner, SVector::zeros());
        self.path.resize(layout.points.len() * layout.n_path, 0.0);
        self.boundary.resize(n_boundary, 0.0);
    }
}

impl<const NX: usize> Duals<NX> {
    /// Resizes and sets all multipliers to zero.
    pub fn reset(&mut self, layout: &Layout, n_boundary: usize) {
        let n = layout.n_segments;
        self.defect.clear();
        self.defect.resize(n, SVector::zeros());
        self.middle.clear();
        self.middle.resize(n * layout.n_inner, SVector::zeros());
        self.path.clear();
        self.path.resize(layout.points.len() * layout.n_path, 0.0);
        self.boundary.clear();
        self.boundary.resize(n_boundary, 0.0);
    }
}

impl<const NX: usize, const NU: usize> Linearisation<NX, NU> {
    pub fn resize(&mut self, layout: &Layout, n_boundary: usize, implicit: bool) {
        let (n, m) = (layout.n_segments, layout.m);
        self.raw.resize(n, m, n_boundary);
        self.resolve.resize(if implicit { n } else { 0 }, SMatrix::zeros());
        let middle = Middle {
            sx: SMatrix::zeros(),
            sp: SVector::zeros(),
            by_next: SMatrix::zeros(),
            defect_by: SMatrix::zeros(),
            hxx: SMatrix::zeros(),
            hxu: SMatrix::zeros(),
            hxp: SVector::zeros(),
        };
        self.middles.resize(if layout.has_middle { n } else { 0 }, middle);
        self.middle_su.resize(if layout.has_middle { n * m } else { 0 }, SVector::zeros());
        self.stages.resize(layout);
        let n_path = layout.points.len() * layout.n_path;
        self.path_x.resize(n_path, SVector::zeros());
        self.path_u.resize(n_path, SVector::zeros());
        self.path_p.resize(n_path, 0.0);
        self.objective.resize(layout.n_variables, 0.0);
        self.lagrangian.resize(layout.n_variables, 0.0);
    }

    /// Sets the second derivatives at inner states to zero.
    pub fn clear_inner_hessian(&mut self) {
        for middle in &mut self.middles {
            middle.hxx.fill(0.0);
            middle.hxu.fill(0.0);
            middle.hxp.fill(0.0);
        }
        self.stages.clear_hessian();
    }

    /// Adds a vector to part of the Lagrangian's gradient.
    pub fn add_gradient(&mut self, offset: usize, values: &[f64]) {
        for (g, v) in self.lagrangian[offset..].iter_mut().zip(values) {
            *g += v;
        }
    }

    /// Adds a vector to part of the cost's gradient.
    pub fn add_objective(&mut self, offset: usize, values: &[f64]) {
        for (g, v) in self.objective[offset..].iter_mut().zip(values) {
            *g += v;
        }
    }

    /// Adds the gradients of a collocation point.
    pub fn add_point_gradient(
        &mut self,
        layout: &Layout,
        (state, control): (usize, usize),
        terms: &PointTerms<NX, NU>,
    ) {
        self.add_gradient(state, terms.x.as_slice());
        self.add_gradient(control, terms.u.as_slice());
        self.lagrangian[layout.time] += terms.p;
        self.add_objective(state, terms.objective_x.as_slice());
        self.add_objective(control, terms.objective_u.as_slice());
        self.objective[layout.time] += terms.objective_p;
    }
}

impl<const NX: usize, const NU: usize, P: Problem<NX, NU>> Program<'_, NX, NU, P> {
    /// Time of a fraction of the flight and its rate with the final time.
    pub fn time_at(&self, fraction: f64, final_time: f64) -> f64 {
        self.bounds.initial_time + fraction * (final_time - self.bounds.initial_time)
    }

    /// Time data of a point in segment `k` at `s` of its length.
    pub fn point_time(&self, k: usize, s: f64, final_time: f64) -> PointTime {
        let f = self.mesh.fractions();
        let width = f[k + 1] - f[k];
        let fraction = f[k] + s * width;
        let rate = if self.free_time { 1.0 } else { 0.0 };
        PointTime {
            time: self.time_at(fraction, final_time),
            h: width * (final_time - self.bounds.initial_time),
            h_rate: width * rate,
            t_rate: fraction * rate,
        }
    }

    /// Cost and constraint residuals at `w`, whose dependent variables are set first.
    pub fn evaluate(
        &self,
        layout: &Layout,
        rows: &BoundaryRows,
        w: &mut [f64],
        scratch: &mut Scratch<NX, NU>,
        out: &mut Values<NX>,
    ) {
        if self.transcription == Transcription::CompressedHermiteSimpson {
            hermite_simpson::set_middles(self, layout, w);
        }
        let mut objective = 0.0;
        for k in 0..layout.n_segments {
            objective += match self.transcription {
                Transcription::RungeKutta { substeps } => {
                    runge_kutta::evaluate(self, layout, substeps, k, w, out)
                }
                Transcription::Trapezoidal => trapezoidal::evaluate(self, layout, k, w, out),
                Transcription::HermiteSimpson | Transcription::CompressedHermiteSimpson => {
                    hermite_simpson::evaluate(self, layout, k, w, out)
                }
                Transcription::LegendreGaussRadau { .. } => radau::evaluate(self, layout, k, w, out),
            };
        }
        path::evaluate(self, layout, w, &mut scratch.f, &mut out.path);
        objective += boundary::evaluate(self, layout, rows, w, &mut scratch.f, &mut out.boundary);
        out.objective = objective;
    }

    /// First and second derivatives at `w`.
    pub fn linearise(
        &self,
        layout: &Layout,
        rows: &BoundaryRows,
        w: &[f64],
        duals: &Duals<NX>,
        scratch: &mut Scratch<NX, NU>,
        out: &mut Linearisation<NX, NU>,
    ) {
        out.raw.clear_hessian();
        out.objective.fill(0.0);
        out.lagrangian.fill(0.0);
        let second = !scratch.first_order_only;
        dispatch(Segments { program: self, layout, w, duals, second, scratch, out });
        path::linearise(self, layout, w, duals, scratch, out);
        boundary::linearise(self, layout, rows, w, duals, scratch, out);
    }

    #[inline(always)]
    fn linearise_segments<A: Arithmetic>(
        &self,
        layout: &Layout,
        w: &[f64],
        duals: &Duals<NX>,
        second: bool,
        scratch: &mut Scratch<NX, NU>,
        out: &mut Linearisation<NX, NU>,
    ) {
        for k in 0..layout.n_segments {
            match self.transcription {
                Transcription::RungeKutta { substeps } => {
                    runge_kutta::linearise::<A, NX, NU, P>(self, layout, substeps, k, w, duals, scratch, out);
                }
                Transcription::Trapezoidal => trapezoidal::linearise(self, layout, k, w, duals, second, out),
                Transcription::HermiteSimpson | Transcription::CompressedHermiteSimpson => {
                    hermite_simpson::linearise::<A, NX, NU, P>(self, layout, k, w, duals, second, out);
                }
                Transcription::LegendreGaussRadau { .. } => {
                    radau::linearise(self, layout, k, w, duals, second, out);
                }
            }
        }
    }

    /// State at a knot.
    pub fn state(&self, layout: &Layout, w: &[f64], knot: usize) -> SVector<f64, NX> {
        vector(w, layout.state(knot))
    }

    /// Control vector of a segment.
    pub fn control(&self, layout: &Layout, w: &[f64], segment: usize, local: usize) -> SVector<f64, NU> {
        vector(w, layout.control(segment, local))
    }
}

struct Segments<'a, 'b, const NX: usize, const NU: usize, P> {
    program: &'a Program<'b, NX, NU, P>,
    layout: &'a Layout,
    w: &'a [f64],
    duals: &'a Duals<NX>,
    second: bool,
    scratch: &'a mut Scratch<NX, NU>,
    out: &'a mut Linearisation<NX, NU>,
}

impl<const NX: usize, const NU: usize, P: Problem<NX, NU>> Kernel for Segments<'_, '_, NX, NU, P> {
    type Output = ();

    #[inline(always)]
    fn run<A: Arithmetic>(self) {
        self.program.linearise_segments::<A>(
            self.layout,
            self.w,
            self.duals,
            self.second,
            self.scratch,
            self.out,
        );
    }
}

/// Adds `block` to the control Hessian of segment `k` at control vectors `(i, i)`.
pub(crate) fn add_control_block<const NX: usize, const NU: usize>(
    raw: &mut Quadratic<NX>,
    m: usize,
    k: usize,
    local: usize,
    block: &SMatrix<f64, NU, NU>,
) {
    for i in 0..NU {
        for j in 0..NU {
            raw.r[(k * m + local * NU + i) * m + local * NU + j] += block[(i, j)];
        }
    }
}
