//! The two quadcopter models of the reference transitions (`tests/data/transitions.md`) and the transition problem.

use nalgebra::{RealField, SVector};
use traj_opt::{Bounds, Dynamics, Guess, Problem};

pub const GRAVITY: f64 = 9.81;
pub const MASS: f64 = 1.5;
pub const MAX_THRUST: f64 = 29.43;
pub const DRAG: f64 = 0.15;
pub const INERTIA: [f64; 3] = [0.015, 0.015, 0.028];

pub type Vector<const N: usize> = SVector<f64, N>;

fn number<T: RealField + Copy>(v: f64) -> T {
    nalgebra::convert(v)
}

/// Velocity and quaternion rates: state p, v, q in rows 0..10.
fn motion<T: RealField + Copy, const N: usize>(x: &SVector<T, N>, thrust: T, w: [T; 3], out: &mut SVector<T, N>) {
    let v = [x[3], x[4], x[5]];
    let (qw, qx, qy, qz) = (x[6], x[7], x[8], x[9]);
    let two: T = number(2.0);
    let half: T = number(0.5);
    let norm = qw * qw + qx * qx + qy * qy + qz * qz;
    let lift = thrust / (norm * number(MASS));
    let axis = [two * (qx * qz + qw * qy), two * (qy * qz - qw * qx), qw * qw - qx * qx - qy * qy + qz * qz];
    let speed = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + number(1e-12)).sqrt();
    let drag = speed * number(0.5 * DRAG / MASS);
    for i in 0..3 {
        out[i] = v[i];
        out[3 + i] = axis[i] * lift - drag * v[i];
    }
    out[5] -= number(GRAVITY);
    out[6] = half * (-qx * w[0] - qy * w[1] - qz * w[2]);
    out[7] = half * (qw * w[0] + qy * w[2] - qz * w[1]);
    out[8] = half * (qw * w[1] - qx * w[2] + qz * w[0]);
    out[9] = half * (qw * w[2] + qx * w[1] - qy * w[0]);
}

/// Model A: collective thrust and body rates are the controls.
pub struct ThrustRate;

impl Dynamics<10, 4> for ThrustRate {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 10>, u: &SVector<T, 4>) -> SVector<T, 10> {
        let mut out = SVector::repeat(T::zero());
        motion(x, u[0], [u[1], u[2], u[3]], &mut out);
        out
    }

    fn is_autonomous(&self) -> bool {
        true
    }
}

/// Model B: four rotor thrusts are the controls.
pub struct RigidBody;

impl Dynamics<13, 4> for RigidBody {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 13>, f: &SVector<T, 4>) -> SVector<T, 13> {
        let mut out = SVector::repeat(T::zero());
        let w = [x[10], x[11], x[12]];
        motion(x, f[0] + f[1] + f[2] + f[3], w, &mut out);
        let arm: T = number(0.225 / std::f64::consts::SQRT_2);
        let torque = [
            arm * (f[1] + f[2] - f[0] - f[3]),
            arm * (f[1] + f[3] - f[0] - f[2]),
            number::<T>(0.016) * (f[0] + f[1] - f[2] - f[3]),
        ];
        let j = INERTIA.map(number::<T>);
        for i in 0..3 {
            let (a, b) = ((i + 1) % 3, (i + 2) % 3);
            out[10 + i] = (torque[i] - (j[b] - j[a]) * w[a] * w[b]) / j[i];
        }
        out
    }

    fn is_autonomous(&self) -> bool {
        true
    }
}

/// A minimum-time transition between two full states, attitude up to sign.
pub struct Transition<D, const NX: usize> {
    pub dynamics: D,
    pub start: Vector<NX>,
    pub end: Vector<NX>,
    pub bounds: Bounds<NX, 4>,
}

impl<D: Dynamics<NX, 4>, const NX: usize> Problem<NX, 4> for Transition<D, NX> {
    type Dynamics = D;

    fn dynamics(&self) -> &D {
        &self.dynamics
    }

    fn bounds(&self) -> Bounds<NX, 4> {
        self.bounds
    }

    fn mayer<T: RealField + Copy>(&self, _: &SVector<T, NX>, _: &SVector<T, NX>, final_time: T) -> T {
        final_time
    }

    fn is_autonomous(&self) -> bool {
        true
    }

    fn n_boundary(&self) -> usize {
        3
    }

    fn boundary<T: RealField + Copy>(&self, _: &SVector<T, NX>, x: &SVector<T, NX>, _: T, out: &mut [T]) {
        let [tw, tx, ty, tz] = [6, 7, 8, 9].map(|i| number::<T>(self.end[i]));
        let (w, a, b, c) = (x[6], x[7], x[8], x[9]);
        out[0] = tw * a - tx * w - ty * c + tz * b;
        out[1] = tw * b - ty * w - tz * a + tx * c;
        out[2] = tw * c - tz * w - tx * b + ty * a;
    }
}

fn terminal_but_attitude<const NX: usize>(mut bounds: Bounds<NX, 4>, end: &Vector<NX>) -> Bounds<NX, 4> {
    for i in (0..NX).filter(|i| !(6..10).contains(i)) {
        bounds = bounds.with_terminal_component(i, end[i]);
    }
    bounds
}

pub fn thrust_rate(start: &Vector<13>, end: &Vector<13>) -> Transition<ThrustRate, 10> {
    let (start, end) = (start.fixed_rows::<10>(0).into_owned(), end.fixed_rows::<10>(0).into_owned());
    let rates = [6.0, 6.0, 2.0];
    let lower = Vector::from([0.05 * MAX_THRUST, -rates[0], -rates[1], -rates[2]]);
    let upper = Vector::from([MAX_THRUST, rates[0], rates[1], rates[2]]);
    let bounds = Bounds::free().with_control(lower, upper).with_initial_state(start).with_final_time(0.05, 500.0);
    Transition { dynamics: ThrustRate, start, end, bounds: terminal_but_attitude(bounds, &end) }
}

pub fn rigid_body(start: &Vector<13>, end: &Vector<13>) -> Transition<RigidBody, 13> {
    let mut upper = Vector::<13>::repeat(f64::INFINITY);
    (upper[10], upper[11], upper[12]) = (6.0, 6.0, 2.0);
    let rotor = MAX_THRUST / 4.0;
    let bounds = Bounds::free()
        .with_state(-upper, upper)
        .with_control(Vector::repeat(0.05 * rotor), Vector::repeat(rotor))
        .with_initial_state(*start)
        .with_final_time(0.05, 500.0);
    Transition { dynamics: RigidBody, start: *start, end: *end, bounds: terminal_but_attitude(bounds, end) }
}

/// Straight line, level attitude, distance over speed.
pub fn naive_guess<D, const NX: usize>(t: &Transition<D, NX>, hover: Vector<4>) -> Guess<NX, 4> {
    let part = |x: &Vector<NX>, i: usize| Vector::<3>::new(x[i], x[i + 1], x[i + 2]);
    let (p0, p1) = (part(&t.start, 0), part(&t.end, 0));
    let speed = 0.5 * (part(&t.start, 3).norm() + part(&t.end, 3).norm());
    let time = ((p1 - p0).norm() / speed.max(5.0)).max(0.5);
    Guess::from_fn(time, 1, |s| {
        let mut x = Vector::<NX>::zeros();
        x.fixed_rows_mut::<3>(0).copy_from(&(p0 + (p1 - p0) * s));
        x.fixed_rows_mut::<3>(3).copy_from(&((p1 - p0) / time));
        x[6] = 1.0;
        (x, hover)
    })
}

pub fn hover_thrust_rate() -> Vector<4> {
    Vector::from([MASS * GRAVITY, 0.0, 0.0, 0.0])
}

pub fn hover_rigid_body() -> Vector<4> {
    Vector::repeat(MASS * GRAVITY / 4.0)
}

/// One row of the reference data.
pub struct Reference {
    pub id: usize,
    pub start: Vector<13>,
    pub end: Vector<13>,
    pub time_thrust_rate: f64,
    pub time_rigid_body: f64,
}

pub fn references() -> Vec<Reference> {
    let text = include_str!("../data/transitions.csv");
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap_or("").split(',').collect();
    let column = |name: &str| header.iter().position(|h| *h == name).expect("column of the reference data");
    let names = ["px", "py", "pz", "vx", "vy", "vz", "qw", "qx", "qy", "qz", "wx", "wy", "wz"];
    let state = |fields: &[&str], prefix: &str| {
        Vector::<13>::from_fn(|i, _| fields[column(&format!("{prefix}_{}", names[i]))].parse().expect("number"))
    };
    lines
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            Reference {
                id: fields[column("id")].parse().expect("id"),
                start: state(&fields, "start"),
                end: state(&fields, "end"),
                time_thrust_rate: fields[column("tfA_hs80")].parse().expect("number"),
                time_rigid_body: fields[column("tfB_hs80")].parse().expect("number"),
            }
        })
        .collect()
}

/// Differences of position (m), velocity (m/s) and attitude (rad) at the end of a flight.
pub fn miss<const NX: usize>(x: &Vector<NX>, target: &Vector<NX>) -> [f64; 3] {
    let distance = |i: usize| (0..3).map(|j| (x[i + j] - target[i + j]).powi(2)).sum::<f64>().sqrt();
    let (q, t) = (x.fixed_rows::<4>(6).normalize(), target.fixed_rows::<4>(6).normalize());
    let angle = 2.0 * (q - t * q.dot(&t).signum()).norm().min(2.0).mul_add(0.5, 0.0).asin() * 2.0;
    [distance(0), distance(3), angle]
}
