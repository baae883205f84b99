//! The words for what the planner counts as values, as mission files, plans and tables use them.

use crate::execution::Way;
use crate::input::Autopilot;
use crate::link::settings::SafeAction;
use planner::{Direction, Model, Objective, Pipeline, Plan, SolverStatus, Transcription};

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

/// The vehicle of a flight of a plan (from 0), and which of its flights it is; both from 1.
#[must_use]
pub fn flight_numbers(plan: &Plan, index: usize) -> [usize; 2] {
    let vehicle = plan.vehicles.get(index).map_or(index, |planned| planned.vehicle);
    let earlier = plan.vehicles.iter().take(index).filter(|planned| planned.vehicle == vehicle);
    [vehicle + 1, earlier.count() + 1]
}

/// The name of a flight: its vehicle's number and, where that flies several times, which of its flights it is: "2 flight 3".
#[must_use]
pub fn flight(plan: &Plan, index: usize) -> String {
    let [vehicle, flight] = flight_numbers(plan, index);
    match plan.vehicles.iter().filter(|planned| planned.vehicle + 1 == vehicle).count() {
        0 | 1 => vehicle.to_string(),
        _ => format!("{vehicle} flight {flight}"),
    }
}

/// The same for the name of a file: `vehicle-2` or `vehicle-2-flight-3`, after another word than `vehicle` if need be.
#[must_use]
pub fn flight_file(word: &str, plan: &Plan, index: usize) -> String {
    format!("{word}-{}", flight(plan, index).replace(' ', "-"))
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
