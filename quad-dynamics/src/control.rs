//! A geometric tracking controller on SE(3).

use nalgebra::{Matrix3, SVector, UnitQuaternion, Vector3, Vector4};

use crate::frames::{GRAVITY, from_wxyz, project_heading};
use crate::models::entries;
use crate::motion::Motion;
use crate::vehicle::Vehicle;

/// Gains of [`TrackingController`], as natural frequencies and damping ratios, so that they fit vehicles of any size.
///
/// The defaults come from a random search for the least greatest error over minimum-time flights of the preset `survey-450`
/// with a thrust budget of 0.9, in still air and in gusts: two random missions of six targets, planned with both models. The
/// field mission of `tests/field.rs` was not among them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
#[non_exhaustive]
pub struct Gains {
    /// Natural frequency of the position loop, rad/s. Default 3.4.
    pub position_frequency: f64,
    /// Damping ratio of the position loop. Default 2.2.
    pub position_damping: f64,
    /// Rate at which the position error's integral acts, 1/s; 0 for none. Default 0.5.
    pub integral_rate: f64,
    /// Greatest acceleration that the integral may ask for, m/s^2. Default 4.
    pub integral_limit: f64,
    /// Natural frequency of the roll and pitch loop, rad/s. Default 11.5.
    pub attitude_frequency: f64,
    /// Damping ratio of roll and pitch. Default 1.
    pub attitude_damping: f64,
    /// Natural frequency of the yaw loop, rad/s: rotors have little yaw torque. Default 7.2.
    pub yaw_frequency: f64,
    /// Damping ratio of yaw. Default 0.47.
    pub yaw_damping: f64,
    /// How many times faster than their own lag the rotors are driven towards their thrust, by overshooting commands within
    /// the limits; 1 for none. Default 4.3.
    pub rotor_lead: f64,
}

impl Default for Gains {
    fn default() -> Self {
        Self {
            position_frequency: 3.4,
            position_damping: 2.2,
            integral_rate: 0.5,
            integral_limit: 4.0,
            attitude_frequency: 11.5,
            attitude_damping: 1.0,
            yaw_frequency: 7.2,
            yaw_damping: 0.47,
            rotor_lead: 4.3,
        }
    }
}

/// Follows a motion with rotor thrusts.
///
/// T. Lee, M. Leok, N. H. McClamroch, *Geometric tracking control of a quadrotor UAV on SE(3)* (2010, DOI
/// 10.1109/CDC.2010.5717652), eqs. 12 and 15 to 16: the wanted force
/// `F = m (a_d + g e_z) + drag - m (w^2 e + 2 z w e' + integral)` gives the thrust `F . z_b` and, with the wanted
/// heading, the wanted attitude `R_d`; the torque is
/// `J (-k_R e_R - k_w e_w + R^T R_d w_d' - w x R^T R_d w_d) + w x J w`.
///
/// Different from Lee: the attitude error is split into that of the thrust direction and that of the heading (D.
/// Brescianini, M. Hehn, R. D'Andrea 2013). At high thrust no rotor has yaw torque to spare, headings drift by radians,
/// and Lee's error would then turn the thrust the wrong way. Added: drag, an integral with a limit, rotor limits by
/// [`Mixer::allocate`](crate::Mixer::allocate) (yaw given up first), a look ahead and a lead for the rotors' lag.
///
/// Lee's proof (almost global exponential attractiveness) is for his error, unlimited rotors and no lag; nothing is proved
/// for this controller.
#[derive(Debug, Clone, PartialEq)]
pub struct TrackingController {
    vehicle: Vehicle,
    gains: Gains,
    /// Integral of the position error times its gain, m/s^2.
    integral: Vector3<f64>,
    /// Rotor speeds that the lag model expects now, rad/s; unknown before the first call.
    rotor_speeds: Option<Vector4<f64>>,
    /// Diagonal gains per unit of inertia: attitude (1/s^2) and rates (1/s).
    attitude_gain: Vector3<f64>,
    rate_gain: Vector3<f64>,
}

impl TrackingController {
    /// A controller of a vehicle with these gains.
    #[must_use]
    pub fn new(vehicle: &Vehicle, gains: Gains) -> Self {
        let (tilt, yaw) = (gains.attitude_frequency, gains.yaw_frequency);
        let (tilt_rate, yaw_rate) = (2.0 * gains.attitude_damping * tilt, 2.0 * gains.yaw_damping * yaw);
        Self {
            vehicle: vehicle.clone(),
            gains,
            integral: Vector3::zeros(),
            rotor_speeds: None,
            attitude_gain: Vector3::new(tilt * tilt, tilt * tilt, yaw * yaw),
            rate_gain: Vector3::new(tilt_rate, tilt_rate, yaw_rate),
        }
    }

    /// Forgets the integral and what the rotors did.
    pub fn reset(&mut self) {
        self.integral = Vector3::zeros();
        self.rotor_speeds = None;
    }

    /// Rotor thrusts (N, within the rotors' limits) for a measured rigid-body state (p, v, q, w), `step` seconds after the
    /// last call.
    ///
    /// `now` is the motion wanted at this time. `ahead` is the motion wanted a little later, where attitude, body rates and
    /// their change towards it are taken from; the same as `now` for no look ahead.
    #[must_use]
    pub fn update(
        &mut self,
        state: &SVector<f64, 13>,
        now: &Motion,
        ahead: &Target,
        step: f64,
    ) -> Vector4<f64> {
        let error = Vector3::from(entries(state, 0)) - now.position;
        let velocity_error = Vector3::from(entries(state, 3)) - now.velocity;
        let attitude = from_wxyz(state[6], state[7], state[8], state[9]);
        let rates = Vector3::from(entries(state, 10));
        let frequency = self.gains.position_frequency;
        let damping = 2.0 * self.gains.position_damping * frequency;
        self.integrate(&error, step);
        let feedback = error * (frequency * frequency) + velocity_error * damping + self.integral;
        let wanted = ahead.acceleration - feedback + Vector3::new(0.0, 0.0, GRAVITY);
        let force = wanted * self.vehicle.mass() - self.vehicle.drag(&ahead.velocity);
        let rotation = attitude.to_rotation_matrix().into_inner();
        let thrust = force.dot(&rotation.column(2));
        let torque = self.torque(&rotation, &rates, &force, ahead);
        let (min, max) = (self.vehicle.min_rotor_thrust(), self.vehicle.max_rotor_thrust());
        let wanted = self.vehicle.mixer().allocate(thrust, &torque, min, max);
        self.lead(&wanted, step)
    }

    /// Rotor speeds (rad/s) of rotor thrusts.
    fn speeds(&self, thrusts: &Vector4<f64>) -> Vector4<f64> {
        thrusts.map(|thrust| (thrust.max(0.0) / self.vehicle.thrust_coefficient()).sqrt())
    }

    /// Commands that bring lagging rotors to the wanted thrusts sooner.
    fn lead(&mut self, wanted: &Vector4<f64>, step: f64) -> Vector4<f64> {
        let target = self.speeds(wanted);
        let now = self.rotor_speeds.unwrap_or(target);
        let (min, max) = (self.vehicle.min_rotor_thrust(), self.vehicle.max_rotor_thrust());
        let limits = self.speeds(&Vector4::new(min, max, 0.0, 0.0));
        let command = (now + (target - now) * self.gains.rotor_lead).map(|s| s.max(limits[0]).min(limits[1]));
        let share = 1.0 - (-step / self.vehicle.parameters().propulsion.time_constant).exp();
        self.rotor_speeds = Some(now + (command - now) * share);
        command.map(|s| s * s * self.vehicle.thrust_coefficient())
    }

    /// Grows the integral and holds it within its limit.
    fn integrate(&mut self, error: &Vector3<f64>, step: f64) {
        let gain = self.gains.position_frequency.powi(2) * self.gains.integral_rate;
        let next = self.integral + error * (gain * step);
        if !next.iter().all(|x| x.is_finite()) {
            return;
        }
        let excess = next.norm() / self.gains.integral_limit;
        self.integral = if excess > 1.0 { next / excess } else { next };
    }

    /// The torque that turns the thrust to `force` and body x to the wanted heading, N m.
    fn torque(
        &self,
        rotation: &Matrix3<f64>,
        rates: &Vector3<f64>,
        force: &Vector3<f64>,
        ahead: &Target,
    ) -> Vector3<f64> {
        let inertia = self.vehicle.inertia_tensor();
        let wanted = wanted_rotation(force, ahead);
        let relative = wanted.transpose() * rotation;
        let attitude_error = attitude_error(rotation, &wanted);
        let wanted_rates = relative.tr_mul(&ahead.body_rates);
        let rate_error = rates - wanted_rates;
        let wanted_spin = relative.tr_mul(&ahead.angular_acceleration) - rates.cross(&wanted_rates);
        let spin = wanted_spin
            - self.attitude_gain.component_mul(&attitude_error)
            - self.rate_gain.component_mul(&rate_error);
        inertia * spin + rates.cross(&(inertia * rates))
    }
}

/// Error of the thrust direction (about body x and y) and of the heading left after it (about body z), rad.
///
/// `R_d` is first turned by the shortest way until its z axis is the body's; what is left is a turn about z.
fn attitude_error(rotation: &Matrix3<f64>, wanted: &Matrix3<f64>) -> Vector3<f64> {
    let (z, wanted_z) = (rotation.column(2).into_owned(), wanted.column(2).into_owned());
    let axis = wanted_z.cross(&z);
    let (sine, cosine) = (axis.norm(), wanted_z.dot(&z));
    let angle = sine.atan2(cosine);
    let tilt = if sine > 0.0 { axis * (angle / sine) } else { Vector3::zeros() };
    let x = UnitQuaternion::from_scaled_axis(tilt) * wanted.column(0);
    let y = z.cross(&x);
    let forward = rotation.column(0);
    let yaw = forward.dot(&y).atan2(forward.dot(&x));
    let mut error = rotation.tr_mul(&tilt);
    error.z = yaw;
    error
}

/// The rotation whose z axis is the force's and whose x axis is closest to the wanted heading.
fn wanted_rotation(force: &Vector3<f64>, ahead: &Target) -> Matrix3<f64> {
    let wanted = ahead.attitude.to_rotation_matrix().into_inner();
    let length = force.norm();
    if !(length > 0.0 && length.is_finite()) {
        return wanted;
    }
    let z = force / length;
    let heading = wanted.column(0).into_owned();
    let sideways = wanted.column(1).into_owned();
    let forward = project_heading(&z, &heading).map(|(x, _)| x);
    let x = forward.or_else(|| project_heading(&z, &sideways).map(|(y, _)| y.cross(&z)));
    x.map_or(wanted, |x| Matrix3::from_columns(&[x, z.cross(&x), z]))
}

/// What the attitude loop follows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// Velocity, m/s, world, for the drag.
    pub velocity: Vector3<f64>,
    /// Acceleration, m/s^2, world.
    pub acceleration: Vector3<f64>,
    /// Attitude, body to world.
    pub attitude: UnitQuaternion<f64>,
    /// Body rates, rad/s.
    pub body_rates: Vector3<f64>,
    /// Time derivative of the body rates, rad/s^2.
    pub angular_acceleration: Vector3<f64>,
}

impl Target {
    /// The motion as it is, its body rates constant.
    #[must_use]
    pub fn of(motion: &Motion) -> Self {
        Self {
            velocity: motion.velocity,
            acceleration: motion.acceleration,
            attitude: motion.attitude,
            body_rates: motion.body_rates,
            angular_acceleration: Vector3::zeros(),
        }
    }

    /// The middle one of three motions, `interval` seconds from first to last, with the mean body rates and their mean change
    /// between the outer two: a jump of the rates becomes a ramp.
    #[must_use]
    pub fn between(before: &Motion, middle: &Motion, after: &Motion, interval: f64) -> Self {
        let turned = (before.attitude.inverse() * after.attitude).scaled_axis();
        Self {
            body_rates: turned / interval,
            angular_acceleration: (after.body_rates - before.body_rates) / interval,
            ..Self::of(middle)
        }
    }
}
