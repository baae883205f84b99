//! Errors of the state estimate.

use nalgebra::{SVector, UnitQuaternion, Vector3};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{Rng, SeedableRng};

use crate::frames::{from_wxyz, to_wxyz};

/// Standard deviations of white errors in the state that a controller sees, per axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct SensorNoise {
    /// Position, m.
    pub position: f64,
    /// Velocity, m/s.
    pub velocity: f64,
    /// Attitude, rad.
    pub attitude: f64,
    /// Body rates, rad/s.
    pub body_rates: f64,
}

impl SensorNoise {
    /// What a filter leaves of satellite positioning with corrections and a small inertial sensor, in size: 2 cm,
    /// 5 cm/s, 0.5 degrees, 0.02 rad/s.
    #[must_use]
    pub fn typical() -> Self {
        Self { position: 0.02, velocity: 0.05, attitude: 0.0087, body_rates: 0.02 }
    }

    /// The rigid-body part of a state as seen with these errors.
    pub(super) fn measure(&self, state: &SVector<f64, 17>, random: &mut Gaussian) -> SVector<f64, 13> {
        let mut seen: SVector<f64, 13> = state.fixed_rows::<13>(0).into_owned();
        if *self == Self::default() {
            return seen;
        }
        for (start, deviation) in [(0, self.position), (3, self.velocity), (10, self.body_rates)] {
            for i in start..start + 3 {
                seen[i] += deviation * random.next();
            }
        }
        let error = Vector3::from_fn(|_, _| self.attitude * random.next());
        let attitude =
            from_wxyz(seen[6], seen[7], seen[8], seen[9]) * UnitQuaternion::from_scaled_axis(error);
        seen.fixed_rows_mut::<4>(6).copy_from(&to_wxyz(&attitude));
        seen
    }
}

/// Standard normal numbers by the polar-free Box-Muller formula (1958), two at a time.
#[derive(Debug, Clone)]
pub(super) struct Gaussian {
    generator: Xoshiro256PlusPlus,
    spare: Option<f64>,
}

impl Gaussian {
    pub fn new(seed: u64) -> Self {
        Self { generator: Xoshiro256PlusPlus::seed_from_u64(seed), spare: None }
    }

    /// The next number; its bits depend on the generator only, not on how a library fills ranges.
    pub fn next(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        // 53 random bits: (0, 1] for the logarithm, [0, 1) for the angle.
        const UNIT: f64 = 1.0 / (1_u64 << 53) as f64;
        let radius_draw = ((self.generator.next_u64() >> 11) + 1) as f64 * UNIT;
        let angle = (self.generator.next_u64() >> 11) as f64 * UNIT * std::f64::consts::TAU;
        let radius = (-2.0 * radius_draw.ln()).sqrt();
        self.spare = Some(radius * angle.sin());
        radius * angle.cos()
    }
}

#[cfg(test)]
mod tests {
    use super::Gaussian;

    #[test]
    fn moments_are_those_of_a_normal_distribution() {
        let mut random = Gaussian::new(7);
        let n = 200_000;
        let (mut first, mut second, mut fourth) = (0.0, 0.0, 0.0);
        for _ in 0..n {
            let x = random.next();
            first += x / n as f64;
            second += x * x / n as f64;
            fourth += x.powi(4) / n as f64;
        }
        // Five standard errors: 1/sqrt(n), sqrt(2/n), sqrt(96/n).
        assert!(first.abs() < 0.012 && (second - 1.0).abs() < 0.016 && (fourth - 3.0).abs() < 0.11);
    }
}
