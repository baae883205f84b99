//! Certified lower bounds on the time of a transition.
//!
//! | bound | what it knows | file |
//! |---|---|---|
//! | [`Envelope`] | thrust and drag along a line; increasing and concave in the distance, so it also bounds whole routes | `envelope.rs` |
//! | [`Drift`] | the same in a steady wind, for whole routes: by direction | `drift.rs` |
//! | [`Agility`] | thrust, gravity, drag, the velocities and the thrust axes at both ends, and how fast an axis turns | `agility.rs` |

mod agility;
mod costate;
mod drift;
mod envelope;
mod speeds;

pub(crate) use agility::Agility;
pub(crate) use drift::{Drift, LegTimes};
pub(crate) use envelope::Envelope;
