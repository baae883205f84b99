//! How a session is flown, and what happens when something goes wrong.

use super::modes::Mode;

/// Settings of a session.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// How far to go.
    pub reach: Reach,
    /// Setpoints per second; PX4 wants at least 2.
    pub rate: f64,
    /// Least battery before the start (percent).
    pub least_battery: u8,
    /// Battery at which a vehicle returns (percent).
    pub return_battery: u8,
    /// Silence after which the link counts as lost (s).
    pub link_timeout: f64,
    /// Distance from the plan at which a vehicle is stopped (m).
    pub deviation: f64,
    /// What a vehicle does whose link is lost.
    pub on_link_loss: SafeAction,
    /// What a vehicle does that is too far from its plan.
    pub on_deviation: SafeAction,
    /// How long a vehicle holds before it returns by itself (s).
    pub hold_patience: f64,
    /// How long to wait for vehicles and for their checks (s).
    pub check_patience: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            reach: Reach::Upload,
            rate: 20.0,
            least_battery: 50,
            return_battery: 20,
            link_timeout: 3.0,
            deviation: 2.0,
            on_link_loss: SafeAction::Return,
            on_deviation: SafeAction::Hold,
            hold_patience: 60.0,
            check_patience: 30.0,
        }
    }
}

/// How far a session goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reach {
    /// Looks, and changes nothing on any vehicle.
    Check,
    /// Uploads missions and reads them back.
    Upload,
    /// Arms, takes off, flies.
    Fly,
}

/// What to do when something is wrong in the air.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SafeAction {
    /// Stay.
    Hold,
    /// Fly home at the height that the vehicle is set to, and land.
    Return,
    /// Land where it is.
    Land,
}

impl SafeAction {
    /// The mode that does it.
    #[must_use]
    pub fn mode(self) -> Mode {
        match self {
            Self::Hold => Mode::Hold,
            Self::Return => Mode::Return,
            Self::Land => Mode::Land,
        }
    }
}
