//! Power by momentum theory, and how long a battery lasts.

use nalgebra::Vector3;

use crate::loiter::Loiter;
use crate::motion::Motion;
use crate::vehicle::Vehicle;

/// Density of air at sea level in the standard atmosphere, kg/m^3 (ISO 2533).
pub const AIR_DENSITY: f64 = 1.225;

impl Vehicle {
    /// Electrical power in hover, W: see [`Vehicle::power`].
    #[must_use]
    pub fn hover_power(&self) -> f64 {
        self.power(self.weight(), &Vector3::zeros())
    }

    /// Electrical power at a collective thrust (N) with an air velocity in body axes (m/s), W.
    ///
    /// Each rotor disc gives a quarter of the thrust `t`; the ideal power is `t (v_i + V_z)`, with the induced velocity
    /// `v_i` of H. Glauert (1935): `v_i sqrt(V_xy^2 + (V_z + v_i)^2) = t/(2 rho A)`, `V_z` the air velocity along the thrust.
    /// Divided by the efficiency, plus the avionics. In descent along the axis faster than `v_i` the formula loses its
    /// meaning (vortex ring), and power is never counted below the avionics: rotors do not charge the battery.
    #[must_use]
    pub fn power(&self, collective_thrust: f64, body_air_velocity: &Vector3<f64>) -> f64 {
        let propulsion = &self.parameters().propulsion;
        let area = std::f64::consts::PI * propulsion.rotor_radius.powi(2);
        let loading = (collective_thrust / 4.0).max(0.0) / (2.0 * AIR_DENSITY * area);
        let level = body_air_velocity.xy().norm();
        let induced = induced_velocity(loading, level, body_air_velocity.z);
        let ideal = collective_thrust.max(0.0) * (induced + body_air_velocity.z);
        ideal.max(0.0) / propulsion.efficiency + self.parameters().battery.avionics_power
    }

    /// Electrical power in a motion through air that itself moves with `wind` (m/s, world), W.
    #[must_use]
    pub fn motion_power(&self, motion: &Motion, wind: &Vector3<f64>) -> f64 {
        let air = motion.attitude.inverse_transform_vector(&(motion.velocity - wind));
        self.power(motion.collective_thrust, &air)
    }

    /// Energy of a flight sampled every `step` seconds through air that moves with `wind` (m/s, world), J, by the trapezoidal rule.
    #[must_use]
    pub fn flight_energy(&self, motions: &[Motion], step: f64, wind: &Vector3<f64>) -> f64 {
        let power = |motion| self.motion_power(motion, wind);
        motions.windows(2).map(|pair| 0.5 * (power(&pair[0]) + power(&pair[1]))).sum::<f64>() * step
    }

    /// How long the usable part of the battery hovers, s.
    #[must_use]
    pub fn hover_endurance(&self) -> f64 {
        self.parameters().battery.usable_energy() / self.hover_power()
    }
}

impl Loiter {
    /// Electrical power on the circle, W; constant, since thrust and attitude against the air are.
    #[must_use]
    pub fn power(&self) -> f64 {
        let still = Vector3::zeros();
        self.vehicle.motion_power(&self.state(0.0, crate::Direction::CounterClockwise), &still)
    }

    /// Energy of the sweep, J.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.power() * self.duration()
    }
}

/// Solves `v sqrt(level^2 + (axial + v)^2) = loading` for `v >= 0` and `axial + v >= 0` where there is such a root.
///
/// The left side grows with `v` from `max(0, -axial)` on, so bisection cannot fail; 60 halvings reach rounding.
fn induced_velocity(loading: f64, level: f64, axial: f64) -> f64 {
    let left = |v: f64| v * level.hypot(axial + v);
    let mut low = (-axial).max(0.0);
    let mut high = low + loading.sqrt() + 1e-9;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if left(middle) < loading {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hover_power_is_that_of_the_actuator_disc() {
        let vehicle = Vehicle::survey_450();
        let area = std::f64::consts::PI * 0.127_f64.powi(2);
        let wanted = vehicle.weight().powf(1.5) / (2.0 * AIR_DENSITY * 4.0 * area).sqrt() / 0.5 + 8.0;
        assert!((vehicle.hover_power() / wanted - 1.0).abs() < 1e-12);
        // A survey quadcopter of this class flies about a quarter of an hour to half an hour.
        assert!((900.0..2400.0).contains(&vehicle.hover_endurance()), "{}", vehicle.hover_endurance());
    }

    #[test]
    fn moving_air_helps_and_climbing_costs() {
        let vehicle = Vehicle::survey_450();
        let at = |x: f64, z: f64| vehicle.power(vehicle.weight(), &Vector3::new(x, 0.0, z));
        assert!(at(6.0, 0.0) < at(0.0, 0.0) && at(0.0, 2.0) > at(0.0, 0.0));
        // Climb power of the ideal disc: v_i = -V/2 + sqrt(V^2/4 + v_h^2), Leishman (2006), eq. 2.79.
        let loading = vehicle.weight() / 4.0 / (2.0 * AIR_DENSITY * std::f64::consts::PI * 0.127_f64.powi(2));
        let induced = -1.0 + (1.0 + loading).sqrt();
        assert!((induced_velocity(loading, 0.0, 2.0) / induced - 1.0).abs() < 1e-12);
        assert!(at(0.0, -50.0) >= 8.0 && at(f64::NAN, 0.0).is_nan() | at(f64::NAN, 0.0).is_finite());
    }
}
