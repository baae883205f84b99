//! Writing what was planned: the plan itself, trajectories and autopilot missions.

mod columns;
pub mod fleet;
pub mod folder;
mod json;
pub mod plan_json;
pub mod qgc;
mod trajectory_csv;

pub use trajectory_csv::{members, trajectory_csv};
