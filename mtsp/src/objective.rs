//! What is to be least.

/// The objective: what counts first; the other counts among solutions that are equal in the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Objective {
    /// The sum of all route lengths (min-sum). Without limits nothing balances the vehicles: with closed routes over a metric,
    /// one vehicle does everything.
    Total,
    /// The length of the longest route (min-max), then the sum.
    #[default]
    Makespan,
}
