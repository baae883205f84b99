//! Real weights as integers.

/// Bits of the largest scaled weight: duals may be sums of many weights and must fit an `i64`.
const WEIGHT_BITS: i32 = 46;

/// Scaled weights are multiples of four, so that the halves of slacks that the search needs are integers.
pub(crate) const UNIT: i64 = 4;

/// A power of two by which weights are multiplied before they are rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scale {
    factor: f64,
}

impl Scale {
    /// The scale for weights up to `greatest` in absolute value.
    pub fn new(greatest: f64) -> Self {
        let exponent = if greatest > 0.0 { greatest.log2().ceil() as i32 } else { 0 };
        // Subnormal extremes leave the range of a power of two; they are clamped and lose nothing that f64 resolves.
        Scale { factor: 2.0_f64.powi((WEIGHT_BITS - exponent).clamp(-1000, 1000)) }
    }

    #[inline]
    pub fn weight(self, weight: f64) -> i64 {
        UNIT * (weight * self.factor).round() as i64
    }

    /// A dual in the unit of the weights.
    pub fn real(self, dual: i64) -> f64 {
        dual as f64 / UNIT as f64 / self.factor
    }

    /// How far the weight of an optimum of the rounded weights can be above the true optimum, `n` vertices.
    ///
    /// Each of the `n / 2` edges of either matching is off by half a unit.
    pub fn error_bound(self, n: usize) -> f64 {
        n as f64 / 2.0 / self.factor
    }
}
