//! Euler angles, where people or papers want them.

use nalgebra::{Rotation3, UnitQuaternion, Vector3};

use crate::error::Error;

/// Attitude as three rotations about the axes z, x', y'': yaw, then roll, then pitch, `R = Rz(yaw) Rx(roll) Ry(pitch)`.
///
/// The order in which the force balance of Gao, Mandal and Bhattacharya (2020, eqs. 3 to 5) holds; not the usual
/// yaw-pitch-roll. Body forward-left-up: a positive roll lowers the right side, a positive pitch the nose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct YawRollPitch {
    /// Rotation about the world's z axis, rad, from east.
    pub yaw: f64,
    /// Rotation about the x axis after the yaw, rad, in [-pi/2, pi/2].
    pub roll: f64,
    /// Rotation about the y axis after the roll, rad.
    pub pitch: f64,
}

/// Closer than this to a roll of a quarter turn (in its cosine), yaw and pitch are one rotation.
const LEAST_COSINE: f64 = 1e-9;

impl YawRollPitch {
    /// The angles of an attitude.
    ///
    /// # Errors
    /// [`Error::EulerSingular`] at a roll of a quarter turn, where yaw and pitch are not defined separately.
    pub fn of(attitude: &UnitQuaternion<f64>) -> Result<Self, Error> {
        let m = attitude.to_rotation_matrix().into_inner();
        // Third row: (-cos roll sin pitch, sin roll, cos roll cos pitch); second column: (-sin yaw cos roll, cos yaw cos
        // roll, sin roll).
        let cosine = m[(0, 1)].hypot(m[(1, 1)]);
        let roll = m[(2, 1)].atan2(cosine);
        if cosine.is_nan() || cosine < LEAST_COSINE {
            return Err(Error::EulerSingular { roll });
        }
        Ok(Self { yaw: (-m[(0, 1)]).atan2(m[(1, 1)]), roll, pitch: (-m[(2, 0)]).atan2(m[(2, 2)]) })
    }

    /// The attitude of the angles.
    #[must_use]
    pub fn attitude(&self) -> UnitQuaternion<f64> {
        let turn = |axis, angle| Rotation3::from_axis_angle(&axis, angle);
        let rotation = turn(Vector3::z_axis(), self.yaw)
            * turn(Vector3::x_axis(), self.roll)
            * turn(Vector3::y_axis(), self.pitch);
        UnitQuaternion::from_rotation_matrix(&rotation)
    }

    /// Rates of the angles (yaw, roll, pitch; rad/s) at body rates (rad/s).
    ///
    /// # Errors
    /// [`Error::EulerSingular`] at a roll of a quarter turn.
    pub fn rates(&self, body_rates: &Vector3<f64>) -> Result<Vector3<f64>, Error> {
        let (sin_roll, cos_roll) = self.roll.sin_cos();
        if cos_roll.is_nan() || cos_roll.abs() < LEAST_COSINE {
            return Err(Error::EulerSingular { roll: self.roll });
        }
        let (sin_pitch, cos_pitch) = self.pitch.sin_cos();
        // w = Ry^T (roll' e_x + Rx^T yaw' e_z) + pitch' e_y
        let yaw = (cos_pitch * body_rates.z - sin_pitch * body_rates.x) / cos_roll;
        let roll = cos_pitch * body_rates.x + sin_pitch * body_rates.z;
        Ok(Vector3::new(yaw, roll, body_rates.y - sin_roll * yaw))
    }
}
