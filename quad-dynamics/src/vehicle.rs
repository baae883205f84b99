//! The vehicle in the checked form that everything else takes.

use nalgebra::{Matrix3, Vector3};

use crate::error::Error;
use crate::frames::GRAVITY;
use crate::mixer::Mixer;
use crate::parameters::{Rotor, VehicleParameters, to_matrix};

/// A quadcopter whose parameters have been checked: it can hover and turn about every axis.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "VehicleParameters", into = "VehicleParameters"))]
pub struct Vehicle {
    parameters: VehicleParameters,
    inertia_tensor: Matrix3<f64>,
    inverse_inertia_tensor: Matrix3<f64>,
    mixer: Mixer,
}

impl Vehicle {
    /// Checks the parameters.
    ///
    /// # Errors
    /// The first of [`VehicleParameters::problems`].
    pub fn new(parameters: VehicleParameters) -> Result<Self, Error> {
        if let Some(problem) = parameters.problems().first() {
            return Err(*problem);
        }
        let mixer = Mixer::new(&parameters.rotors, parameters.torque_to_thrust)?;
        let inertia_tensor = to_matrix(&parameters.inertia_tensor);
        let unphysical =
            || Error::InertiaNotPhysical { moments: inertia_tensor.symmetric_eigenvalues().into() };
        let inverse_inertia_tensor = inertia_tensor.try_inverse().ok_or_else(unphysical)?;
        Ok(Self { parameters, inertia_tensor, inverse_inertia_tensor, mixer })
    }

    /// The plain numbers.
    #[must_use]
    pub fn parameters(&self) -> &VehicleParameters {
        &self.parameters
    }

    /// Mass, kg.
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.parameters.mass
    }

    /// Weight, N.
    #[must_use]
    pub fn weight(&self) -> f64 {
        self.parameters.mass * GRAVITY
    }

    /// Inertia tensor in body axes, kg m^2.
    #[must_use]
    pub fn inertia_tensor(&self) -> &Matrix3<f64> {
        &self.inertia_tensor
    }

    /// Inverse of the inertia tensor, 1/(kg m^2).
    #[must_use]
    pub fn inverse_inertia_tensor(&self) -> &Matrix3<f64> {
        &self.inverse_inertia_tensor
    }

    /// Greatest collective thrust, N.
    #[must_use]
    pub fn max_thrust(&self) -> f64 {
        self.parameters.max_thrust
    }

    /// Least collective thrust, N.
    #[must_use]
    pub fn min_thrust(&self) -> f64 {
        self.parameters.max_thrust * self.parameters.min_thrust_share
    }

    /// Greatest thrust of one rotor, N.
    #[must_use]
    pub fn max_rotor_thrust(&self) -> f64 {
        self.max_thrust() / 4.0
    }

    /// Least thrust of one rotor, N.
    #[must_use]
    pub fn min_rotor_thrust(&self) -> f64 {
        self.min_thrust() / 4.0
    }

    /// Drag coefficient, kg/m.
    #[must_use]
    pub fn drag_coefficient(&self) -> f64 {
        self.parameters.drag_coefficient
    }

    /// Greatest body rates about body x, y and z, rad/s.
    #[must_use]
    pub fn max_body_rates(&self) -> Vector3<f64> {
        self.parameters.max_body_rates.into()
    }

    /// Thrust of one rotor per squared speed, N s^2/rad^2.
    #[must_use]
    pub fn thrust_coefficient(&self) -> f64 {
        self.max_rotor_thrust() / self.parameters.propulsion.max_rotor_speed.powi(2)
    }

    /// Yaw torque of a rotor per newton of its thrust, m.
    #[must_use]
    pub fn torque_to_thrust(&self) -> f64 {
        self.parameters.torque_to_thrust
    }

    /// The four rotors.
    #[must_use]
    pub fn rotors(&self) -> &[Rotor; 4] {
        &self.parameters.rotors
    }

    /// Thrust and torque from rotor thrusts and back.
    #[must_use]
    pub fn mixer(&self) -> &Mixer {
        &self.mixer
    }

    /// Drag force at a velocity through the air, N, world axes: `-c_d/2 |v| v`.
    #[must_use]
    pub fn drag(&self, air_velocity: &Vector3<f64>) -> Vector3<f64> {
        air_velocity * (-0.5 * self.drag_coefficient() * air_velocity.norm())
    }
}

impl TryFrom<VehicleParameters> for Vehicle {
    type Error = Error;

    fn try_from(parameters: VehicleParameters) -> Result<Self, Error> {
        Self::new(parameters)
    }
}

impl From<Vehicle> for VehicleParameters {
    fn from(vehicle: Vehicle) -> Self {
        vehicle.parameters
    }
}
