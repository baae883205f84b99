//! The costate of the bound in `agility.rs`: how it is evaluated, and how a good one is found.

use super::agility::{Agility, Passage};
use super::speeds::{Speed, Speeds};
use nalgebra::{SMatrix, SVector, Vector3};
use quad_dynamics::GRAVITY;
use std::f64::consts::PI;

type Vector6 = SVector<f64, 6>;
type Matrix6 = SMatrix<f64, 6, 6>;
type Matrix3 = SMatrix<f64, 3, 3>;

/// `lambda(0) = mu`, `d lambda/dq = n - c lambda` over the time to go `q`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Costate {
    /// Weight of the position.
    n: Vector3<f64>,
    /// Weight of the last velocity.
    mu: Vector3<f64>,
}

impl Costate {
    /// The costate that reverses half-way, in the direction of the offset; `None` if there is no such direction.
    pub(super) fn first(passage: &Passage, time: f64) -> Option<Self> {
        let n = passage.offset(time).try_normalize(1e-9)?;
        let half = 0.5 * time;
        Some(Self { n, mu: (Vector3::z() * 0.3 - n) * half })
    }

    fn at(&self, [a, b]: [f64; 2]) -> Vector3<f64> {
        self.n * a + self.mu * b
    }

    /// Whether no `T` in `[T_a, T_b]` is possible; exact but for rounding, see the proof in `agility.rs`.
    pub(super) fn excludes(
        &self,
        agility: &Agility,
        passage: &Passage,
        speeds: &Speeds,
        [first, last]: [f64; 2],
    ) -> bool {
        let [v_0, v_1] = passage.velocities;
        let along = self.n.dot(&passage.offset(first)).min(self.n.dot(&passage.offset(last)));
        let mut most = -self.mu.dot(&v_1) - along;
        let mut starts = f64::NEG_INFINITY;
        let mut size = self.mu.norm();
        for cell in cells(agility, speeds, [first, last]) {
            let ends = cell.weights.map(|weights| self.at(weights));
            let free = ends.map(|lambda| cell.rho * lambda.norm() - GRAVITY * lambda.z);
            let thrust = (0..2)
                .map(|end| ends.map(|lambda| cell.thrust(agility, passage, end, &lambda)))
                .map(|thrust| [free[0] + thrust[0], free[1] + thrust[1]])
                .min_by(|a, b| cell.chord(*a).total_cmp(&cell.chord(*b)))
                .unwrap_or_default();
            if cell.last {
                most += cell.length * thrust[0].max(thrust[1]).max(0.0);
                starts = ends[0].dot(&v_0).max(ends[1].dot(&v_0));
            } else {
                most += cell.length * cell.chord(thrust);
            }
            size = size.max(ends[1].norm());
        }
        most + starts < -1e-9 * size * passage.size(last)
    }

    /// Some damped Newton steps on the convex function that must become negative for a time of `time`.
    pub(super) fn improve(&mut self, agility: &Agility, passage: &Passage, speeds: &Speeds, time: f64) {
        const STEPS: usize = 4;
        // One component of n is held: the function is homogeneous, and only the direction of (n, mu) counts.
        let offset = passage.offset(time);
        let Some(along) = offset.try_normalize(1e-9) else { return };
        let held = Vector6::new(along.x, along.y, along.z, 0.0, 0.0, 0.0);
        let cells: Vec<Cell> = cells(agility, speeds, [time, time]).collect();
        let mut damping = 1e-3;
        let mut here = self.expand(agility, passage, &offset, &cells);
        for _ in 0..STEPS {
            let (value, gradient, hessian) = here;
            let mut step = None;
            for _ in 0..6 {
                let scale = hessian.trace() / 6.0;
                let matrix = hessian
                    + Matrix6::identity() * (damping * scale)
                    + held * held.transpose() * (1e9 * scale);
                let Some(factors) = matrix.cholesky() else { return };
                let move_by = -factors.solve(&(gradient - held * held.dot(&gradient)));
                let mut moved = *self;
                moved.n += move_by.fixed_rows::<3>(0);
                moved.mu += move_by.fixed_rows::<3>(3);
                let there = moved.expand(agility, passage, &offset, &cells);
                if there.0 < value {
                    damping *= 0.2;
                    step = Some((moved, there));
                    break;
                }
                damping *= 10.0;
            }
            let Some((moved, there)) = step else { return };
            *self = moved;
            here = there;
        }
    }

    /// Value, gradient and an approximate Hessian of the function, by the midpoints of the cells.
    fn expand(
        &self,
        agility: &Agility,
        passage: &Passage,
        offset: &Vector3<f64>,
        cells: &[Cell],
    ) -> (f64, Vector6, Matrix6) {
        let [v_0, v_1] = passage.velocities;
        let [a, b] = cells.last().map_or([0.0, 1.0], |cell| cell.weights[1]);
        let mut value = self.at([a, b]).dot(&v_0) - self.mu.dot(&v_1) - self.n.dot(offset);
        let mut gradient = stacked(&(v_0 * a - offset), &(v_0 * b - v_1));
        let mut hessian = Matrix6::zeros();
        for cell in cells {
            let h = cell.length;
            let weights: [f64; 2] = std::array::from_fn(|i| 0.5 * (cell.weights[0][i] + cell.weights[1][i]));
            let lambda = self.at(weights);
            let (thrust, slope, curve) = cell.expand(agility, passage, &lambda);
            let norm = lambda.norm().max(1e-9);
            value += h * (thrust + cell.rho * norm - GRAVITY * lambda.z);
            let slope = slope + lambda * (cell.rho / norm) - Vector3::z() * GRAVITY;
            let across = Matrix3::identity() - lambda * lambda.transpose() / (norm * norm);
            let curve = curve + across * (cell.rho / norm);
            gradient += stacked(&(slope * (h * weights[0])), &(slope * (h * weights[1])));
            for (row, wr) in weights.into_iter().enumerate() {
                for (column, wc) in weights.into_iter().enumerate() {
                    let mut block = hessian.fixed_view_mut::<3, 3>(3 * row, 3 * column);
                    block += curve * (h * wr * wc);
                }
            }
        }
        (value, gradient, hessian)
    }
}

fn stacked(a: &Vector3<f64>, b: &Vector3<f64>) -> Vector6 {
    Vector6::new(a.x, a.y, a.z, b.x, b.y, b.z)
}

/// Cells of the grid over the time to go: fine at both ends, where the thrust axis is not free.
const CELLS: [usize; 3] = [12, 20, 12];
/// Share of a half turn's time that the fine cells cover at each end.
const TURNING: f64 = 0.8;

/// The cells over `[0, T_a]`, and `[T_a, T_b]` as the last one.
fn cells(agility: &Agility, speeds: &Speeds, [first, last]: [f64; 2]) -> impl Iterator<Item = Cell> {
    let turning = (TURNING * PI / agility.turn_rate).clamp(0.05 * first, 0.3 * first);
    let breaks = [0.0, turning, first - turning, first];
    let spans = (0..3).flat_map(move |zone| {
        let (from, to, n) = (breaks[zone], breaks[zone + 1], CELLS[zone]);
        let node = move |i: usize| from + (to - from) * i as f64 / n as f64;
        (0..n).map(move |i| ([node(i), node(i + 1)], false))
    });
    let mut weights = [0.0, 1.0];
    spans.chain(std::iter::once(([first, last], true))).map(move |(span, is_last)| {
        let cell = Cell::new(agility, speeds, weights, span, last, is_last);
        weights = cell.weights[1];
        cell
    })
}

/// Linear part of the drag, as a share of what it is at the greatest speed: both parts of `rho` are equal then.
const LINEAR: f64 = 2.0 * (std::f64::consts::SQRT_2 - 1.0);

/// A stretch of the time to go, with drag and cones as loose as anywhere in it.
struct Cell {
    /// How long it is (s).
    length: f64,
    /// Whether it is the last one.
    last: bool,
    /// The weights of `n` and `mu` in `lambda` at both of its ends.
    weights: [[f64; 2]; 2],
    /// What the linear part leaves of the drag (m/s^2).
    rho: f64,
    /// Cosine and sine of the cones' half angles, around the first and the last axis.
    cones: [[f64; 2]; 2],
    /// Weight of the second end in the mean of a chord.
    second: f64,
}

impl Cell {
    fn new(
        agility: &Agility,
        speeds: &Speeds,
        weights: [f64; 2],
        [from, to]: [f64; 2],
        time: f64,
        last: bool,
    ) -> Self {
        let Speed { most, likely } = speeds.within([from, to], time);
        let k = agility.drag;
        // Any line would do. Speeding up, the tangent at the right speed loses nothing; slowing down, drag helps, and the
        // chord is nearest.
        let c = likely.map_or(0.0, |s| 2.0 * k * s).max(LINEAR * k * most);
        let s = if k > 0.0 { (c / (2.0 * k)).min(most) } else { 0.0 };
        let rho = (c * s - k * s * s).max((k * most - c) * most);
        let length = to - from;
        let width = c * length;
        let minus = -(-width).exp_m1();
        let growth = if width < 1e-9 { length } else { minus / c };
        // The mean of (E_a - E)/(E_a - E_b) over the cell: (1 - (1 - exp(-w))/w)/(1 - exp(-w)), by its series for small w.
        let second = if width < 1e-3 { 0.5 + width / 12.0 } else { (1.0 - minus / width) / minus };
        let cone = |free: f64| {
            let angle = agility.turn_rate * free;
            if angle < PI { [angle.cos(), angle.sin()] } else { [-1.0, 0.0] }
        };
        let next = [growth + weights[0] * (1.0 - minus), weights[1] * (1.0 - minus)];
        Self { length, last, weights: [weights, next], rho, cones: [cone(time - from), cone(to)], second }
    }

    /// Bound on the mean over the cell of a convex function with these values at both ends.
    fn chord(&self, [a, b]: [f64; 2]) -> f64 {
        a * (1.0 - self.second) + b * self.second
    }

    /// The greatest `f lambda . e` over thrusts and the axes in one of the cones.
    fn thrust(&self, agility: &Agility, passage: &Passage, end: usize, lambda: &Vector3<f64>) -> f64 {
        let [cos, sin] = self.cones[end];
        let norm = lambda.norm();
        let along = lambda.dot(&passage.axes[end]);
        let reach = if along >= cos * norm {
            norm
        } else {
            along * cos + (norm * norm - along * along).max(0.0).sqrt() * sin
        };
        reach * agility.thrust[usize::from(reach > 0.0)]
    }

    /// Value, gradient and Hessian of the smaller of the two cones' thrusts.
    fn expand(
        &self,
        agility: &Agility,
        passage: &Passage,
        lambda: &Vector3<f64>,
    ) -> (f64, Vector3<f64>, Matrix3) {
        let values = [0, 1].map(|end| self.thrust(agility, passage, end, lambda));
        let end = usize::from(values[1] < values[0]);
        let [cos, sin] = self.cones[end];
        let norm = lambda.norm().max(1e-9);
        let unit = lambda / norm;
        let axis = passage.axes[end];
        let along = lambda.dot(&axis);
        if along >= cos * norm {
            let f = agility.thrust[1];
            let across = Matrix3::identity() - unit * unit.transpose();
            return (f * norm, unit * f, across * (f / norm));
        }
        let f = agility.thrust[usize::from(values[end] > 0.0)];
        let side = lambda - axis * along;
        let length = side.norm().max(1e-9);
        let side = side / length;
        let third = Matrix3::identity() - axis * axis.transpose() - side * side.transpose();
        (values[end], (axis * cos + side * sin) * f, third * (f * sin / length))
    }
}
