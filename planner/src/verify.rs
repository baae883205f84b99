//! A check of a finished plan that does not trust the solver.

use crate::plan::Miss;

/// Tolerances of a verification. Defaults: 5 cm, 5 cm/s and 1 degree for the integrated miss.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Greatest integrated miss of a leg.
    pub miss: Miss,
    /// How far a bound on states or a safe distance may be overstepped between knots (m, m/s, rad/s).
    pub bound: f64,
}

impl Default for Tolerances {
    fn default() -> Self {
        Self { miss: Miss { position: 0.05, velocity: 0.05, attitude: 1f64.to_radians() }, bound: 0.01 }
    }
}

/// What a verification saw.
#[derive(Debug, Clone, Default)]
pub struct Verification {
    /// One line per leg.
    pub legs: Vec<LegCheck>,
    /// All that is out of tolerance; empty if the plan stands.
    pub failures: Vec<Failure>,
}

/// What was measured on one leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegCheck {
    /// The vehicle, from 0.
    pub vehicle: usize,
    /// The leg, from 0.
    pub leg: usize,
    /// End of the integrated controls against the loiter (or hover) state computed afresh.
    pub miss: Miss,
    /// Greatest overstepping of bounds on controls and states, between knots too (in the bound's own unit).
    pub bound_violation: f64,
    /// Least distance to a target's centre minus its safe distance (m), between knots too; infinite without targets.
    pub clearance: f64,
}

/// Something that is out of tolerance.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Failure {
    /// The integrated controls miss the wanted state.
    #[error(
        "vehicle {} leg {}: integrated miss {:.3} m, {:.3} m/s, {:.2} deg",
        vehicle + 1, leg + 1, miss.position, miss.velocity, miss.attitude.to_degrees()
    )]
    Miss {
        /// The vehicle, from 0.
        vehicle: usize,
        /// The leg, from 0.
        leg: usize,
        /// How far.
        miss: Miss,
    },
    /// A bound on a control or a state is overstepped.
    #[error("vehicle {} leg {}: a bound is overstepped by {violation:.4}", vehicle + 1, leg + 1)]
    Bound {
        /// The vehicle, from 0.
        vehicle: usize,
        /// The leg, from 0.
        leg: usize,
        /// By how much (in the bound's own unit).
        violation: f64,
    },
    /// A safe distance is broken.
    #[error("vehicle {} leg {}: {:.3} m inside a target's safe distance", vehicle + 1, leg + 1, -clearance)]
    Clearance {
        /// The vehicle, from 0.
        vehicle: usize,
        /// The leg, from 0.
        leg: usize,
        /// Negative distance (m).
        clearance: f64,
    },
    /// Legs do not join up in time, or a route does not match its legs.
    #[error("vehicle {} leg {}: the leg does not join the one before it", vehicle + 1, leg + 1)]
    Joint {
        /// The vehicle, from 0.
        vehicle: usize,
        /// The leg, from 0.
        leg: usize,
    },
    /// A target is circled by nobody or more than once.
    #[error("target {} is circled {times} times instead of once", target + 1)]
    Coverage {
        /// The target, from 0.
        target: usize,
        /// How often.
        times: usize,
    },
    /// A value found is below its lower bound: one of the two is wrong.
    #[error("the certificate contradicts itself: {value} s found below a lower bound of {lower_bound} s")]
    Certificate {
        /// The value (s).
        value: f64,
        /// The bound (s).
        lower_bound: f64,
    },
}

impl Verification {
    /// Whether everything is within tolerance.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.failures.is_empty()
    }

    /// The greatest miss over all legs, each component by itself.
    #[must_use]
    pub fn worst_miss(&self) -> Miss {
        self.legs.iter().fold(Miss::default(), |worst, leg| Miss {
            position: worst.position.max(leg.miss.position),
            velocity: worst.velocity.max(leg.miss.velocity),
            attitude: worst.attitude.max(leg.miss.attitude),
        })
    }
}
