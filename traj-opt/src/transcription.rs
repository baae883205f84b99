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
        /// Steps a segment, from 1 to 100.
        substeps: usize,
    },
    /// Trapezoidal rule, order 2: the control is linear over a segment (two control vectors: left, right).
    Trapezoidal,
    /// Separated Hermite-Simpson (Lobatto IIIA), order 4: the control is quadratic over a segment (three control vectors: left, middle,
    /// right); the middle state is the Hermite interpolant. Bounds on states hold at the knots and in the middle.
    HermiteSimpson,
    /// Compressed Hermite-Simpson: the same equations with the middle states eliminated, so that they are always interpolants;
    /// bounds on states hold at the knots only, path constraints also in the middle. The same solutions where no state bound is
    /// active.
    CompressedHermiteSimpson,
    /// Legendre-Gauss-Radau collocation (Radau IIA), order `2 degree - 1`: the state is a polynomial of that degree over a
    /// segment, the control one of a degree less through its values at the collocation points, the last of which is the segment's
    /// end. Bounds and path constraints hold at the collocation points; the control at a segment's start is extrapolated.
    LegendreGaussRadau {
        /// Collocation points a segment, 1 to 7 (clamped).
        degree: usize,
    },
}

/// Greatest number of collocation points of a segment.
pub(crate) const MAX_DEGREE: usize = 7;

/// Zeros of `P_d - P_(d-1)`, the difference of Legendre polynomials, moved to `(0, 1]`.
const RADAU: [&[f64]; MAX_DEGREE] = [
    &[1.0],
    &[1.0 / 3.0, 1.0],
    &[0.155_051_025_721_682_2, 0.644_948_974_278_317_8, 1.0],
    &[0.088_587_959_512_703_94, 0.409_466_864_440_734_7, 0.787_659_461_760_847, 1.0],
    &[
        0.057_104_196_114_517_68,
        0.276_843_013_638_123_8,
        0.583_590_432_368_916_8,
        0.860_240_135_656_219_5,
        1.0,
    ],
    &[
        0.039_809_857_051_468_74,
        0.198_013_417_873_608_18,
        0.437_974_810_247_386_16,
        0.695_464_273_353_636_1,
        0.901_464_914_201_173_6,
        1.0,
    ],
    &[
        0.029_316_427_159_784_893,
        0.148_078_599_668_484_3,
        0.336_984_690_281_154_3,
        0.558_671_518_771_550_1,
        0.769_233_862_030_054_5,
        0.926_945_671_319_741_1,
        1.0,
    ],
];

fn radau(degree: usize) -> &'static [f64] {
    RADAU[degree.clamp(1, MAX_DEGREE) - 1]
}

impl Default for Transcription {
    fn default() -> Self {
        Self::RungeKutta { substeps: 2 }
    }
}

impl Transcription {
    /// With at least one step a segment, and not so many that the number alone takes memory.
    pub(crate) fn valid(self) -> Self {
        match self {
            Self::RungeKutta { substeps } => Self::RungeKutta { substeps: substeps.clamp(1, 100) },
            other => other,
        }
    }

    /// Number of control vectors of a segment.
    #[must_use]
    pub fn n_local(self) -> usize {
        match self {
            Self::RungeKutta { .. } => 1,
            Self::Trapezoidal => 2,
            Self::HermiteSimpson | Self::CompressedHermiteSimpson => 3,
            Self::LegendreGaussRadau { degree } => radau(degree).len(),
        }
    }

    /// Order of the error of the states for a smooth control.
    #[must_use]
    pub fn order(self) -> usize {
        match self {
            Self::Trapezoidal => 2,
            Self::RungeKutta { .. } | Self::HermiteSimpson | Self::CompressedHermiteSimpson => 4,
            Self::LegendreGaussRadau { degree } => 2 * radau(degree).len() - 1,
        }
    }

    /// Where in the segment the control vectors apply, as fractions of it.
    #[must_use]
    pub fn control_points(self) -> &'static [f64] {
        match self {
            Self::RungeKutta { .. } => &[0.0],
            Self::Trapezoidal => &[0.0, 1.0],
            Self::HermiteSimpson | Self::CompressedHermiteSimpson => &[0.0, 0.5, 1.0],
            Self::LegendreGaussRadau { degree } => radau(degree),
        }
    }

    pub(crate) fn is_hermite_simpson(self) -> bool {
        matches!(self, Self::HermiteSimpson | Self::CompressedHermiteSimpson)
    }

    /// States inside a segment that the transcribed problem stores.
    pub(crate) fn n_inner(self) -> usize {
        match self {
            Self::RungeKutta { .. } | Self::Trapezoidal => 0,
            Self::HermiteSimpson | Self::CompressedHermiteSimpson => 1,
            Self::LegendreGaussRadau { degree } => radau(degree).len() - 1,
        }
    }

    /// True if each defect is resolved for the end state by a matrix of the segment.
    pub(crate) fn resolves_end(self) -> bool {
        self.is_hermite_simpson() || self == Self::Trapezoidal
    }
}
