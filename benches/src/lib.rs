//! Instances shared by the benchmarks.

/// Uniform points in the unit square by a linear congruence from `state` on, the same for ever.
#[must_use]
pub fn uniform(mut state: u64, n: usize) -> Vec<[f64; 2]> {
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..n).map(|_| [next(), next()]).collect()
}

/// The generator's state where a benchmark needs no other.
pub const SEED: u64 = 0x2545_f491_4f6c_dd1d;

/// The depot at the origin, and uniform targets in a square of 2 km around it (m).
#[must_use]
pub fn depot_and_targets(n: usize) -> Vec<[f64; 2]> {
    let targets = uniform(0x9e37_79b9_7f4a_7c15, n).into_iter().map(|p| p.map(|x| 2000.0 * x - 1000.0));
    std::iter::once([0.0, 0.0]).chain(targets).collect()
}
