//! What a tour is measured by: a symmetric, non-negative distance that obeys the triangle inequality.

/// A finite metric space over the vertices `0..len()`.
///
/// Implementors promise `distance(i, i) = 0`, symmetry, non-negativity and the triangle inequality; the bounds of this
/// crate hold only then. Open trait: implement it for your own data.
pub trait Metric {
    /// The number of vertices.
    fn len(&self) -> usize;

    /// Whether there is no vertex at all.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The distance from vertex `i` to vertex `j`.
    ///
    /// # Panics
    /// May panic if `i` or `j` is not below [`len`](Metric::len).
    fn distance(&self, i: usize, j: usize) -> f64;
}
