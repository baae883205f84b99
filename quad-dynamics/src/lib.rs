//! Quadcopter dynamics: how fast a vehicle can circle, what its attitude, rates and rotor thrusts must be, how it moves, how
//! well it follows a plan, and how long its battery lasts.
//!
//! # The loiter formula
//!
//! A vehicle of mass `m` circles at constant height with radius `r` and speed `v`. Seen from behind (left) and from its
//! left (right), `T` is the thrust along body z:
//!
//! ```text
//!        T cos(theta) \    |                       | / T
//!                      \phi|                       |/  theta: nose down into the drag
//!    centre <-----------[+]           drag <------[+]------> track
//!            m v^2/r     |      c_d v^2 / 2        |
//!                        | m g                     | m g
//! ```
//!
//! 1. Upwards the thrust carries the weight: `T_z = m g`.
//! 2. Towards the centre it gives the centripetal force: `T_c = m v^2 / r`.
//! 3. Along the track it overcomes the drag: `T_t = c_d v^2 / 2`.
//! 4. The three directions are perpendicular to each other,
//! 5. so `T^2 = T_z^2 + T_c^2 + T_t^2 = (m g)^2 + (m v^2/r)^2 + (c_d v^2/2)^2`.
//! 6. Collect `v`: `T^2 - (m g)^2 = v^4 (m^2/r^2 + c_d^2/4)`.
//! 7. **`v_max = [(T^2 - m^2 g^2) / (m^2/r^2 + c_d^2/4)]^(1/4)`** (Gao, Mandal, Bhattacharya 2020, eq. 6).
//! 8. The bank is `tan(phi) = v^2/(r g)`, the pitch `sin(theta) = c_d v^2/(2 T)`: the thrust is
//!    `R_z(yaw) R_x(-+phi) R_y(theta) T e_z`, in the order yaw, roll, pitch (eqs. 3 to 5).
//! 9. The attitude turns with the circle, at `v/r` about the vertical: the body rates are `R^T (0, 0, +-v/r)`, constant.
//! 10. Constant rates `w` still need the torque `w x J w`: a spread of rotor thrusts.
//!
//! # Entry points
//!
//! | question | answer |
//! |---|---|
//! | what is the vehicle? | [`VehicleParameters`] and presets, checked into a [`Vehicle`] |
//! | how fast can it circle here, and what limits it? | [`Loiter::new`] from a [`LoiterSpec`]; [`Limit`]; [`loiter_speed`] |
//! | which circle has this speed or period, which is the quickest? | [`Loiter::with_speed`], [`Loiter::with_period`], [`Loiter::quickest`] |
//! | and in wind? | [`WindyLoiter`] |
//! | where is it on the circle, in every model's state? | [`Loiter::state`], [`Motion`] |
//! | how does it move? | [`PointMass`], [`JerkLimited`], [`ThrustRate`], [`RigidBody`], [`RotorLag`]; [`Jacobian`] |
//! | and after a while? | [`rk4()`], [`rk4_step_unit`] |
//! | which attitude and thrust follow this trajectory? | [`FlatOutput`] |
//! | how well will it follow a plan? | [`simulate`], [`simulate_batch`], [`Tracking`]; [`TrackingController`], [`Mixer`] |
//! | what does the camera see? | [`Camera`] |
//! | how long does the battery last? | [`Vehicle::hover_endurance`], [`Vehicle::power`], [`Loiter::energy`] |
//! | what does an autopilot leave of commands? | [`ShapingLimits`] |
//!
//! Conventions (east-north-up, forward-left-up, quaternions `(w, x, y, z)` body to world, SI): [`frames`].
//!
//! # Example
//!
//! ```
//! use quad_dynamics::{Direction, Limit, Loiter, LoiterSpec, RigidBody, Vehicle, rk4};
//!
//! let vehicle = Vehicle::survey_450();
//! let loiter = Loiter::new(&vehicle, &LoiterSpec::new(3.0).with_thrust_budget(0.6))?;
//! assert!((loiter.speed - 4.39).abs() < 0.01 && loiter.limit == Some(Limit::Thrust));
//!
//! // The rotor thrusts held constant fly the circle, and it closes.
//! let motion = loiter.state(0.0, Direction::CounterClockwise);
//! let model = RigidBody::new(&vehicle);
//! let start = motion.rigid_body_state();
//! let end = rk4(|x| model.derivative(x, &motion.rotor_thrusts), &start, loiter.period(), 2000);
//! assert!((end - start).fixed_rows::<6>(0).amax() < 1e-9);
//! # Ok::<(), quad_dynamics::Error>(())
//! ```
//!
//! # Guarantees
//!
//! - Numbers of any kind are answered by a value or a typed [`Error`] that names field, value and remedy, never by a panic.
//! - A loiter's states obey the equation of motion, and its limits hold from rest up to its speed.
//! - Equal input and seed give equal flights to the bit, with or without the feature `rayon`.
//!
//! Not guaranteed: that the controller follows any plan (rotors with lag cannot follow jumps of the body rates), that
//! planning models contain all drag ([`Aerodynamics`] is for [`RotorLag`] only), or that a scan over speeds sees a violation of
//! a body-rate or rotor limit narrower than its step.
//!
//! # How it is tested
//!
//! Against a second model of rotation matrices, dual numbers, fifty reference transitions, Jacobi's elliptic functions,
//! energy and momentum, simulated circles, and RotorPy (`benches/peers/vehicle` of the repository: the same rotor commands,
//! positions equal to 1e-10 m after 5 s).
//!
//! # Features
//!
//! `serde`: parameters, options and results as data. `rayon`: [`simulate_batch`] on all cores.
//!
//! # References
//!
//! Gao, Mandal, Bhattacharya, *Planning for Aerial Robot Teams for Wide-Area Biometric and Phenotypic Data Collection* (2020).
//! Lee, Leok, McClamroch, *Geometric tracking control of a quadrotor UAV on SE(3)* (2010). Brescianini, Hehn, D'Andrea,
//! *Nonlinear quadrocopter attitude control* (2013). Faessler, Franchi, Scaramuzza, *Differential flatness of quadrotor
//! dynamics subject to rotor drag* (2018). MIL-F-8785C, *Flying qualities of piloted airplanes* (1980).

#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod camera;
mod control;
mod energy;
mod equipment;
mod error;
mod euler;
mod flatness;
pub mod frames;
pub mod loiter;
mod mixer;
pub mod models;
mod motion;
mod parameters;
mod presets;
mod rk4;
mod series;
mod shaping;
pub mod simulation;
mod vehicle;

pub use nalgebra;

pub use camera::{Camera, View};
pub use control::{Gains, Target, TrackingController};
pub use energy::AIR_DENSITY;
pub use equipment::{Aerodynamics, Battery, Propulsion};
pub use error::{Error, Field, Requirement};
pub use euler::YawRollPitch;
pub use flatness::{FlatOutput, FlatState};
pub use frames::{Direction, GRAVITY, Heading};
pub use loiter::{CameraLimit, Limit, Loiter, LoiterSpec, LoiterYaw, WindyLoiter, loiter_speed};
pub use mixer::Mixer;
pub use models::{Jacobian, JerkLimited, PointMass, RigidBody, RotorLag, ThrustRate};
pub use motion::Motion;
pub use parameters::{Rotor, Spin, VehicleParameters};
pub use rk4::{rk4, rk4_step, rk4_step_unit};
pub use shaping::ShapingLimits;
pub use simulation::{Flight, SimulationOptions, Tracking, simulate, simulate_batch};
pub use vehicle::Vehicle;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
