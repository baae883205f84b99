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
    /// `scale / p`, with `p = 2^squarings` and at least 4 squarings.
    factor: f64,
    squarings: u32,
    limits: Vec<f64>,
    limited: bool,
    /// Energy of each route at the length last told.
    cached: Vec<Cached>,
}

#[derive(Clone, Copy)]
struct Cached {
    /// NaN if the energy has changed since.
    length: f64,
    energy: f64,
    slope: f64,
}

/// Slope of the energy beyond the limit.
const OVER_LIMIT: f64 = 100.0;

impl Energy {
    pub fn new(objective: Objective, limits: Vec<f64>) -> Self {
        let limited = limits.iter().any(|l| l.is_finite());
        let cached = vec![Cached { length: f64::NAN, energy: 0.0, slope: 0.0 }; limits.len()];
        Self { objective, scale: 1.0, factor: 1.0, squarings: 6, limits, limited, cached }
    }

    pub fn set_scale(&mut self, scale: f64) {
        self.scale = if scale > 0.0 { scale } else { 1.0 };
        self.factor = self.scale / f64::from(1u32 << self.squarings);
        for cached in &mut self.cached {
            cached.length = f64::NAN;
        }
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

    /// Tells the lengths of all routes.
    pub fn cache_all(&mut self, lengths: &[f64]) {
        for (vehicle, &length) in lengths.iter().enumerate() {
            self.cache(vehicle, length);
        }
    }

    /// Tells the length of a route.
    #[inline]
    pub fn cache(&mut self, vehicle: usize, length: f64) {
        if length == self.cached[vehicle].length {
            return;
        }
        let energy = self.of(vehicle, length);
        let mut slope = match self.objective {
            Objective::Total => 1.0,
            // d/dL of (scale / p) (L / scale)^p is p E / L.
            Objective::Makespan if length > 0.0 => {
                power(length / self.scale, self.squarings) * self.scale / length
            }
            Objective::Makespan => 0.0,
        };
        if self.limited && length > self.limits[vehicle] {
            slope += OVER_LIMIT;
        }
        // Less by more than the rounding of both sides.
        self.cached[vehicle] = Cached { length, energy, slope: slope * SAFE };
    }

    /// Value and slope at the length last told.
    #[inline(always)]
    pub fn cached(&self, vehicle: usize) -> (f64, f64) {
        let cached = &self.cached[vehicle];
        (cached.energy, cached.slope)
    }

    /// The energy of all routes at the lengths last told.
    pub fn total(&self) -> f64 {
        self.cached.iter().map(|c| c.energy).sum()
    }
}

/// Keeps the slope a lower bound in spite of rounding.
const SAFE: f64 = 1.0 - 1e-9;

/// `x` to the power 2^`squarings`, at least 16.
#[inline(always)]
fn power(x: f64, squarings: u32) -> f64 {
    let mut y = x * x;
    y *= y;
    y *= y;
    y *= y;
    for _ in 4..squarings {
        y *= y;
    }
    y
}
