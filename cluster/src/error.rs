//! What can be wrong with the input of this crate.

/// Why an input was refused; nothing has been computed when one of these is returned.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A coordinate is NaN or infinite.
    #[error("coordinate {axis} of point {point} is not finite")]
    NonFiniteCoordinate {
        /// Index of the point.
        point: usize,
        /// Index of the coordinate.
        axis: usize,
    },
    /// A weight is not a positive finite number.
    #[error("weight of point {point} is {weight}, but weights must be positive and finite")]
    InvalidWeight {
        /// Index of the point.
        point: usize,
        /// The offending value.
        weight: f64,
    },
    /// There are not as many weights as points.
    #[error("{found} weights given for {expected} points")]
    WeightCount {
        /// The number of points.
        expected: usize,
        /// The number of weights.
        found: usize,
    },
    /// Zero clusters were asked for although there are points.
    #[error("zero clusters asked for, but there are points to put somewhere")]
    NoClusters,
    /// An option is outside its range.
    #[error("option {option} must be at least {minimum}, got {found}")]
    OptionTooSmall {
        /// Name of the field.
        option: OptionName,
        /// The least value allowed.
        minimum: f64,
        /// The value found.
        found: f64,
    },
    /// The capacities together are smaller than the number of points.
    #[error("the capacities sum to {capacity}, but there are {points} points")]
    CapacityTooSmall {
        /// Sum of all capacities.
        capacity: usize,
        /// The number of points.
        points: usize,
    },
    /// More clusters than moves between any two of them can be kept for.
    #[error("{clusters} clusters of limited size are asked for, at most {limit} can be")]
    TooManyClusters {
        /// The number of clusters.
        clusters: usize,
        /// The greatest number allowed.
        limit: usize,
    },
    /// More points than distances between any two of them can be kept for.
    #[error(
        "the distances between {points} points do not fit the memory, those of {limit} may; merge_within needs none"
    )]
    TooManyPoints {
        /// The number of points.
        points: usize,
        /// The greatest number allowed.
        limit: usize,
    },
    /// A diameter or height is NaN or negative.
    #[error("a diameter must be a number that is not negative, got {diameter}")]
    InvalidDiameter {
        /// The offending value.
        diameter: f64,
    },
    /// A condensed matrix has a length that no number of observations gives.
    #[error("a condensed matrix of {observations} observations has {expected} entries, found {found}")]
    CondensedLength {
        /// The number of observations claimed.
        observations: usize,
        /// `observations (observations - 1) / 2`.
        expected: usize,
        /// The number of entries given.
        found: usize,
    },
    /// A dissimilarity is NaN, infinite or negative.
    #[error("dissimilarity {index} of the condensed matrix is {value}, but must be finite and not negative")]
    InvalidDissimilarity {
        /// Position in the condensed matrix.
        index: usize,
        /// The offending value.
        value: f64,
    },
    /// A handle names no point that is in the clustering.
    #[error("no point has the handle {id}")]
    UnknownPoint {
        /// The handle.
        id: usize,
    },
    /// A label names no cluster.
    #[error("label {label} of point {point} names no cluster of the {clusters} there are")]
    UnknownLabel {
        /// Index of the point.
        point: usize,
        /// Its label.
        label: usize,
        /// The number of clusters.
        clusters: usize,
    },
}

/// Options that can be out of range, see [`Error::OptionTooSmall`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum OptionName {
    /// [`KMeansOptions::n_init`](crate::KMeansOptions::n_init)
    NInit,
    /// [`KMeansOptions::max_iterations`](crate::KMeansOptions::max_iterations)
    MaxIterations,
    /// [`KMeansOptions::tolerance`](crate::KMeansOptions::tolerance)
    Tolerance,
}

impl std::fmt::Display for OptionName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            OptionName::NInit => "n_init",
            OptionName::MaxIterations => "max_iterations",
            OptionName::Tolerance => "tolerance",
        })
    }
}

/// Refuses points with a coordinate that is not finite.
pub(crate) fn check_finite<const D: usize>(points: &[[f64; D]]) -> Result<(), Error> {
    for (point, coordinates) in points.iter().enumerate() {
        if let Some(axis) = coordinates.iter().position(|x| !x.is_finite()) {
            return Err(Error::NonFiniteCoordinate { point, axis });
        }
    }
    Ok(())
}
