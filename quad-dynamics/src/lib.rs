//! Quadcopter dynamics: parameters, loiter speed and loiter states, differentiable models and integration.
//!
//! # Entry points
//!
//! | question | answer |
//! |---|---|
//! | what is the vehicle? | [`VehicleParameters`], checked into a [`Vehicle`] |
//! | how fast can it circle here, and what limits it? | [`Loiter::new`] from a [`LoiterSpec`], [`Limit`] |
//! | where is it on the circle, in every model's state? | [`Loiter::state`], [`Motion`] |
//! | how does it move? | [`PointMass`], [`JerkLimited`], [`ThrustRate`], [`RigidBody`] |
//! | and after a while? | [`rk4`] |

#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod camera;
mod control;
mod energy;
mod equipment;
mod error;
pub mod frames;
pub mod loiter;
mod mixer;
pub mod models;
mod motion;
mod presets;
mod rk4;
mod shaping;
pub mod simulation;
mod vehicle;

pub use nalgebra;

pub use camera::{Camera, View};
pub use control::{Gains, Target, TrackingController};
pub use energy::AIR_DENSITY;
pub use equipment::{Aerodynamics, Battery, Propulsion};
pub use error::{Error, Field, Requirement};
pub use frames::{Direction, GRAVITY, Heading};
pub use loiter::{CameraLimit, Limit, Loiter, LoiterSpec, LoiterYaw, WindyLoiter, loiter_speed};
pub use mixer::Mixer;
pub use models::{Jacobian, JerkLimited, PointMass, RigidBody, RotorLag, ThrustRate};
pub use motion::Motion;
pub use rk4::{rk4, rk4_step, rk4_step_unit};
pub use shaping::ShapingLimits;
pub use simulation::{Flight, SimulationOptions, Tracking, simulate, simulate_batch};
pub use vehicle::{Rotor, Spin, Vehicle, VehicleParameters};
