//! What can be wrong with a mission, and why a plan could not be made.

use crate::plan::Candidate;

/// Why there is no plan.
#[derive(Debug, Clone, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The mission cannot be flown as it stands; nothing was computed.
    #[error("the mission has {} problem(s), the first: {}", problems.len(), problems.first().map_or_else(String::new, ToString::to_string))]
    Mission {
        /// All that is wrong, in the order of the mission's fields; never empty.
        problems: Vec<Problem>,
    },
    /// The routes could not be found.
    #[error("no routes: {source}")]
    Routing {
        /// What the solver says.
        #[from]
        source: mtsp::Error,
    },
    /// The targets could not be clustered.
    #[error("no clusters: {source}")]
    Clustering {
        /// What the clustering says.
        #[from]
        source: cluster::Error,
    },
    /// No candidate of a leg could be solved.
    #[error(
        "leg {} of vehicle {} to {} could not be solved: none of {} candidate entries converged (smallest residual {:.1e})",
        leg + 1, vehicle + 1, goal_name(*circle), candidates.len(), smallest_residual(candidates)
    )]
    Leg {
        /// The vehicle, from 0.
        vehicle: usize,
        /// The leg of its route, from 0.
        leg: usize,
        /// The circle that it leads to; `None` for the pad.
        circle: Option<usize>,
        /// What became of every candidate, with residuals.
        candidates: Vec<Candidate>,
    },
    /// The caller asked to stop before there was a complete plan.
    #[error("stopped by the caller before the plan was complete")]
    Stopped,
}

fn goal_name(circle: Option<usize>) -> String {
    circle.map_or_else(|| "the pad".to_owned(), |circle| format!("circle {}", circle + 1))
}

fn smallest_residual(candidates: &[Candidate]) -> f64 {
    let residual = |candidate: &Candidate| match candidate.outcome {
        crate::plan::Outcome::Failed { primal_residual, dual_residual } => primal_residual.max(dual_residual),
        _ => f64::INFINITY,
    };
    candidates.iter().map(residual).fold(f64::INFINITY, f64::min)
}

/// One thing that is wrong with a mission. Its message names field, value and remedy.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// A number is not finite or outside its range.
    #[error("{field} = {value} is out of range: give a number {range}")]
    OutOfRange {
        /// The field, as in the mission file: `loiter.radius`, `targets.positions[3]`.
        field: String,
        /// Its value.
        value: f64,
        /// The range in words: "above 0", "from 4 to 2000".
        range: &'static str,
    },
    /// A plan cannot follow events.
    #[error("the plan cannot follow events: it is not the mission's; plan the mission itself")]
    NotReplannable,
    /// Groups of targets do not share out the targets.
    #[error("groups: target {} is in {groups} of them: put it in exactly one", target + 1)]
    NotGrouped {
        /// The target, from 0.
        target: usize,
        /// How many groups it is in.
        groups: usize,
    },
    /// A group of targets has no target, or one that there is not.
    #[error("groups: group {} is empty or names a target that there is not: give numbers from 0 to one less than the targets", group + 1)]
    BadGroup {
        /// The group, from 0.
        group: usize,
    },
    /// An event names something that there is not.
    #[error("there is no {what} {index}: number them from 0, as the mission does")]
    Unknown {
        /// Target or vehicle.
        what: &'static str,
        /// Its number.
        index: usize,
    },
    /// There is nobody to fly.
    #[error("fleet.vehicles = 0: give at least one vehicle")]
    NoVehicles,
    /// There is nothing to circle.
    #[error("targets: there are none: give at least one position")]
    NoTargets,
    /// No loiter can be flown around a target, or around any.
    #[error("loiter: {source} (for target {})", target + 1)]
    Loiter {
        /// The first target for which it fails, from 0.
        target: usize,
        /// Why, with the remedy.
        source: quad_dynamics::Error,
    },
    /// The circle is inside the distance that must be kept.
    #[error(
        "loiter.radius = {radius} m is inside the safe distance of {safe_distance} m of target {}: \
         enlarge the radius or reduce transition.safe_distance",
        target + 1
    )]
    CircleInsideSafeDistance {
        /// The target, from 0.
        target: usize,
        /// Radius of its circle (m).
        radius: f64,
        /// Its safe distance (m).
        safe_distance: f64,
    },
    /// A pad by the depot is too close to a target.
    #[error(
        "depot.position: a pad of the depot is {distance:.2} m from target {} whose safe distance is {safe_distance} m: \
         move the depot away, or reduce fleet.separation (pads stand around the depot) or transition.safe_distance",
        target + 1
    )]
    DepotTooClose {
        /// The target, from 0.
        target: usize,
        /// From the closest pad (m).
        distance: f64,
        /// What must be kept (m).
        safe_distance: f64,
    },
    /// The circle around one target enters the safe distance of another.
    #[error(
        "targets {} and {} are {distance:.2} m apart, too close: the circle of radius {radius} m around the first comes \
         within the safe distance of {safe_distance} m of the second; set targets.merge_within to {distance:.2} or more, \
         or make loiter.radius or transition.safe_distance smaller",
        first + 1, second + 1
    )]
    TargetsTooClose {
        /// The target that is circled, from 0.
        first: usize,
        /// The target whose safe distance is broken, from 0.
        second: usize,
        /// Between the two (m).
        distance: f64,
        /// Radius of the first one's circle (m).
        radius: f64,
        /// Safe distance of the second (m).
        safe_distance: f64,
    },
    /// No flight to a target and back is short enough for the vehicles.
    #[error(
        "fleet.endurance = {endurance} s: no flight to target {} and back takes less than {least:.1} s: \
         raise the endurance, move the depot closer or leave the target out",
        target + 1
    )]
    BeyondEndurance {
        /// The target, from 0.
        target: usize,
        /// A proven lower bound on the time of a flight that circles only this target (s).
        least: f64,
        /// The endurance (s).
        endurance: f64,
    },
    /// No flight to a target and back is possible with one battery.
    #[error(
        "fleet.vehicle.battery: no flight to target {} and back takes less than {least:.0} J, and {usable:.0} J may be used: \
         use a larger battery, move the depot closer or leave the target out",
        target + 1
    )]
    BeyondBattery {
        /// The target, from 0.
        target: usize,
        /// A proven lower bound on the energy of a flight that circles only this target (J).
        least: f64,
        /// What may be used of a full battery (J).
        usable: f64,
    },
    /// A circle is outside the height limits.
    #[error(
        "the circle of target {} at height {height} m is outside transition.heights = [{}, {}]: widen the limits or change the height",
        target + 1, heights[0], heights[1]
    )]
    HeightOutsideLimits {
        /// The target, from 0.
        target: usize,
        /// Height of its circle (m).
        height: f64,
        /// The limits (m).
        heights: [f64; 2],
    },
    /// The transition's thrust budget is less than a loiter or a hover needs.
    #[error(
        "transition.thrust_budget = {budget} gives {available:.2} N, less than the {needed:.2} N that {what} needs: \
         raise it to at least {least:.3}, or lower loiter.thrust_budget"
    )]
    TransitionBudget {
        /// The budget.
        budget: f64,
        /// Thrust that it allows (N).
        available: f64,
        /// Thrust that is needed (N).
        needed: f64,
        /// "hover" or "the loiter".
        what: &'static str,
        /// The least budget that would do.
        least: f64,
    },
    /// A shaping limit of the jerk-limited model is below what the loiter needs.
    #[error("transition.shaping.{limit} = {value} is below the {needed:.3} that the loiter around target {} needs: raise it or slow the loiter with loiter.speed_limit", target + 1)]
    ShapingBelowLoiter {
        /// "speed", "acceleration" or "jerk".
        limit: &'static str,
        /// Its value.
        value: f64,
        /// What the loiter needs.
        needed: f64,
        /// The target, from 0.
        target: usize,
    },
}

impl Problem {
    /// The key of the mission file that the problem is about, such as `loiter.radius`.
    #[must_use]
    pub fn field(&self) -> &str {
        match self {
            Self::OutOfRange { field, .. } => field,
            Self::NoVehicles => "fleet.vehicles",
            Self::NoTargets | Self::Unknown { .. } => "targets",
            Self::NotReplannable | Self::NotGrouped { .. } | Self::BadGroup { .. } => "groups",
            Self::Loiter { source: quad_dynamics::Error::WindTooStrong { .. }, .. } => "environment.wind",
            Self::Loiter { .. } => "loiter",
            Self::CircleInsideSafeDistance { .. } => "loiter.radius",
            Self::DepotTooClose { .. } => "depot.position",
            Self::TargetsTooClose { .. } => "targets",
            Self::BeyondEndurance { .. } => "fleet.endurance",
            Self::BeyondBattery { .. } => "fleet.vehicle.battery",
            Self::HeightOutsideLimits { .. } => "transition.heights",
            Self::TransitionBudget { .. } => "transition.thrust_budget",
            Self::ShapingBelowLoiter { .. } => "transition.shaping",
        }
    }
}
