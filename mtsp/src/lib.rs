//! x
#![forbid(unsafe_code)]
#![allow(missing_docs)]
mod check; mod error; mod improve; mod initial; mod objective; mod problem; mod solution;
pub mod lower_bound;
pub use check::*; pub use error::{Error, List}; pub use improve::*; pub use objective::*; pub use problem::{Problem, End}; pub use solution::*;
