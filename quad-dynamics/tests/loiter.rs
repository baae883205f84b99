//! Loiters against the force balance, against simulated circles and against states computed elsewhere.

use std::f64::consts::{FRAC_PI_2, TAU};

mod common;

use common::any_vehicle;
use proptest::prelude::*;
use quad_dynamics::nalgebra::{Rotation3, Vector3};
use quad_dynamics::*;

fn survey() -> Vehicle {
    Vehicle::new(VehicleParameters::survey_450()).expect("a preset is sound")
}

fn any_yaw() -> impl Strategy<Value = LoiterYaw> {
    prop_oneof![Just(LoiterYaw::AlongTrack), Just(LoiterYaw::AtTarget)]
}

fn any_direction() -> impl Strategy<Value = Direction> {
    prop_oneof![Just(Direction::CounterClockwise), Just(Direction::Clockwise)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Equations 3 to 5 of the paper in the rotation order yaw, roll, pitch.
    #[test]
    fn forces_balance(
        vehicle in any_vehicle(), radius in 0.3..500.0_f64, share in 0.02..1.0_f64, angle in -7.0..7.0_f64,
        direction in any_direction(),
    ) {
        let least = vehicle.weight() / vehicle.max_thrust();
        let spec = LoiterSpec::new(radius).with_thrust_budget(least + share * (1.0 - least));
        let loiter = Loiter::new(&vehicle, &spec).unwrap();
        let motion = loiter.state(angle, direction);
        let (thrust, v) = (loiter.thrust, loiter.speed);
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * thrust;
        prop_assert!(close(thrust * loiter.bank.cos() * loiter.pitch.cos(), vehicle.weight()));
        prop_assert!(close(thrust * loiter.pitch.cos() * loiter.bank.sin(), vehicle.mass() * v * v / radius));
        prop_assert!(close(thrust * loiter.pitch.sin(), 0.5 * vehicle.drag_coefficient() * v * v));
        let yaw = angle + direction.sign() * FRAC_PI_2;
        let rotation = Rotation3::from_axis_angle(&Vector3::z_axis(), yaw)
            * Rotation3::from_axis_angle(&Vector3::x_axis(), -direction.sign() * loiter.bank)
            * Rotation3::from_axis_angle(&Vector3::y_axis(), loiter.pitch);
        let difference = (rotation.matrix() - motion.attitude.to_rotation_matrix().matrix()).amax();
        prop_assert!(difference < 1e-9, "attitude differs by {}", difference);
        prop_assert!((loiter.tilt() - motion.tilt()).abs() < 1e-7);
        if loiter.limit == Some(Limit::Thrust) {
            prop_assert!(close(thrust, spec.thrust_budget * vehicle.max_thrust()));
        }
    }

    /// Constant rotor thrusts keep the rigid body on its circle, and it closes on itself.
    #[test]
    fn circles_close(
        vehicle in any_vehicle(), radius in 1.0..30.0_f64, share in 0.1..0.9_f64, angle in -3.0..3.0_f64,
        yaw in any_yaw(), direction in any_direction(),
    ) {
        let least = vehicle.weight() / vehicle.max_thrust();
        let spec = LoiterSpec::new(radius).with_thrust_budget(least + share * (1.0 - least)).with_yaw(yaw);
        let loiter = Loiter::new(&vehicle, &spec).unwrap();
        let motion = loiter.state(angle, direction);
        let model = RigidBody::new(&vehicle);
        let start = motion.rigid_body_state();
        let end = rk4(|x| model.derivative(x, &motion.rotor_thrusts), &start, loiter.period(), 2000);
        prop_assert!((end - start).fixed_rows::<6>(0).amax() < 1e-9 * (1.0 + radius), "{}", (end - start).amax());
        prop_assert!((end - start).fixed_rows::<3>(10).amax() < 1e-9 * (1.0 + loiter.angular_speed()));
        // Half a turn of the vertical axis per circle: q comes back as -q.
        prop_assert!((end + start).fixed_rows::<4>(6).amax() < 1e-9);

        let model = ThrustRate::new(&vehicle);
        let start = motion.thrust_rate_state();
        let end = rk4(|x| model.derivative(x, &motion.thrust_rate_control()), &start, loiter.period(), 2000);
        prop_assert!((end - start).fixed_rows::<6>(0).amax() < 1e-9 * (1.0 + radius));
    }

    /// Every limit holds at the speed found, and the one named as binding really ends there.
    #[test]
    fn the_named_limit_binds(
        vehicle in any_vehicle(), radius in 0.2..60.0_f64, share in 0.05..1.0_f64, yaw in any_yaw(),
        speed in prop::option::of(0.5..20.0_f64), bank in prop::option::of(0.05..1.2_f64),
        acceleration in prop::option::of(0.5..20.0_f64), camera in prop::option::of(0.05..5.0_f64),
    ) {
        let least = vehicle.weight() / vehicle.max_thrust();
        let mut spec = LoiterSpec::new(radius).with_thrust_budget(least + share * (1.0 - least)).with_yaw(yaw);
        spec.speed_limit = speed;
        spec.bank_limit = bank;
        spec.acceleration_limit = acceleration;
        spec.camera_limit = camera.map(|angular_speed| CameraLimit { angular_speed });
        let loiter = Loiter::new(&vehicle, &spec).unwrap();
        let tolerance = 1.0 + 1e-9;
        let v = loiter.speed;
        prop_assert!(v > 0.0);
        prop_assert!(loiter.thrust <= spec.thrust_budget * vehicle.max_thrust() * tolerance);
        prop_assert!(speed.is_none_or(|limit| v <= limit));
        prop_assert!(bank.is_none_or(|limit| loiter.bank <= limit * tolerance));
        prop_assert!(acceleration.is_none_or(|limit| v * v / radius <= limit * tolerance));
        prop_assert!(camera.is_none_or(|limit| v / radius <= limit * tolerance));
        let ratios = |v: f64| {
            let probe = Loiter::at_speed(&vehicle, &LoiterSpec::new(radius).with_thrust_budget(1.0).with_yaw(yaw)
                .with_body_rate_limits(false).with_rotor_limits(false), v);
            let motion = probe.unwrap().state(0.3, Direction::Clockwise);
            let rates = motion.body_rates.component_div(&vehicle.max_body_rates()).abs();
            let (low, high) = (motion.rotor_thrusts.min(), motion.rotor_thrusts.max());
            (rates, (high / vehicle.max_rotor_thrust()).max(2.0 - low / vehicle.min_rotor_thrust()))
        };
        let (rates, rotor) = ratios(v * (1.0 - 1e-9));
        prop_assert!(rates.max() <= tolerance && rotor <= tolerance, "{rates} {rotor}");
        let bound = match loiter.limit.unwrap() {
            Limit::Thrust => loiter.thrust / (spec.thrust_budget * vehicle.max_thrust()),
            Limit::Speed => v / speed.unwrap(),
            Limit::Bank => loiter.bank / bank.unwrap(),
            Limit::Acceleration => v * v / radius / acceleration.unwrap(),
            Limit::Camera => v / radius / camera.unwrap(),
            Limit::RollRate => rates.x,
            Limit::PitchRate => rates.y,
            Limit::YawRate => rates.z,
            Limit::Rotor => rotor,
            _ => 0.0,
        };
        prop_assert!((bound - 1.0).abs() < 1e-6, "{:?} at {}", loiter.limit, bound);
    }

    /// Numbers of any kind are answered, never a panic, and an accepted loiter is finite.
    #[test]
    fn any_numbers_are_answered(
        radius in any::<f64>(), budget in any::<f64>(), sweep in any::<f64>(), speed in any::<f64>(), bank in any::<f64>(),
    ) {
        let vehicle = survey();
        for spec in [
            LoiterSpec::new(radius),
            LoiterSpec::new(radius).with_thrust_budget(1.0).with_yaw(LoiterYaw::AtTarget),
            LoiterSpec::new(2.0).with_thrust_budget(budget),
            LoiterSpec::new(2.0).with_sweep(sweep).with_speed_limit(speed).with_bank_limit(bank),
        ] {
            match Loiter::new(&vehicle, &spec) {
                Ok(loiter) => {
                    prop_assert!(spec.problems(&vehicle).is_empty());
                    let motion = loiter.state(1.0, Direction::Clockwise);
                    prop_assert!(motion.rigid_body_state().iter().all(|x| x.is_finite()), "{:?}", spec);
                }
                // As text, since NaN differs from itself.
                Err(error) => prop_assert_eq!(error.to_string(), spec.problems(&vehicle)[0].to_string()),
            }
        }
    }
}

/// The yaw rate passes 2 rad/s below about 1 m of radius at full thrust; larger circles are bound by the thrust.
#[test]
fn the_yaw_rate_binds_small_circles() {
    let vehicle = survey();
    let at = |radius| {
        Loiter::new(&vehicle, &LoiterSpec::new(radius).with_thrust_budget(1.0).with_rotor_limits(false))
    };
    assert_eq!(at(0.8).unwrap().limit, Some(Limit::YawRate));
    assert_eq!(at(1.5).unwrap().limit, Some(Limit::Thrust));
    let loiter = at(0.8).unwrap();
    assert!((loiter.state(0.0, Direction::Clockwise).body_rates.z + 2.0).abs() < 1e-9);
}

/// At full thrust some rotor must give more than its share: `w x J w` is not zero.
#[test]
fn rotor_limits_bind_at_full_thrust() {
    let loiter = Loiter::new(&survey(), &LoiterSpec::new(3.0).with_thrust_budget(1.0)).unwrap();
    assert_eq!(loiter.limit, Some(Limit::Rotor));
    assert!(loiter.thrust < survey().max_thrust());
}

#[test]
fn a_budget_below_the_weight_says_how_much_is_missing() {
    let error = Loiter::new(&survey(), &LoiterSpec::new(3.0).with_thrust_budget(0.4)).unwrap_err();
    let Error::BudgetBelowWeight { thrust, weight, least_budget, .. } = error else { panic!("{error}") };
    assert!((weight - thrust - 2.943).abs() < 1e-9 && (least_budget - 0.5).abs() < 1e-12);
    assert!(error.to_string().contains("2.943 N short"), "{error}");
    assert!(Loiter::new(&survey(), &LoiterSpec::new(3.0).with_thrust_budget(least_budget)).is_err());
    assert!(Loiter::new(&survey(), &LoiterSpec::new(3.0).with_thrust_budget(least_budget * 1.0001)).is_ok());
}

#[test]
fn speeds_above_a_limit_are_refused() {
    let spec = LoiterSpec::new(3.0).with_speed_limit(2.0);
    let error = Loiter::at_speed(&survey(), &spec, 2.5).unwrap_err();
    assert_eq!(error, Error::SpeedAboveLimit { speed: 2.5, allowed: 2.0, limit: Limit::Speed });
    let loiter = Loiter::at_speed(&survey(), &spec, 1.5).unwrap();
    assert_eq!((loiter.speed, loiter.limit), (1.5, None));
}

#[test]
fn a_longer_sweep_leaves_elsewhere() {
    let loiter = Loiter::new(&survey(), &LoiterSpec::new(3.0).with_sweep(TAU + 0.35)).unwrap();
    let (entry, exit) =
        (loiter.state(1.0, Direction::Clockwise), loiter.exit_state(1.0, Direction::Clockwise));
    let angle = exit.position.y.atan2(exit.position.x);
    assert!((angle - 0.65).abs() < 1e-12 && (entry.position - exit.position).norm() > 1.0);
    assert!((loiter.duration() / loiter.period() - (1.0 + 0.35 / TAU)).abs() < 1e-12);
}

/// Facing the target, body x has no component along the track.
#[test]
fn at_target_faces_the_target() {
    let loiter = Loiter::new(&survey(), &LoiterSpec::new(3.0).with_yaw(LoiterYaw::AtTarget)).unwrap();
    for direction in Direction::BOTH {
        let motion = loiter.state(0.7, direction);
        let (x, z) = (motion.attitude * Vector3::x(), motion.attitude * Vector3::z());
        let inward = -motion.position.normalize();
        assert!(x.cross(&z).dot(&inward).abs() < 1e-12 && x.dot(&inward) > 0.8);
    }
}

/// Start and end states of the reference transitions (`tests/data/README.md`).
#[test]
fn states_match_the_reference_transitions() {
    let text = include_str!("data/transitions.csv");
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let vehicle = survey();
    let mut n_states = 0;
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let get = |name: &str| -> f64 {
            let column = header.iter().position(|h| *h == name).unwrap();
            cells[column].parse().unwrap()
        };
        for (end, circle) in [("start", "0"), ("end", "1")] {
            let centre = Vector3::from(["x", "y", "z"].map(|axis| get(&format!("c{circle}{axis}"))));
            let spec =
                LoiterSpec::new(get(&format!("r{circle}"))).with_thrust_budget(1.0).with_rotor_limits(false);
            let loiter = Loiter::new(&vehicle, &spec).unwrap();
            let clockwise = get(&format!("dir{circle}")) < 0.0;
            let direction = if clockwise { Direction::Clockwise } else { Direction::CounterClockwise };
            let state =
                loiter.state(get(&format!("ang{circle}")), direction).translated(&centre).rigid_body_state();
            let names = ["px", "py", "pz", "vx", "vy", "vz", "qw", "qx", "qy", "qz", "wx", "wy", "wz"];
            let wanted = names.map(|name| get(&format!("{end}_{name}")));
            let sign = (6..10).map(|i| state[i] * wanted[i]).sum::<f64>().signum();
            for i in 0..13 {
                let factor = if (6..10).contains(&i) { sign } else { 1.0 };
                assert!((factor * state[i] - wanted[i]).abs() < 1e-8, "{end} {} of {line}", names[i]);
            }
            n_states += 1;
        }
    }
    assert_eq!(n_states, 100);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// In wind the states obey the equation of motion, stay in the budget, and touch it where thrust binds.
    #[test]
    fn windy_circles_stay_in_budget(
        vehicle in any_vehicle(), radius in 2.0..40.0_f64, share in 0.3..0.9_f64, wind in [-4.0..4.0_f64, -4.0..4.0, -1.0..1.0],
        yaw in any_yaw(), direction in any_direction(),
    ) {
        let least = vehicle.weight() / vehicle.max_thrust();
        let budget = least + share * (1.0 - least);
        let spec = LoiterSpec::new(radius).with_thrust_budget(budget).with_yaw(yaw);
        let wind = Vector3::from(wind);
        let Ok(loiter) = WindyLoiter::new(&vehicle, &spec, wind, direction) else {
            let hover = (Vector3::new(0.0, 0.0, vehicle.weight()) + vehicle.drag(&wind)).norm();
            prop_assert!(hover >= budget * vehicle.max_thrust());
            return Ok(());
        };
        let model = RigidBody::new(&vehicle).with_wind(wind);
        let mut greatest = 0.0_f64;
        for i in 0..720 {
            let motion = loiter.state(i as f64 * TAU / 720.0);
            greatest = greatest.max(motion.collective_thrust);
            let rate = model.derivative(&motion.rigid_body_state(), &motion.rotor_thrusts);
            prop_assert!((rate.fixed_rows::<3>(3) - motion.acceleration).amax() < 1e-9);
        }
        let share = greatest / (budget * vehicle.max_thrust());
        prop_assert!(share < 1.0 + 1e-3, "{share}");
        prop_assert!(loiter.limit != Limit::Thrust || share > 1.0 - 1e-6, "{share}");
        // The body rates are those of the attitude that changes along the circle.
        let step = 1e-5;
        let (before, now, after) = (loiter.state(1.0 - step), loiter.state(1.0), loiter.state(1.0 + step));
        let turned = (before.attitude.inverse() * after.attitude).scaled_axis();
        let rates = turned * (direction.sign() * loiter.angular_speed() / (2.0 * step));
        prop_assert!((rates - now.body_rates).norm() < 1e-5 * (1.0 + rates.norm()), "{rates} {}", now.body_rates);
    }

    /// Radius for a speed and for a period, and back.
    #[test]
    fn radii_can_be_chosen(vehicle in any_vehicle(), radius in 1.0..60.0_f64, share in 0.1..0.9_f64) {
        let least = vehicle.weight() / vehicle.max_thrust();
        let spec = LoiterSpec::new(radius).with_thrust_budget(least + share * (1.0 - least));
        let loiter = Loiter::new(&vehicle, &spec).unwrap();
        let again = Loiter::with_speed(&vehicle, &spec, loiter.speed * 0.999).unwrap();
        prop_assert!(again.radius <= radius && (again.speed / loiter.speed - 0.999).abs() < 1e-12);
        let again = Loiter::with_period(&vehicle, &spec, loiter.period()).unwrap();
        prop_assert!((again.period() / loiter.period() - 1.0).abs() < 1e-9 && again.radius > radius * (1.0 - 1e-6));
        let quickest = Loiter::quickest(&vehicle, &spec, 0.5, 60.0).unwrap();
        prop_assert!(quickest.period() <= loiter.period() * (1.0 + 1e-9));
    }
}

/// Without wind the windy circle is the circle.
#[test]
fn no_wind_is_no_wind() {
    let spec = LoiterSpec::new(3.0);
    let still = Loiter::new(&survey(), &spec).unwrap();
    let windy = WindyLoiter::new(&survey(), &spec, Vector3::zeros(), Direction::Clockwise).unwrap();
    assert!((windy.speed / still.speed - 1.0).abs() < 1e-12 && windy.limit == Limit::Thrust);
    let (a, b) = (windy.state(0.3), still.state(0.3, Direction::Clockwise));
    assert!((a.rigid_body_state() - b.rigid_body_state()).amax() < 1e-12);
    let storm = WindyLoiter::new(&survey(), &spec, Vector3::new(20.0, 0.0, 0.0), Direction::Clockwise);
    assert!(matches!(storm, Err(Error::WindTooStrong { .. })));
    assert!(
        WindyLoiter::new(&survey(), &spec, Vector3::new(f64::NAN, 0.0, 0.0), Direction::Clockwise).is_err()
    );
}
