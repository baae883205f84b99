//! Plans for teams of quadcopters that fly one full circle around each of many targets.
//!
//! A [`Mission`] says what is asked: targets, fleet, limits. [`plan()`] answers with a [`Plan`]: who circles which target in
//! which order, how fast, where each circle is entered and in which direction, and how to fly from circle to circle in the
//! least time that the vehicle's dynamics allow. The method is that of Gao, Mandal, Bhattacharya (2020), step by step:
//!
//! | step | what happens | file |
//! |---|---|---|
//! | check | all that is wrong with the mission, at once; targets out of reach | `check.rs`, `reach.rs` |
//! | circles | close targets merged; the fastest loiter within the limits | `circles.rs` |
//! | routes | k-means and Christofides, or optimised routes by calibrated leg times | `allocation.rs`, `leg_model.rs` |
//! | sorties | too long for the batteries? shorter flights, a battery swapped in between | `sorties.rs` |
//! | entries | sampled angles in both directions, bounded from below | `entry.rs`, `bound/` |
//! | legs | the paper's Algorithm 1: the fastest transition over all entries | `legs.rs`, `race.rs`, `transition/` |
//! | whole routes | entries that are best for a route, not for a leg | `whole_route.rs`, `time_model.rs` |
//! | events | what is being flown stays, the rest follows the mission as it changes | `replan/` |
//! | certificate | makespan and total beside lower bounds | `certificate.rs` |
//! | camera | the share of its loiter in which each target is in the picture | `in_view.rs` |
//! | verification | all controls integrated again, independently, each leg in the wind it was planned for | `verify.rs`, `airs.rs` |
//!
//! # Example
//! ```
//! use planner::quad_dynamics::{Vehicle, VehicleParameters};
//! use planner::{Entries, Mission, Options, Target, Tolerances, plan};
//!
//! let targets = vec![Target::at([15.0, 5.0]), Target::at([4.0, 18.0])];
//! let vehicle = Vehicle::new(VehicleParameters::survey_450())?;
//! let mut mission = Mission::new(vehicle, 2, targets);
//! mission.transition.entries = Entries::Sampled(4);
//!
//! let plan = plan(&mission, &Options::default())?;
//! assert!(plan.certificate.makespan >= plan.certificate.makespan_lower_bound);
//! assert!(plan.verify(&mission, &Tolerances::default()).passed());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Guarantees
//! - Every leg in a plan was solved; a leg that could not be is an [`Error::Leg`] with all residuals.
//! - Candidate entries are compared on coarse meshes first, and some are left out on an estimate ([`Outcome::Slower`]), others on a
//!   proven bound ([`Outcome::ProvenWorse`]). Each is recorded as what it is, and [`Options::exhaustive`] solves all to the end.
//! - The certificate's lower bounds hold over every allocation, order, entry, direction and admissible motion; a test holds them against
//!   all plans of small missions (`exhaustive.rs`). After events in flight they hold over every continuation from that moment on.
//! - The same mission and seed give the same plan to the bit, with or without the feature `rayon`, on any number of threads.
//!
//! What is *not* guaranteed: that a transition is the global optimum of its problem (the solver finds local ones from several
//! guesses), or that clustering first gives routes within a factor of the best (it has none; see [`Certificate`]).
//!
//! # Features
//! `rayon`: routes and candidate entries are solved side by side. `serde`: [`Mission`] as data.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod airs;
mod allocation;
mod bound;
mod certificate;
mod check;
mod circles;
mod closed_loop;
mod entry;
mod error;
#[cfg(test)]
mod exhaustive;
mod in_view;
mod leg_model;
mod legs;
mod mission;
mod options;
mod plan;
mod planning;
mod race;
mod reach;
mod replan;
mod round;
mod sample;
mod separation;
mod sorties;
mod threads;
mod time_model;
mod transition;
#[cfg(feature = "serde")]
mod unlimited;
mod verify;
mod warnings;
mod whole_route;

pub use christofides;
pub use cluster;
pub use mtsp;
pub use quad_dynamics;
pub use traj_opt;

pub use closed_loop::Flown;
pub use error::{Error, Problem};
pub use mission::{
    CameraSettings, Entries, Environment, Fleet, LoiterSettings, Mission, Model, Objective, Pipeline, Target,
    Transcription, TransitionSettings,
};
pub use options::{Clustering, Options, Progress};
pub use plan::{
    Approach, Candidate, Certificate, Circle, Entry, Leg, Loiter, Miss, Outcome, Phase, Plan, Sample,
    SolverStatus, Transition, VehiclePlan, Warning,
};
pub use planning::plan;
pub use quad_dynamics::{Direction, LoiterYaw, ShapingLimits};
pub use replan::{Event, Replanner, Update};
pub use sample::Sampler;
pub use verify::{Failure, LegCheck, Tolerances, Verification};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
