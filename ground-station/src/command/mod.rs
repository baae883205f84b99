//! The commands of the program, without its command line.

mod check;
mod fly;
mod outputs;
mod plan;
mod report;

pub use check::check;
pub use fly::{FlyRequest, fly, tasks};
pub(crate) use outputs::sampled;
pub use outputs::{Outputs, outputs};
pub(crate) use plan::rows;
pub use plan::{PlanRequest, plan};
pub use report::{ReportRequest, report};
