//! The commands of the program, without its command line.

mod check;
mod export;
mod fly;
mod follow;
mod init;
mod live;
mod outputs;
mod plan;
mod report;
mod simulate;
mod solve;
mod study;

pub use check::check;
pub use export::{ExportRequest, export};
pub use fly::{FlyRequest, fly, tasks};
pub use init::{InitRequest, init};
pub use live::LivePlan;
pub(crate) use outputs::sampled;
pub use outputs::{Outputs, outputs};
pub(crate) use plan::rows;
pub use plan::{PlanRequest, plan};
pub use report::{ReportRequest, report};
pub use simulate::{SimulateRequest, simulate};
pub use solve::{SolveRequest, routes, tour};
pub use study::{Study, merge, study, transitions};
