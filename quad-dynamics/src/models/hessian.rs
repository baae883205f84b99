//! Analytic second derivatives of the models, contracted with a weight, for floats: what an optimal-control solver spends
//! most of its time on when they come from dual numbers.

use nalgebra::{Matrix3, Matrix4, Matrix4x3, SMatrix, SVector, Vector3, Vector4};

use super::{Air, JerkLimited, PointMass, RigidBody, ThrustRate};

/// Second derivatives of the scalar `weight . f(x, u)`; those by control alone are zero in every model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hessian<const NX: usize, const NU: usize> {
    /// State by state, symmetric.
    pub state_state: SMatrix<f64, NX, NX>,
    /// State (row) by control (column).
    pub state_control: SMatrix<f64, NX, NU>,
}

impl<const NX: usize, const NU: usize> Hessian<NX, NU> {
    fn zeros() -> Self {
        Self { state_state: SMatrix::zeros(), state_control: SMatrix::zeros() }
    }
}

impl PointMass {
    /// Second derivatives of `weight .` [`derivative`](Self::derivative).
    #[must_use]
    pub fn hessian(&self, state: &SVector<f64, 6>, weight: &SVector<f64, 6>) -> Hessian<6, 3> {
        let mut hessian = Hessian::<6, 3>::zeros();
        let drag = drag_curvature(&self.air, &rows(state, 3), &rows(weight, 3));
        hessian.state_state.fixed_view_mut::<3, 3>(3, 3).copy_from(&drag);
        hessian
    }
}

impl JerkLimited {
    /// Second derivatives of `weight .` [`derivative`](Self::derivative): all zero, the model is linear.
    #[must_use]
    pub fn hessian(&self) -> Hessian<9, 3> {
        Hessian::zeros()
    }
}

impl ThrustRate {
    /// Second derivatives of `weight .` [`derivative`](Self::derivative).
    #[must_use]
    pub fn hessian(
        &self,
        state: &SVector<f64, 10>,
        control: &SVector<f64, 4>,
        weight: &SVector<f64, 10>,
    ) -> Hessian<10, 4> {
        let mut hessian = Hessian::<10, 4>::zeros();
        let lift = Lift::new(&rows(state, 6), &rows(weight, 3), self.air.inverse_mass);
        let drag = drag_curvature(&self.air, &rows(state, 3), &rows(weight, 3));
        hessian.state_state.fixed_view_mut::<3, 3>(3, 3).copy_from(&drag);
        hessian.state_state.fixed_view_mut::<4, 4>(6, 6).copy_from(&(lift.curvature * control[0]));
        hessian.state_control.fixed_view_mut::<4, 1>(6, 0).copy_from(&lift.gradient);
        hessian.state_control.fixed_view_mut::<4, 3>(6, 1).copy_from(&turning(&rows(weight, 6)));
        hessian
    }
}

impl RigidBody {
    /// Second derivatives of `weight .` [`derivative`](Self::derivative).
    #[must_use]
    pub fn hessian(
        &self,
        state: &SVector<f64, 13>,
        control: &SVector<f64, 4>,
        weight: &SVector<f64, 13>,
    ) -> Hessian<13, 4> {
        let mut hessian = Hessian::<13, 4>::zeros();
        let lift = Lift::new(&rows(state, 6), &rows(weight, 3), self.air.inverse_mass);
        let drag = drag_curvature(&self.air, &rows(state, 3), &rows(weight, 3));
        let block = &mut hessian.state_state;
        block.fixed_view_mut::<3, 3>(3, 3).copy_from(&drag);
        block.fixed_view_mut::<4, 4>(6, 6).copy_from(&(lift.curvature * control.sum()));
        let turning = turning(&rows(weight, 6));
        block.fixed_view_mut::<4, 3>(6, 10).copy_from(&turning);
        block.fixed_view_mut::<3, 4>(10, 6).copy_from(&turning.transpose());
        // -l . (w x J w) with l = J^-T weight is the quadratic form w' [l]x J w.
        let l: Vector3<f64> = self.vehicle.inverse_inertia_tensor().tr_mul(&rows::<3, 13>(weight, 10));
        let gyroscopic = l.cross_matrix() * self.vehicle.inertia_tensor();
        block.fixed_view_mut::<3, 3>(10, 10).copy_from(&(gyroscopic + gyroscopic.transpose()));
        for rotor in 0..4 {
            hessian.state_control.fixed_view_mut::<4, 1>(6, rotor).copy_from(&lift.gradient);
        }
        hessian
    }
}

fn rows<const N: usize, const S: usize>(vector: &SVector<f64, S>, start: usize) -> SVector<f64, N> {
    SVector::from_fn(|i, _| vector[start + i])
}

/// Second derivatives by velocity of `weight . (-k |v| v)`, `v` relative to the air:
/// `-k [(l.v)/|v| (I - n n') + n l' + l n']`, `n = v/|v|`; zero at rest, where they do not exist but are bounded.
fn drag_curvature(air: &Air, velocity: &Vector3<f64>, weight: &Vector3<f64>) -> Matrix3<f64> {
    let relative = velocity - air.wind;
    let speed = relative.norm();
    if speed == 0.0 {
        return Matrix3::zeros();
    }
    let n = relative / speed;
    let mixed = n * weight.transpose();
    let across = (Matrix3::identity() - n * n.transpose()) * weight.dot(&n);
    (across + mixed + mixed.transpose()) * -air.drag_per_mass
}

/// First and second derivatives by the quaternion of `weight . z_b / m`, the acceleration that a newton of thrust gives.
struct Lift {
    gradient: Vector4<f64>,
    curvature: Matrix4<f64>,
}

impl Lift {
    /// `z_b . l = q' F q / |q|^2` with a symmetric `F`, so with `c` its value and `s = |q|^2` the gradient is
    /// `g = 2 (F q - c q)/s` and the curvature `2 (F - c I - q g' - g q')/s`.
    fn new(q: &Vector4<f64>, weight: &Vector3<f64>, inverse_mass: f64) -> Self {
        let [x, y, z] = [weight.x, weight.y, weight.z];
        #[rustfmt::skip]
        let form = Matrix4::new(
            z, -y, x, 0.0,
            -y, -z, 0.0, x,
            x, 0.0, -z, y,
            0.0, x, y, z,
        );
        let squared = q.norm_squared();
        let image = form * q;
        let value = q.dot(&image) / squared;
        let gradient = (image - q * value) * (2.0 / squared);
        let mixed = q * gradient.transpose();
        let curvature = (form - Matrix4::identity() * value - mixed - mixed.transpose()) * (2.0 / squared);
        Self { gradient: gradient * inverse_mass, curvature: curvature * inverse_mass }
    }
}

/// Second derivatives of `weight . q'` by quaternion (row) and body rates (column): the quaternion's rate is bilinear.
fn turning(weight: &Vector4<f64>) -> Matrix4x3<f64> {
    let [w, x, y, z] = [0, 1, 2, 3].map(|i| 0.5 * weight[i]);
    #[rustfmt::skip]
    let matrix = Matrix4x3::new(
        x, y, z,
        -w, z, -y,
        -z, -w, x,
        y, -x, -w,
    );
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Vehicle, VehicleParameters};
    use num_dual::Dual2SVec64;
    use proptest::prelude::*;

    const TOLERANCE: f64 = 1e-9;

    /// Second derivatives of `weight . f` by dual numbers over state and control together.
    fn by_dual_numbers<const N: usize>(
        values: &SVector<f64, N>,
        function: impl Fn(&SVector<Dual2SVec64<N>, N>) -> Dual2SVec64<N>,
    ) -> SMatrix<f64, N, N> {
        let seeded = SVector::from_fn(|i, _| Dual2SVec64::from_re(values[i]).derivative(i));
        function(&seeded).v2.0.unwrap_or_else(SMatrix::zeros)
    }

    fn weighted<const N: usize, const M: usize>(
        rate: &SVector<Dual2SVec64<M>, N>,
        weight: &SVector<f64, N>,
    ) -> Dual2SVec64<M> {
        (0..N).map(|i| rate[i] * weight[i]).fold(Dual2SVec64::from_re(0.0), |sum, term| sum + term)
    }

    fn vehicle() -> Vehicle {
        let mut parameters = VehicleParameters::survey_450();
        parameters.inertia_tensor = [[0.015, 0.001, 0.0], [0.001, 0.017, 0.002], [0.0, 0.002, 0.028]];
        Vehicle::new(parameters).unwrap()
    }

    fn numbers<const N: usize>() -> impl Strategy<Value = SVector<f64, N>> {
        prop::array::uniform::<_, N>(-3.0..3.0f64).prop_map(SVector::from)
    }

    proptest! {
        #[test]
        fn thrust_rate_agrees_with_dual_numbers(values in numbers::<14>(), weight in numbers::<10>()) {
            prop_assume!(rows::<4, 14>(&values, 6).norm() > 0.1 && rows::<3, 14>(&values, 3).norm() > 0.1);
            let model = ThrustRate::new(&vehicle()).with_wind(Vector3::new(0.1, -0.2, 0.05));
            let expected = by_dual_numbers(&values, |v| {
                weighted(&model.derivative(&SVector::from_fn(|i, _| v[i]), &SVector::from_fn(|i, _| v[10 + i])), &weight)
            });
            let found = model.hessian(&rows(&values, 0), &rows(&values, 10), &weight);
            prop_assert!((found.state_state - expected.fixed_view::<10, 10>(0, 0)).amax() < TOLERANCE * (1.0 + expected.amax()));
            prop_assert!((found.state_control - expected.fixed_view::<10, 4>(0, 10)).amax() < TOLERANCE * (1.0 + expected.amax()));
            prop_assert!(expected.fixed_view::<4, 4>(10, 10).amax() == 0.0);
        }

        #[test]
        fn rigid_body_agrees_with_dual_numbers(values in numbers::<17>(), weight in numbers::<13>()) {
            prop_assume!(rows::<4, 17>(&values, 6).norm() > 0.1 && rows::<3, 17>(&values, 3).norm() > 0.1);
            let model = RigidBody::new(&vehicle());
            let expected = by_dual_numbers(&values, |v| {
                weighted(&model.derivative(&SVector::from_fn(|i, _| v[i]), &SVector::from_fn(|i, _| v[13 + i])), &weight)
            });
            let found = model.hessian(&rows(&values, 0), &rows(&values, 13), &weight);
            prop_assert!((found.state_state - expected.fixed_view::<13, 13>(0, 0)).amax() < TOLERANCE * (1.0 + expected.amax()));
            prop_assert!((found.state_control - expected.fixed_view::<13, 4>(0, 13)).amax() < TOLERANCE * (1.0 + expected.amax()));
        }

        #[test]
        fn point_mass_agrees_with_dual_numbers(values in numbers::<6>(), weight in numbers::<6>()) {
            prop_assume!(rows::<3, 6>(&values, 3).norm() > 0.1);
            let model = PointMass::new(&vehicle());
            let still = SVector::from_element(Dual2SVec64::from_re(1.0));
            let expected = by_dual_numbers(&values, |v| weighted(&model.derivative(v, &still), &weight));
            prop_assert!((model.hessian(&values, &weight).state_state - expected).amax() < TOLERANCE * (1.0 + expected.amax()));
        }
    }

    #[test]
    fn at_rest_nothing_is_undefined() {
        let model = PointMass::new(&vehicle());
        let hessian = model.hessian(&SVector::zeros(), &SVector::repeat(1.0));
        assert!(hessian.state_state.iter().all(|x| x.is_finite()));
    }
}
