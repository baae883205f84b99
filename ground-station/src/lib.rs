//! The ground station as a library: everything the program does, for its tests and for programs like it.
#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod cli;
pub mod command;
pub mod export;
pub mod failure;
pub mod geodesy;
pub mod input;
pub mod plot;
pub mod problem;
pub mod report;
pub mod words;
