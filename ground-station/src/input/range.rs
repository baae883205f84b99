//! Ranges of numbers, with words for people.

use std::fmt;

/// The numbers that a key accepts; not-a-number and infinities are in no range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    low: f64,
    low_included: bool,
    high: f64,
}

impl Range {
    /// Above 0.
    pub const POSITIVE: Self = Self { low: 0.0, low_included: false, high: f64::INFINITY };
    /// 0 or more.
    pub const NOT_NEGATIVE: Self = Self { low: 0.0, low_included: true, high: f64::INFINITY };
    /// Above 0, at most 1.
    pub const SHARE: Self = Self { low: 0.0, low_included: false, high: 1.0 };

    /// From `low` to `high`, both included.
    #[must_use]
    pub const fn between(low: f64, high: f64) -> Self {
        Self { low, low_included: true, high }
    }

    /// Above `low`, at most `high`.
    #[must_use]
    pub const fn above_to(low: f64, high: f64) -> Self {
        Self { low, low_included: false, high }
    }

    /// Whether the number is in the range.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        let above = value > self.low || (self.low_included && value == self.low);
        value.is_finite() && above && value <= self.high
    }
}

impl fmt::Display for Range {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { low, high, .. } = self;
        match (self.low_included, high.is_finite()) {
            (true, false) => write!(formatter, "{low} or more"),
            (false, false) => write!(formatter, "above {low}"),
            (true, true) => write!(formatter, "from {low} to {high}"),
            (false, true) => write!(formatter, "above {low}, at most {high}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_and_words_agree() {
        assert!(
            !Range::POSITIVE.contains(0.0) && Range::NOT_NEGATIVE.contains(0.0) && Range::SHARE.contains(1.0)
        );
        for range in [Range::POSITIVE, Range::NOT_NEGATIVE, Range::SHARE] {
            for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                assert!(!range.contains(value), "{range} {value}");
            }
        }
        assert_eq!(Range::SHARE.to_string(), "above 0, at most 1");
        assert_eq!(Range::between(-90.0, 90.0).to_string(), "from -90 to 90");
        assert_eq!(Range::NOT_NEGATIVE.to_string(), "0 or more");
    }
}
