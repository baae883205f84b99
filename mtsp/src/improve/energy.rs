//! What the search minimises: a sum of convex functions of the route lengths.

use crate::objective::Objective;

/// Energy of a route as a function of its length.
///
/// Min-sum: the length itself. Min-max: `(scale / p) (length / scale)^p` with `scale` the best makespan so far, whose slope is 1
/// at the best makespan and small for short routes: minimising the sum flattens the longest routes first, yet
/// every route feels some pull to be short, which plain min-max does not give. Over its limit a route pays [`OVER_LIMIT`] times the excess.
#[derive(Clone)]
pub(crate) struct Energy {
    objective: Objective,
    scale: f64,
    /// `scale / p`, with `p = 2^squarings`.
    factor: f64,
    squarings: u32,
    limits: Vec<f64>,
    limited: bool,
}

/// Slope of the energy beyond the limit.
const OVER_LIMIT: f64 = 100.0;

impl Energy {
    pub fn new(objective: Objective, limits: Vec<f64>) -> Self {
        let limited = limits.iter().any(|l| l.is_finite());
        Self { objective, scale: 1.0, factor: 1.0, squarings: 6, limits, limited }
    }

    pub fn set_scale(&mut self, scale: f64) {
        self.scale = if scale > 0.0 { scale } else { 1.0 };
        self.factor = self.scale / f64::from(1u32 << self.squarings);
    }

    /// Sets p to 2^`squarings`: higher powers look at the longest route alone, lower ones let routes pass each other.
    pub fn set_squarings(&mut self, squarings: u32) {
        self.squarings = squarings;
        self.set_scale(self.scale);
    }

    #[inline(always)]
    pub fn of(&self, vehicle: usize, length: f64) -> f64 {
        let mut energy = match self.objective {
            Objective::Total => length,
            Objective::Makespan => power(length / self.scale, self.squarings) * self.factor,
        };
        if self.limited && length > self.limits[vehicle] {
            energy += OVER_LIMIT * (length - self.limits[vehicle]);
        }
        energy
    }
}

/// `x` to the power 2^`squarings`.
#[inline(always)]
fn power(x: f64, squarings: u32) -> f64 {
    let mut y = x;
    for _ in 0..squarings {
        y *= y;
    }
    y
}
