//! Names and units of the states and controls of each model, in the order in which the planner lists them.

use planner::Model;
use std::collections::BTreeMap;

const POSITION: [&str; 3] = ["position_east_m", "position_north_m", "position_up_m"];
const VELOCITY: [&str; 3] = ["velocity_east_m_s", "velocity_north_m_s", "velocity_up_m_s"];
const ACCELERATION: [&str; 3] = ["acceleration_east_m_s2", "acceleration_north_m_s2", "acceleration_up_m_s2"];
const ATTITUDE: [&str; 4] = ["attitude_w", "attitude_x", "attitude_y", "attitude_z"];
const BODY_RATES: [&str; 3] = ["body_rate_x_rad_s", "body_rate_y_rad_s", "body_rate_z_rad_s"];
const THRUST_VECTOR: [&str; 3] = ["thrust_east_N", "thrust_north_N", "thrust_up_N"];
const ROTOR_THRUSTS: [&str; 4] =
    ["rotor_1_thrust_N", "rotor_2_thrust_N", "rotor_3_thrust_N", "rotor_4_thrust_N"];
const JERK: [&str; 3] = ["jerk_east_m_s3", "jerk_north_m_s3", "jerk_up_m_s3"];

/// The states of a model.
#[must_use]
pub fn state_columns(model: Model) -> Vec<&'static str> {
    match model {
        Model::PointMass => [&POSITION[..], &VELOCITY].concat(),
        Model::JerkLimited => [&POSITION[..], &VELOCITY, &ACCELERATION].concat(),
        Model::ThrustRate => [&POSITION[..], &VELOCITY, &ATTITUDE].concat(),
        Model::RigidBody => [&POSITION[..], &VELOCITY, &ATTITUDE, &BODY_RATES].concat(),
    }
}

/// The controls of a model.
#[must_use]
pub fn control_columns(model: Model) -> Vec<&'static str> {
    match model {
        Model::PointMass => THRUST_VECTOR.to_vec(),
        Model::JerkLimited => JERK.to_vec(),
        Model::ThrustRate => [&["collective_thrust_N"], &BODY_RATES[..]].concat(),
        Model::RigidBody => ROTOR_THRUSTS.to_vec(),
    }
}

/// Rows turned into named columns.
#[must_use]
pub fn by_column(names: &[&str], rows: &[Vec<f64>]) -> BTreeMap<String, Vec<f64>> {
    let column = |index: usize| rows.iter().filter_map(|row| row.get(index).copied()).collect();
    names.iter().enumerate().map(|(index, name)| ((*name).to_owned(), column(index))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_model_has_as_many_names_as_the_design_says() {
        for (model, states, controls) in [
            (Model::PointMass, 6, 3),
            (Model::JerkLimited, 9, 3),
            (Model::ThrustRate, 10, 4),
            (Model::RigidBody, 13, 4),
        ] {
            assert_eq!((state_columns(model).len(), control_columns(model).len()), (states, controls));
        }
    }

    #[test]
    fn columns_are_the_transposed_rows() {
        let table = by_column(&["a", "b"], &[vec![1.0, 2.0], vec![3.0, 4.0]]);
        assert_eq!(table["a"], [1.0, 3.0]);
        assert_eq!(table["b"], [2.0, 4.0]);
    }
}
