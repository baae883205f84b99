//! The cone program of one iteration.

use super::jacobian::Triplets;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

/// A cone at one collocation point: factors of variables and value at the iterate, radius first.
pub(super) struct Placed {
    pub rows: Vec<(Vec<(usize, f64)>, f64)>,
}

impl Placed {
    /// `norm - radius` after the step `d`, or zero inside.
    pub fn excess(&self, d: &[f64]) -> f64 {
        let value = |(terms, at): &(Vec<(usize, f64)>, f64)| {
            at + terms.iter().map(|&(i, factor)| factor * d[i]).sum::<f64>()
        };
        let norm = self.rows[1..].iter().map(|row| value(row).powi(2)).sum::<f64>().sqrt();
        (norm - value(&self.rows[0])).max(0.0)
    }
}

/// Data of the subproblem: minimise `gradient d + d' curvature d / 2 + penalty (sum |jacobian d + residual| + cone excess)` within
/// bounds and trust region. The cost is divided by `cost_scale`, rows by `row_scale`, variables by `scale`; those of scale zero are fixed.
pub(super) struct Subproblem<'a> {
    pub gradient: &'a [f64],
    pub curvature: &'a Triplets,
    pub jacobian: &'a Triplets,
    pub residual: &'a [f64],
    pub row_scale: &'a [f64],
    pub scale: &'a [f64],
    /// Least and greatest step of every variable.
    pub range: &'a [(f64, f64)],
    /// Variables that the trust region holds; slacks are not.
    pub n_trusted: usize,
    pub cones: &'a [Placed],
    pub cost_scale: f64,
}

/// Step and multipliers in the units of the problem.
#[derive(Clone, Debug, Default)]
pub(super) struct Answer {
    pub step: Vec<f64>,
    pub rows: Vec<f64>,
    pub lower: Vec<f64>,
    pub upper: Vec<f64>,
    /// `1 + rows` numbers a cone.
    pub cones: Vec<Vec<f64>>,
}

/// Rows of `A x + s = b`.
#[derive(Default)]
struct Rows {
    a: Triplets,
    b: Vec<f64>,
}

impl Subproblem<'_> {
    /// Scaled greatest entry of a step, of the variables that the radius limits.
    pub fn length(&self, d: &[f64]) -> f64 {
        let size = |i: usize| if self.scale[i] > 0.0 { (d[i] / self.scale[i]).abs() } else { 0.0 };
        (0..self.n_trusted).map(size).fold(0.0, f64::max)
    }

    /// Cost of the model after a step, relative to the iterate's, with the weighted violation that it leaves.
    pub fn model(&self, d: &[f64], penalty: f64) -> (f64, f64) {
        let linear: f64 = self.gradient.iter().zip(d).map(|(g, d)| g * d).sum();
        let quadratic: f64 =
            self.curvature.iter().map(|(i, j, v)| v * d[i] * d[j] / (self.scale[i] * self.scale[j])).sum();
        let mut left = self.residual.to_vec();
        self.jacobian.iter().for_each(|(row, column, v)| left[row] += v * d[column]);
        let rows: f64 = left.iter().zip(self.row_scale).map(|(v, s)| v.abs() / s).sum();
        let violation = rows + self.cones.iter().map(|c| c.excess(d)).sum::<f64>();
        ((linear + 0.5 * quadratic) / self.cost_scale + penalty * violation, violation)
    }

    /// Solves; `None` if the cone solver failed.
    pub fn solve(&self, penalty: f64, radius: f64) -> Option<Answer> {
        let free: Vec<usize> = (0..self.scale.len()).filter(|&i| self.scale[i] > 0.0).collect();
        let mut column = vec![usize::MAX; self.scale.len()];
        free.iter().enumerate().for_each(|(c, &i)| column[i] = c);
        let (n, m) = (free.len(), self.residual.len());
        let n_all = n + 2 * m + self.cones.len();
        let mut rows = Rows::default();
        for (i, j, v) in self.jacobian.iter() {
            if column[j] != usize::MAX {
                rows.a.push(i, column[j], v * self.scale[j] / self.row_scale[i]);
            }
        }
        for i in 0..m {
            rows.a.push(i, n + i, 1.0);
            rows.a.push(i, n + m + i, -1.0);
            rows.b.push(-self.residual[i] / self.row_scale[i]);
        }
        let mut shapes = vec![SupportedConeT::ZeroConeT(m)];
        let sides = self.push_bounds(&free, radius, &mut rows);
        for i in n..n_all {
            rows.a.push(rows.b.len(), i, -1.0);
            rows.b.push(0.0);
        }
        shapes.push(SupportedConeT::NonnegativeConeT(rows.b.len() - m));
        let first_cone = rows.b.len();
        for (index, cone) in self.cones.iter().enumerate() {
            rows.a.push(rows.b.len(), n + 2 * m + index, -1.0);
            for (terms, at) in &cone.rows {
                for &(i, factor) in terms.iter().filter(|(i, _)| column[*i] != usize::MAX) {
                    rows.a.push(rows.b.len(), column[i], -factor * self.scale[i]);
                }
                rows.b.push(*at);
            }
            shapes.push(SupportedConeT::SecondOrderConeT(cone.rows.len()));
        }
        let mut cost: Vec<f64> =
            free.iter().map(|&i| self.gradient[i] * self.scale[i] / self.cost_scale).collect();
        cost.resize(n_all, penalty);
        let (x, z) = self.call(&column, cost, rows, &shapes)?;
        Some(self.answer(&free, (x, z), &sides, first_cone))
    }

    /// Bounds and trust region; returns for every row its variable and side if it is a bound of the problem.
    fn push_bounds(&self, free: &[usize], radius: f64, rows: &mut Rows) -> Vec<(usize, bool)> {
        let mut sides = vec![];
        for (c, &i) in free.iter().enumerate() {
            let trust = if i < self.n_trusted { radius } else { f64::INFINITY };
            for (sign, limit) in [(1.0, self.range[i].1), (-1.0, -self.range[i].0)] {
                let limit = (limit / self.scale[i]).min(trust);
                if limit.is_finite() {
                    rows.a.push(rows.b.len(), c, sign);
                    rows.b.push(limit);
                    sides.push((i, sign > 0.0));
                }
            }
        }
        sides
    }

    fn call(
        &self,
        column: &[usize],
        cost: Vec<f64>,
        rows: Rows,
        shapes: &[SupportedConeT<f64>],
    ) -> Option<(Vec<f64>, Vec<f64>)> {
        let n = cost.len();
        let mut p = Triplets::default();
        for (i, j, v) in self.curvature.iter() {
            if column[i] <= column[j] && column[j] != usize::MAX {
                p.push(column[i], column[j], v / self.cost_scale);
            }
        }
        let p = CscMatrix::new_from_triplets(n, n, p.rows, p.columns, p.values);
        let a = CscMatrix::new_from_triplets(rows.b.len(), n, rows.a.rows, rows.a.columns, rows.a.values);
        let tight = 1e-9;
        let settings = DefaultSettings {
            verbose: false,
            max_iter: 100,
            max_threads: 1,
            tol_gap_abs: tight,
            tol_gap_rel: tight,
            tol_feas: tight,
            ..DefaultSettings::default()
        };
        let mut solver = DefaultSolver::new(&p, &cost, &a, &rows.b, shapes, settings).ok()?;
        solver.solve();
        let usable = matches!(
            solver.solution.status,
            SolverStatus::Solved | SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress
        );
        let finite = solver.solution.x.iter().chain(&solver.solution.z).all(|v| v.is_finite());
        (usable && finite).then(|| (solver.solution.x.clone(), solver.solution.z.clone()))
    }

    fn answer(
        &self,
        free: &[usize],
        (x, z): (Vec<f64>, Vec<f64>),
        sides: &[(usize, bool)],
        first_cone: usize,
    ) -> Answer {
        let (n, m) = (self.scale.len(), self.residual.len());
        let mut answer =
            Answer { step: vec![0.0; n], lower: vec![0.0; n], upper: vec![0.0; n], ..Answer::default() };
        for (c, &i) in free.iter().enumerate() {
            answer.step[i] = (x[c] * self.scale[i]).clamp(self.range[i].0, self.range[i].1);
        }
        answer.rows = (0..m).map(|i| z[i] * self.cost_scale / self.row_scale[i]).collect();
        for (&(i, above), z) in sides.iter().zip(&z[m..]) {
            let side = if above { &mut answer.upper } else { &mut answer.lower };
            side[i] = z.max(0.0) * self.cost_scale / self.scale[i];
        }
        let mut at = first_cone;
        for cone in self.cones {
            answer.cones.push(z[at..at + cone.rows.len()].iter().map(|v| v * self.cost_scale).collect());
            at += cone.rows.len();
        }
        answer
    }
}
