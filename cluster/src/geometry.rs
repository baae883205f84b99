//! Distances between points given as arrays, and a scale at which their squares neither overflow nor vanish.

/// Squared Euclidean distance.
#[inline(always)]
pub(crate) fn squared_distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    let mut sum = 0.0;
    for axis in 0..D {
        let difference = a[axis] - b[axis];
        sum += difference * difference;
    }
    sum
}

/// Euclidean distance that survives coordinates whose squares overflow or underflow.
#[inline]
pub(crate) fn distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    let squared = squared_distance(a, b);
    if squared.is_finite() && squared > SAFE_SQUARE {
        return squared.sqrt();
    }
    // Rare: halve before subtracting (two finite numbers may differ by more than the largest one).
    let largest = (0..D).fold(0.0_f64, |m, axis| m.max((a[axis] / 2.0 - b[axis] / 2.0).abs()));
    if largest == 0.0 {
        // Either equal or one unit of the least subnormal apart.
        return (0..D).fold(0.0_f64, |m, axis| m.max((a[axis] - b[axis]).abs()));
    }
    let sum: f64 = (0..D).map(|axis| ((a[axis] / 2.0 - b[axis] / 2.0) / largest).powi(2)).sum();
    2.0 * largest * sum.sqrt()
}

/// Below this a square has lost digits to underflow: the least normal number over the unit roundoff, 2^-1022 / 2^-53.
const SAFE_SQUARE: f64 = 1.0e-291;

/// A power of two by which to multiply all points so that squared distances are safe; 1 unless coordinates are extreme.
pub(crate) fn safe_scale<const D: usize>(points: &[[f64; D]]) -> f64 {
    power_of_two(points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs())))
}

/// A power of two that brings a greatest magnitude to about 1; 1 unless it is extreme.
pub(crate) fn power_of_two(largest: f64) -> f64 {
    if largest == 0.0 || (1e-100..1e100).contains(&largest) {
        return 1.0;
    }
    // Clamped so that the inverse is a normal number too.
    let exponent = -(largest.log2().floor().clamp(-1000.0, 1000.0));
    2.0_f64.powi(exponent as i32)
}

/// The points multiplied by `scale`.
pub(crate) fn scaled<const D: usize>(points: &[[f64; D]], scale: f64) -> Vec<[f64; D]> {
    points.iter().map(|p| p.map(|x| x * scale)).collect()
}
