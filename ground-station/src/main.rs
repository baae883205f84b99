//! Ground station: plans missions for teams of quadcopters.
fn main() {}
