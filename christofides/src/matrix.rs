//! Metrics that are given by a matrix or by a function.

use crate::error::Error;
use crate::metric::Metric;
use crate::validate::{validate_symmetric, validate_triangles};

/// A dense symmetric distance matrix, row-major, `n x n`.
///
/// # Examples
/// ```
/// use christofides::{christofides, Matrix};
///
/// let matrix = Matrix::metric(3, vec![0.0, 1.0, 2.0, 1.0, 0.0, 2.0, 2.0, 2.0, 0.0])?;
/// assert_eq!(christofides(&matrix)?.cost(), 5.0);
/// # Ok::<(), christofides::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    n: usize,
    distances: Vec<f64>,
    is_metric: bool,
}

impl Matrix {
    /// A matrix that is checked for everything a metric promises, the triangle inequality included.
    ///
    /// # Errors
    /// The first violated promise, with its indices. `O(n^3)` time.
    pub fn metric(n: usize, distances: Vec<f64>) -> Result<Self, Error> {
        let mut matrix = Self::symmetric(n, distances)?;
        validate_triangles(&matrix)?;
        matrix.is_metric = true;
        Ok(matrix)
    }

    /// A matrix that is finite, symmetric, non-negative and zero on the diagonal, but may break the triangle inequality.
    ///
    /// Algorithms whose bound needs a metric check it themselves (`O(n^3)`) and refuse the matrix if it is none.
    ///
    /// # Errors
    /// The first violated promise, with its indices. `O(n^2)` time.
    pub fn symmetric(n: usize, distances: Vec<f64>) -> Result<Self, Error> {
        let expected = n.saturating_mul(n);
        if distances.len() != expected {
            return Err(Error::DimensionMismatch { expected, found: distances.len() });
        }
        let matrix = Self { n, distances, is_metric: false };
        validate_symmetric(&matrix)?;
        Ok(matrix)
    }

    /// The distances of `metric`, tabulated.
    ///
    /// # Errors
    /// What [`Matrix::symmetric`] refuses; [`Error::TooManyVertices`] if the table would not fit the memory.
    pub fn tabulate(metric: &impl Metric) -> Result<Self, Error> {
        let n = metric.len();
        let mut distances = Vec::new();
        // The largest table that could be asked for, not the largest that there is memory for.
        let limit = (isize::MAX as usize / size_of::<f64>()).isqrt();
        if distances.try_reserve_exact(n.saturating_mul(n)).is_err() {
            return Err(Error::TooManyVertices { n, limit: limit.min(n - 1) });
        }
        distances.extend((0..n).flat_map(|i| (0..n).map(move |j| metric.distance(i, j))));
        Ok(Self { is_metric: metric.is_metric(), ..Self::symmetric(n, distances)? })
    }

    /// The same distances, known to obey the triangle inequality.
    #[cfg(feature = "petgraph")]
    pub(crate) fn promised(self) -> Self {
        Self { is_metric: true, ..self }
    }

    /// The distances, row-major.
    #[must_use]
    pub fn as_slice(&self) -> &[f64] {
        &self.distances
    }
}

impl Metric for Matrix {
    fn len(&self) -> usize {
        self.n
    }

    #[inline]
    fn distance(&self, i: usize, j: usize) -> f64 {
        self.distances[i * self.n + j]
    }

    fn is_metric(&self) -> bool {
        self.is_metric
    }
}

/// A function of two vertices as a metric.
///
/// # Examples
/// ```
/// use christofides::{FromFn, Metric};
///
/// let on_a_line = FromFn::metric(5, |i, j| i.abs_diff(j) as f64);
/// assert_eq!(on_a_line.distance(4, 1), 3.0);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct FromFn<F> {
    n: usize,
    distance: F,
    is_metric: bool,
}

impl<F: Fn(usize, usize) -> f64> FromFn<F> {
    /// A function that the caller promises to be a metric.
    pub fn metric(n: usize, distance: F) -> Self {
        Self { n, distance, is_metric: true }
    }

    /// A symmetric function that may break the triangle inequality.
    pub fn symmetric(n: usize, distance: F) -> Self {
        Self { n, distance, is_metric: false }
    }
}

impl<F: Fn(usize, usize) -> f64> Metric for FromFn<F> {
    fn len(&self) -> usize {
        self.n
    }

    #[inline]
    fn distance(&self, i: usize, j: usize) -> f64 {
        (self.distance)(i, j)
    }

    fn is_metric(&self) -> bool {
        self.is_metric
    }
}
