//! From a plan of the planner to the document.

use super::{
    ApproachEntry, CandidateEntry, CertificateEntry, CircleEntry, ExecutedCircleEntry, ExecutionEntry,
    LegEntry, LoiterEntry, MissEntry, MissionEntry, OriginEntry, OutcomeEntry, PlanDocument, TargetEntry,
    TeamEntry, TransitionEntry, VERSION, VehicleEntry,
};
use crate::execution::{CircleOutcome, Execution, streamed};
use crate::export::columns::{by_column, control_columns, state_columns};
use crate::export::folder::FORMAT;
use crate::export::json;
use crate::input::MissionFile;
use crate::words;
use planner::{Candidate, Circle, Leg, Miss, Outcome, Plan, Transition, VehiclePlan};

impl PlanDocument {
    /// The document of a plan; `warnings` are listed as they are.
    #[must_use]
    pub fn new(file: &MissionFile, plan: &Plan, warnings: &[String]) -> Self {
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            mission: mission_entry(file),
            targets: target_entries(file, plan),
            circles: plan
                .circles
                .iter()
                .enumerate()
                .map(|(index, circle)| circle_entry(index, circle))
                .collect(),
            team: team_entry(plan),
            certificate: certificate_entry(plan),
            closest_approach: plan.closest_approach.map(|approach| ApproachEntry {
                vehicles: approach.vehicles.map(|flight| words::flight_numbers(plan, flight)[0]),
                time_s: approach.time,
                distance_m: approach.distance,
            }),
            warnings: warnings.to_vec(),
            vehicles: (0..plan.vehicles.len()).map(|index| vehicle_entry(file, plan, index)).collect(),
        }
    }

    /// The text of the file.
    ///
    /// # Errors
    ///
    /// Those of serialisation; a document has none.
    pub fn to_text(&self) -> serde_json::Result<String> {
        json::to_text(self)
    }
}

fn mission_entry(file: &MissionFile) -> MissionEntry {
    let mission = &file.mission;
    MissionEntry {
        name: mission.name.clone(),
        autopilot: words::word(&words::AUTOPILOTS, &file.autopilot).to_owned(),
        objective: words::word(&words::OBJECTIVES, &mission.objective).to_owned(),
        pipeline: words::word(&words::PIPELINES, &mission.pipeline).to_owned(),
        seed: mission.seed,
        model: words::word(&words::MODELS, &mission.transition.model).to_owned(),
        transcription: words::word(&words::TRANSCRIPTIONS, &mission.transition.transcription).to_owned(),
        origin: file.origin.map(|origin| OriginEntry {
            latitude_deg: origin.latitude,
            longitude_deg: origin.longitude,
            altitude_m: origin.altitude,
        }),
        depot_east_m: mission.depot[0],
        depot_north_m: mission.depot[1],
        separation_m: mission.fleet.separation,
        endurance_s: finite(mission.fleet.endurance),
        swap_time_s: mission.swap_time,
    }
}

fn target_entries(file: &MissionFile, plan: &Plan) -> Vec<TargetEntry> {
    let shares = plan.shares_in_view(&file.mission).unwrap_or_default();
    let common = file.mission.transition.safe_distance;
    let entry = |(index, target): (usize, &planner::Target)| TargetEntry {
        target: index + 1,
        name: target.name.clone(),
        east_m: target.position[0],
        north_m: target.position[1],
        safe_distance_m: target.safe_distance.unwrap_or(common),
        share_in_view: shares.get(index).copied(),
    };
    file.mission.targets.iter().enumerate().map(entry).collect()
}

fn circle_entry(index: usize, circle: &Circle) -> CircleEntry {
    CircleEntry {
        circle: index + 1,
        targets: circle.members.iter().map(|member| member + 1).collect(),
        centre_east_m: circle.centre[0],
        centre_north_m: circle.centre[1],
        radius_m: circle.radius,
        height_m: circle.height,
        sweep_deg: circle.sweep.to_degrees(),
        speed_m_s: circle.speed,
        speed_limited_by: circle.limit.map(|limit| limit.to_string()),
        duration_s: circle.duration,
    }
}

fn team_entry(plan: &Plan) -> TeamEntry {
    let sum = |of: fn(&VehiclePlan) -> f64| plan.vehicles.iter().map(of).sum();
    TeamEntry {
        makespan_s: plan.certificate.makespan,
        total_time_s: plan.certificate.total,
        transition_time_s: sum(VehiclePlan::transition_time),
        loiter_time_s: sum(VehiclePlan::loiter_time),
        length_m: sum(VehiclePlan::length),
    }
}

fn certificate_entry(plan: &Plan) -> CertificateEntry {
    let certificate = &plan.certificate;
    CertificateEntry {
        makespan_lower_bound_s: certificate.makespan_lower_bound,
        makespan_gap: finite(certificate.makespan_gap()),
        total_time_lower_bound_s: certificate.total_lower_bound,
        total_time_gap: finite(certificate.total_gap()),
    }
}

fn vehicle_entry(file: &MissionFile, plan: &Plan, index: usize) -> VehicleEntry {
    let vehicle = &plan.vehicles[index];
    let [number, flight] = words::flight_numbers(plan, index);
    VehicleEntry {
        vehicle: number,
        flight,
        pad_east_m: vehicle.pad[0],
        pad_north_m: vehicle.pad[1],
        pad_up_m: vehicle.pad[2],
        route: vehicle.route.iter().map(|circle| circle + 1).collect(),
        start_time_s: vehicle.start_time(),
        duration_s: vehicle.duration(),
        transition_time_s: vehicle.transition_time(),
        loiter_time_s: vehicle.loiter_time(),
        length_m: vehicle.length(),
        execution: execution_entry(&streamed(file, plan, vehicle)),
        legs: vehicle.legs.iter().enumerate().map(|(index, leg)| leg_entry(index, leg)).collect(),
    }
}

fn execution_entry(execution: &Execution) -> ExecutionEntry {
    let circle = |circle: &CircleOutcome| ExecutedCircleEntry {
        targets: circle.name.clone(),
        radius_m: circle.radius,
        duration_s: circle.duration,
        seen_deg: circle.seen.to_degrees(),
    };
    ExecutionEntry {
        way: words::word(&words::WAYS, &execution.way).to_owned(),
        duration_s: execution.duration,
        circles: execution.circles.iter().map(circle).collect(),
    }
}

fn leg_entry(index: usize, leg: &Leg) -> LegEntry {
    LegEntry {
        leg: index + 1,
        start_time_s: leg.start_time,
        arrival_time_s: leg.arrival_time(),
        end_time_s: leg.end_time(),
        length_m: leg.transition.length + leg.loiter.map_or(0.0, |loiter| loiter.length),
        loiter: leg.loiter.map(|loiter| LoiterEntry {
            circle: loiter.circle + 1,
            entry_angle_deg: loiter.entry.angle.to_degrees(),
            direction: words::sign(loiter.entry.direction),
            duration_s: loiter.duration,
            length_m: loiter.length,
        }),
        transition: transition_entry(&leg.transition),
        candidates: leg.candidates.iter().map(candidate_entry).collect(),
    }
}

fn transition_entry(transition: &Transition) -> TransitionEntry {
    TransitionEntry {
        model: words::word(&words::MODELS, &transition.model).to_owned(),
        duration_s: transition.duration,
        length_m: transition.length,
        max_speed_m_s: transition.max_speed,
        max_tilt_deg: transition.max_tilt.to_degrees(),
        solver_status: words::status(transition.status).to_owned(),
        solver_iterations: transition.iterations,
        primal_residual: transition.primal_residual,
        dual_residual: transition.dual_residual,
        integrated_miss: miss_entry(&transition.miss),
        knots_s: transition.knots.clone(),
        states: by_column(&state_columns(transition.model), &transition.states),
        controls_per_segment: transition.control_nodes,
        controls: by_column(&control_columns(transition.model), &transition.controls),
    }
}

fn miss_entry(miss: &Miss) -> MissEntry {
    MissEntry {
        position_m: miss.position,
        velocity_m_s: miss.velocity,
        attitude_deg: miss.attitude.to_degrees(),
    }
}

fn candidate_entry(candidate: &Candidate) -> CandidateEntry {
    CandidateEntry {
        entry_angle_deg: candidate.entry.map(|entry| entry.angle.to_degrees()),
        direction: candidate.entry.map(|entry| words::sign(entry.direction)),
        outcome: match candidate.outcome {
            Outcome::Solved { duration } => OutcomeEntry::Solved { duration_s: duration },
            Outcome::Slower { duration } => OutcomeEntry::Slower { duration_s: duration },
            Outcome::ProvenWorse { lower_bound } => OutcomeEntry::ProvenWorse { lower_bound_s: lower_bound },
            Outcome::Failed { primal_residual, dual_residual } => OutcomeEntry::Failed {
                primal_residual: finite(primal_residual),
                dual_residual: finite(dual_residual),
            },
        },
    }
}

/// JSON has no infinity: what is not finite is left out.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
