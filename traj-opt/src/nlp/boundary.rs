//! Boundary constraints and end-point cost.

use super::layout::Layout;
use super::program::{Duals, Linearisation, Program, Scratch};
use crate::autodiff::{constant, constant2, gradient, hessian_part, mixed_part, seed, seed_rows, seed2};
use crate::{Bounds, Problem};
use nalgebra::{SMatrix, SVector};
use num_dual::{Derivative, Dual2SVec64, Dual64, DualSVec64, HyperDual64, HyperDualSVec64};

/// The rows of the border: the problem's boundary functions, then the fixed components of the end state.
#[derive(Clone, Debug, Default)]
pub(crate) struct BoundaryRows {
    pub n_functions: usize,
    /// Slack of each function's row (index into the slack section), if it is an inequality.
    pub slack: Vec<Option<usize>>,
    /// Target of equality rows.
    pub target: Vec<f64>,
    /// Fixed components of the end state.
    pub fixed: Vec<usize>,
    pub n_slacks: usize,
}

impl BoundaryRows {
    pub fn rebuild<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
        &mut self,
        problem: &P,
        bounds: &Bounds<NX, NU>,
    ) {
        self.n_functions = problem.n_boundary();
        self.slack.clear();
        self.target.clear();
        self.fixed.clear();
        self.n_slacks = 0;
        for i in 0..self.n_functions {
            let (lower, upper) = problem.boundary_bounds(i);
            if lower == upper {
                self.slack.push(None);
            } else {
                self.slack.push(Some(self.n_slacks));
                self.n_slacks += 1;
            }
            self.target.push(lower);
        }
        for i in 0..NX {
            if bounds.terminal_lower[i] == bounds.terminal_upper[i] {
                self.fixed.push(i);
                self.target.push(bounds.terminal_lower[i]);
            }
        }
    }

    pub fn len(&self) -> usize {
        self.n_functions + self.fixed.len()
    }

    /// What row `i` is compared with: its slack or its target.
    fn reference(&self, layout: &Layout, w: &[f64], i: usize) -> f64 {
        match self.slack.get(i).copied().flatten() {
            Some(slack) => w[layout.boundary_slacks + slack],
            None => self.target[i],
        }
    }
}

/// Boundary residuals; returns the end-point cost.
pub(crate) fn evaluate<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    rows: &BoundaryRows,
    w: &[f64],
    scratch: &mut [f64],
    out: &mut [f64],
) -> f64 {
    let initial = program.state(layout, w, 0);
    let terminal = program.state(layout, w, layout.n_segments);
    let tf = w[layout.time];
    let n = rows.n_functions;
    program.problem.boundary(&initial, &terminal, tf, &mut scratch[..n]);
    for i in 0..n {
        out[i] = scratch[i] - rows.reference(layout, w, i);
    }
    for (j, &component) in rows.fixed.iter().enumerate() {
        out[n + j] = terminal[component] - rows.target[n + j];
    }
    program.problem.mayer(&initial, &terminal, tf)
}

/// Jacobian, gradient and second derivatives. The mixed derivative of start and end state is left out: it does not fit the
/// recursion, and is zero unless a nonlinear function couples free start and end states.
pub(crate) fn linearise<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    rows: &BoundaryRows,
    w: &[f64],
    duals: &Duals<NX>,
    scratch: &mut Scratch<NX, NU>,
    out: &mut Linearisation<NX, NU>,
) {
    let (x0, xf) = (program.state(layout, w, 0), program.state(layout, w, layout.n_segments));
    let tf = w[layout.time];
    first_derivatives(program, layout, rows, (&x0, &xf, tf), scratch, out);
    let last = layout.state(layout.n_segments);
    for i in 0..rows.len() {
        let nu = duals.boundary[i];
        if i >= rows.n_functions {
            let component = rows.fixed[i - rows.n_functions];
            out.raw.e0[i] = SVector::zeros();
            out.raw.ef[i] = SVector::zeros();
            out.raw.ef[i][component] = 1.0;
            out.raw.et[i] = 0.0;
        } else if let Some(slack) = rows.slack[i] {
            out.lagrangian[layout.boundary_slacks + slack] -= nu;
        }
        let (start, end, time) = (out.raw.e0[i] * nu, out.raw.ef[i] * nu, out.raw.et[i] * nu);
        out.add_gradient(0, start.as_slice());
        out.add_gradient(last, end.as_slice());
        out.lagrangian[layout.time] += time;
    }
    second_derivatives(program, layout, &duals.boundary[..rows.n_functions], (&x0, &xf, tf), scratch, out);
}

type Ends<'a, const NX: usize> = (&'a SVector<f64, NX>, &'a SVector<f64, NX>, f64);

fn first_derivatives<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    rows: &BoundaryRows,
    (x0, xf, tf): Ends<NX>,
    scratch: &mut Scratch<NX, NU>,
    out: &mut Linearisation<NX, NU>,
) {
    let problem = program.problem;
    let n = rows.n_functions;
    let time = DualSVec64::from_re(tf);
    problem.boundary(&constant::<NX, NX>(x0), &seed(xf), time, &mut scratch.x[..n]);
    for i in 0..n {
        out.raw.ef[i] = gradient(&scratch.x[i]);
    }
    problem.boundary(&seed(x0), &constant::<NX, NX>(xf), time, &mut scratch.x[..n]);
    for i in 0..n {
        out.raw.e0[i] = gradient(&scratch.x[i]);
    }
    let by_end = gradient(&problem.mayer(&constant::<NX, NX>(x0), &seed(xf), time));
    let by_start = gradient(&problem.mayer(&seed(x0), &constant::<NX, NX>(xf), time));
    let t = Dual64::from_re(tf).derivative();
    let (s0, sf) = (x0.map(Dual64::from_re), xf.map(Dual64::from_re));
    problem.boundary(&s0, &sf, t, &mut scratch.t[..n]);
    for i in 0..n {
        out.raw.et[i] = if program.free_time { scratch.t[i].eps } else { 0.0 };
    }
    let by_time = if program.free_time { problem.mayer(&s0, &sf, t).eps } else { 0.0 };
    let last = layout.state(layout.n_segments);
    for (offset, values) in [(0, by_start), (last, by_end)] {
        out.add_objective(offset, values.as_slice());
        out.add_gradient(offset, values.as_slice());
    }
    out.objective[layout.time] += by_time;
    out.lagrangian[layout.time] += by_time;
}

fn second_derivatives<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    weights: &[f64],
    (x0, xf, tf): Ends<NX>,
    scratch: &mut Scratch<NX, NU>,
    out: &mut Linearisation<NX, NU>,
) {
    let problem = program.problem;
    let n = weights.len();
    let time = Dual2SVec64::from_re(tf);
    for (knot, start, end) in
        [(layout.n_segments, constant2::<NX, NX>(x0), seed2(xf)), (0, seed2(x0), constant2::<NX, NX>(xf))]
    {
        problem.boundary(&start, &end, time, &mut scratch.xx[..n]);
        out.raw.q[knot] += hessian_part(&problem.mayer(&start, &end, time));
        for i in 0..n {
            out.raw.q[knot] += hessian_part(&scratch.xx[i]) * weights[i];
        }
    }
    if !program.free_time {
        return;
    }
    let mut time = HyperDualSVec64::<NX, 1>::from_re(tf);
    time.eps2 = Derivative::some(SMatrix::<f64, 1, 1>::repeat(1.0));
    for (knot, start, end) in [
        (layout.n_segments, x0.map(HyperDualSVec64::from_re), seed_rows::<NX, 1>(xf)),
        (0, seed_rows::<NX, 1>(x0), xf.map(HyperDualSVec64::from_re)),
    ] {
        problem.boundary(&start, &end, time, &mut scratch.xt[..n]);
        out.raw.qp[knot] += mixed_part(&problem.mayer(&start, &end, time));
        for i in 0..n {
            out.raw.qp[knot] += mixed_part(&scratch.xt[i]) * weights[i];
        }
    }
    let tt = HyperDual64::new(tf, 1.0, 1.0, 0.0);
    let (s0, sf) = (x0.map(HyperDual64::from_re), xf.map(HyperDual64::from_re));
    problem.boundary(&s0, &sf, tt, &mut scratch.tt[..n]);
    out.raw.hpp += problem.mayer(&s0, &sf, tt).eps1eps2;
    for i in 0..n {
        out.raw.hpp += scratch.tt[i].eps1eps2 * weights[i];
    }
}
