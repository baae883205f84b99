//! Derivatives: closed forms against automatic differentiation.
mod common;

use common::quadcopter::*;
use nalgebra::SVector;
use traj_opt::check_derivatives;

#[test]
fn closed_forms_of_the_quadcopter_agree_with_automatic_differentiation() {
    for r in references() {
        let scale = 1.0 + 0.1 * (r.id % 5) as f64;
        let mut x = r.start;
        for i in 6..10 {
            x[i] *= scale;
        }
        let rates = SVector::from([11.0 + r.id as f64 * 0.3, 1.0 - 0.2 * r.id as f64, 2.0, -0.7]);
        let a = x.fixed_rows::<10>(0).into_owned();
        assert!(check_derivatives(&ThrustRate, 0.0, &a, &rates) < 1e-11, "model A, transition {}", r.id);
        assert!(check_derivatives(&RigidBody, 0.0, &x, &rates) < 1e-11, "model B, transition {}", r.id);
    }
}
