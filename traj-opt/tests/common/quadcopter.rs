//! The two quadcopter models of the reference transitions (`tests/data/transitions.md`) and the transition problem.

use nalgebra::{RealField, SVector};
use traj_opt::{Bounds, Dynamics, Guess, Hessian, Jacobian, Problem};

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
fn motion<T: RealField + Copy, const N: usize>(
    x: &SVector<T, N>,
    thrust: T,
    w: [T; 3],
    out: &mut SVector<T, N>,
) {
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

/// Derivatives of [`motion`] in closed form: the same for both models.
mod closed_form {
    use super::{DRAG, GRAVITY, MASS};
    use nalgebra::{Matrix4, SMatrix, SVector, Vector3, Vector4};

    /// `q' M q / |q|^2` is the component of the body's z axis along `weight`.
    fn axis_form(weight: &Vector3<f64>) -> Matrix4<f64> {
        let (x, y, z) = (weight[0], weight[1], weight[2]);
        Matrix4::new(z, -y, x, 0.0, -y, -z, 0.0, x, x, 0.0, -z, y, 0.0, x, y, z)
    }

    fn speed(v: &Vector3<f64>) -> f64 {
        (v.norm_squared() + 1e-12).sqrt()
    }

    /// Value and gradient of the component of the body's z axis along `weight`.
    fn axis_component(q: &Vector4<f64>, form: &Matrix4<f64>) -> (f64, Vector4<f64>) {
        let n = q.norm_squared();
        let fq = form * q;
        let value = q.dot(&fq) / n;
        (value, (fq - q * value) * (2.0 / n))
    }

    /// Quaternion rate is `1/2 rates(q) w`.
    pub fn rates(q: &Vector4<f64>) -> SMatrix<f64, 4, 3> {
        let (w, x, y, z) = (q[0], q[1], q[2], q[3]);
        SMatrix::<f64, 4, 3>::new(-x, -y, -z, w, -z, y, z, w, -x, -y, x, w)
    }

    pub struct First {
        pub acceleration: Vector3<f64>,
        pub by_velocity: SMatrix<f64, 3, 3>,
        pub by_attitude: SMatrix<f64, 3, 4>,
        /// The body's z axis over the mass.
        pub by_thrust: Vector3<f64>,
        pub rate_by_attitude: Matrix4<f64>,
        pub rate_by_rates: SMatrix<f64, 4, 3>,
    }

    pub fn first<const N: usize>(x: &SVector<f64, N>, thrust: f64, w: [f64; 3]) -> First {
        let v = Vector3::new(x[3], x[4], x[5]);
        let q = Vector4::new(x[6], x[7], x[8], x[9]);
        let k = 0.5 * DRAG / MASS;
        let s = speed(&v);
        let mut by_attitude = SMatrix::<f64, 3, 4>::zeros();
        let mut by_thrust = Vector3::zeros();
        for i in 0..3 {
            let (value, gradient) = axis_component(&q, &axis_form(&Vector3::ith(i, 1.0)));
            by_attitude.set_row(i, &(gradient * (thrust / MASS)).transpose());
            by_thrust[i] = value / MASS;
        }
        let [a, b, c] = w.map(|r| 0.5 * r);
        First {
            acceleration: by_thrust * thrust - v * (k * s) - Vector3::z() * GRAVITY,
            by_velocity: (SMatrix::identity() * s + v * v.transpose() / s) * -k,
            by_attitude,
            by_thrust,
            rate_by_attitude: Matrix4::new(0.0, -a, -b, -c, a, 0.0, c, -b, b, -c, 0.0, a, c, b, -a, 0.0),
            rate_by_rates: rates(&q) * 0.5,
        }
    }

    pub struct Second {
        pub velocity: SMatrix<f64, 3, 3>,
        pub attitude: Matrix4<f64>,
        pub attitude_thrust: Vector4<f64>,
        pub attitude_rates: SMatrix<f64, 4, 3>,
    }

    pub fn second<const N: usize>(x: &SVector<f64, N>, thrust: f64, weight: &SVector<f64, N>) -> Second {
        let v = Vector3::new(x[3], x[4], x[5]);
        let q = Vector4::new(x[6], x[7], x[8], x[9]);
        let wv = Vector3::new(weight[3], weight[4], weight[5]);
        let (s, wq) = (speed(&v), [weight[6], weight[7], weight[8], weight[9]].map(|l| 0.5 * l));
        let along = wv.dot(&v) / s;
        let mixed = wv * v.transpose() / s;
        let velocity = (mixed + mixed.transpose() + SMatrix::identity() * along
            - v * v.transpose() * (along / (s * s)))
            * (-0.5 * DRAG / MASS);
        let form = axis_form(&wv);
        let (value, gradient) = axis_component(&q, &form);
        let outer = q * gradient.transpose();
        let n = q.norm_squared();
        let attitude =
            (form - Matrix4::identity() * value - outer - outer.transpose()) * (2.0 / n * thrust / MASS);
        let attitude_rates = SMatrix::<f64, 4, 3>::new(
            wq[1], wq[2], wq[3], -wq[0], wq[3], -wq[2], -wq[3], -wq[0], wq[1], wq[2], -wq[1], -wq[0],
        );
        Second { velocity, attitude, attitude_thrust: gradient / MASS, attitude_rates }
    }
}

fn fill_state_jacobian<const N: usize>(first: &closed_form::First, out: &mut nalgebra::SMatrix<f64, N, N>) {
    for i in 0..3 {
        out[(i, 3 + i)] = 1.0;
    }
    out.fixed_view_mut::<3, 3>(3, 3).copy_from(&first.by_velocity);
    out.fixed_view_mut::<3, 4>(3, 6).copy_from(&first.by_attitude);
    out.fixed_view_mut::<4, 4>(6, 6).copy_from(&first.rate_by_attitude);
}

/// Model A: collective thrust and body rates are the controls.
pub struct ThrustRate;

impl Dynamics<10, 4> for ThrustRate {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 10>, u: &SVector<T, 4>) -> SVector<T, 10> {
        let mut out = SVector::repeat(T::zero());
        motion(x, u[0], [u[1], u[2], u[3]], &mut out);
        out
    }

    fn jacobian(&self, t: f64, x: &SVector<f64, 10>, u: &SVector<f64, 4>) -> Jacobian<10, 4> {
        let first = closed_form::first(x, u[0], [u[1], u[2], u[3]]);
        let mut state = nalgebra::SMatrix::<f64, 10, 10>::zeros();
        let mut control = nalgebra::SMatrix::<f64, 10, 4>::zeros();
        fill_state_jacobian(&first, &mut state);
        control.fixed_view_mut::<3, 1>(3, 0).copy_from(&first.by_thrust);
        control.fixed_view_mut::<4, 3>(6, 1).copy_from(&first.rate_by_rates);
        Jacobian { value: self.derivative(t, x, u), state, control, time: SVector::zeros() }
    }

    fn hessian(
        &self,
        _: f64,
        x: &SVector<f64, 10>,
        u: &SVector<f64, 4>,
        weight: &SVector<f64, 10>,
    ) -> Hessian<10, 4> {
        let second = closed_form::second(x, u[0], weight);
        let mut out = Hessian::<10, 4>::zeros();
        out.state_state.fixed_view_mut::<3, 3>(3, 3).copy_from(&second.velocity);
        out.state_state.fixed_view_mut::<4, 4>(6, 6).copy_from(&second.attitude);
        out.state_control.fixed_view_mut::<4, 1>(6, 0).copy_from(&second.attitude_thrust);
        out.state_control.fixed_view_mut::<4, 3>(6, 1).copy_from(&second.attitude_rates);
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

    fn jacobian(&self, t: f64, x: &SVector<f64, 13>, f: &SVector<f64, 4>) -> Jacobian<13, 4> {
        let w = [x[10], x[11], x[12]];
        let first = closed_form::first(x, f.sum(), w);
        let mut state = nalgebra::SMatrix::<f64, 13, 13>::zeros();
        let mut control = nalgebra::SMatrix::<f64, 13, 4>::zeros();
        fill_state_jacobian(&first, &mut state);
        state.fixed_view_mut::<4, 3>(6, 10).copy_from(&first.rate_by_rates);
        let arm = 0.225 / std::f64::consts::SQRT_2;
        let lever = [[-arm, arm, arm, -arm], [-arm, arm, -arm, arm], [0.016, 0.016, -0.016, -0.016]];
        for i in 0..3 {
            let (a, b) = ((i + 1) % 3, (i + 2) % 3);
            let gyro = (INERTIA[b] - INERTIA[a]) / INERTIA[i];
            state[(10 + i, 10 + a)] = -gyro * w[b];
            state[(10 + i, 10 + b)] = -gyro * w[a];
            for rotor in 0..4 {
                control[(3 + i, rotor)] = first.by_thrust[i];
                control[(10 + i, rotor)] = lever[i][rotor] / INERTIA[i];
            }
        }
        Jacobian { value: self.derivative(t, x, f), state, control, time: SVector::zeros() }
    }

    fn hessian(
        &self,
        _: f64,
        x: &SVector<f64, 13>,
        f: &SVector<f64, 4>,
        weight: &SVector<f64, 13>,
    ) -> Hessian<13, 4> {
        let second = closed_form::second(x, f.sum(), weight);
        let mut out = Hessian::<13, 4>::zeros();
        out.state_state.fixed_view_mut::<3, 3>(3, 3).copy_from(&second.velocity);
        out.state_state.fixed_view_mut::<4, 4>(6, 6).copy_from(&second.attitude);
        out.state_state.fixed_view_mut::<4, 3>(6, 10).copy_from(&second.attitude_rates);
        out.state_state.fixed_view_mut::<3, 4>(10, 6).copy_from(&second.attitude_rates.transpose());
        for i in 0..3 {
            let (a, b) = ((i + 1) % 3, (i + 2) % 3);
            let gyro = -weight[10 + i] * (INERTIA[b] - INERTIA[a]) / INERTIA[i];
            out.state_state[(10 + a, 10 + b)] = gyro;
            out.state_state[(10 + b, 10 + a)] = gyro;
        }
        for rotor in 0..4 {
            out.state_control.fixed_view_mut::<4, 1>(6, rotor).copy_from(&second.attitude_thrust);
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
    let bounds =
        Bounds::free().with_control(lower, upper).with_initial_state(start).with_final_time(0.05, 500.0);
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

/// A cubic through both end states, as fast as thrust allows, with the attitude that its acceleration and drag ask for.
pub fn cubic_guess<D, const NX: usize>(t: &Transition<D, NX>) -> Guess<NX, 4> {
    let mut low = 0.05;
    let mut high = 1.0;
    while peak_thrust(t, high) > THRUST_OF_GUESS * MAX_THRUST && high < 400.0 {
        low = high;
        high *= 2.0;
    }
    for _ in 0..12 {
        let middle = 0.5 * (low + high);
        if peak_thrust(t, middle) > THRUST_OF_GUESS * MAX_THRUST {
            low = middle;
        } else {
            high = middle;
        }
    }
    let n = 24;
    let mut fractions = vec![];
    let (mut states, mut controls) = (Vec::<Vector<NX>>::new(), vec![]);
    let mut previous = t.start.fixed_rows::<4>(6).into_owned();
    for k in 0..=n {
        let s = k as f64 / n as f64;
        let (p, v, force) = cubic(t, high, s);
        let mut x = t.start * (1.0 - s) + t.end * s;
        x.fixed_rows_mut::<3>(0).copy_from(&p);
        x.fixed_rows_mut::<3>(3).copy_from(&v);
        let blend = if k == 0 { previous } else { least_turn(&previous, &force.normalize()) };
        previous = blend;
        x.fixed_rows_mut::<4>(6).copy_from(&blend);
        let mut u = if NX == 13 { Vector::<4>::repeat(force.norm() / 4.0) } else { Vector::zeros() };
        if NX == 10 {
            u[0] = force.norm();
        }
        fractions.push(s);
        states.push(x);
        controls.push(u);
    }
    Guess::from_samples(high, fractions, states, controls).expect("equal lengths")
}

const THRUST_OF_GUESS: f64 = 0.95;

/// Position, velocity and thrust vector of the cubic at a fraction of its duration.
fn cubic<D, const NX: usize>(t: &Transition<D, NX>, time: f64, s: f64) -> (Vector<3>, Vector<3>, Vector<3>) {
    let part = |x: &Vector<NX>, i: usize| Vector::<3>::new(x[i], x[i + 1], x[i + 2]);
    let (p0, p1) = (part(&t.start, 0), part(&t.end, 0));
    let (m0, m1) = (part(&t.start, 3) * time, part(&t.end, 3) * time);
    let (c2, c3) = ((p1 - p0) * 3.0 - m0 * 2.0 - m1, (p0 - p1) * 2.0 + m0 + m1);
    let p = p0 + m0 * s + c2 * (s * s) + c3 * (s * s * s);
    let v = (m0 + c2 * (2.0 * s) + c3 * (3.0 * s * s)) / time;
    let a = (c2 * 2.0 + c3 * (6.0 * s)) / (time * time);
    let force = (a + Vector::<3>::z() * GRAVITY) * MASS + v * (0.5 * DRAG * v.norm());
    (p, v, force)
}

fn peak_thrust<D, const NX: usize>(t: &Transition<D, NX>, time: f64) -> f64 {
    (0..=8).map(|k| cubic(t, time, k as f64 / 8.0).2.norm()).fold(0.0, f64::max)
}

/// Turns the attitude `q` by the least angle that brings its z axis to `axis`.
fn least_turn(q: &Vector<4>, axis: &Vector<3>) -> Vector<4> {
    let q = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]));
    let from = q * Vector::<3>::z();
    let turn = nalgebra::UnitQuaternion::rotation_between(&from, axis)
        .unwrap_or_else(nalgebra::UnitQuaternion::identity);
    let out = turn * q;
    Vector::<4>::new(out.w, out.i, out.j, out.k)
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
    pub centre: Vector<3>,
}

pub fn references() -> Vec<Reference> {
    let text = include_str!("../data/transitions.csv");
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap_or("").split(',').collect();
    let column = |name: &str| header.iter().position(|h| *h == name).expect("column of the reference data");
    let names = ["px", "py", "pz", "vx", "vy", "vz", "qw", "qx", "qy", "qz", "wx", "wy", "wz"];
    let state = |fields: &[&str], prefix: &str| {
        Vector::<13>::from_fn(|i, _| {
            fields[column(&format!("{prefix}_{}", names[i]))].parse().expect("number")
        })
    };
    lines
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            Reference {
                id: fields[column("id")].parse().expect("id"),
                start: state(&fields, "start"),
                end: state(&fields, "end"),
                time_thrust_rate: fields[column("tfA_hs80")].parse().expect("number"),
                centre: Vector::<3>::from_fn(|i, _| {
                    fields[column(["c1x", "c1y", "c1z"][i])].parse().expect("number")
                }),
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
