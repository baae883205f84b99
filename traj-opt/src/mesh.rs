//! How the time interval is divided into segments.

use crate::Error;

/// Knots of a trajectory as fractions of the flight: increasing from 0 to 1, `n_segments + 1` of them.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Unchecked"))]
pub struct Mesh {
    fractions: Vec<f64>,
}

/// A mesh as it stands in a file.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
struct Unchecked {
    fractions: Vec<f64>,
}

#[cfg(feature = "serde")]
impl TryFrom<Unchecked> for Mesh {
    type Error = Error;

    fn try_from(unchecked: Unchecked) -> Result<Self, Error> {
        Self::from_fractions(unchecked.fractions)
    }
}

/// More segments or samples than anybody solves for; what is asked for beyond is cut, before it takes memory.
pub(crate) const MOST: usize = 1 << 20;

impl Mesh {
    /// `n_segments` segments of equal length (at least one, at most 2^20).
    #[must_use]
    pub fn uniform(n_segments: usize) -> Self {
        let n = n_segments.clamp(1, MOST);
        Self { fractions: (0..=n).map(|k| k as f64 / n as f64).collect() }
    }

    /// Segments that are short at both ends and long in the middle; at least one, at most 2^20.
    ///
    /// Knots are `x = (1 - a) s + a (3 s^2 - 2 s^3)` of uniform `s`: the outermost segments are about `1 - a` times the
    /// uniform length, those in the middle `1 + a/2` times. `grading` is `a`, clamped to `[0, 0.95]`; 0 is uniform.
    /// Minimum-time flights turn hardest near their ends, whatever their length.
    #[must_use]
    pub fn graded(n_segments: usize, grading: f64) -> Self {
        let n = n_segments.clamp(1, MOST);
        let a = if grading.is_finite() { grading.clamp(0.0, 0.95) } else { 0.0 };
        let knot = |k: usize| {
            let s = k as f64 / n as f64;
            (1.0 - a) * s + a * s * s * (3.0 - 2.0 * s)
        };
        let mut fractions: Vec<f64> = (0..=n).map(knot).collect();
        fractions[n] = 1.0;
        Self { fractions }
    }

    /// A mesh with the given knots.
    ///
    /// # Errors
    /// [`Error::InvalidMesh`] unless the fractions start at 0, end at 1 and increase strictly.
    pub fn from_fractions(fractions: Vec<f64>) -> Result<Self, Error> {
        let increasing = fractions.windows(2).all(|w| w[0] < w[1]);
        let ends = fractions.first() == Some(&0.0) && fractions.last() == Some(&1.0);
        if increasing && ends && fractions.len() >= 2 {
            Ok(Self { fractions })
        } else {
            let knot =
                fractions.windows(2).position(|w| w[0].partial_cmp(&w[1]) != Some(std::cmp::Ordering::Less));
            Err(Error::InvalidMesh { knot: knot.map_or(0, |k| k + 1) })
        }
    }

    /// Number of segments, at least 1.
    #[must_use]
    pub fn n_segments(&self) -> usize {
        self.fractions.len() - 1
    }

    /// The knots, `n_segments + 1` increasing values from 0 to 1.
    #[must_use]
    pub fn fractions(&self) -> &[f64] {
        &self.fractions
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn graded_meshes_are_symmetric_and_increasing() {
        for a in [0.0, 0.5, 0.95, 7.0, f64::NAN] {
            let mesh = Mesh::graded(41, a);
            let f = mesh.fractions();
            assert!(Mesh::from_fractions(f.to_vec()).is_ok());
            for k in 0..=41 {
                assert!((f[k] + f[41 - k] - 1.0).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn bad_knots_are_refused() {
        for bad in
            [vec![], vec![0.0], vec![0.0, 0.0, 1.0], vec![0.1, 1.0], vec![0.0, f64::NAN, 1.0], vec![0.0, 2.0]]
        {
            assert!(Mesh::from_fractions(bad).is_err());
        }
    }
}
