//! The commands of the program, without its command line.

mod check;
mod outputs;
mod plan;

pub use check::check;
pub use outputs::{Outputs, outputs};
pub use plan::{PlanRequest, plan};
