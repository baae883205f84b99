//! Generated vehicles.
#![allow(dead_code)]

use proptest::prelude::*;
use quad_dynamics::*;

/// From a palm's width to a man's weight, in an X.
pub fn any_vehicle() -> impl Strategy<Value = Vehicle> {
    let sizes = (0.02..20.0_f64, 1.2..5.0_f64, 0.0..0.5_f64, 0.03..0.6_f64);
    (sizes, [0.9..1.3_f64, 0.9..1.3, 1.2..1.75], 0.2..2.0_f64).prop_map(
        |((mass, ratio, drag, arm), shape, rate)| {
            let inertia = shape.map(|share| share * 0.3 * mass * arm * arm);
            let parameters = VehicleParameters::survey_450()
                .with_mass(mass)
                .with_rotors(VehicleParameters::x_layout(arm))
                .with_principal_inertia(inertia)
                .with_max_thrust(ratio * mass * GRAVITY)
                .with_drag_coefficient(drag * mass)
                .with_max_body_rates([6.0 * rate, 6.0 * rate, 3.0 * rate]);
            Vehicle::new(parameters).expect("generated vehicles are sound")
        },
    )
}

/// A preset, or a generated vehicle with rotors in an X, a +, or anywhere around the centre from where they can hold a hover.
pub fn any_layout() -> impl Strategy<Value = Vehicle> {
    let preset = prop::sample::select(VehicleParameters::PRESETS.to_vec())
        .prop_map(|name| Vehicle::preset(name).expect("a name of the list").expect("a preset is sound"));
    prop_oneof![preset, any_generated()]
}

fn any_generated() -> impl Strategy<Value = Vehicle> {
    let askew = prop::array::uniform4((-0.5..0.5_f64, 0.7..1.4_f64)).prop_map(Some);
    (any_vehicle(), any::<bool>(), prop_oneof![Just(None), askew], 0.004..0.03_f64).prop_filter_map(
        "a rotor cannot give what a hover asks of it",
        |(vehicle, plus, askew, torque_to_thrust)| {
            let mut parameters = vehicle.parameters().clone();
            let [x, y] = parameters.rotors[0].position;
            let arm = x.hypot(y);
            if plus {
                parameters.rotors = VehicleParameters::plus_layout(arm);
            }
            for (rotor, (turn, stretch)) in parameters.rotors.iter_mut().zip(askew.into_iter().flatten()) {
                let [x, y] = rotor.position;
                let (sin, cos) = turn.sin_cos();
                rotor.position = [stretch * (cos * x - sin * y), stretch * (sin * x + cos * y)];
            }
            parameters.torque_to_thrust = torque_to_thrust;
            Vehicle::new(parameters).ok()
        },
    )
}
