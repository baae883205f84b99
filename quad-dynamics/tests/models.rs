//! The models against a second one, written with rotation matrices and Newton-Euler, and against physics.

use num_dual::{DualSVec64, jacobian};
use proptest::prelude::*;
use quad_dynamics::nalgebra::{Matrix3, SMatrix, SVector, UnitQuaternion, Vector3, Vector4};
use quad_dynamics::*;

/// The same vehicle again: rotation matrix for the attitude, forces and torques summed rotor by rotor.
struct NewtonEuler {
    vehicle: VehicleParameters,
    wind: Vector3<f64>,
}

impl NewtonEuler {
    /// (velocity', R', rates') for velocity, R, rates and the rotor thrusts.
    fn rates(
        &self,
        v: Vector3<f64>,
        r: Matrix3<f64>,
        w: Vector3<f64>,
        f: [f64; 4],
    ) -> (Vector3<f64>, Matrix3<f64>, Vector3<f64>) {
        let mut force = Vector3::new(0.0, 0.0, -self.vehicle.mass * 9.81);
        let mut torque = Vector3::zeros();
        for (rotor, f) in self.vehicle.rotors.iter().zip(f) {
            let push = Vector3::new(0.0, 0.0, f);
            force += r * push;
            torque += Vector3::new(rotor.position[0], rotor.position[1], 0.0).cross(&push);
            let reaction = if rotor.spin == Spin::Clockwise { 1.0 } else { -1.0 };
            torque.z += reaction * self.vehicle.torque_to_thrust * f;
        }
        let air = v - self.wind;
        force -= air * air.norm() * self.vehicle.drag_coefficient / 2.0;
        let rows = self.vehicle.inertia_tensor;
        let inertia = Matrix3::from_fn(|i, j| rows[i][j]);
        let spin = inertia.lu().solve(&(torque - w.cross(&(inertia * w)))).unwrap();
        (force / self.vehicle.mass, r * w.cross_matrix(), spin)
    }
}

fn vector(range: f64) -> impl Strategy<Value = Vector3<f64>> {
    [-range..range, -range..range, -range..range].prop_map(Vector3::from)
}

fn attitude() -> impl Strategy<Value = UnitQuaternion<f64>> {
    vector(3.0).prop_map(UnitQuaternion::from_scaled_axis)
}

/// The survey quadcopter with a full, asymmetric inertia tensor and uneven rotors.
fn crooked() -> VehicleParameters {
    let mut parameters = VehicleParameters::survey_450();
    parameters.inertia_tensor = [[0.015, 0.001, -0.002], [0.001, 0.018, 0.0005], [-0.002, 0.0005, 0.028]];
    parameters.rotors[0].position = [0.17, -0.16];
    parameters
}

fn state(p: Vector3<f64>, v: Vector3<f64>, q: &UnitQuaternion<f64>, w: Vector3<f64>) -> SVector<f64, 13> {
    SVector::from([p.x, p.y, p.z, v.x, v.y, v.z, q.w, q.i, q.j, q.k, w.x, w.y, w.z])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn models_agree_with_newton_euler(
        p in vector(50.0), v in vector(15.0), q in attitude(), w in vector(6.0), wind in vector(8.0),
        f in [0.3..8.0_f64, 0.3..8.0, 0.3..8.0, 0.3..8.0], norm in 0.5..2.0_f64,
    ) {
        let parameters = crooked();
        let vehicle = Vehicle::new(parameters.clone()).unwrap();
        let rotation = q.to_rotation_matrix().into_inner();
        let second = NewtonEuler { vehicle: parameters, wind };
        let (acceleration, rotation_rate, spin) = second.rates(v, rotation, w, f);

        // The quaternion's norm must not matter to the motion of the centre.
        let mut x = state(p, v, &q, w);
        let rigid = RigidBody::new(&vehicle).with_wind(wind);
        let rate = rigid.derivative(&x, &Vector4::from(f));
        prop_assert!((rate.fixed_rows::<3>(0) - v).amax() == 0.0);
        prop_assert!((rate.fixed_rows::<3>(3) - acceleration).amax() < 1e-11);
        prop_assert!((rate.fixed_rows::<3>(10) - spin).amax() < 1e-9);

        // R' from q': move along the quaternion's rate and difference the matrices.
        let h = 1e-6;
        let moved = |h: f64| {
            let c = x + rate * h;
            frames::from_wxyz(c[6], c[7], c[8], c[9]).to_rotation_matrix().into_inner()
        };
        prop_assert!(((moved(h) - moved(-h)) / (2.0 * h) - rotation_rate).amax() < 1e-8);

        for i in 6..10 {
            x[i] *= norm;
        }
        let scaled = rigid.derivative(&x, &Vector4::from(f));
        prop_assert!((scaled.fixed_rows::<3>(3) - acceleration).amax() < 1e-11);
        prop_assert!((scaled.fixed_rows::<4>(6) - rate.fixed_rows::<4>(6) * norm).amax() < 1e-11);

        let total: f64 = f.iter().sum();
        let control = Vector4::new(total, w.x, w.y, w.z);
        let rate = ThrustRate::new(&vehicle).with_wind(wind).derivative(&x.fixed_rows::<10>(0).into_owned(), &control);
        prop_assert!((rate - scaled.fixed_rows::<10>(0)).amax() < 1e-11);

        let push = rotation * Vector3::new(0.0, 0.0, total);
        let rate = PointMass::new(&vehicle).with_wind(wind).derivative(&x.fixed_rows::<6>(0).into_owned(), &push);
        prop_assert!((rate - scaled.fixed_rows::<6>(0)).amax() < 1e-11);

        let jerk_limited = JerkLimited::new(&vehicle).with_wind(wind);
        let full = SVector::<f64, 9>::from_fn(|i, _| if i < 6 { x[i] } else { acceleration[i - 6] });
        prop_assert!((jerk_limited.thrust_force(&full) - push).amax() < 1e-10);
        let rate = jerk_limited.derivative(&full, &w);
        prop_assert!((rate.fixed_rows::<6>(0) - full.fixed_rows::<6>(3)).amax() == 0.0);
        prop_assert!((rate.fixed_rows::<3>(6) - w).amax() == 0.0);
    }

    /// A motion read off a model repeats what the model does: `Motion` of each model, from one loiter.
    #[test]
    fn motions_agree_between_models(radius in 1.0..20.0_f64, angle in -3.0..3.0_f64, clockwise in any::<bool>()) {
        let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
        let direction = if clockwise { Direction::Clockwise } else { Direction::CounterClockwise };
        let wanted = Loiter::new(&vehicle, &LoiterSpec::new(radius)).unwrap().state(angle, direction);
        let along = Heading::AlongTrack;
        let jerk_limited = JerkLimited::new(&vehicle).motion(&wanted.jerk_limited_state(), &wanted.jerk, along);
        let thrust_rate = ThrustRate::new(&vehicle).motion(&wanted.thrust_rate_state(), &wanted.thrust_rate_control());
        let rigid = RigidBody::new(&vehicle).motion(&wanted.rigid_body_state(), &wanted.rotor_thrusts);
        for motion in [jerk_limited, thrust_rate, rigid] {
            prop_assert!((motion.acceleration - wanted.acceleration).norm() < 1e-9);
            prop_assert!((motion.jerk - wanted.jerk).norm() < 1e-9);
            prop_assert!(motion.attitude.angle_to(&wanted.attitude) < 1e-7);
            prop_assert!((motion.body_rates - wanted.body_rates).norm() < 1e-9);
            prop_assert!((motion.collective_thrust - wanted.collective_thrust).abs() < 1e-9);
            prop_assert!((motion.rotor_thrusts - wanted.rotor_thrusts).norm() < 1e-9);
        }
        let point = PointMass::new(&vehicle).motion(&wanted.point_mass_state(), &wanted.point_mass_control(), along);
        prop_assert!((point.acceleration - wanted.acceleration).norm() < 1e-9);
        prop_assert!(point.attitude.angle_to(&wanted.attitude) < 1e-7);
    }

    /// The other models' analytic derivatives against dual numbers.
    #[test]
    fn jacobians_agree_with_dual_numbers(v in vector(15.0), q in attitude(), w in vector(6.0), wind in vector(8.0)) {
        let vehicle = Vehicle::new(crooked()).unwrap();
        let x = state(Vector3::zeros(), v, &q, w) * 1.1;
        macro_rules! check {
            ($model:expr, $nx:literal, $nu:literal) => {
                let model = $model;
                let x: SVector<f64, $nx> = x.fixed_rows::<$nx>(0).into_owned();
                let u = SVector::<f64, $nu>::from_fn(|i, _| 12.0 - 3.0 * i as f64);
                let analytic = model.jacobian(&x, &u);
                let (value, by_state): (SVector<f64, $nx>, SMatrix<f64, $nx, $nx>) = jacobian(
                    |x: SVector<DualSVec64<$nx>, $nx>| model.derivative(&x, &u.map(DualSVec64::from_re)), &x);
                let (_, by_control): (SVector<f64, $nx>, SMatrix<f64, $nx, $nu>) = jacobian(
                    |u: SVector<DualSVec64<$nu>, $nu>| model.derivative(&x.map(DualSVec64::from_re), &u), &u);
                prop_assert!((analytic.value - value).amax() < 1e-12 * (1.0 + value.amax()));
                prop_assert!((analytic.state - by_state).amax() < 1e-11 * (1.0 + by_state.amax()));
                prop_assert!((analytic.control - by_control).amax() < 1e-11 * (1.0 + by_control.amax()));
            };
        }
        check!(PointMass::new(&vehicle).with_wind(wind), 6, 3);
        check!(JerkLimited::new(&vehicle).with_wind(wind), 9, 3);
        check!(ThrustRate::new(&vehicle).with_wind(wind), 10, 4);
    }

    /// With rotors at their commands and no further drag, the model with lag is the rigid body.
    #[test]
    fn rotor_lag_contains_the_rigid_body(
        v in vector(15.0), q in attitude(), w in vector(6.0), wind in vector(8.0), s in [150.0..690.0_f64, 150.0..690.0, 150.0..690.0, 150.0..690.0],
    ) {
        let vehicle = Vehicle::new(crooked()).unwrap();
        let x = state(Vector3::zeros(), v, &q, w);
        let speeds = Vector4::from(s);
        let thrusts = speeds.map(|s| vehicle.thrust_coefficient() * s * s);
        let full = SVector::<f64, 17>::from_fn(|i, _| if i < 13 { x[i] } else { speeds[i - 13] });
        let wanted = RigidBody::new(&vehicle).with_wind(wind).derivative(&x, &thrusts);
        let rate = RotorLag::new(&vehicle).with_wind(wind).derivative(&full, &(speeds * 1.1));
        prop_assert!((rate.fixed_rows::<13>(0) - wanted).amax() < 1e-10);
        prop_assert!((rate.fixed_rows::<4>(13) * 0.05 - speeds * 0.1).amax() < 1e-10);
    }

    /// Dual numbers through the generic derivative, against central differences.
    #[test]
    fn dual_numbers_differentiate(v in vector(15.0), q in attitude(), w in vector(6.0), wind in vector(8.0)) {
        let vehicle = Vehicle::new(crooked()).unwrap();
        let model = RigidBody::new(&vehicle).with_wind(wind);
        let x = state(Vector3::zeros(), v, &q, w);
        let control = Vector4::new(3.0, 4.0, 5.0, 2.0);
        let (value, derivative): (SVector<f64, 13>, SMatrix<f64, 13, 13>) = jacobian(
            |x: SVector<DualSVec64<13>, 13>| model.derivative(&x, &control.map(DualSVec64::from_re)), &x,
        );
        prop_assert!((value - model.derivative(&x, &control)).amax() < 1e-12);
        let analytic = model.jacobian(&x, &control);
        prop_assert!((analytic.state - derivative).amax() < 1e-11 * (1.0 + derivative.amax()));
        let (_, by_control): (SVector<f64, 13>, SMatrix<f64, 13, 4>) = jacobian(
            |u: SVector<DualSVec64<4>, 4>| model.derivative(&x.map(DualSVec64::from_re), &u), &control,
        );
        prop_assert!((analytic.control - by_control).amax() < 1e-11 * (1.0 + by_control.amax()));
        prop_assert_eq!(analytic.value, value);
        let h = 1e-5;
        for column in 0..13 {
            let step = SVector::<f64, 13>::ith(column, h);
            let central = (model.derivative(&(x + step), &control) - model.derivative(&(x - step), &control)) / (2.0 * h);
            prop_assert!((derivative.column(column) - central).amax() < 1e-6);
        }
    }
}

/// At zero air speed the drag has a derivative, and it is zero.
#[test]
fn no_air_speed_is_differentiable() {
    let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
    let model = PointMass::new(&vehicle);
    let (_, derivative): (SVector<f64, 6>, SMatrix<f64, 6, 6>) = jacobian(
        |x: SVector<DualSVec64<6>, 6>| {
            model.derivative(&x, &SVector::from([1.0, 2.0, 3.0]).map(DualSVec64::from_re))
        },
        &SVector::zeros(),
    );
    assert!(derivative.iter().all(|x| x.is_finite()));
    assert_eq!(derivative.fixed_view::<3, 3>(3, 3).into_owned(), Matrix3::zeros());
}

#[test]
fn hover_stays() {
    let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
    let hover = Motion::hover(&vehicle, Vector3::new(1.0, 2.0, 3.0), 0.7);
    assert!(hover.tilt() < 1e-12);
    assert!((hover.attitude * Vector3::x() - Vector3::new(0.7_f64.cos(), 0.7_f64.sin(), 0.0)).norm() < 1e-12);
    let rate = RigidBody::new(&vehicle).derivative(&hover.rigid_body_state(), &hover.rotor_thrusts);
    assert!(rate.amax() < 1e-12, "{rate}");
}

/// Degenerate motions have an attitude too: no force, force along the velocity, nothing finite.
#[test]
fn degenerate_motions_are_answered() {
    let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
    let model = PointMass::new(&vehicle);
    let states = [[0.0; 6], [0.0, 0.0, 0.0, 0.0, 0.0, 5.0], [0.0, 0.0, 0.0, f64::NAN, 0.0, f64::INFINITY]];
    let forces = [[0.0; 3], [0.0, 0.0, 10.0], [10.0, 0.0, 0.0], [0.0, 10.0, 0.0]];
    let headings =
        [Heading::AlongTrack, Heading::Towards(Vector3::zeros()), Heading::Yaw(0.0), Heading::Yaw(f64::NAN)];
    for (state, force) in states.iter().flat_map(|s| forces.iter().map(move |f| (s, f))) {
        for heading in headings {
            let motion = model.motion(&SVector::from(*state), &SVector::from(*force), heading);
            assert!((motion.attitude.norm() - 1.0).abs() < 1e-9, "{state:?} {force:?} {heading:?}");
        }
    }
}
