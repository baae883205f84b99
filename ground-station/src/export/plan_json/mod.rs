//! `plan.json`: the whole plan. Units are in the names of the fields; vehicles, targets, circles and legs count from 1.
//!
//! Nothing timed goes into it: the same mission gives the same bytes.

mod from_plan;

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The version of the format; it grows when a reader of the old one could misread the new one.
pub const VERSION: u32 = 1;

/// The whole document.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanDocument {
    /// [`FORMAT`](super::folder::FORMAT).
    pub format: String,
    /// [`VERSION`].
    pub version: u32,
    /// What was asked.
    pub mission: MissionEntry,
    /// The targets, in the order of the mission file.
    pub targets: Vec<TargetEntry>,
    /// The circles to fly, after close targets have been merged.
    pub circles: Vec<CircleEntry>,
    /// Totals over the team.
    pub team: TeamEntry,
    /// Lower bounds that no plan for this mission can beat.
    pub certificate: CertificateEntry,
    /// Where two vehicles in the air come closest.
    pub closest_approach: Option<ApproachEntry>,
    /// What the operator should know, in plain words.
    pub warnings: Vec<String>,
    /// What each vehicle does.
    pub vehicles: Vec<VehicleEntry>,
}

/// What was asked, as far as a reader of the plan needs it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)] // names and units say it all
pub struct MissionEntry {
    pub name: String,
    pub autopilot: String,
    pub objective: String,
    pub pipeline: String,
    pub seed: u64,
    pub model: String,
    pub transcription: String,
    pub origin: Option<OriginEntry>,
    pub depot_east_m: f64,
    pub depot_north_m: f64,
    pub separation_m: f64,
    pub endurance_s: Option<f64>,
    /// Time to swap a battery, where vehicles may fly several times.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub swap_time_s: Option<f64>,
}

/// Where east and north are zero.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct OriginEntry {
    pub latitude_deg: f64,
    pub longitude_deg: f64,
    pub altitude_m: f64,
}

/// A target.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct TargetEntry {
    pub target: usize,
    pub name: String,
    pub east_m: f64,
    pub north_m: f64,
    pub safe_distance_m: f64,
    /// Share of its circle during which it is in the picture; absent without a camera.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub share_in_view: Option<f64>,
}

/// A circle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct CircleEntry {
    pub circle: usize,
    pub targets: Vec<usize>,
    pub centre_east_m: f64,
    pub centre_north_m: f64,
    pub radius_m: f64,
    pub height_m: f64,
    pub sweep_deg: f64,
    pub speed_m_s: f64,
    /// What keeps the speed from being greater, if anything does.
    pub speed_limited_by: Option<String>,
    pub duration_s: f64,
}

/// Totals over the team.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct TeamEntry {
    pub makespan_s: f64,
    pub total_time_s: f64,
    pub transition_time_s: f64,
    pub loiter_time_s: f64,
    pub length_m: f64,
}

/// Lower bounds and how far the plan can be above the best; a gap of 0.2 is 20 %.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct CertificateEntry {
    pub makespan_lower_bound_s: f64,
    pub makespan_gap: Option<f64>,
    pub total_time_lower_bound_s: f64,
    pub total_time_gap: Option<f64>,
}

/// Where two vehicles come closest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct ApproachEntry {
    pub vehicles: [usize; 2],
    pub time_s: f64,
    pub distance_m: f64,
}

/// What one vehicle does; a vehicle without legs stays on its pad.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct VehicleEntry {
    pub vehicle: usize,
    /// Which of its flights: further ones follow after those of all vehicles, each with a fresh battery.
    pub flight: usize,
    pub pad_east_m: f64,
    pub pad_north_m: f64,
    pub pad_up_m: f64,
    /// Circles in the order in which they are flown.
    pub route: Vec<usize>,
    /// When it takes off; later than 0 where it waits for others to pass.
    pub start_time_s: f64,
    pub duration_s: f64,
    pub transition_time_s: f64,
    pub loiter_time_s: f64,
    pub length_m: f64,
    /// How it is flown, and what becomes of its circles then.
    pub execution: ExecutionEntry,
    pub legs: Vec<LegEntry>,
}

/// What an autopilot makes of a vehicle's flight.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct ExecutionEntry {
    pub way: String,
    /// Time in the air by that way.
    pub duration_s: f64,
    /// In the order of the route.
    pub circles: Vec<ExecutedCircleEntry>,
}

/// A circle as it will be flown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct ExecutedCircleEntry {
    /// "3", or "3+5" where targets are circled together.
    pub targets: String,
    pub radius_m: f64,
    pub duration_s: f64,
    pub seen_deg: f64,
}

/// A transition and the loiter at its end; the last leg leads back to the pad and has none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct LegEntry {
    pub leg: usize,
    pub start_time_s: f64,
    pub arrival_time_s: f64,
    pub end_time_s: f64,
    pub length_m: f64,
    pub loiter: Option<LoiterEntry>,
    pub transition: TransitionEntry,
    /// What became of every candidate entry.
    pub candidates: Vec<CandidateEntry>,
}

/// A circle as it is flown; direction +1 is counter-clockwise seen from above.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct LoiterEntry {
    pub circle: usize,
    pub entry_angle_deg: f64,
    pub direction: i8,
    pub duration_s: f64,
    pub length_m: f64,
}

/// A flight in minimum time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct TransitionEntry {
    pub model: String,
    pub duration_s: f64,
    pub length_m: f64,
    pub max_speed_m_s: f64,
    pub max_tilt_deg: f64,
    pub solver_status: String,
    pub solver_iterations: usize,
    pub primal_residual: f64,
    pub dual_residual: f64,
    pub integrated_miss: MissEntry,
    /// Times of the knots from the start of the transition.
    pub knots_s: Vec<f64>,
    /// One column per state, one value per knot.
    pub states: BTreeMap<String, Vec<f64>>,
    /// Equally spaced nodes of the control in a segment: 1 is a constant control, 2 a linear one, 3 a quadratic one.
    pub controls_per_segment: usize,
    /// One column per control, so many values for each segment in turn.
    pub controls: BTreeMap<String, Vec<f64>>,
}

/// How far an independent integration of the controls ends from the wanted state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct MissEntry {
    pub position_m: f64,
    pub velocity_m_s: f64,
    pub attitude_deg: f64,
}

/// A candidate entry and what became of it; a flight to the pad has one candidate without entry.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct CandidateEntry {
    pub entry_angle_deg: Option<f64>,
    pub direction: Option<i8>,
    #[serde(flatten)]
    pub outcome: OutcomeEntry,
}

/// What became of a candidate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "outcome", rename_all = "kebab-case")]
#[allow(missing_docs)]
pub enum OutcomeEntry {
    /// Solved, with its time.
    Solved { duration_s: f64 },
    /// Given up half solved, because it takes longer than another.
    Slower {
        /// Time of flight when it was given up, s.
        duration_s: f64,
    },
    /// A certified lower bound exceeds the best time.
    ProvenWorse { lower_bound_s: f64 },
    /// Not solved; says nothing about its time.
    Failed { primal_residual: Option<f64>, dual_residual: Option<f64> },
}
