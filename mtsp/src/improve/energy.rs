//! What the search minimises: a sum of convex functions of the route lengths.

use crate::objective::Objective;

/// How the energy of a route grows with its length when the makespan is to be least. Each is convex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    /// `(scale / p) (length / scale)^p` with `p = 2^squarings`, at least 4 squarings: higher powers look at the longest route alone,
    /// lower ones let routes pass each other.
    Power(u32),
    /// A slope of [`FLAT`] up to [`KNEE`] times the scale and 1 more beyond: the total cost with a penalty on what is longer than a
    /// solution that would be an improvement, as in a bisection on limits.
    Knee,
}

/// Energy of a route as a function of its length.
///
/// Min-sum: the length itself. Min-max: one of [`Shape`] with `scale` the best makespan so far, whose slope is about 1
/// at the best makespan and small for short routes: minimising the sum flattens the longest routes first, yet
/// every route feels some pull to be short, which plain min-max does not give. Over its limit a route pays [`OVER_LIMIT`] times the excess.
#[derive(Clone)]
pub(crate) struct Energy {
    objective: Objective,
    scale: f64,
    shape: Shape,
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

/// Slope of the shape with a knee below it, and where the knee is.
const FLAT: f64 = 0.03;
const KNEE: f64 = 0.998;

/// Slope of the energy beyond the limit.
const OVER_LIMIT: f64 = 100.0;

impl Energy {
    pub fn new(objective: Objective, limits: Vec<f64>) -> Self {
        let limited = limits.iter().any(|l| l.is_finite());
        let cached = vec![Cached { length: f64::NAN, energy: 0.0, slope: 0.0 }; limits.len()];
        Self { objective, scale: 1.0, shape: Shape::Power(6), limits, limited, cached }
    }

    pub fn set_scale(&mut self, scale: f64) {
        self.scale = if scale > 0.0 { scale } else { 1.0 };
        for cached in &mut self.cached {
            cached.length = f64::NAN;
        }
    }

    pub fn set_shape(&mut self, shape: Shape) {
        self.shape = shape;
        self.set_scale(self.scale);
    }

    #[inline(always)]
    pub fn of(&self, vehicle: usize, length: f64) -> f64 {
        let mut energy = match self.objective {
            Objective::Total => length,
            Objective::Makespan => match self.shape {
                Shape::Power(squarings) => {
                    power(length / self.scale, squarings) * self.scale / f64::from(1u32 << squarings)
                }
                Shape::Knee => FLAT * length + (length - KNEE * self.scale).max(0.0),
            },
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
            Objective::Makespan => match self.shape {
                // d/dL of (scale / p) (L / scale)^p is p E / L.
                Shape::Power(squarings) if length > 0.0 => {
                    power(length / self.scale, squarings) * self.scale / length
                }
                Shape::Power(_) => 0.0,
                Shape::Knee if length > KNEE * self.scale => FLAT + 1.0,
                Shape::Knee => FLAT,
            },
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
