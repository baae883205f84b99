//! Vehicles that someone measured, each with its source.

use crate::vehicle::{VehicleParameters, diagonal};

impl VehicleParameters {
    /// A 450 mm-class survey quadcopter: 1.5 kg, thrust twice its weight.
    ///
    /// The size of vehicle that Gao, Mandal and Bhattacharya (2020) flew; the numbers are those of the reference
    /// transitions in `tests/data/transitions.csv`: inertia diag(0.015, 0.015, 0.028) kg m^2, rotors 0.225 m from the
    /// centre in an X, yaw torque to thrust 0.016 m, drag coefficient 0.15 kg/m.
    #[must_use]
    pub fn survey_450() -> Self {
        Self {
            mass: 1.5,
            inertia_tensor: diagonal([0.015, 0.015, 0.028]),
            rotors: Self::x_layout(0.225),
            max_thrust: 29.43,
            min_thrust_share: Self::DEFAULT_MIN_THRUST_SHARE,
            drag_coefficient: 0.15,
            max_body_rates: [6.0, 6.0, 2.0],
            torque_to_thrust: 0.016,
        }
    }
}
