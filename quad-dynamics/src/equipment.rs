//! What simulation and energy need to know beyond what planning needs.

/// Rotors and their drives.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct Propulsion {
    /// Rotor speed at the greatest thrust, rad/s; thrust grows with its square. Default 700.
    pub max_rotor_speed: f64,
    /// Time constant of the first-order lag between commanded and real rotor speed, s. Default 0.05.
    pub time_constant: f64,
    /// Radius of a rotor, m. Default 0.127 (10-inch propeller).
    pub rotor_radius: f64,
    /// Ideal power of momentum theory over electrical power: figure of merit times motor and controller efficiency.
    /// Default 0.5.
    pub efficiency: f64,
}

impl Default for Propulsion {
    fn default() -> Self {
        Self { max_rotor_speed: 700.0, time_constant: 0.05, rotor_radius: 0.127, efficiency: 0.5 }
    }
}

/// Drag that planning leaves out: [`RotorLag`](crate::RotorLag) has it, the other models do not. Default none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct Aerodynamics {
    /// Body drag along body x, y and z beyond the drag coefficient, kg/m: force `-c_i/2 |v| v_i`, `v` the air velocity in
    /// body axes.
    pub body_drag: [f64; 3],
    /// Rotor drag along body x, y and z, kg/rad: each rotor, turning at `s`, adds the force `-s k_i u_i`, `u` its own air
    /// velocity in body axes (linear in the velocity; Faessler 2018, Svacha 2017).
    pub rotor_drag: [f64; 3],
}

/// Battery and what it feeds besides the rotors.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct Battery {
    /// Energy when full, J: nominal voltage times capacity. Default 266 400 (14.8 V, 5 A h).
    pub energy: f64,
    /// Share that may be used in flight. Default 0.8.
    pub usable_share: f64,
    /// Constant power of autopilot, radio, camera, W. Default 8.
    pub avionics_power: f64,
}

impl Battery {
    /// Energy that may be used, J.
    #[must_use]
    pub fn usable_energy(&self) -> f64 {
        self.energy * self.usable_share
    }
}

impl Default for Battery {
    fn default() -> Self {
        Self { energy: 14.8 * 5.0 * 3600.0, usable_share: 0.8, avionics_power: 8.0 }
    }
}
