//! Continuous states and controls from the numbers of a solution.

use nalgebra::SVector;

/// Times, states and state derivatives between which the state is a cubic Hermite polynomial. The derivative jumps with the
/// control, so each interval has its own two.
#[derive(Clone, Debug, Default)]
pub(crate) struct Nodes<const NX: usize> {
    pub times: Vec<f64>,
    pub states: Vec<SVector<f64, NX>>,
    /// Derivative at the left and right end of each interval.
    pub slopes: Vec<[SVector<f64, NX>; 2]>,
    /// Intervals that share one polynomial through their nodes instead; 0 for none.
    pub group: usize,
}

impl<const NX: usize> Nodes<NX> {
    pub fn state_at(&self, time: f64) -> SVector<f64, NX> {
        let last = self.times.len() - 2;
        let k = self.times.partition_point(|&t| t <= time).saturating_sub(1).min(last);
        if self.group > 0 {
            let first = k - k % self.group;
            let nodes = first..=first + self.group;
            return polynomial(
                &self.times[nodes.clone()],
                &self.states[nodes],
                time.clamp(self.times[0], self.times[last + 1]),
            );
        }
        let h = self.times[k + 1] - self.times[k];
        let s = if h > 0.0 { ((time - self.times[k]) / h).clamp(0.0, 1.0) } else { 0.0 };
        let (a, b) = (self.states[k], self.states[k + 1]);
        let [da, db] = self.slopes[k];
        let (s2, s3) = (s * s, s * s * s);
        a * (2.0 * s3 - 3.0 * s2 + 1.0)
            + da * (h * (s3 - 2.0 * s2 + s))
            + b * (3.0 * s2 - 2.0 * s3)
            + db * (h * (s3 - s2))
    }
}

/// The two of the increasing `points` next to `s` and the weight of the second; beyond the ends, the last of them alone counts.
pub(crate) fn bracket(points: &[f64], s: f64) -> (usize, usize, f64) {
    let n = points.len();
    let right = points.partition_point(|&p| p <= s).clamp(1, n.max(2) - 1).min(n - 1);
    let left = right.saturating_sub(1);
    let width = points[right] - points[left];
    (left, right, if width > 0.0 { ((s - points[left]) / width).clamp(0.0, 1.0) } else { 0.0 })
}

/// Lagrange interpolation of `values` at `points`, evaluated at `s`.
pub(crate) fn polynomial<const N: usize>(
    points: &[f64],
    values: &[SVector<f64, N>],
    s: f64,
) -> SVector<f64, N> {
    let mut sum = SVector::zeros();
    for (i, value) in values.iter().enumerate() {
        let mut basis = 1.0;
        for (j, &point) in points.iter().enumerate() {
            if j != i {
                basis *= (s - point) / (points[i] - point);
            }
        }
        sum += value * basis;
    }
    sum
}
