//! How fast a circle can be flown, and what says so.

use std::fmt;

use super::{LoiterSpec, circle};
use crate::error::{Error, Field, Requirement};
use crate::frames::{Direction, GRAVITY};
use crate::motion::Motion;
use crate::vehicle::Vehicle;

/// What binds a loiter's speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum Limit {
    /// The thrust budget (eq. 6).
    Thrust,
    /// The speed limit.
    Speed,
    /// The bank limit.
    Bank,
    /// The autopilot's acceleration limit.
    Acceleration,
    /// The camera's limit.
    Camera,
    /// The body rate about x.
    RollRate,
    /// The body rate about y.
    PitchRate,
    /// The body rate about z.
    YawRate,
    /// The least or greatest thrust of a single rotor.
    Rotor,
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Limit::Thrust => "thrust",
            Limit::Speed => "speed",
            Limit::Bank => "bank",
            Limit::Acceleration => "acceleration",
            Limit::Camera => "camera",
            Limit::RollRate => "roll-rate",
            Limit::PitchRate => "pitch-rate",
            Limit::YawRate => "yaw-rate",
            Limit::Rotor => "rotor",
        })
    }
}

/// Greatest speed (m/s) on a circle of `radius` (m) with collective thrust `thrust` (N):
/// `v = [(T^2 - m^2 g^2)/(m^2/r^2 + c_d^2/4)]^(1/4)` (Gao, Mandal and Bhattacharya 2020, eq. 6).
///
/// # Errors
/// [`Error::OutOfRange`] for a radius or thrust that is not positive and finite, [`Error::BudgetBelowWeight`] for a
/// thrust below the weight.
///
/// ```
/// use quad_dynamics::{loiter_speed, Vehicle, VehicleParameters};
/// let vehicle = Vehicle::new(VehicleParameters::survey_450())?;
/// let speed = loiter_speed(&vehicle, 3.0, 0.6 * vehicle.max_thrust())?;
/// assert!((speed - 4.39).abs() < 0.01);
/// # Ok::<(), quad_dynamics::Error>(())
/// ```
pub fn loiter_speed(vehicle: &Vehicle, radius: f64, thrust: f64) -> Result<f64, Error> {
    Requirement::Positive.check(Field::Radius, radius)?;
    Requirement::Positive.check(Field::ThrustBudget, thrust)?;
    let weight = vehicle.weight();
    if thrust < weight {
        let budget = |force: f64| force / vehicle.max_thrust();
        let (thrust_budget, least_budget) = (budget(thrust), budget(weight));
        return Err(Error::BudgetBelowWeight { thrust_budget, thrust, weight, least_budget });
    }
    Ok(thrust_limited_speed(vehicle, radius, thrust))
}

/// Eq. 6; the difference of squares is factored, which keeps its digits when the thrust is close to the weight.
pub(super) fn thrust_limited_speed(vehicle: &Vehicle, radius: f64, thrust: f64) -> f64 {
    let weight = vehicle.weight();
    let horizontal = ((thrust - weight) * (thrust + weight)).sqrt();
    let per_speed_squared = (vehicle.mass() / radius).hypot(0.5 * vehicle.drag_coefficient());
    (horizontal / per_speed_squared).sqrt()
}

/// The least of the limits that have a closed form; `thrust_limited` is the speed that the thrust allows at most.
pub(super) fn closed_form_speed(spec: &LoiterSpec, thrust_limited: f64) -> (Limit, f64) {
    let radius = spec.radius;
    let closed_forms = [
        Some((Limit::Thrust, thrust_limited)),
        spec.speed_limit.map(|speed| (Limit::Speed, speed)),
        spec.bank_limit.map(|bank| (Limit::Bank, (radius * GRAVITY * bank.tan()).sqrt())),
        spec.acceleration_limit.map(|acceleration| (Limit::Acceleration, (radius * acceleration).sqrt())),
        spec.camera_limit.map(|camera| (Limit::Camera, radius * camera.angular_speed)),
    ];
    let first = (Limit::Thrust, f64::INFINITY);
    closed_forms.into_iter().flatten().fold(first, |a, b| if b.1 < a.1 { b } else { a })
}

/// The greatest speed for which every limit holds from rest up to it, and the limit that ends there.
pub(super) fn greatest_speed(vehicle: &Vehicle, spec: &LoiterSpec) -> (Limit, f64) {
    let thrust = spec.thrust_budget * vehicle.max_thrust();
    let least = closed_form_speed(spec, thrust_limited_speed(vehicle, spec.radius, thrust));
    first_violation(least.1, |speed| {
        Direction::BOTH.into_iter().find_map(|direction| {
            let motion = circle::motion(vehicle, spec.radius, speed, spec.yaw, 0.0, direction);
            violated(vehicle, spec, &motion, f64::INFINITY)
        })
    })
    .unwrap_or(least)
}

/// The thrust, body-rate or rotor limit that a motion violates, if any; `budget` is the greatest thrust, N.
pub(super) fn violated(vehicle: &Vehicle, spec: &LoiterSpec, motion: &Motion, budget: f64) -> Option<Limit> {
    if motion.collective_thrust > budget {
        return Some(Limit::Thrust);
    }
    let greatest = vehicle.max_body_rates();
    let axes = [Limit::RollRate, Limit::PitchRate, Limit::YawRate].into_iter().enumerate();
    let mut rate = axes.filter(|(i, _)| spec.body_rate_limits && motion.body_rates[*i].abs() > greatest[*i]);
    let (min, max) = (vehicle.min_rotor_thrust(), vehicle.max_rotor_thrust());
    let outside = motion.rotor_thrusts.iter().any(|thrust| *thrust < min || *thrust > max);
    rate.next().map(|(_, limit)| limit).or((spec.rotor_limits && outside).then_some(Limit::Rotor))
}

/// The least speed up to `top` at which `violated` says so, found by a scan and bisection to the last bit.
///
/// The yaw rate `(v/r) m g/T` rises and falls again with speed: the first violation counts, since a vehicle that speeds
/// up meets it. A violation narrower than the scan's step goes unseen, except at `top` itself.
pub(super) fn first_violation(
    top: f64,
    mut violated: impl FnMut(f64) -> Option<Limit>,
) -> Option<(Limit, f64)> {
    const N_STEPS: usize = 256;
    const N_BISECTIONS: usize = 60;
    let speed = |step: usize| top * step as f64 / N_STEPS as f64;
    let step = (1..=N_STEPS).find(|step| violated(speed(*step)).is_some())?;
    let (mut good, mut bad) = (speed(step - 1), speed(step));
    for _ in 0..N_BISECTIONS {
        let middle = 0.5 * (good + bad);
        if violated(middle).is_some() {
            bad = middle;
        } else {
            good = middle;
        }
    }
    violated(bad).map(|limit| (limit, good))
}
