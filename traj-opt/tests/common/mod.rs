//! Models and data shared by the tests and examples.
#![allow(missing_docs, dead_code)]

pub mod quadcopter;
