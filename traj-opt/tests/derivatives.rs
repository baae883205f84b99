//! Derivatives: closed forms against automatic differentiation.
mod common;

use common::quadcopter::*;
use nalgebra::{RealField, SVector};
use traj_opt::{Bounds, Dynamics, Hessian, Problem, check_derivatives, check_path_derivatives};

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

/// A path function `x0^2 u0 + x1` with its derivatives, of which `wrong` spoils one.
struct Product {
    wrong: [f64; 2],
    hessian: bool,
}

impl Dynamics<2, 1> for Product {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
        SVector::from([x[1], u[0]])
    }
}

impl Problem<2, 1> for Product {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<2, 1> {
        Bounds::free()
    }

    fn n_path(&self) -> usize {
        1
    }

    fn path<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>, values: &mut [T]) {
        values[0] = x[0] * x[0] * u[0] + x[1];
    }

    fn path_gradients(
        &self,
        x: &SVector<f64, 2>,
        u: &SVector<f64, 1>,
        by_state: &mut [SVector<f64, 2>],
        by_control: &mut [SVector<f64, 1>],
    ) -> bool {
        by_state[0] = SVector::from([2.0 * x[0] * u[0], 1.0]);
        by_control[0] = SVector::from([x[0] * x[0] + self.wrong[0]]);
        true
    }

    fn path_hessian(
        &self,
        x: &SVector<f64, 2>,
        u: &SVector<f64, 1>,
        weights: &[f64],
        sum: &mut Hessian<2, 1>,
    ) -> bool {
        sum.state_state[(0, 0)] += weights[0] * 2.0 * u[0];
        sum.state_control[(0, 0)] += weights[0] * (2.0 * x[0] + self.wrong[1]);
        self.hessian
    }
}

#[test]
fn wrong_derivatives_of_path_functions_are_found() {
    let (x, u) = (SVector::from([0.7, -1.3]), SVector::from([2.1]));
    let check = |wrong, hessian| check_path_derivatives(&Product { wrong, hessian }, &x, &u);
    assert!(check([0.0; 2], true) < 1e-14);
    assert!(check([1e-3, 0.0], true) > 1e-4, "a gradient");
    assert!(check([0.0, 1e-3], true) > 1e-4, "a second derivative");
    assert!(check([f64::NAN, 0.0], true).is_nan(), "not a number");
    assert_eq!(check([0.0; 2], false), f64::INFINITY, "gradients without second derivatives");
}
