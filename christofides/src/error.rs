//! What can be wrong with the input.

/// The reason why an input was refused; indices are those of the caller.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A coordinate is NaN or infinite.
    #[error("coordinate {axis} of point {point} is not finite")]
    NonFiniteCoordinate {
        /// Index of the point.
        point: usize,
        /// Index of the coordinate within the point.
        axis: usize,
    },
    /// A distance is NaN or infinite.
    #[error("distance from {i} to {j} is not finite")]
    NonFiniteDistance {
        /// First vertex.
        i: usize,
        /// Second vertex.
        j: usize,
    },
    /// A distance is below zero.
    #[error("distance from {i} to {j} is negative")]
    NegativeDistance {
        /// First vertex.
        i: usize,
        /// Second vertex.
        j: usize,
    },
    /// A vertex is at a positive distance from itself.
    #[error("distance from {i} to itself is not zero")]
    NonZeroDiagonal {
        /// The vertex.
        i: usize,
    },
    /// `distance(i, j)` differs from `distance(j, i)`.
    #[error("distance from {i} to {j} differs from the way back")]
    Asymmetric {
        /// First vertex.
        i: usize,
        /// Second vertex.
        j: usize,
    },
    /// `distance(i, j) > distance(i, via) + distance(via, j)`.
    #[error("distance from {i} to {j} is longer than the way over {via}")]
    TriangleInequality {
        /// First vertex.
        i: usize,
        /// Second vertex.
        j: usize,
        /// The vertex over which the way is shorter.
        via: usize,
    },
    /// The length of a slice does not fit the number of vertices.
    #[error("expected {expected} entries, found {found}")]
    DimensionMismatch {
        /// Entries that were needed.
        expected: usize,
        /// Entries that were given.
        found: usize,
    },
    /// A vertex that does not exist.
    #[error("vertex {vertex} is out of range for {n} vertices")]
    VertexOutOfRange {
        /// The vertex.
        vertex: usize,
        /// Number of vertices.
        n: usize,
    },
    /// An order that misses or repeats a vertex.
    #[error("vertex {vertex} is missing from the order or occurs in it twice")]
    NotAPermutation {
        /// The vertex.
        vertex: usize,
    },
    /// An odd number of vertices has no perfect matching.
    #[error("{n} vertices cannot be matched perfectly because their number is odd")]
    OddVertexCount {
        /// Number of vertices.
        n: usize,
    },
    /// The graph has no perfect matching.
    #[error("the graph has no perfect matching: at least {exposed} vertices stay unmatched")]
    NoPerfectMatching {
        /// Vertices that no matching of this size can cover.
        exposed: usize,
    },
    /// The graph is not connected.
    #[error("the graph falls into {n_components} components: {first} and {second} are not connected")]
    Disconnected {
        /// Number of connected components.
        n_components: usize,
        /// A vertex of one component.
        first: usize,
        /// A vertex of another component.
        second: usize,
        /// Component of every vertex, numbered from 0 in order of first occurrence.
        components: Vec<usize>,
    },
    /// Start and end of a path with more than one vertex coincide.
    #[error("a path over {n} vertices cannot start and end at vertex {vertex}")]
    EqualEnds {
        /// The vertex.
        vertex: usize,
        /// Number of vertices.
        n: usize,
    },
    /// More vertices than an algorithm takes.
    #[error("{n} vertices are more than the {limit} that this algorithm takes")]
    TooManyVertices {
        /// Number of vertices.
        n: usize,
        /// The limit.
        limit: usize,
    },
    /// Distances so large that sums of them overflow.
    #[error("distances are too large: their sum is not finite")]
    Overflow,
}
