//! Mixer limits, the controller and the simulator.

use proptest::prelude::*;
use quad_dynamics::nalgebra::{Vector3, Vector4};
use quad_dynamics::simulation::{Dryden, SensorNoise, sample};
use quad_dynamics::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    /// Requests within the limits are met exactly; others stay within them, and yaw goes first.
    #[test]
    fn allocation_respects_limits(
        thrust in -10.0..50.0_f64, torque in [-3.0..3.0_f64, -3.0..3.0, -0.5..0.5], small in 0.0..1.0_f64,
    ) {
        let vehicle = Vehicle::survey_450();
        let mixer = vehicle.mixer();
        let (min, max) = (vehicle.min_rotor_thrust(), vehicle.max_rotor_thrust());
        let torque = Vector3::from(torque) * small;
        let given = mixer.allocate(thrust, &torque, min, max);
        prop_assert!(given.min() >= min && given.max() <= max);
        let (given_thrust, given_torque) = mixer.thrust_and_torque(&given);
        let wanted = mixer.rotor_thrusts(thrust, &torque);
        if wanted.min() >= min && wanted.max() <= max {
            prop_assert!((given - wanted).amax() < 1e-12);
        }
        // Roll and pitch are met whenever some thrust allows them without yaw; else both shrink alike.
        let tilt = mixer.rotor_thrusts(0.0, &Vector3::new(torque.x, torque.y, 0.0));
        if tilt.max() - tilt.min() <= max - min {
            prop_assert!((given_torque.xy() - torque.xy()).amax() < 1e-12);
        } else {
            prop_assert!(given_torque.xy().perp(&torque.xy()).abs() < 1e-12);
            prop_assert!(given_torque.xy().norm() < torque.xy().norm());
        }
        // Yaw never turns against the request.
        prop_assert!(given_torque.z * torque.z >= -1e-12);
        // Thrust gives way only where roll and pitch leave it no room.
        if tilt.max() + thrust / 4.0 <= max && tilt.min() + thrust / 4.0 >= min {
            prop_assert!((given_thrust - thrust).abs() < 1e-9);
        }
    }

    /// Nonsense limits and requests are answered.
    #[test]
    fn allocation_never_panics(thrust in any::<f64>(), torque in any::<[f64; 3]>(), min in any::<f64>(), max in any::<f64>()) {
        let _ = Vehicle::survey_450().mixer().allocate(thrust, &Vector3::from(torque), min, max);
    }
}

fn loiter_plan(vehicle: &Vehicle, spec: &LoiterSpec, options: &SimulationOptions) -> Vec<Motion> {
    let loiter = Loiter::new(vehicle, spec).unwrap();
    let direction = Direction::CounterClockwise;
    sample(|t| loiter.state(loiter.angular_speed() * t, direction), loiter.duration(), options.step)
}

#[test]
fn hover_is_held() {
    for name in VehicleParameters::PRESETS {
        let vehicle = Vehicle::preset(name).unwrap().unwrap();
        let hover = Motion::hover(&vehicle, Vector3::new(1.0, 2.0, 3.0), 0.5);
        let flight = simulate(&vehicle, &vec![hover; 2000], &SimulationOptions::default(), 1).unwrap();
        assert!(
            flight.tracking.max_error < 1e-9 && flight.tracking.completed == 1.0,
            "{name} {:?}",
            flight.tracking
        );
    }
}

#[test]
fn loiters_are_followed() {
    let vehicle = Vehicle::survey_450();
    let options = SimulationOptions::default();
    for radius in [1.5, 3.0, 10.0] {
        let plan = loiter_plan(&vehicle, &LoiterSpec::new(radius), &options);
        let tracking = simulate(&vehicle, &plan, &options, 1).unwrap().tracking;
        assert!(tracking.max_error < 0.15 && tracking.extra_length.abs() < 0.06, "{radius}: {tracking:?}");
    }
}

/// In a wind of 5 m/s with gusts, with sensor noise: bounded, and the same again for the same seed.
#[test]
fn gusts_are_survived_and_repeat() {
    let vehicle = Vehicle::survey_450();
    let options = SimulationOptions::default()
        .with_wind(Vector3::new(3.0, -4.0, 0.0))
        .with_gusts(5.0, 1.5)
        .with_noise(SensorNoise::typical());
    let plan = loiter_plan(&vehicle, &LoiterSpec::new(3.0), &options);
    let seeds: Vec<u64> = (0..20).collect();
    let all = simulate_batch(&vehicle, &plan, &options, &seeds);
    let worst = all.iter().map(|tracking| tracking.max_error).fold(0.0, f64::max);
    assert!(worst < 1.0, "{worst}");
    let again = simulate(&vehicle, &plan, &options, 3).unwrap();
    assert_eq!(again.tracking, all[3]);
    assert_ne!(all[2], all[3]);
}

#[test]
fn empty_and_broken_plans_are_answered() {
    let vehicle = Vehicle::survey_450();
    assert!(simulate(&vehicle, &[], &SimulationOptions::default(), 1).is_none());
    let mut plan = vec![Motion::hover(&vehicle, Vector3::zeros(), 0.0); 100];
    plan[50].position.x = f64::NAN;
    let flight = simulate(&vehicle, &plan, &SimulationOptions::default(), 1).unwrap();
    // One bad sample costs some thrust for a moment, not the flight.
    assert!(flight.end.iter().all(|x| x.is_finite()) && flight.end[2].abs() < 0.1, "{}", flight.end);
    let mut options = SimulationOptions::default();
    options.step = f64::NAN;
    let _ = simulate(&vehicle, &plan, &options, 1);
}

/// Standard deviations, time correlation and independence of the step, over many generators.
#[test]
fn gusts_have_the_spectrum_asked_for() {
    let sigma = Vector3::new(1.5, 1.2, 0.7);
    for step in [0.02, 0.2] {
        let mut sums = [Vector3::zeros(), Vector3::zeros()];
        let n = 400;
        let lag = (1.0_f64 / step).round() as usize;
        for seed in 0..n {
            let mut gusts = Dryden::new(Vector3::zeros(), sigma, 20.0, 8.0, step, seed);
            let first = gusts.advance();
            let later = (0..lag).map(|_| gusts.advance()).last().unwrap();
            sums[0] += first.component_mul(&first) / n as f64;
            sums[1] += first.component_mul(&later) / n as f64;
        }
        let feet: f64 = 20.0 / 0.3048;
        let scales = [feet / (0.177 + 0.000823 * feet).powf(1.2) * 0.3048 / 8.0, 20.0 / 8.0];
        let correlation = [
            (-1.0 / scales[0]).exp(),
            (1.0 - 0.5 / scales[0]) * (-1.0 / scales[0]).exp(),
            (1.0 - 0.5 / scales[1]) * (-1.0 / scales[1]).exp(),
        ];
        for axis in 0..3 {
            let variance = sums[0][axis] / sigma[axis].powi(2);
            let shared = sums[1][axis] / sigma[axis].powi(2);
            // Five standard errors of 400 samples: sqrt(2/400), 1/sqrt(400).
            assert!((variance - 1.0).abs() < 0.36, "axis {axis} step {step}: variance {variance}");
            assert!(
                (shared - correlation[axis]).abs() < 0.3,
                "axis {axis} step {step}: {shared} {}",
                correlation[axis]
            );
        }
    }
}

/// The controller at rest asks for hover thrust, and for more of it when below its place.
#[test]
fn the_controller_pushes_the_right_way() {
    let vehicle = Vehicle::survey_450();
    let hover = Motion::hover(&vehicle, Vector3::zeros(), 0.0);
    let target = Target::of(&hover);
    let at = |place: Vector3<f64>| {
        let state = hover.translated(&place).rigid_body_state();
        TrackingController::new(&vehicle, Gains::default()).update(&state, &hover, &target, 0.0)
    };
    assert!((at(Vector3::zeros()) - Vector4::repeat(vehicle.weight() / 4.0)).amax() < 1e-12);
    assert!(at(Vector3::new(0.0, 0.0, -0.1)).sum() > vehicle.weight());
    // Too far east: pitch back, which is a negative torque about y: more thrust in front.
    let (_, torque) = vehicle.mixer().thrust_and_torque(&at(Vector3::new(0.1, 0.0, 0.0)));
    assert!(torque.y < 0.0 && torque.x.abs() < 1e-12);
}
