//! The transcribed constraints as one sparse matrix, and the curvature of the Lagrangian, made convex point by point.

use crate::dense::{Separate, vector};
use crate::nlp::interior_point::Memory;
use crate::nlp::program::Program;
use crate::nlp::running::{self, PointModel, PointTerms, PointTime};
use crate::{Problem, Transcription};
use nalgebra::{DMatrix, SVector};

/// A sparse matrix by its entries.
#[derive(Clone, Debug, Default)]
pub(super) struct Triplets {
    pub rows: Vec<usize>,
    pub columns: Vec<usize>,
    pub values: Vec<f64>,
}

impl Triplets {
    pub fn clear(&mut self) {
        self.rows.clear();
        self.columns.clear();
        self.values.clear();
    }

    pub fn push(&mut self, row: usize, column: usize, value: f64) {
        if value != 0.0 {
            self.rows.push(row);
            self.columns.push(column);
            self.values.push(value);
        }
    }

    pub fn iter(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        self.rows.iter().zip(&self.columns).zip(&self.values).map(|((&r, &c), &v)| (r, c, v))
    }
}

/// A collocation point: where in the segment, offsets of its state and control, weight in the running cost.
struct Node {
    s: f64,
    state: usize,
    control: usize,
    weight: f64,
}

/// `sum of leads + h sum of weights f - own = 0`, the rows beginning at `row`.
struct Residual {
    row: usize,
    leads: Vec<(usize, f64)>,
    own: usize,
    weights: Vec<f64>,
}

/// Points and residuals of segment `k`; no residuals for multiple shooting.
fn scheme<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    memory: &Memory<NX, NU>,
    k: usize,
) -> (Vec<Node>, Vec<Residual>) {
    let layout = &memory.layout;
    let (start, end, defect) = (layout.state(k), layout.state(k + 1), k * NX);
    let inner_row = |i: usize| (layout.n_segments + k * layout.n_inner + i) * NX;
    let node = |s, state, local, weight| Node { s, state, control: layout.control(k, local), weight };
    match program.transcription {
        Transcription::RungeKutta { .. } => (vec![node(0.0, start, 0, 1.0)], vec![]),
        Transcription::Trapezoidal => (
            vec![node(0.0, start, 0, 0.5), node(1.0, end, 1, 0.5)],
            vec![Residual { row: defect, leads: vec![(start, 1.0)], own: end, weights: vec![0.5; 2] }],
        ),
        Transcription::HermiteSimpson | Transcription::CompressedHermiteSimpson => {
            let middle = layout.middle(k);
            let simpson = vec![1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0];
            let hermite = vec![1.0 / 8.0, 0.0, -1.0 / 8.0];
            (
                vec![
                    node(0.0, start, 0, simpson[0]),
                    node(0.5, middle, 1, simpson[1]),
                    node(1.0, end, 2, simpson[2]),
                ],
                vec![
                    Residual { row: defect, leads: vec![(start, 1.0)], own: end, weights: simpson },
                    Residual {
                        row: inner_row(0),
                        leads: vec![(start, 0.5), (end, 0.5)],
                        own: middle,
                        weights: hermite,
                    },
                ],
            )
        }
        Transcription::LegendreGaussRadau { .. } => {
            let (table, points) = (&layout.tableau, program.transcription.control_points());
            let d = table.degree;
            let state = |i: usize| if i + 1 < d { layout.inner(k, i) } else { end };
            let nodes = (0..d).map(|i| node(points[i], state(i), i, table.weight(d - 1, i))).collect();
            let residual = |i: usize| Residual {
                row: if i + 1 < d { inner_row(i) } else { defect },
                leads: vec![(start, 1.0)],
                own: state(i),
                weights: (0..d).map(|j| table.weight(i, j)).collect(),
            };
            (nodes, (0..d).map(residual).collect())
        }
    }
}

/// Number of scalar constraints: defects, inner residuals, path and boundary rows, in this order.
pub(super) fn n_rows<const NX: usize, const NU: usize>(memory: &Memory<NX, NU>) -> usize {
    let v = &memory.values;
    (v.defect.len() + v.middle.len()) * NX + v.path.len() + v.boundary.len()
}

/// First derivatives of all constraints by all variables, and blocks of the Lagrangian's second derivatives whose negative
/// eigenvalues are set to zero. The memory holds the first-order linearisation at its iterate.
pub(super) fn derivatives<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    memory: &Memory<NX, NU>,
    jacobian: &mut Triplets,
    curvature: &mut Triplets,
) {
    jacobian.clear();
    curvature.clear();
    for k in 0..memory.layout.n_segments {
        let (nodes, residuals) = scheme(program, memory, k);
        if residuals.is_empty() {
            shooting_rows(memory, k, jacobian);
        }
        for residual in &residuals {
            for i in 0..NX {
                residual.leads.iter().for_each(|&(at, v)| jacobian.push(residual.row + i, at + i, v));
                jacobian.push(residual.row + i, residual.own + i, -1.0);
            }
        }
        for (j, node) in nodes.iter().enumerate() {
            let at = program.point_time(k, node.s, memory.w[memory.layout.time]);
            let x: SVector<f64, NX> = vector(&memory.w, node.state);
            let u: SVector<f64, NU> = vector(&memory.w, node.control);
            let model = running::differentiate(program.problem, at.time, &x, &u);
            let mut omega = SVector::zeros();
            for residual in &residuals {
                point_rows(memory, residual, j, node, &at, &model, jacobian);
                omega += multiplier(memory, residual.row) * residual.weights[j];
            }
            if residuals.is_empty() {
                omega = memory.duals.defect[k];
            }
            let hessian = running::hessian(program.problem, &at, (&x, &u, true), &omega, node.weight);
            let terms = PointTerms::new::<Separate>(&model, &at, &omega, node.weight, &hessian);
            let mut block = DMatrix::zeros(NX + NU + 1, NX + NU + 1);
            block.view_mut((0, 0), (NX, NX)).copy_from(&hessian.state_state);
            block.view_mut((0, NX), (NX, NU)).copy_from(&hessian.state_control);
            block.view_mut((NX, 0), (NU, NX)).copy_from(&hessian.state_control.transpose());
            block.view_mut((NX, NX), (NU, NU)).copy_from(&hessian.control_control);
            let last = NX + NU;
            for i in 0..last {
                let v = if i < NX { terms.xp[i] } else { terms.up[i - NX] };
                (block[(i, last)], block[(last, i)]) = (v, v);
            }
            block[(last, last)] = terms.pp;
            push_convex(memory, node, block, curvature);
        }
    }
    path_and_boundary_rows(memory, jacobian);
}

fn multiplier<const NX: usize, const NU: usize>(memory: &Memory<NX, NU>, row: usize) -> SVector<f64, NX> {
    let (k, n) = (row / NX, memory.layout.n_segments);
    if k < n { memory.duals.defect[k] } else { memory.duals.middle[k - n] }
}

/// What the slope at a point contributes to a residual.
fn point_rows<const NX: usize, const NU: usize>(
    memory: &Memory<NX, NU>,
    residual: &Residual,
    j: usize,
    node: &Node,
    at: &PointTime,
    model: &PointModel<NX, NU>,
    out: &mut Triplets,
) {
    let (weight, f) = (residual.weights[j], &model.f);
    let by_time = (f.value * at.h_rate + f.time * (at.h * at.t_rate)) * weight;
    for i in 0..NX {
        (0..NX).for_each(|c| out.push(residual.row + i, node.state + c, weight * at.h * f.state[(i, c)]));
        (0..NU).for_each(|c| out.push(residual.row + i, node.control + c, weight * at.h * f.control[(i, c)]));
        out.push(residual.row + i, memory.layout.time, by_time[i]);
    }
}

fn shooting_rows<const NX: usize, const NU: usize>(memory: &Memory<NX, NU>, k: usize, out: &mut Triplets) {
    let (layout, raw) = (&memory.layout, &memory.lin.raw);
    for i in 0..NX {
        (0..NX).for_each(|j| out.push(k * NX + i, layout.state(k) + j, raw.a[k][(i, j)]));
        (0..NU).for_each(|j| out.push(k * NX + i, layout.control(k, 0) + j, raw.b[k * layout.m + j][i]));
        out.push(k * NX + i, layout.time, raw.ap[k][i]);
        out.push(k * NX + i, layout.state(k + 1) + i, -1.0);
    }
}

fn path_and_boundary_rows<const NX: usize, const NU: usize>(memory: &Memory<NX, NU>, out: &mut Triplets) {
    let (layout, lin, v) = (&memory.layout, &memory.lin, &memory.values);
    let first = (v.defect.len() + v.middle.len()) * NX;
    for row in 0..v.path.len() {
        let point = &layout.points[row / layout.n_path];
        let (state, control) = (layout.point_state(point), layout.control(point.segment, point.local));
        (0..NX).for_each(|j| out.push(first + row, state + j, lin.path_x[row][j]));
        (0..NU).for_each(|j| out.push(first + row, control + j, lin.path_u[row][j]));
        out.push(first + row, layout.time, lin.path_p[row]);
        out.push(first + row, layout.path_slacks + row, -1.0);
    }
    let first = first + v.path.len();
    for row in 0..v.boundary.len() {
        for j in 0..NX {
            out.push(first + row, j, lin.raw.e0[row][j]);
            out.push(first + row, layout.state(layout.n_segments) + j, lin.raw.ef[row][j]);
        }
        out.push(first + row, layout.time, lin.raw.et[row]);
        if let Some(slack) = memory.rows.slack.get(row).copied().flatten() {
            out.push(first + row, layout.boundary_slacks + slack, -1.0);
        }
    }
}

/// Adds the nearest positive semidefinite matrix to a block, in scaled variables, so that no unit decides what is cut off.
fn push_convex<const NX: usize, const NU: usize>(
    memory: &Memory<NX, NU>,
    node: &Node,
    mut block: DMatrix<f64>,
    out: &mut Triplets,
) {
    let place = |i: usize| match i {
        i if i < NX => node.state + i,
        i if i < NX + NU => node.control + i - NX,
        _ => memory.layout.time,
    };
    let size = block.nrows();
    let scale: Vec<f64> = (0..size).map(|i| memory.variable_scale[place(i)]).collect();
    for i in 0..size {
        for j in 0..size {
            block[(i, j)] *= scale[i] * scale[j];
        }
    }
    if block.iter().all(|v| *v == 0.0) || block.iter().any(|v| !v.is_finite()) {
        return;
    }
    let eigen = block.symmetric_eigen();
    let kept = eigen.eigenvalues.map(|v| v.max(0.0));
    if kept.amax() == 0.0 {
        return;
    }
    let convex = &eigen.eigenvectors * DMatrix::from_diagonal(&kept) * eigen.eigenvectors.transpose();
    for i in 0..size {
        for j in 0..size {
            out.push(place(i), place(j), 0.5 * (convex[(i, j)] + convex[(j, i)]));
        }
    }
}
