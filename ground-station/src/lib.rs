//! Ground station.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod export;
pub mod failure;
pub mod geodesy;
pub mod input;
pub mod plot;
pub mod problem;
pub mod words;
