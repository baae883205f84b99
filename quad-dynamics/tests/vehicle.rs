//! Parameters: what is refused, with which words, and presets.

mod common;

use common::any_layout;
use proptest::prelude::*;
use quad_dynamics::nalgebra::{Vector3, Vector4};
use quad_dynamics::*;

#[test]
fn presets_are_sound_and_hover() {
    for name in VehicleParameters::PRESETS {
        let vehicle = Vehicle::preset(name).unwrap().unwrap();
        let hover = vehicle.mixer().rotor_thrusts(vehicle.weight(), &Vector3::zeros());
        assert!((hover / (vehicle.weight() / 4.0) - Vector4::repeat(1.0)).amax() < 1e-12, "{name}");
        let speed = (vehicle.max_rotor_thrust() / vehicle.thrust_coefficient()).sqrt();
        assert!((speed / vehicle.parameters().propulsion.max_rotor_speed - 1.0).abs() < 1e-12);
        assert!(Loiter::new(&vehicle, &LoiterSpec::new(3.0)).unwrap().speed > 1.0);
    }
    assert_eq!(Vehicle::survey_450(), Vehicle::preset("survey-450").unwrap().unwrap());
}

/// Torques of the survey quadcopter as its data's description has them.
#[test]
fn the_survey_quadcopter_mixes_as_documented() {
    let a = 0.225 / 2.0_f64.sqrt();
    let f = [3.0, 4.0, 5.0, 6.5];
    let (thrust, torque) = Vehicle::survey_450().mixer().thrust_and_torque(&Vector4::from(f));
    let wanted = [
        a * (-f[0] + f[1] + f[2] - f[3]),
        a * (-f[0] + f[1] - f[2] + f[3]),
        0.016 * (f[0] + f[1] - f[2] - f[3]),
    ];
    assert!((torque - Vector3::from(wanted)).amax() < 1e-14 && (thrust - 18.5).abs() < 1e-14);
}

#[test]
fn every_problem_is_named() {
    let mut parameters = VehicleParameters::survey_450();
    parameters.mass = -1.0;
    parameters.max_body_rates[1] = f64::NAN;
    parameters.inertia_tensor[0][1] = 0.1;
    let text: Vec<String> = parameters.problems().iter().map(ToString::to_string).collect();
    assert_eq!(text[0], "`mass` is -1 but must be finite and above zero");
    assert!(text[1].contains("max_body_rates") && text[1].contains("NaN"), "{text:?}");
    assert!(text[2].contains("(0, 1) and (1, 0) differ"), "{text:?}");
    assert_eq!(text.len(), 3);
}

#[test]
fn impossible_vehicles_are_refused() {
    let base = VehicleParameters::survey_450;
    let refused = |parameters: VehicleParameters| Vehicle::new(parameters).unwrap_err();
    assert!(matches!(refused(base().with_max_thrust(14.0)), Error::ThrustBelowWeight { .. }));
    assert!(matches!(
        refused(base().with_principal_inertia([0.01, 0.01, 0.03])),
        Error::InertiaNotPhysical { .. }
    ));
    assert!(matches!(
        refused(base().with_principal_inertia([0.0, 0.01, 0.01])),
        Error::InertiaNotPhysical { .. }
    ));
    // A lamina meets the triangle inequality with equality and is a real body.
    assert!(Vehicle::new(base().with_principal_inertia([0.01, 0.01, 0.02])).is_ok());
    let mut one_spin = base();
    one_spin.rotors.iter_mut().for_each(|rotor| rotor.spin = Spin::Clockwise);
    assert!(matches!(refused(one_spin), Error::RotorsDependent));
    let mut line = base();
    line.rotors.iter_mut().for_each(|rotor| rotor.position[1] = 0.0);
    assert!(matches!(refused(line), Error::RotorsDependent));
    let mut lopsided = base();
    lopsided.rotors.iter_mut().for_each(|rotor| rotor.position[0] += 0.15);
    assert!(matches!(refused(lopsided), Error::HoverImbalance { .. }));
    let mut heavy_idle = base();
    heavy_idle.min_thrust_share = 0.6;
    assert!(matches!(refused(heavy_idle), Error::LeastThrustAboveWeight { .. }));
}

proptest! {
    /// No numbers make the checks panic, and what they accept flies.
    #[test]
    fn any_numbers_are_answered(
        mass in any::<f64>(), thrust in any::<f64>(), moments in any::<[f64; 3]>(), arm in any::<f64>(),
        drag in any::<f64>(), mild in 0.01..100.0_f64,
    ) {
        let base = VehicleParameters::survey_450;
        let full = base().with_mass(mass).with_max_thrust(thrust).with_principal_inertia(moments)
            .with_rotors(VehicleParameters::x_layout(arm)).with_drag_coefficient(drag);
        let each = [
            full,
            base().with_mass(mild).with_max_thrust(thrust),
            base().with_principal_inertia(moments),
            base().with_rotors(VehicleParameters::plus_layout(arm)),
            base().with_drag_coefficient(drag),
        ];
        for parameters in each {
            if let Ok(vehicle) = Vehicle::new(parameters) {
                let hover = Motion::hover(&vehicle, Vector3::zeros(), 0.0);
                let thrust = hover.rotor_thrusts.sum();
                prop_assert!((thrust / vehicle.weight() - 1.0).abs() < 1e-9, "{thrust} {}", vehicle.weight());
            }
        }
    }

    /// The mixer's two directions undo each other, and the torque is that of forces at their places and of the spins.
    #[test]
    fn the_mixer_inverts(f in [-9.0..9.0_f64, -9.0..9.0, -9.0..9.0, -9.0..9.0], vehicle in any_layout()) {
        let (thrust, torque) = vehicle.mixer().thrust_and_torque(&Vector4::from(f));
        prop_assert!((vehicle.mixer().rotor_thrusts(thrust, &torque) - Vector4::from(f)).amax() < 1e-11);
        let arms = vehicle.rotors().iter().zip(f).map(|(rotor, f)| {
            let [x, y] = rotor.position;
            Vector3::new(x, y, 0.0).cross(&Vector3::new(0.0, 0.0, f))
                + Vector3::z() * (rotor.spin.yaw_sign() * vehicle.torque_to_thrust() * f)
        });
        prop_assert!((arms.sum::<Vector3<f64>>() - torque).amax() < 1e-12 * (1.0 + torque.norm()));
        prop_assert!((f.iter().sum::<f64>() - thrust).abs() < 1e-12 * (1.0 + thrust.abs()));
    }
}

#[cfg(feature = "serde")]
#[test]
fn parameters_survive_a_file() {
    for name in VehicleParameters::PRESETS {
        let vehicle = Vehicle::preset(name).unwrap().unwrap();
        let text = serde_json::to_string(&vehicle).unwrap();
        assert_eq!(serde_json::from_str::<Vehicle>(&text).unwrap(), vehicle);
    }
    let text = serde_json::to_string(&VehicleParameters::survey_450()).unwrap();
    let bad = text.replace("\"mass\":1.5", "\"mass\":-1.5");
    assert!(serde_json::from_str::<Vehicle>(&bad).unwrap_err().to_string().contains("`mass` is -1.5"));
    let unknown = text.replace("\"mass\"", "\"weight\":3.0,\"mass\"");
    assert!(serde_json::from_str::<Vehicle>(&unknown).is_err());
}

#[test]
fn a_negative_least_rotor_speed_is_refused() {
    let with_least = |speed: f64| {
        let parameters =
            VehicleParameters::survey_450().with_rotor_coefficients(1.2e-5, 1.9e-7, speed, 800.0);
        Vehicle::new(parameters)
    };
    assert!(with_least(100.0).is_ok());
    assert!(with_least(-100.0).is_err() && with_least(f64::NAN).is_err());
}
