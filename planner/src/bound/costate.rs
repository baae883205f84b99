//! The costate of the bound in `agility.rs`: how it is evaluated, and how a good one is found.

use super::agility::{Agility, Passage};
use super::speeds::{Speed, Speeds};
use nalgebra::{SMatrix, SVector, Vector3};
use quad_dynamics::GRAVITY;
use std::f64::consts::PI;

type Vector6 = SVector<f64, 6>;
type Matrix6 = SMatrix<f64, 6, 6>;
type Matrix3 = SMatrix<f64, 3, 3>;

/// `lambda(0) = mu`, `d lambda/dq = n - C lambda` over the time to go `q`, on a straight line within each cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Costate {
    /// Weight of the position.
    n: Vector3<f64>,
    /// Weight of the last velocity.
    mu: Vector3<f64>,
}

/// What `n` and `mu` weigh in `lambda`.
#[derive(Debug, Clone, Copy)]
struct Weights {
    n: Vector3<f64>,
    mu: Vector3<f64>,
}

impl Costate {
    /// The costate that reverses half-way, in the direction of the offset; `None` if there is no such direction.
    pub(super) fn first(passage: &Passage, time: f64) -> Option<Self> {
        let n = passage.offset(time).try_normalize(1e-9)?;
        let half = 0.5 * time;
        Some(Self { n, mu: (Vector3::z() * 0.3 - n) * half })
    }

    fn at(&self, weights: &Weights) -> Vector3<f64> {
        self.n.component_mul(&weights.n) + self.mu.component_mul(&weights.mu)
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
            let ends = cell.weights.map(|weights| self.at(&weights));
            let a = self.n - (ends[1] - ends[0]) / cell.length;
            let free = ends.map(|lambda| cell.coasting(agility, &a, &lambda).0 - GRAVITY * lambda.z);
            let thrust = (0..2)
                .map(|end| ends.map(|lambda| cell.thrust(agility, passage, end, &lambda)))
                .map(|thrust| [free[0] + thrust[0], free[1] + thrust[1]])
                .min_by(|a, b| (a[0] + a[1]).total_cmp(&(b[0] + b[1])))
                .unwrap_or_default();
            if cell.last {
                most += cell.length * thrust[0].max(thrust[1]).max(0.0);
                starts = ends[0].dot(&v_0).max(ends[1].dot(&v_0));
            } else {
                most += cell.length * 0.5 * (thrust[0] + thrust[1]);
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
        let start = cells.last().map_or(Weights::AT_THE_END, |cell| cell.weights[1]);
        let mut value = self.at(&start).dot(&v_0) - self.mu.dot(&v_1) - self.n.dot(offset);
        let mut gradient =
            stacked(&(v_0.component_mul(&start.n) - offset), &(v_0.component_mul(&start.mu) - v_1));
        let mut hessian = Matrix6::zeros();
        for cell in cells {
            let h = cell.length;
            let weights = cell.middle();
            let lambda = self.at(&weights);
            let (thrust, slope, curve) = cell.expand(agility, passage, &lambda);
            let norm = lambda.norm().max(1e-9);
            let (coasting, velocity) = cell.coasting(agility, &cell.linear.component_mul(&lambda), &lambda);
            value += h * (thrust + coasting - GRAVITY * lambda.z);
            let drag = velocity.component_mul(&cell.linear) - velocity * (agility.drag * velocity.norm());
            let slope = slope + drag - Vector3::z() * GRAVITY;
            let across = Matrix3::identity() - lambda * lambda.transpose() / (norm * norm);
            let curve = (curve + across * (coasting / (norm * norm))) * h;
            let both = [weights.n, weights.mu];
            gradient += stacked(&(slope.component_mul(&both[0]) * h), &(slope.component_mul(&both[1]) * h));
            for (row, wr) in both.iter().enumerate() {
                for (column, wc) in both.iter().enumerate() {
                    let mut block = hessian.fixed_view_mut::<3, 3>(3 * row, 3 * column);
                    block += curve.component_mul(&(wr * wc.transpose()));
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
    let mut weights = Weights::AT_THE_END;
    spans.chain(std::iter::once(([first, last], true))).map(move |(span, is_last)| {
        let cell = Cell::new(agility, speeds, weights, span, last, is_last);
        weights = cell.weights[1];
        cell
    })
}

/// `C` while slowing down, as a share of `k` times the greatest speed `V`: `c = LINEAR k V` makes the greatest
/// `c s - k s^2` of a speed `s` along `lambda` equal to the `(k V - c) V` of the greatest against it.
const LINEAR: f64 = 2.0 * (std::f64::consts::SQRT_2 - 1.0);

/// A stretch of the time to go, with speeds and cones as loose as anywhere in it.
struct Cell {
    /// How long it is (s).
    length: f64,
    /// Whether it is the last one.
    last: bool,
    /// `lambda` at both of its ends.
    weights: [Weights; 2],
    /// Diagonal of `C`, by which `lambda` was chosen (1/s).
    linear: Vector3<f64>,
    /// The greatest speed (m/s).
    speed: f64,
    /// Cosine and sine of the cones' half angles, around the first and the last axis.
    cones: [[f64; 2]; 2],
}

impl Weights {
    /// `lambda(0) = mu`.
    const AT_THE_END: Self = Self { n: Vector3::new(0.0, 0.0, 0.0), mu: Vector3::new(1.0, 1.0, 1.0) };

    /// After `length` more of the time to go under `d lambda/dq = n - C lambda`.
    fn after(&self, linear: &Vector3<f64>, length: f64) -> Self {
        let left = linear.map(|c| (-c * length).exp());
        let growth = linear.map(|c| if c * length < 1e-9 { length } else { -(-c * length).exp_m1() / c });
        Self { n: self.n.component_mul(&left) + growth, mu: self.mu.component_mul(&left) }
    }
}

impl Cell {
    fn new(
        agility: &Agility,
        speeds: &Speeds,
        weights: Weights,
        [from, to]: [f64; 2],
        time: f64,
        last: bool,
    ) -> Self {
        let Speed { most, likely } = speeds.within([from, to], time);
        let k = agility.drag;
        // Any C would do. In a flight at speed s along the horizontal, the gradient of the drag k|v|v, 2 k s along it and k s
        // across it, loses nothing; slowing down, drag helps, and its chord is nearest.
        let chord = LINEAR * k * most;
        let [along, across] = likely.map_or([chord; 2], |s| [2.0, 1.0].map(|share| chord.max(share * k * s)));
        let linear = Vector3::new(along, along, across);
        let cone = |free: f64| {
            let angle = agility.turn_rate * free;
            if angle < PI { [angle.cos(), angle.sin()] } else { [-1.0, 0.0] }
        };
        let length = to - from;
        let weights = [weights, weights.after(&linear, length)];
        Self { length, last, weights, linear, speed: most, cones: [cone(time - from), cone(to)] }
    }

    /// About half-way.
    fn middle(&self) -> Weights {
        let [a, b] = &self.weights;
        Weights { n: (a.n + b.n) * 0.5, mu: (a.mu + b.mu) * 0.5 }
    }

    /// The greatest `a . v - k |v| lambda . v` over velocities up to the greatest speed, and where it is.
    fn coasting(&self, agility: &Agility, a: &Vector3<f64>, lambda: &Vector3<f64>) -> (f64, Vector3<f64>) {
        let k = agility.drag;
        if k <= 0.0 {
            return (0.0, Vector3::zeros());
        }
        // At the speed r it is r |a - k r lambda|, greatest at the first root of its derivative or at the greatest speed.
        let at = |r: f64| {
            let across = a - lambda * (k * r);
            (r * across.norm(), across, r)
        };
        let (aa, ab, bb) = (a.norm_squared(), k * a.dot(lambda), k * k * lambda.norm_squared());
        let discriminant = 9.0 * ab * ab - 8.0 * aa * bb;
        let fastest = at(self.speed);
        let root = 2.0 * aa / (3.0 * ab + discriminant.max(0.0).sqrt());
        let best = if discriminant >= 0.0 && ab > 0.0 && root < self.speed {
            let slower = at(root);
            if slower.0 > fastest.0 { slower } else { fastest }
        } else {
            fastest
        };
        let (value, across, r) = best;
        (value, across.try_normalize(0.0).map_or(Vector3::zeros(), |direction| direction * r))
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
