//! Numbers at the edge of what `f64` holds: every public function answers or refuses, none panics.

mod common;

use common::any_layout;
use proptest::prelude::*;
use quad_dynamics::nalgebra::{SVector, UnitQuaternion, Vector3, Vector4};
use quad_dynamics::simulation::{Dryden, SensorNoise, sample};
use quad_dynamics::*;

fn extreme() -> impl Strategy<Value = f64> {
    let special = prop::sample::select(vec![
        0.0,
        -0.0,
        5e-324,
        -1e-310,
        1e-160,
        1e154,
        1e300,
        -1e300,
        f64::MAX,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
    ]);
    prop_oneof![3 => special, 1 => prop::num::f64::ANY, 6 => -20.0..20.0_f64]
}

fn vector() -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(extreme()).prop_map(Vector3::from)
}

fn entries<const N: usize>() -> impl Strategy<Value = SVector<f64, N>> {
    prop::collection::vec(extreme(), N).prop_map(|values| SVector::from_fn(|i, _| values[i]))
}

fn heading() -> impl Strategy<Value = Heading> {
    prop_oneof![
        Just(Heading::AlongTrack),
        vector().prop_map(Heading::Towards),
        extreme().prop_map(Heading::Yaw)
    ]
}

/// A state of the rigid body as a motion, whatever it holds.
fn motion() -> impl Strategy<Value = Motion> {
    (any_layout(), vector(), entries::<13>(), entries::<4>()).prop_map(|(vehicle, wind, state, control)| {
        RigidBody::new(&vehicle).with_wind(wind).motion(&state, &control)
    })
}

fn spec() -> impl Strategy<Value = LoiterSpec> {
    let limits = prop::array::uniform5(
        prop_oneof![2 => Just(None), 1 => extreme().prop_map(Some), 1 => (0.01..30.0).prop_map(Some)],
    );
    let size = prop_oneof![extreme(), 0.1..1e3_f64, Just(1e9), Just(5e-324)];
    (size, prop_oneof![extreme(), Just(0.9)], any::<[bool; 3]>(), limits).prop_map(
        |(radius, budget, [yaw, rates, rotors], limits)| {
            let mut spec = LoiterSpec::new(radius).with_thrust_budget(budget);
            spec = spec.with_yaw(if yaw { LoiterYaw::AtTarget } else { LoiterYaw::AlongTrack });
            spec = spec.with_body_rate_limits(rates).with_rotor_limits(rotors);
            let [speed, bank, acceleration, camera, sweep] = limits;
            (spec.speed_limit, spec.bank_limit, spec.acceleration_limit) = (speed, bank, acceleration);
            spec.camera_limit = camera.map(|frames| CameraLimit::from_frame_rate(frames, 24.0));
            sweep.map_or(spec, |sweep| spec.with_sweep(sweep))
        },
    )
}

/// Numbers throughout; only the time of a circle at next to no speed may be beyond them.
fn is_sound(loiter: &Loiter) -> bool {
    let state = loiter.state(1.0, Direction::Clockwise);
    let numbers = [loiter.speed, loiter.radius, loiter.thrust, loiter.tilt(), state.velocity.norm()];
    numbers.iter().all(|x| x.is_finite() && *x >= 0.0) && loiter.speed > 0.0 && loiter.period() > 0.0
}

/// Everything that a motion is asked for.
fn ask(vehicle: &Vehicle, motion: &Motion, number: f64, point: &Vector3<f64>) {
    let _ = (motion.tilt(), motion.thrust_force(), motion.translated(point));
    let _ = (motion.point_mass_state(), motion.point_mass_control(), motion.jerk_limited_state());
    let _ = (motion.thrust_rate_state(), motion.thrust_rate_control(), motion.rigid_body_state());
    let _ = (vehicle.motion_power(motion, point), vehicle.flight_energy(&[*motion, *motion], number, point));
    let _ = (FlatOutput::of(motion).is_ok(), YawRollPitch::of(&motion.attitude).is_ok());
    for camera in [Camera::new(1.0, 0.8), Camera::new(number.abs(), number)].into_iter().flatten() {
        let camera = camera.with_mount(number, point.x).with_stabilised(number > 0.0);
        let _ = (camera.view(motion, point), camera.share_of_picture(number, point.y));
        let _ = (camera.distance_for(number, point.z), camera.radius_for(number, point.y, point.z));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn models_of_any_numbers(
        vehicle in any_layout(), wind in vector(), state in entries::<17>(), control in entries::<4>(), weight in entries::<13>(),
        heading in heading(),
    ) {
        let (point, jerk) = (PointMass::new(&vehicle).with_wind(wind), JerkLimited::new(&vehicle).with_wind(wind));
        let (rate, body) = (ThrustRate::new(&vehicle).with_wind(wind), RigidBody::new(&vehicle).with_wind(wind));
        let mut lag = RotorLag::new(&vehicle).with_wind(wind);
        lag.set_wind(-wind);
        let force = Vector3::new(control[0], control[1], control[2]);
        let (six, nine) = (state.fixed_rows::<6>(0).into_owned(), state.fixed_rows::<9>(0).into_owned());
        let (ten, thirteen) = (state.fixed_rows::<10>(0).into_owned(), state.fixed_rows::<13>(0).into_owned());
        let _ = (point.jacobian(&six, &force), point.hessian(&six, &weight.fixed_rows::<6>(0).into_owned()));
        let _ = (jerk.jacobian(&nine, &force), jerk.hessian(), jerk.thrust_force(&nine));
        let _ = (rate.jacobian(&ten, &control), rate.hessian(&ten, &control, &weight.fixed_rows::<10>(0).into_owned()));
        let _ = (body.jacobian(&thirteen, &control), body.hessian(&thirteen, &control, &weight));
        let _ = rk4_step_unit(|x| lag.derivative(x, &control), &state, weight[0], 6);
        let _ = rk4(|x| rate.derivative(x, &control), &ten, weight[1], 3);
        let motions = [
            point.motion(&six, &force, heading),
            jerk.motion(&nine, &force, heading),
            rate.motion(&ten, &control),
            body.motion(&thirteen, &control),
            Motion::hover(&vehicle, force, weight[0]),
            Motion::hover_in_wind(&vehicle, force, weight[1], wind),
        ];
        for motion in motions {
            ask(&vehicle, &motion, weight[2], &force);
        }
    }

    #[test]
    fn loiters_of_any_numbers(
        vehicle in any_layout(), spec in spec(), numbers in entries::<4>(), wind in prop_oneof![vector(), [-3.0..3.0_f64, -3.0..3.0, 0.0..0.1].prop_map(Vector3::from)],
    ) {
        prop_assert_eq!(spec.problems(&vehicle).is_empty(), Loiter::new(&vehicle, &spec).is_ok());
        let _ = loiter_speed(&vehicle, numbers[0], numbers[1]);
        let found = [
            Loiter::new(&vehicle, &spec),
            Loiter::at_speed(&vehicle, &spec, numbers[0]),
            Loiter::with_speed(&vehicle, &spec, numbers[0]),
            Loiter::with_period(&vehicle, &spec, numbers[1]),
            Loiter::quickest(&vehicle, &spec, numbers[2], numbers[3]),
        ];
        for loiter in found.into_iter().flatten() {
            prop_assert!(is_sound(&loiter), "{:?}", loiter);
            let _ = (loiter.exit_state(numbers[0], Direction::CounterClockwise), loiter.power(), loiter.energy());
            let _ = (loiter.length(), loiter.duration(), loiter.angular_speed());
            let camera = Camera::new(1.2, 0.9).unwrap();
            let share = camera.share_in_view(&loiter, Direction::Clockwise, numbers[0], [numbers[1], numbers[2]]);
            prop_assert!((0.0..=1.0).contains(&share));
        }
        if let Ok(loiter) = WindyLoiter::new(&vehicle, &spec, wind, Direction::Clockwise) {
            prop_assert!(loiter.speed.is_finite() && loiter.greatest_thrust().is_finite(), "{:?}", loiter);
            let _ = (loiter.greatest_body_rates(), loiter.state(numbers[0]), loiter.period(), loiter.angular_speed());
        }
    }

    #[test]
    fn vehicles_of_any_numbers(vehicle in any_layout(), numbers in prop::collection::vec(extreme(), 16), which in 0..12_usize) {
        let mut parameters = vehicle.parameters().clone();
        let [a, b, c] = [numbers[0], numbers[1], numbers[2]];
        parameters = match which {
            0 => parameters.with_mass(a),
            1 => parameters.with_principal_inertia([a, b, c]),
            2 => parameters.with_max_thrust(a),
            3 => parameters.with_drag_coefficient(a),
            4 => parameters.with_max_body_rates([a, b, c]),
            5 => parameters.with_rotor_coefficients(a, b, c, numbers[3]),
            6 => parameters.with_rotors(VehicleParameters::plus_layout(a)),
            7 => { parameters.propulsion.rotor_radius = a; parameters.propulsion.efficiency = b; parameters }
            8 => { parameters.aerodynamics.rotor_drag = [a, b, c]; parameters.aerodynamics.body_drag = [c, a, b]; parameters }
            9 => { parameters.battery.energy = a; parameters.battery.usable_share = b; parameters.battery.avionics_power = c; parameters }
            10 => { parameters.inertia_tensor = [[a, b, c], [b, numbers[3], numbers[4]], [c, numbers[4], numbers[5]]]; parameters }
            _ => { parameters.rotors[which % 4].position = [a, b]; parameters }
        };
        let _ = Mixer::new(&parameters.rotors, numbers[6]);
        let sound = parameters.problems().is_empty();
        let Ok(vehicle) = Vehicle::new(parameters) else { return Ok(()) };
        prop_assert!(sound);
        let air = Vector3::new(numbers[7], numbers[8], numbers[9]);
        let _ = (vehicle.power(numbers[6], &air), vehicle.drag(&air), vehicle.linear_drag());
        prop_assert!(vehicle.hover_power() > 0.0 && !vehicle.hover_endurance().is_nan());
        let thrusts = vehicle.mixer().allocate(numbers[10], &air, numbers[11], numbers[12]);
        let _ = (vehicle.mixer().thrust_and_torque(&thrusts), vehicle.mixer().rotor_thrusts(numbers[10], &air));
        let _ = Loiter::new(&vehicle, &LoiterSpec::new(3.0)).map(|loiter| loiter.energy());
    }

    #[test]
    fn flat_outputs_of_any_numbers(vehicle in any_layout(), vectors in prop::collection::vec(vector(), 7), angles in prop::array::uniform3(extreme())) {
        let [yaw, yaw_rate, yaw_acceleration] = angles;
        let [position, velocity, acceleration, jerk, snap] = [vectors[0], vectors[1], vectors[2], vectors[3], vectors[4]];
        let flat = FlatOutput { position, velocity, acceleration, jerk, snap, yaw, yaw_rate, yaw_acceleration };
        let _ = flat.state(&vehicle, &vectors[5]);
        let euler = YawRollPitch { yaw, roll: yaw_rate, pitch: yaw_acceleration };
        let _ = (euler.attitude(), euler.rates(&vectors[6]));
        let shaping = ShapingLimits::arducopter().with_speed(yaw).with_acceleration(yaw_rate).with_jerk(yaw_acceleration);
        let _ = shaping.check();
        let unit = frames::from_wxyz(yaw, yaw_rate, yaw_acceleration, position.x);
        prop_assert!((frames::to_wxyz(&unit).norm() - 1.0).abs() < 1e-9, "{:?}", unit);
    }

    #[test]
    fn flights_of_any_numbers(
        vehicle in any_layout(), plan in prop::collection::vec(motion(), 0..8), numbers in prop::collection::vec(extreme(), 24), seed in any::<u64>(),
        record_every in prop_oneof![0..4_usize, Just(usize::MAX)],
    ) {
        let mut options = SimulationOptions::default();
        options.record_every = record_every;
        options.step = if seed % 2 == 0 { numbers[0] } else { 0.002 };
        options = options.with_wind(Vector3::new(numbers[1], numbers[2], numbers[3])).with_gusts(numbers[4], numbers[5]);
        options = options.with_ramp(numbers[6]).with_look_ahead(numbers[7]);
        let [position, velocity, attitude, body_rates] = [numbers[8], numbers[9], numbers[10], numbers[11]];
        options = options.with_noise(SensorNoise { position, velocity, attitude, body_rates });
        let mut gains = Gains::default();
        (gains.position_frequency, gains.integral_limit, gains.rotor_lead) = (numbers[12], numbers[13], numbers[14]);
        if seed % 3 == 0 {
            options = options.with_gains(gains);
        }
        let flight = simulate(&vehicle, &plan, &options, seed);
        prop_assert_eq!(flight.is_none(), plan.is_empty());
        prop_assert_eq!(simulate_batch(&vehicle, &plan, &options, &[seed, 1]).len(), if plan.is_empty() { 0 } else { 2 });
        let mut gusts = Dryden::new(options.wind, Vector3::new(numbers[15], numbers[16], numbers[17]), numbers[18], numbers[19], numbers[20], seed);
        let _ = (gusts.advance(), Dryden::low_altitude_intensity(numbers[21], numbers[22]));
        let mut controller = TrackingController::new(&vehicle, gains);
        if let (Some(first), Some(last)) = (plan.first(), plan.last()) {
            let target = Target::between(first, first, last, numbers[23]);
            // Commands are rotor speeds, whose squares round.
            let (min, max) = (vehicle.min_rotor_thrust() * (1.0 - 1e-12), vehicle.max_rotor_thrust() * (1.0 + 1e-12));
            for target in [target, Target::of(last)] {
                let thrusts: Vector4<f64> = controller.update(&last.rigid_body_state(), first, &target, options.step);
                prop_assert!(thrusts.iter().all(|thrust| thrust.is_nan() || (min..=max).contains(thrust)), "{}", thrusts);
                controller.reset();
            }
        }
    }
}

/// A step alone takes neither memory nor time.
#[test]
fn enormous_numbers_of_samples_are_refused() {
    let vehicle = Vehicle::survey_450();
    let still = |_: f64| Motion::hover(&vehicle, Vector3::zeros(), 0.0);
    for (duration, step) in [
        (1e300, 1.0),
        (1.0, 5e-324),
        (f64::INFINITY, 1.0),
        (f64::NAN, 1.0),
        (1.0, f64::NAN),
        (1.0, -1.0),
        (-1.0, -1.0),
    ] {
        assert_eq!(sample(still, duration, step).len(), 1);
    }
    assert_eq!(sample(still, 1.0, 0.25).len(), 5);
    assert_eq!(Vehicle::preset("no such vehicle"), None);
    assert_eq!(frames::from_wxyz(0.0, 0.0, 0.0, 0.0), UnitQuaternion::identity());
}
