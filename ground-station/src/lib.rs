//! The ground station as a library: from a list of targets to files that autopilots read.
//!
//! The program `ground-station` is a command line around this crate; tests, and programs like it, use it directly. It adds
//! nothing to the mathematics: a mission file becomes a [`planner::Mission`], the planner answers with a [`planner::Plan`],
//! and the plan becomes files and pictures.
//!
//! # Entry points
//!
//! | step | entry point |
//! |---|---|
//! | a mission file (TOML), with the target files that it names | [`input::read`], [`input::built_in`] |
//! | all that is wrong with it: file, line, key, value, remedy | [`problem::Problem`], [`failure::Failure`] |
//! | WGS-84 to local east-north and back | [`geodesy::Origin`] |
//! | the plan, its check and its files | [`command::plan`] |
//! | `plan.json` | [`export::plan_json::PlanDocument`] |
//! | trajectories as CSV | [`export::trajectory_csv`] |
//! | QGroundControl missions for ArduPilot and PX4 | [`export::qgc`] |
//! | KML, GeoJSON, `QGC WPL 110`, tables | [`export::fleet`] |
//! | what each way of execution really does | [`execution`] |
//! | one HTML page that flies the vehicles | [`page`] |
//! | the live MAVLink link | [`link`] |
//! | plans that follow events in flight | [`command::LivePlan`], [`events`] |
//! | the paper's figures and simulations | [`study`] |
//! | the output folder, written whole or not at all | [`export::folder`] |
//! | map and profiles as SVG | [`plot`] |
//! | the table on the terminal | [`report`] |
//!
//! # Example
//!
//! ```
//! use ground_station::input;
//! use std::path::Path;
//!
//! let mission = "[depot]\nposition = [0.0, 0.0]\n[fleet]\nvehicles = 0\n[loiter]\nraduis = 4.0\n[[target]]\nposition = [20.0, 5.0]\n";
//! let problems = input::parse("my.toml", mission, Path::new("")).unwrap_err();
//! let messages: Vec<String> = problems.iter().map(ToString::to_string).collect();
//! assert_eq!(messages[0], "my.toml:4: fleet.vehicles = 0 is out of range: give a whole number from 1 to 1000");
//! assert_eq!(messages[1], "my.toml:6: loiter.raduis = 4.0: unknown key: did you mean \"radius\"?");
//! ```
//!
//! # Guarantees
//!
//! - Bad input is refused with all its problems, before anything is computed, and nothing is written.
//! - The output folder is replaced as a whole: after a failure it is as it was before. A folder that holds anything but a
//!   plan of ours is never replaced unasked.
//! - The same mission gives the same bytes.
//! - Nothing moves without leave: a session arms and takes off only if it is told to, and lets go of a vehicle whose mode
//!   somebody else changes.
//!
//! What is *not* guaranteed: that an autopilot flies a `.plan` file as planned. ArduPilot and PX4 cannot; what they will do
//! instead is among the warnings. The trajectory tables are what a vehicle that is streamed its setpoints flies.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

pub mod cli;
pub mod command;
pub mod events;
pub mod execution;
pub mod export;
pub mod failure;
pub mod geodesy;
pub mod input;
pub mod link;
pub mod nodes;
pub mod page;
pub mod plot;
pub mod problem;
pub mod report;
pub mod study;
pub mod words;
