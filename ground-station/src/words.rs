//! The words for what the planner counts as values, as mission files, plans and tables use them.

use crate::execution::Way;
use crate::input::Autopilot;
use crate::link::settings::SafeAction;
use planner::{Direction, Model, Objective, Pipeline, SolverStatus, Transcription};

/// Words for [`Autopilot`].
pub const AUTOPILOTS: [(&str, Autopilot); 2] = [("ardupilot", Autopilot::ArduPilot), ("px4", Autopilot::Px4)];
/// Words for [`Way`].
pub const WAYS: [(&str, Way); 4] = [
    ("stream", Way::Stream),
    ("loiter-items", Way::LoiterItems),
    ("polygon", Way::Polygon),
    ("live-orbit", Way::LiveOrbit),
];
/// Words for [`SafeAction`].
pub const SAFE_ACTIONS: [(&str, SafeAction); 3] =
    [("hold", SafeAction::Hold), ("return", SafeAction::Return), ("land", SafeAction::Land)];
/// Words for [`Objective`].
pub const OBJECTIVES: [(&str, Objective); 2] =
    [("makespan", Objective::Makespan), ("total", Objective::Total)];
/// Words for [`Pipeline`].
pub const PIPELINES: [(&str, Pipeline); 2] = [("optimised", Pipeline::Optimised), ("paper", Pipeline::Paper)];
/// Words for [`Model`].
pub const MODELS: [(&str, Model); 4] = [
    ("thrust-rate", Model::ThrustRate),
    ("rigid-body", Model::RigidBody),
    ("point-mass", Model::PointMass),
    ("jerk-limited", Model::JerkLimited),
];
/// Words for [`Transcription`].
pub const TRANSCRIPTIONS: [(&str, Transcription); 3] = [
    ("rk4", Transcription::RungeKutta),
    ("hermite-simpson", Transcription::HermiteSimpson),
    ("trapezoidal", Transcription::Trapezoidal),
];

/// The word for a value in one of the tables above.
#[must_use]
pub fn word<T: PartialEq>(words: &[(&'static str, T)], value: &T) -> &'static str {
    words.iter().find(|(_, listed)| listed == value).map_or("unknown", |(word, _)| word)
}

/// How a solve ended.
#[must_use]
pub fn status(status: SolverStatus) -> &'static str {
    match status {
        SolverStatus::Solved => "solved",
        SolverStatus::Acceptable => "acceptable",
        SolverStatus::Failed => "failed",
    }
}

/// +1 for counter-clockwise seen from above, -1 for clockwise.
#[must_use]
pub fn sign(direction: Direction) -> i8 {
    match direction {
        Direction::CounterClockwise => 1,
        Direction::Clockwise => -1,
    }
}
