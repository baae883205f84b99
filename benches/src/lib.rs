//! Instances shared by the benchmarks.
