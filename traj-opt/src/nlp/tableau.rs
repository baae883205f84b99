//! Butcher's coefficients of Radau IIA, the implicit Runge-Kutta method that Legendre-Gauss-Radau collocation is.

use crate::transcription::MAX_DEGREE;

/// Weights of the slopes at the collocation points in the states there: row i integrates the interpolating polynomial of the
/// slopes from 0 to point i. The last row, to 1, is the quadrature rule.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tableau {
    pub degree: usize,
    weights: [[f64; MAX_DEGREE]; MAX_DEGREE],
}

impl Tableau {
    /// Coefficients for the given collocation points in `(0, 1]`, at most [`MAX_DEGREE`] of them.
    pub fn new(points: &[f64]) -> Self {
        let degree = points.len().min(MAX_DEGREE);
        let mut weights = [[0.0; MAX_DEGREE]; MAX_DEGREE];
        for j in 0..degree {
            let basis = lagrange_coefficients(&points[..degree], j);
            for (i, &end) in points[..degree].iter().enumerate() {
                // Horner's scheme for the antiderivative
                weights[i][j] =
                    (0..degree).rev().fold(0.0, |sum, power| (sum + basis[power] / (power + 1) as f64) * end);
            }
        }
        Self { degree, weights }
    }

    /// Weight of the slope at point `j` in the state at point `i`.
    #[inline(always)]
    pub fn weight(&self, i: usize, j: usize) -> f64 {
        self.weights[i][j]
    }
}

/// Monomial coefficients, in ascending powers, of the polynomial that is 1 at point `j` and 0 at the others.
fn lagrange_coefficients(points: &[f64], j: usize) -> [f64; MAX_DEGREE] {
    let mut out = [0.0; MAX_DEGREE];
    out[0] = 1.0;
    let mut degree = 0;
    for (i, &p) in points.iter().enumerate() {
        if i == j {
            continue;
        }
        let scale = 1.0 / (points[j] - p);
        degree += 1;
        for power in (0..=degree).rev() {
            let below = if power > 0 { out[power - 1] } else { 0.0 };
            out[power] = (below - p * out[power]) * scale;
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Transcription;

    #[test]
    fn quadrature_is_exact_to_twice_the_degree_less_two() {
        for degree in 1..=MAX_DEGREE {
            let points = Transcription::LegendreGaussRadau { degree }.control_points();
            let table = Tableau::new(points);
            for power in 0..2 * degree - 1 {
                let sum: f64 =
                    (0..degree).map(|j| table.weight(degree - 1, j) * points[j].powi(power as i32)).sum();
                assert!(
                    (sum - 1.0 / (power + 1) as f64).abs() < 1e-12,
                    "degree {degree}, power {power}: {sum}"
                );
            }
            for i in 0..degree {
                let row: f64 = (0..degree).map(|j| table.weight(i, j)).sum();
                assert!((row - points[i]).abs() < 1e-12);
            }
        }
    }
}
