//! Between rotor thrusts and what they do to the body.

use nalgebra::{Matrix4, Vector3, Vector4};

use crate::error::Error;
use crate::vehicle::Rotor;

/// Linear map between four rotor thrusts and (collective thrust, torque).
///
/// A rotor at `(x, y)` with thrust `f` gives the torque `(y f, -x f, ± k f)`, `k` the torque-to-thrust length and the
/// sign its spin's.
#[derive(Debug, Clone, PartialEq)]
pub struct Mixer {
    forward: Matrix4<f64>,
    inverse: Matrix4<f64>,
}

impl Mixer {
    /// The map of four rotors with yaw torque `torque_to_thrust` (m) per newton.
    ///
    /// # Errors
    /// [`Error::RotorsDependent`] if the rotors cannot produce the three torques independently.
    pub fn new(rotors: &[Rotor; 4], torque_to_thrust: f64) -> Result<Self, Error> {
        // Below this determinant of the matrix with rows of length one, the inverse is noise.
        const LEAST_DETERMINANT: f64 = 1e-9;
        let column = |rotor: &Rotor| {
            let [x, y] = rotor.position;
            Vector4::new(1.0, y, -x, rotor.spin.yaw_sign() * torque_to_thrust)
        };
        let forward = Matrix4::from_columns(&rotors.each_ref().map(column));
        let lengths = Vector4::from_fn(|row, _| forward.row(row).norm().recip());
        let scale = Matrix4::from_diagonal(&lengths);
        let normalised = scale * forward;
        let independent = normalised.determinant().abs() > LEAST_DETERMINANT;
        let inverse = normalised.try_inverse().filter(|_| independent).map(|inverse| inverse * scale);
        let inverse = inverse.filter(|m| m.iter().all(|x| x.is_finite())).ok_or(Error::RotorsDependent)?;
        Ok(Self { forward, inverse })
    }

    /// Collective thrust (N) and torque (N m, body axes) of rotor thrusts (N).
    #[must_use]
    pub fn thrust_and_torque(&self, rotor_thrusts: &Vector4<f64>) -> (f64, Vector3<f64>) {
        let wrench = self.forward * rotor_thrusts;
        (wrench[0], wrench.fixed_rows::<3>(1).into_owned())
    }

    /// The rotor thrusts (N) with this collective thrust (N) and torque (N m); they may lie outside what rotors can do.
    #[must_use]
    pub fn rotor_thrusts(&self, collective_thrust: f64, torque: &Vector3<f64>) -> Vector4<f64> {
        self.inverse * Vector4::new(collective_thrust, torque.x, torque.y, torque.z)
    }
}
