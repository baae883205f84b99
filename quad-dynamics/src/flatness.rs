//! From a trajectory of position and yaw to everything else, and back.

use nalgebra::{Matrix3, Vector3, Vector4};

use crate::error::Error;
use crate::frames::{GRAVITY, from_axes};
use crate::motion::Motion;
use crate::series::{Series, SeriesVector};
use crate::vehicle::Vehicle;

/// A quadcopter's flat outputs, position and yaw, with their time derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FlatOutput {
    /// Position, m, world.
    pub position: Vector3<f64>,
    /// Velocity, m/s.
    pub velocity: Vector3<f64>,
    /// Acceleration, m/s^2.
    pub acceleration: Vector3<f64>,
    /// Jerk, m/s^3.
    pub jerk: Vector3<f64>,
    /// Snap, m/s^4.
    pub snap: Vector3<f64>,
    /// Yaw, rad from east: the direction of body x seen from above.
    pub yaw: f64,
    /// Yaw rate, rad/s.
    pub yaw_rate: f64,
    /// Yaw acceleration, rad/s^2.
    pub yaw_acceleration: f64,
}

/// What flat outputs imply.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct FlatState {
    /// The motion; its rotor thrusts give the torque below.
    pub motion: Motion,
    /// Time derivative of the body rates, rad/s^2, body axes.
    pub angular_acceleration: Vector3<f64>,
    /// Torque on the body, N m, body axes.
    pub torque: Vector3<f64>,
}

impl Vehicle {
    /// Linear drag per mass along body x, y and z, 1/s, that the rotors have at hover speed: `4 s k_i/m`.
    #[must_use]
    pub fn linear_drag(&self) -> Vector3<f64> {
        let hover = (0.25 * self.weight() / self.thrust_coefficient()).sqrt();
        Vector3::from(self.parameters().aerodynamics.rotor_drag) * (4.0 * hover / self.mass())
    }
}

impl FlatOutput {
    /// Attitude, thrust, body rates and rotor thrusts in still air, with the vehicle's quadratic drag and a linear drag per
    /// mass `linear_drag` along the body axes (1/s; [`Vehicle::linear_drag`] or zero).
    ///
    /// M. Faessler, A. Franchi, D. Scaramuzza, *Differential Flatness of Quadrotor Dynamics Subject to Rotor Drag for
    /// Accurate Tracking of High-Speed Trajectories* (2018, DOI 10.1109/LRA.2017.2776353), eqs. 11 to 20: with
    /// `alpha = a + g e_z + d_x v`, `beta = a + g e_z + d_y v` and `y_C` to the left of the yaw, `x_B` is along
    /// `y_C x alpha` and `y_B` along `beta x x_B`. The quadratic drag is isotropic and joins `a`. Rates and angular
    /// acceleration are the exact time derivatives of that attitude, carried along as series instead of solved for.
    ///
    /// # Errors
    /// [`Error::FlatnessSingular`] where the thrust vanishes or points along `y_C`, so that the attitude is not defined.
    pub fn state(&self, vehicle: &Vehicle, linear_drag: &Vector3<f64>) -> Result<FlatState, Error> {
        let singular = || Error::FlatnessSingular { acceleration: self.acceleration.into(), yaw: self.yaw };
        let velocity = SeriesVector::new(&self.velocity, &self.acceleration, &self.jerk);
        let push =
            SeriesVector::new(&(self.acceleration + Vector3::new(0.0, 0.0, GRAVITY)), &self.jerk, &self.snap)
                .plus(&quadratic_drag(&velocity, 0.5 * vehicle.drag_coefficient() / vehicle.mass()));
        let along = |axis: usize| push.plus(&velocity.scaled(Series::constant(linear_drag[axis])));
        let [cos, sin] = Series([self.yaw, self.yaw_rate, self.yaw_acceleration]).cos_sin();
        let zero = Series::constant(0.0);
        let left = SeriesVector([zero - sin, cos, zero]);
        let x = left.cross(&along(0)).normalised().ok_or_else(singular)?;
        let y = along(1).cross(&x).normalised().ok_or_else(singular)?;
        let z = x.cross(&y);
        let thrust = z.dot(&along(2)).0[0] * vehicle.mass();
        Ok(self.assemble(vehicle, [&x, &y, &z], thrust))
    }

    fn assemble(&self, vehicle: &Vehicle, axes: [&SeriesVector; 3], thrust: f64) -> FlatState {
        let matrix = |order: usize| Matrix3::from_columns(&axes.map(|axis| axis.order(order)));
        let (rotation, first, second) = (matrix(0), matrix(1), matrix(2));
        // R^T R' = [w]x and R^T R'' = [w]x [w]x + [w']x
        let body_rates = unskew(&rotation.tr_mul(&first));
        let angular_acceleration = unskew(&rotation.tr_mul(&second));
        let inertia = vehicle.inertia_tensor();
        let torque = inertia * angular_acceleration + body_rates.cross(&(inertia * body_rates));
        let rotor_thrusts: Vector4<f64> = vehicle.mixer().rotor_thrusts(thrust, &torque);
        let [x, y, z] = axes.map(|axis| axis.order(0));
        let motion = Motion {
            position: self.position,
            velocity: self.velocity,
            acceleration: self.acceleration,
            jerk: self.jerk,
            attitude: from_axes(x, y, z),
            body_rates,
            collective_thrust: thrust,
            rotor_thrusts,
        };
        FlatState { motion, angular_acceleration, torque }
    }

    /// The flat outputs of a motion, up to the jerk and the yaw rate; snap and yaw acceleration are not in a motion and are
    /// zero.
    ///
    /// # Errors
    /// [`Error::YawUndefined`] where body x is vertical.
    pub fn of(motion: &Motion) -> Result<Self, Error> {
        let forward = motion.attitude * Vector3::x();
        let level = forward.xy().norm_squared();
        if level.is_nan() || level < 1e-18 {
            return Err(Error::YawUndefined);
        }
        let turning = motion.attitude * motion.body_rates.cross(&Vector3::x());
        Ok(Self {
            position: motion.position,
            velocity: motion.velocity,
            acceleration: motion.acceleration,
            jerk: motion.jerk,
            yaw: forward.y.atan2(forward.x),
            yaw_rate: (forward.x * turning.y - forward.y * turning.x) / level,
            ..Self::default()
        })
    }
}

/// `k |v| v` with two derivatives; at rest only its value and first derivative exist, and both are zero.
fn quadratic_drag(velocity: &SeriesVector, factor: f64) -> SeriesVector {
    let squared = velocity.dot(velocity);
    if squared.0[0] > f64::MIN_POSITIVE {
        velocity.scaled(squared.sqrt() * Series::constant(factor))
    } else {
        velocity.scaled(Series::constant(0.0))
    }
}

/// The vector of the antisymmetric part of a matrix.
fn unskew(m: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(m[(2, 1)] - m[(1, 2)], m[(0, 2)] - m[(2, 0)], m[(1, 0)] - m[(0, 1)]) * 0.5
}
