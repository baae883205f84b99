//! The ways in which a trajectory is represented by finitely many numbers.

/// How dynamics, controls and constraints are discretised on each segment of the mesh.
///
/// Controls belong to a segment: [`n_local`](Transcription::n_local) control vectors each. They may jump at the knots (an
/// optimal control of bang-bang kind does); the states are continuous.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Transcription {
    /// Multiple shooting: the control is constant over a segment and the classic Runge-Kutta method of order 4 takes
    /// `substeps` equal steps. What it returns can be flown: integrating the controls reproduces the states to the error of
    /// the Runge-Kutta steps. Path constraints hold at the knots, with the control of the segment that begins there.
    RungeKutta {
        /// Steps a segment, at least 1.
        substeps: usize,
    },
    /// Trapezoidal rule, order 2: the control is linear over a segment (two control vectors: left, right).
    Trapezoidal,
    /// Hermite-Simpson (Lobatto IIIA), order 4: the control is quadratic over a segment (three control vectors: left, middle,
    /// right); the middle state is the Hermite interpolant. Bounds on states hold at the knots and in the middle.
    HermiteSimpson,
}

impl Default for Transcription {
    fn default() -> Self {
        Self::RungeKutta { substeps: 2 }
    }
}

impl Transcription {
    /// Number of control vectors of a segment.
    #[must_use]
    pub fn n_local(self) -> usize {
        match self {
            Self::RungeKutta { .. } => 1,
            Self::Trapezoidal => 2,
            Self::HermiteSimpson => 3,
        }
    }

    /// Order of the error of the states for a smooth control.
    #[must_use]
    pub fn order(self) -> usize {
        match self {
            Self::Trapezoidal => 2,
            Self::RungeKutta { .. } | Self::HermiteSimpson => 4,
        }
    }

    /// Where in the segment the control vectors apply, as fractions of it.
    #[must_use]
    pub fn control_points(self) -> &'static [f64] {
        match self {
            Self::RungeKutta { .. } => &[0.0],
            Self::Trapezoidal => &[0.0, 1.0],
            Self::HermiteSimpson => &[0.0, 0.5, 1.0],
        }
    }
}
