//! Point sets that are hard on clustering code: ties, duplicates, lines, extreme scales.

use proptest::prelude::*;

/// Up to `n` points: spread, on a coarse grid (ties and duplicates), on a line, tiny, or huge.
pub fn points(n: usize) -> impl Strategy<Value = Vec<[f64; 2]>> {
    (0usize..5, prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 0..n)).prop_map(|(kind, raw)| {
        raw.into_iter()
            .map(|(x, y)| match kind {
                0 => [x, y],
                1 => [(3.0 * x).round(), (3.0 * y).round()],
                2 => [x, 0.5 * x],
                3 => [1e-180 * x, 1e-180 * y],
                _ => [1e180 * x, 1e180 * y],
            })
            .collect()
    })
}

/// Distance that neither overflows nor underflows.
pub fn distance(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
