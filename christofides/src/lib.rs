//! Metric travelling salesman: Christofides' algorithm with exact minimum-weight perfect matching, tour improvement and
//! certified lower bounds.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod metric;

pub use metric::Metric;
