//! The live link: MAVLink to a fleet of ArduCopters or PX4s.
//!
//! What thinks knows neither sockets nor clocks and is told the time: [`mission`] and [`command`] are single exchanges,
//! [`pilot`] is one vehicle from silence to the ground, [`session`] the fleet. [`transport`] moves bytes, [`frames`] makes
//! messages of them.

pub mod address;
pub mod command;
pub mod frames;
pub mod item;
pub mod mission;
pub mod modes;
pub mod pilot;
pub mod run;
pub mod session;
pub mod settings;
pub mod tlog;
pub mod track;
pub mod transport;
pub mod vehicle;
