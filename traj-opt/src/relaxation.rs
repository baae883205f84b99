//! Certified lower bounds on minimum time from a convex relaxation.
//!
//! A point mass moves from `(p0, v0)` to `(pf, vf)` with `|a - bias| <= A` and `|v| <= V` at all times. Cut any such motion of
//! duration T into n intervals of length `h = T/n`. Whatever the motion does inside them, with `d` the displacement of an interval,
//! `v`, `w` the velocities at its ends and `b = a - bias`:
//!
//! ```text
//! |w - v - h bias| <= A h                 since the mean of b lies in the ball (convexity)
//! |v|, |w| <= V,  |d| <= V h              since the mean of v lies in the ball
//! |d - h (v + w)/2| <= A h^2/4            since d - h (v + w)/2 = integral of (h/2 - s) b(s) ds (the constant bias drops out) and
//!                                         the integral of |h/2 - s| over the interval is h^2/4
//! ```
//!
//! So the motion's samples satisfy these inequalities, without any error of discretisation. The last is not convex in h, therefore
//! h is enclosed, `h1 <= h <= h2`, and the inequalities are weakened to hold for every such h:
//!
//! ```text
//! |w - v - h1 bias| <= A h2 + (h2 - h1) |bias|,   |d| <= V h2,   |d - h1 (v + w)/2| <= A h2^2/4 + (h2 - h1) V
//! ```
//!
//! If this second-order cone program is infeasible, no motion has a duration between `n h1` and `n h2`. Enclosures are refuted
//! one after the other from zero upwards; where that stops is the bound. No refutation is taken on trust: the solver's dual vector is
//! projected onto the cones and must separate by more than its own error over a box that contains every feasible point
//! (S. Boyd, L. Vandenberghe, *Convex Optimization*, 2004, section 5.8; the rounding of the check itself is covered by a margin).

use crate::Error;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SupportedConeT};

/// A point mass with a ball of accelerations and a speed limit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PointMass {
    /// Start position, m.
    pub start: [f64; 3],
    /// Start velocity, m/s.
    pub start_velocity: [f64; 3],
    /// End position, m.
    pub end: [f64; 3],
    /// End velocity, m/s.
    pub end_velocity: [f64; 3],
    /// Greatest distance of the acceleration from `bias`, m/s^2; positive.
    pub acceleration: f64,
    /// Centre of the ball of accelerations, m/s^2 (gravity, for a thrust of limited norm).
    pub bias: [f64; 3],
    /// Greatest speed, m/s; positive and finite, not below the speeds at the ends.
    pub speed: f64,
}

/// Settings of [`least_time_bound`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct BoundOptions {
    /// Intervals, at most 1000. Default 20. The gap of the relaxation falls with their square.
    pub n_intervals: usize,
    /// Relative width of the enclosures of the duration. Default 0.01. The bound is lower by about as much.
    pub resolution: f64,
    /// Most enclosures. Default 2000.
    pub max_enclosures: usize,
}

impl Default for BoundOptions {
    fn default() -> Self {
        Self { n_intervals: 20, resolution: 0.01, max_enclosures: 2000 }
    }
}

impl BoundOptions {
    /// Sets [`n_intervals`](Self::n_intervals).
    #[must_use]
    pub fn with_n_intervals(mut self, n: usize) -> Self {
        self.n_intervals = n;
        self
    }

    /// Sets [`resolution`](Self::resolution).
    #[must_use]
    pub fn with_resolution(mut self, resolution: f64) -> Self {
        self.resolution = resolution;
        self
    }
}

/// A duration that no motion of the point mass can be shorter than, s.
///
/// # Errors
/// [`Error::InvalidOption`] if a number of the problem or an option is out of range.
///
/// # Guarantee
/// Every motion has at least this duration, also in continuous time, for any vehicle whose accelerations and speeds obey the
/// limits. The bound is not claimed to be attained.
///
/// # Examples
/// ```
/// use traj_opt::{BoundOptions, PointMass, least_time_bound};
///
/// let mass = PointMass { start: [0.0; 3], start_velocity: [0.0; 3], end: [4.0, 0.0, 0.0], end_velocity: [0.0; 3],
///     acceleration: 1.0, bias: [0.0; 3], speed: 10.0 };
/// let bound = least_time_bound(&mass, &BoundOptions::default())?;
/// assert!(bound <= 4.0 && bound > 3.7); // exactly 2 sqrt(d/a) = 4
/// # Ok::<(), traj_opt::Error>(())
/// ```
pub fn least_time_bound(mass: &PointMass, options: &BoundOptions) -> Result<f64, Error> {
    validate(mass, options)?;
    let distance = norm(difference(mass.end, mass.start));
    let turn = norm(difference(mass.end_velocity, mass.start_velocity));
    // elementary: the mean speed, and the mean acceleration
    let mut bound = (distance / mass.speed).max(turn / (mass.acceleration + norm(mass.bias)));
    if bound == 0.0 {
        return Ok(0.0);
    }
    for _ in 0..options.max_enclosures {
        let upper = bound * (1.0 + options.resolution);
        if !refuted(mass, options.n_intervals, bound, upper) {
            break;
        }
        bound = upper;
    }
    Ok(bound)
}

fn validate(mass: &PointMass, options: &BoundOptions) -> Result<(), Error> {
    let refuse = |option, value| Err(Error::InvalidOption { option, value });
    for v in [mass.start, mass.start_velocity, mass.end, mass.end_velocity, mass.bias].concat() {
        if !v.is_finite() {
            return refuse("point mass", v);
        }
    }
    let fastest = norm(mass.start_velocity).max(norm(mass.end_velocity));
    if !(mass.speed > 0.0 && mass.speed.is_finite() && fastest <= mass.speed) {
        return refuse("speed", mass.speed);
    }
    if !(mass.acceleration > 0.0 && mass.acceleration.is_finite()) {
        return refuse("acceleration", mass.acceleration);
    }
    if !(options.resolution > 0.0 && options.resolution <= 1.0) {
        return refuse("resolution", options.resolution);
    }
    if !(1..=1000).contains(&options.n_intervals) {
        return refuse("n_intervals", options.n_intervals as f64);
    }
    Ok(())
}

/// Rows of `A x + s = b`, `s` in a product of second-order cones of dimension 4, by triplets.
#[derive(Default)]
struct Cones {
    rows: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
    b: Vec<f64>,
}

impl Cones {
    /// `|terms - target| <= radius` with terms `(first column of a vector, factor)`.
    fn ball(&mut self, terms: &[(usize, f64)], target: [f64; 3], radius: f64) {
        let first = self.b.len();
        self.b.push(radius);
        for axis in 0..3 {
            self.b.push(-target[axis]);
            for &(column, factor) in terms {
                self.rows.push(first + 1 + axis);
                self.columns.push(column + axis);
                self.values.push(-factor);
            }
        }
    }
}

/// The relaxation for durations between `lower` and `upper`. Variables: velocities at the knots, then displacements, the latter
/// in units of `V h2` and the former of V, so that all lie in the unit ball.
fn relaxation(mass: &PointMass, n: usize, lower: f64, upper: f64) -> Cones {
    let (h1, h2) = (lower / n as f64, upper / n as f64);
    let (v, d) = (mass.speed, mass.speed * h2);
    let mut cones = Cones::default();
    let velocity = |k: usize| 3 * k;
    let displacement = |k: usize| 3 * (n + 1 + k);
    for k in 0..n {
        let turn = mass.acceleration * h2 + (h2 - h1) * norm(mass.bias);
        cones.ball(&[(velocity(k + 1), 1.0), (velocity(k), -1.0)], mass.bias.map(|b| b * h1 / v), turn / v);
        let moment = mass.acceleration * h2 * h2 / 4.0 + (h2 - h1) * v;
        let mean = -0.5 * h1 / h2;
        cones.ball(
            &[(displacement(k), 1.0), (velocity(k), mean), (velocity(k + 1), mean)],
            [0.0; 3],
            moment / d,
        );
        cones.ball(&[(displacement(k), 1.0)], [0.0; 3], 1.0);
    }
    for k in 1..n {
        cones.ball(&[(velocity(k), 1.0)], [0.0; 3], 1.0);
    }
    cones.ball(&[(velocity(0), 1.0)], mass.start_velocity.map(|c| c / v), 0.0);
    cones.ball(&[(velocity(n), 1.0)], mass.end_velocity.map(|c| c / v), 0.0);
    let all: Vec<(usize, f64)> = (0..n).map(|k| (displacement(k), 1.0)).collect();
    cones.ball(&all, difference(mass.end, mass.start).map(|c| c / d), 0.0);
    cones
}

/// Slack that every radius is given before the refutation: covers the rounding of data, products and sums of the check, which
/// are some thousand operations on numbers of order one at 1e-16 each.
const MARGIN: f64 = 1e-9;

/// True if it is proved that no duration in the range is possible.
fn refuted(mass: &PointMass, n: usize, lower: f64, upper: f64) -> bool {
    let mut cones = relaxation(mass, n, lower, upper);
    for radius in cones.b.iter_mut().step_by(4) {
        *radius += MARGIN;
    }
    let n_variables = 3 * (2 * n + 1);
    let a = CscMatrix::new_from_triplets(
        cones.b.len(),
        n_variables,
        cones.rows.clone(),
        cones.columns.clone(),
        cones.values.clone(),
    );
    let settings = DefaultSettings { verbose: false, max_iter: 100, ..DefaultSettings::default() };
    let shapes = vec![SupportedConeT::SecondOrderConeT(4); cones.b.len() / 4];
    let p = CscMatrix::zeros((n_variables, n_variables));
    let Ok(mut solver) = DefaultSolver::new(&p, &vec![0.0; n_variables], &a, &cones.b, &shapes, settings)
    else {
        return false;
    };
    solver.solve();
    separates(&cones, n_variables, &solver.solution.z)
}

/// True if `z`, moved into the dual cones, proves infeasibility: any feasible x has `|x_i| <= 1` up to the margin and
/// `0 <= z' s = z' b - (A' z)' x`, which fails if `z' b + |A' z|_1 < 0`.
fn separates(cones: &Cones, n_variables: usize, z: &[f64]) -> bool {
    let size = z.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    if !(size > 0.0 && size.is_finite()) {
        return false;
    }
    let mut z: Vec<f64> = z.iter().map(|v| v / size).collect();
    for cone in z.chunks_exact_mut(4) {
        cone[0] = cone[0].max(norm([cone[1], cone[2], cone[3]]) * (1.0 + 1e-15));
    }
    let mut columns = vec![0.0; n_variables];
    for ((&row, &column), value) in cones.rows.iter().zip(&cones.columns).zip(&cones.values) {
        columns[column] += z[row] * value;
    }
    let error: f64 = columns.iter().map(|v| v.abs()).sum();
    let value: f64 = z.iter().zip(&cones.b).map(|(z, b)| z * b).sum();
    let magnitude: f64 = z.iter().zip(&cones.b).map(|(z, b)| z.abs() * (1.0 + b.abs())).sum();
    // every radius carries the margin, so a separation of this much is more than rounding
    value + error * (1.0 + 2.0 * MARGIN) < -1e-12 * magnitude
}

fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn norm(v: [f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}
