//! Physics that has closed answers, flatness and Euler angles.

mod common;

use common::any_layout;
use proptest::prelude::*;
use quad_dynamics::nalgebra::{SVector, UnitQuaternion, Vector3, Vector4};
use quad_dynamics::*;

fn vector(range: f64) -> impl Strategy<Value = Vector3<f64>> {
    [-range..range, -range..range, -range..range].prop_map(Vector3::from)
}

fn airless(moments: [f64; 3]) -> Vehicle {
    let parameters =
        VehicleParameters::survey_450().with_drag_coefficient(0.0).with_principal_inertia(moments);
    Vehicle::new(parameters).unwrap()
}

fn tumbling(rates: Vector3<f64>, velocity: Vector3<f64>) -> SVector<f64, 13> {
    let mut x = SVector::<f64, 13>::zeros();
    x[6] = 1.0;
    x.fixed_rows_mut::<3>(3).copy_from(&velocity);
    x.fixed_rows_mut::<3>(10).copy_from(&rates);
    x
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(50))]

    /// Free fall without drag and thrust: a parabola, constant energies and angular momentum in the world.
    #[test]
    fn free_fall_conserves(rates in vector(5.0), velocity in vector(10.0)) {
        let vehicle = airless([0.015, 0.020, 0.028]);
        let model = RigidBody::new(&vehicle);
        let start = tumbling(rates, velocity);
        let end = (0..2000).fold(start, |x, _| rk4_step_unit(|x| model.derivative(x, &Vector4::zeros()), &x, 1e-3, 6));
        let fallen = velocity * 2.0 - Vector3::new(0.0, 0.0, 0.5 * GRAVITY * 4.0);
        prop_assert!((end.fixed_rows::<3>(0) - fallen).amax() < 1e-10);
        let momentum = |x: &SVector<f64, 13>| {
            frames::from_wxyz(x[6], x[7], x[8], x[9]) * (vehicle.inertia_tensor() * x.fixed_rows::<3>(10))
        };
        prop_assert!((momentum(&end) - momentum(&start)).norm() < 1e-9 * momentum(&start).norm() + 1e-15);
        let energy = |x: &SVector<f64, 13>| {
            let w = x.fixed_rows::<3>(10).into_owned();
            let v = x.fixed_rows::<3>(3).norm_squared();
            0.5 * (vehicle.mass() * v + w.dot(&(vehicle.inertia_tensor() * w))) + vehicle.weight() * x[2]
        };
        prop_assert!((energy(&end) - energy(&start)).abs() < 1e-9 * (1.0 + energy(&start).abs()));
    }

    /// Flat outputs give a motion whose model has the accelerations asked for, and give the outputs back.
    #[test]
    fn flatness_round_trip(
        vehicle in any_layout(), v in vector(8.0), a in vector(5.0), j in vector(20.0), s in vector(50.0), yaw in -3.1..3.1_f64, turn in -2.0..2.0_f64,
    ) {
        let flat = FlatOutput { velocity: v, acceleration: a, jerk: j, snap: s, yaw, yaw_rate: turn, ..FlatOutput::default() };
        let state = flat.state(&vehicle, &Vector3::zeros()).unwrap();
        let model = RigidBody::new(&vehicle);
        let rate = model.derivative(&state.motion.rigid_body_state(), &state.motion.rotor_thrusts);
        prop_assert!((rate.fixed_rows::<3>(3) - a).amax() < 1e-10);
        let wanted = state.angular_acceleration;
        prop_assert!((rate.fixed_rows::<3>(10) - wanted).amax() < 1e-8 * (1.0 + wanted.norm()));
        let back = FlatOutput::of(&model.motion(&state.motion.rigid_body_state(), &state.motion.rotor_thrusts)).unwrap();
        let turned = (back.yaw - yaw).sin().abs();
        prop_assert!((back.acceleration - a).amax() < 1e-10 && turned < 1e-10);
        prop_assert!((back.yaw_rate - turn).abs() < 1e-8);
        // The model's jerk has the thrust constant: the difference is along the thrust.
        let missing = back.jerk - j;
        prop_assert!(missing.cross(&(state.motion.attitude * Vector3::z())).norm() < 1e-8 * (1.0 + j.norm()));
    }

    /// Rates and angular accelerations are the time derivatives of attitude and rates, with linear drag too.
    #[test]
    fn flatness_rates_are_derivatives(
        vehicle in any_layout(), v in vector(8.0), a in vector(5.0), j in vector(20.0), s in vector(50.0), yaw in -3.1..3.1_f64, turn in -2.0..2.0_f64,
        spin in -3.0..3.0_f64,
    ) {
        let drag = Vector3::new(0.3, 0.5, 0.1);
        let at = |t: f64| FlatOutput {
            position: Vector3::zeros(),
            velocity: v + a * t + j * (t * t / 2.0) + s * (t * t * t / 6.0),
            acceleration: a + j * t + s * (t * t / 2.0),
            jerk: j + s * t,
            snap: s,
            yaw: yaw + turn * t + spin * t * t / 2.0,
            yaw_rate: turn + spin * t,
            yaw_acceleration: spin,
        }.state(&vehicle, &drag).unwrap();
        let h = 1e-5;
        let (before, now, after) = (at(-h), at(0.0), at(h));
        let rates = (before.motion.attitude.inverse() * after.motion.attitude).scaled_axis() / (2.0 * h);
        prop_assert!((rates - now.motion.body_rates).norm() < 1e-5 * (1.0 + rates.norm()));
        let spin = (after.motion.body_rates - before.motion.body_rates) / (2.0 * h);
        prop_assert!((spin - now.angular_acceleration).norm() < 1e-4 * (1.0 + spin.norm()));
        // The equation of motion with linear drag: m a = T z - m g e_z - drag - m R D R^T v.
        let motion = now.motion;
        let linear = motion.attitude * drag.component_mul(&motion.attitude.inverse_transform_vector(&v));
        let force = motion.thrust_force() + vehicle.drag(&v) - linear * vehicle.mass();
        let acceleration = force / vehicle.mass() - Vector3::new(0.0, 0.0, GRAVITY);
        prop_assert!((acceleration - a).amax() < 1e-9, "{acceleration} {a}");
    }

    /// Euler angles and back; rates against differences.
    #[test]
    fn euler_angles_round_trip(axis in vector(3.0), rates in vector(4.0)) {
        let attitude = UnitQuaternion::from_scaled_axis(axis);
        let Ok(angles) = YawRollPitch::of(&attitude) else { return Ok(()) };
        prop_assert!(angles.attitude().angle_to(&attitude) < 1e-7);
        prop_assume!(angles.roll.cos() > 0.1);
        let h = 1e-6;
        let moved = |h: f64| YawRollPitch::of(&(attitude * UnitQuaternion::from_scaled_axis(rates * h))).unwrap();
        let (after, before) = (moved(h), moved(-h));
        let difference = |a: f64, b: f64| (a - b).sin().atan2((a - b).cos()) / (2.0 * h);
        let wanted = Vector3::new(
            difference(after.yaw, before.yaw), difference(after.roll, before.roll), difference(after.pitch, before.pitch),
        );
        prop_assert!((angles.rates(&rates).unwrap() - wanted).norm() < 1e-5 * (1.0 + wanted.norm()));
    }
}

#[test]
fn euler_singularity_is_reported() {
    let attitude = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::FRAC_PI_2);
    assert!(matches!(YawRollPitch::of(&attitude), Err(Error::EulerSingular { .. })));
    let free_fall = FlatOutput { acceleration: Vector3::new(0.0, 0.0, -GRAVITY), ..FlatOutput::default() };
    let state = free_fall.state(&Vehicle::survey_450(), &Vector3::zeros());
    assert!(matches!(state, Err(Error::FlatnessSingular { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Torque-free precession of asymmetric bodies.
    #[test]
    fn precession_follows_jacobi(
        a in 0.01..0.02_f64, more in 1.1..1.6_f64, share in 0.1..0.9_f64, w3 in 2.0..5.0_f64, slower in 0.1..0.9_f64,
    ) {
        let (b, c) = (more * a, more * a + share * a);
        // Below the separatrix.
        let w1 = slower * w3 * (c * (c - b) / (a * (b - a))).sqrt();
        precess([a, b, c], w1.min(6.0), w3);
    }

    /// An hour at 100 Hz, tumbling.
    #[test]
    fn the_quaternion_stays_unit_for_an_hour(rates in vector(3.0)) {
        let model = RigidBody::new(&airless([0.015, 0.020, 0.028]));
        let mut x = tumbling(rates, Vector3::zeros());
        let mut worst = 0.0_f64;
        for _ in 0..360_000 {
            x = rk4_step_unit(|x| model.derivative(x, &Vector4::zeros()), &x, 0.01, 6);
            worst = worst.max((x.fixed_rows::<4>(6).norm() - 1.0).abs());
        }
        prop_assert!(worst < 1e-12, "{}", worst);
    }
}

/// Precession from rates about the first and third axis against Jacobi's elliptic functions (Landau and Lifshitz,
/// Mechanics, sec. 37): rates cn, sn, dn of a time that runs at `sqrt((C - B)(M^2 - 2EA)/(ABC))`.
fn precess([a, b, c]: [f64; 3], w1: f64, w3: f64) {
    let vehicle = airless([a, b, c]);
    let energy = a * w1 * w1 + c * w3 * w3; // 2E, with w2 = 0 at the start
    let momentum = a * a * w1 * w1 + c * c * w3 * w3; // M^2
    assert!(momentum > energy * b);
    let speed = ((c - b) * (momentum - energy * a) / (a * b * c)).sqrt();
    let modulus = ((b - a) * (energy * c - momentum) / ((c - b) * (momentum - energy * a))).sqrt();
    let amplitude2 = ((energy * c - momentum) / (b * (c - b))).sqrt();
    let model = RigidBody::new(&vehicle);
    let mut x = tumbling(Vector3::new(w1, 0.0, w3), Vector3::zeros());
    let step = 1e-3;
    for k in 1..=5000 {
        x = rk4_step_unit(|x| model.derivative(x, &Vector4::zeros()), &x, step, 6);
        let (sn, cn, dn) = jacobi(speed * step * k as f64, modulus);
        let wanted = Vector3::new(w1 * cn, amplitude2 * sn, w3 * dn);
        let flown = x.fixed_rows::<3>(10).into_owned();
        // J1 w1' = (J2 - J3) w2 w3 < 0 for w2 > 0, so w2 grows from J2 w2' = (J3 - J1) w3 w1 > 0.
        assert!((flown - wanted).norm() < 1e-9, "step {k}: {flown} {wanted}");
    }
}

/// sn, cn, dn by descending Landen steps (arithmetic-geometric mean; Abramowitz and Stegun 16.4).
fn jacobi(u: f64, k: f64) -> (f64, f64, f64) {
    let (mut a, mut c) = (vec![1.0], vec![k]);
    let mut b = (1.0 - k * k).sqrt();
    while c.last().unwrap().abs() > 1e-16 && a.len() < 40 {
        let last = *a.last().unwrap();
        c.push((last - b) / 2.0);
        a.push((last + b) / 2.0);
        b = (last * b).sqrt();
    }
    let n = a.len() - 1;
    let mut phi = 2.0_f64.powi(n as i32) * a[n] * u;
    for i in (1..=n).rev() {
        phi = (phi + (c[i] / a[i] * phi.sin()).asin()) / 2.0;
    }
    (phi.sin(), phi.cos(), (1.0 - k * k * phi.sin().powi(2)).sqrt())
}

/// Halving the step divides the error by sixteen, projection included.
#[test]
fn the_integrator_has_order_four() {
    let vehicle = Vehicle::survey_450();
    let model = RigidBody::new(&vehicle);
    let start = tumbling(Vector3::new(1.0, 2.0, -1.5), Vector3::new(3.0, 1.0, 0.0));
    let control = Vector4::new(3.6, 3.7, 3.65, 3.6);
    let fly = |n: usize| {
        (0..n).fold(start, |x, _| rk4_step_unit(|x| model.derivative(x, &control), &x, 1.0 / n as f64, 6))
    };
    let exact = fly(6400);
    let errors = [50, 100, 200].map(|n| (fly(n) - exact).norm());
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 4.0).abs() < 0.2, "{errors:?}");
    }
}
