//! The minimum-time problem of one transition, and guesses for it.

use nalgebra::{Quaternion, RealField, SVector, UnitQuaternion, Vector3};
use planner::quad_dynamics::{RigidBody, ThrustRate, Vehicle};
use traj_opt::{Bounds, Dynamics, Guess, Hessian, IntegrateOptions, Jacobian, Problem, Solution};

/// Lets `traj-opt` see a model of `quad-dynamics`.
macro_rules! dynamics {
    ($name:ident, $model:ty, $nx:literal) => {
        pub struct $name(pub $model);

        impl Dynamics<$nx, 4> for $name {
            fn derivative<T: RealField + Copy>(
                &self,
                _: T,
                x: &SVector<T, $nx>,
                u: &SVector<T, 4>,
            ) -> SVector<T, $nx> {
                self.0.derivative(x, u)
            }

            fn is_autonomous(&self) -> bool {
                true
            }

            fn jacobian(&self, _: f64, x: &SVector<f64, $nx>, u: &SVector<f64, 4>) -> Jacobian<$nx, 4> {
                let found = self.0.jacobian(x, u);
                let (value, state, control) = (found.value, found.state, found.control);
                Jacobian { value, state, control, time: SVector::zeros() }
            }

            fn hessian(
                &self,
                _: f64,
                x: &SVector<f64, $nx>,
                u: &SVector<f64, 4>,
                weight: &SVector<f64, $nx>,
            ) -> Hessian<$nx, 4> {
                let found = self.0.hessian(x, u, weight);
                let (state_state, state_control) = (found.state_state, found.state_control);
                Hessian { state_state, state_control, ..Hessian::zeros() }
            }
        }
    };
}

dynamics!(Rates, ThrustRate, 10);
dynamics!(Rotors, RigidBody, 13);

/// One transition of either model.
pub struct Transition<'a, D, const NX: usize> {
    pub dynamics: &'a D,
    pub start: SVector<f64, NX>,
    pub end: SVector<f64, NX>,
    pub bounds: Bounds<NX, 4>,
    pub hover: SVector<f64, 4>,
    pub vehicle: &'a Vehicle,
}

impl<D: Dynamics<NX, 4>, const NX: usize> Problem<NX, 4> for Transition<'_, D, NX> {
    type Dynamics = D;

    fn dynamics(&self) -> &D {
        self.dynamics
    }

    fn bounds(&self) -> Bounds<NX, 4> {
        let mut bounds = self.bounds.with_initial_state(self.start).with_final_time(0.05, 500.0);
        for i in (0..NX).filter(|i| !(6..10).contains(i)) {
            bounds = bounds.with_terminal_component(i, self.end[i]);
        }
        bounds
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

    /// The vector part of the rotation from the wanted attitude: three equations, not four, and blind to the sign.
    fn boundary<T: RealField + Copy>(&self, _: &SVector<T, NX>, x: &SVector<T, NX>, _: T, out: &mut [T]) {
        let [tw, tx, ty, tz] = [6, 7, 8, 9].map(|i| nalgebra::convert::<f64, T>(self.end[i]));
        let (w, a, b, c) = (x[6], x[7], x[8], x[9]);
        out[0] = tw * a - tx * w - ty * c + tz * b;
        out[1] = tw * b - ty * w - tz * a + tx * c;
        out[2] = tw * c - tz * w - tx * b + ty * a;
    }
}

pub fn part<const NX: usize>(x: &SVector<f64, NX>, i: usize) -> Vector3<f64> {
    Vector3::new(x[i], x[i + 1], x[i + 2])
}

pub fn attitude<const NX: usize>(x: &SVector<f64, NX>) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(Quaternion::new(x[6], x[7], x[8], x[9]))
}

impl<D: Dynamics<NX, 4>, const NX: usize> Transition<'_, D, NX> {
    /// Straight line, level attitude, distance over speed.
    pub fn naive(&self) -> Guess<NX, 4> {
        let (p0, p1) = (part(&self.start, 0), part(&self.end, 0));
        let speed = 0.5 * (part(&self.start, 3).norm() + part(&self.end, 3).norm());
        let time = ((p1 - p0).norm() / speed.max(5.0)).max(0.5);
        Guess::from_fn(time, 1, |s| {
            let mut x = SVector::<f64, NX>::zeros();
            x.fixed_rows_mut::<3>(0).copy_from(&(p0 + (p1 - p0) * s));
            x.fixed_rows_mut::<3>(3).copy_from(&((p1 - p0) / time));
            x[6] = 1.0;
            (x, self.hover)
        })
    }

    /// Position, velocity and thrust vector of the cubic through both ends at a fraction of its duration.
    fn cubic(&self, time: f64, s: f64) -> (Vector3<f64>, Vector3<f64>, Vector3<f64>) {
        let (p0, p1) = (part(&self.start, 0), part(&self.end, 0));
        let (m0, m1) = (part(&self.start, 3) * time, part(&self.end, 3) * time);
        let (c2, c3) = ((p1 - p0) * 3.0 - m0 * 2.0 - m1, (p0 - p1) * 2.0 + m0 + m1);
        let v = (m0 + c2 * (2.0 * s) + c3 * (3.0 * s * s)) / time;
        let a = (c2 * 2.0 + c3 * (6.0 * s)) / (time * time);
        let drag = v * (0.5 * self.vehicle.drag_coefficient() * v.norm());
        let force = a * self.vehicle.mass() + Vector3::z() * self.vehicle.weight() + drag;
        (p0 + m0 * s + c2 * (s * s) + c3 * (s * s * s), v, force)
    }

    /// That cubic, `stretch` times as long as full thrust allows, with the thrust axis that it asks for and a nose that turns
    /// evenly by `spin` radians on top.
    pub fn own(&self, stretch: f64, spin: f64) -> Guess<NX, 4> {
        let most = 0.95 * self.vehicle.max_thrust();
        let peak = |t: f64| (0..=8).map(|k| self.cubic(t, k as f64 / 8.0).2.norm()).fold(0.0, f64::max);
        let (mut low, mut high) = (0.05, 1.0);
        while peak(high) > most && high < 400.0 {
            (low, high) = (high, 2.0 * high);
        }
        for _ in 0..10 {
            let middle = 0.5 * (low + high);
            if peak(middle) > most { low = middle } else { high = middle }
        }
        let time = high * stretch;
        let (mut q, mut fractions, mut states, mut controls) =
            (attitude(&self.start), vec![], vec![], vec![]);
        for k in 0..=24 {
            let s = k as f64 / 24.0;
            let (p, v, force) = self.cubic(time, s);
            if k > 0 {
                let turn = UnitQuaternion::rotation_between(&(q * Vector3::z()), &force).unwrap_or_default();
                q = turn * q * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), spin / 24.0);
            }
            let mut x = self.start * (1.0 - s) + self.end * s;
            x.fixed_rows_mut::<3>(0).copy_from(&p);
            x.fixed_rows_mut::<3>(3).copy_from(&v);
            x.fixed_rows_mut::<4>(6).copy_from(&SVector::from([q.w, q.i, q.j, q.k]));
            fractions.push(s);
            states.push(x);
            controls.push(self.hover * (force.norm() / self.vehicle.weight()));
        }
        Guess::from_samples(time, fractions, states, controls).unwrap_or_else(|_| self.naive())
    }

    /// What the integrated controls miss: m, m/s, degrees.
    pub fn miss(&self, solution: &Solution<NX, 4>) -> [f64; 3] {
        match solution.integrate(self.dynamics, &IntegrateOptions::default()) {
            Ok(flown) => {
                let x = flown.end_state();
                let turned = attitude(x).angle_to(&attitude(&self.end)).to_degrees();
                let distance = |i| (part(x, i) - part(&self.end, i)).norm();
                [distance(0), distance(3), turned]
            }
            Err(_) => [f64::INFINITY; 3],
        }
    }
}
