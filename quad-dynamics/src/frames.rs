//! The conventions, stated once.
//!
//! * **World**: east-north-up; x east, y north, z up; gravity is `(0, 0, -GRAVITY)`.
//! * **Body**: forward-left-up; thrust along body +z.
//! * **Attitude**: unit Hamilton quaternion, body to world, `x_world = q x_body q*`; stored in state vectors as
//!   `(w, x, y, z)`. `q` and `-q` are one attitude.
//! * **Body rates**: angular velocity of the body against the world, in body axes, rad/s; `q' = q (0, rates) / 2`.
//! * **Yaw**: from east, counter-clockwise seen from above.
//! * SI units, angles in radians.

use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3, Vector4};

/// Gravitational acceleration used throughout, m/s^2.
///
/// 9.81 rather than the conventional standard value 9.806 65, as in the data and simulators this crate is compared
/// with; gravity varies by 0.5 % over the Earth anyway.
pub const GRAVITY: f64 = 9.81;

/// Sense in which a circle is flown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Direction {
    /// Counter-clockwise seen from above: +1.
    #[default]
    CounterClockwise,
    /// Clockwise seen from above: -1.
    Clockwise,
}

impl Direction {
    /// Both directions, counter-clockwise first.
    pub const BOTH: [Direction; 2] = [Direction::CounterClockwise, Direction::Clockwise];

    /// +1 for counter-clockwise, -1 for clockwise.
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Direction::CounterClockwise => 1.0,
            Direction::Clockwise => -1.0,
        }
    }

    /// The other direction.
    #[must_use]
    pub fn reversed(self) -> Self {
        match self {
            Direction::CounterClockwise => Direction::Clockwise,
            Direction::Clockwise => Direction::CounterClockwise,
        }
    }
}

/// Where the body's x axis points, as far as the thrust direction leaves it free.
///
/// Body x is the wanted direction projected orthogonally to the thrust. Where that is undefined (no speed, the point
/// reached, or thrust along the wanted direction) it falls back to east, then to north.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Heading {
    /// Along the velocity.
    AlongTrack,
    /// Towards a point in the world, at any height: only the horizontal direction counts.
    Towards(Vector3<f64>),
    /// A fixed yaw, rad from east.
    Yaw(f64),
}

impl Heading {
    /// The wanted direction and its time derivative (any length) at a position, velocity and acceleration.
    pub(crate) fn direction(self, p: &Vector3<f64>, v: &Vector3<f64>, a: &Vector3<f64>) -> [Vector3<f64>; 2] {
        match self {
            Heading::AlongTrack => [*v, *a],
            Heading::Towards(point) => {
                [Vector3::new(point.x - p.x, point.y - p.y, 0.0), Vector3::new(-v.x, -v.y, 0.0)]
            }
            Heading::Yaw(yaw) => [Vector3::new(yaw.cos(), yaw.sin(), 0.0), Vector3::zeros()],
        }
    }
}

/// A quaternion as the state vectors hold it: `(w, x, y, z)`.
#[must_use]
pub fn to_wxyz(attitude: &UnitQuaternion<f64>) -> Vector4<f64> {
    Vector4::new(attitude.w, attitude.i, attitude.j, attitude.k)
}

/// The attitude of four state entries `(w, x, y, z)` of any norm but zero; the identity if they are zero or not finite.
#[must_use]
pub fn from_wxyz(w: f64, x: f64, y: f64, z: f64) -> UnitQuaternion<f64> {
    let raw = Quaternion::new(w, x, y, z);
    let norm = raw.norm();
    // Only numbers whose squares leave the range are scaled first: others keep their bits.
    let raw = if norm > 1e-150 && norm.is_finite() { raw } else { raw / raw.coords.amax() };
    UnitQuaternion::try_new(raw, 0.0).filter(|q| q.coords.iter().all(|c| c.is_finite())).unwrap_or_default()
}

/// The attitude whose body axes are the columns given, which must be orthonormal and right-handed.
pub(crate) fn from_axes(x: Vector3<f64>, y: Vector3<f64>, z: Vector3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, y, z])))
}

/// Body x for thrust along the unit vector `z` and the wanted direction `heading`, with the projection's length; `None`
/// if the direction is (nearly) along `z`.
pub(crate) fn project_heading(z: &Vector3<f64>, heading: &Vector3<f64>) -> Option<(Vector3<f64>, f64)> {
    // Below this sine of the angle between heading and thrust the projection is rounding noise.
    const LEAST_SINE: f64 = 1e-9;
    let along = heading - z * heading.dot(z);
    let length = along.norm();
    (length > LEAST_SINE * heading.norm() && length.is_finite()).then(|| (along / length, length))
}
