//! What is answered: everything every vehicle does, with times.
//!
//! Vehicles, targets and legs are numbered from 0 here; files and tables number them from 1.

use crate::mission::Model;
use quad_dynamics::{Direction, Limit};

/// A complete plan.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Plan {
    /// The circles to fly, after close targets have been merged.
    pub circles: Vec<Circle>,
    /// What each vehicle does; a vehicle without a route stays on its pad. Further sorties of vehicles follow
    /// ([`VehiclePlan::vehicle`], [`Mission::swap_time`](crate::Mission)).
    pub vehicles: Vec<VehiclePlan>,
    /// How good the plan can be said to be.
    pub certificate: Certificate,
    /// Where two airborne vehicles come closest; `None` with fewer than two of them.
    pub closest_approach: Option<Approach>,
    /// What the operator should know before flying.
    pub warnings: Vec<Warning>,
    /// Targets that need not be circled, ascending: those that have vanished ([`Replanner`](crate::Replanner)).
    pub skipped: Vec<usize>,
    /// Targets that were not where they are at the start, and since when they are (s after the mission's start): nobody has to
    /// keep away from them earlier ([`Replanner`](crate::Replanner)).
    pub known_since: Vec<(usize, f64)>,
    /// Winds that were planned for before the mission's (m/s: east, north), each with the time (s after the mission's start) at
    /// which it changed, ascending: a leg that starts by then was planned for it ([`Event::WindChanges`](crate::Event)).
    pub earlier_winds: Vec<(f64, [f64; 2])>,
}

/// A loiter circle: what is flown around a target, or around several merged ones.
#[derive(Debug, Clone, PartialEq)]
pub struct Circle {
    /// The targets it serves, indices into the mission's list, ascending.
    pub members: Vec<usize>,
    /// Centre: east, north (m).
    pub centre: [f64; 2],
    /// Radius (m).
    pub radius: f64,
    /// Height above the ground (m).
    pub height: f64,
    /// Angle flown (rad).
    pub sweep: f64,
    /// Speed along the circle (m/s).
    pub speed: f64,
    /// What keeps the speed from being greater.
    pub limit: Option<Limit>,
    /// Time for the sweep (s).
    pub duration: f64,
}

/// What one vehicle does from take-off to landing.
#[derive(Debug, Clone)]
pub struct VehiclePlan {
    /// The vehicle: its place in [`Plan::vehicles`], or that of the vehicle whose further sortie this is.
    pub vehicle: usize,
    /// Where it hovers before the first and after the last leg (m, east-north-up).
    pub pad: [f64; 3],
    /// Where its nose points when it takes off (rad, from east, counter-clockwise): towards its first circle.
    pub heading: f64,
    /// The circles it flies, in order; indices into [`Plan::circles`].
    pub route: Vec<usize>,
    /// One leg per circle of the route and one back to the pad; empty for a spare vehicle.
    pub legs: Vec<Leg>,
    /// Time in the air (s) had every leg been the fastest by itself, as in the paper; what [`VehiclePlan::duration`] is less was
    /// gained by choosing entries for the route as a whole.
    pub leg_by_leg: f64,
    /// When the vehicle dropped out (s after the mission's start); its route and legs are those that it had completed.
    pub lost_at: Option<f64>,
}

/// A transition and the loiter that follows it; the last leg of a vehicle leads back to its pad and has no loiter.
#[derive(Debug, Clone)]
pub struct Leg {
    /// When the transition starts (s after the mission's start).
    pub start_time: f64,
    /// The flight to the circle or to the pad.
    pub transition: Transition,
    /// The circle flown at its end.
    pub loiter: Option<Loiter>,
    /// What became of every candidate entry, in the order of angle and then direction. For a flight to the pad the one
    /// candidate has no entry; where the entry was chosen for the route as a whole, it is the only candidate.
    pub candidates: Vec<Candidate>,
}

/// A circle as it is flown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loiter {
    /// Index into [`Plan::circles`].
    pub circle: usize,
    /// Where and in which direction it is entered.
    pub entry: Entry,
    /// Time for the sweep (s).
    pub duration: f64,
    /// Length of the arc (m).
    pub length: f64,
}

/// Where and how a circle is entered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Entry {
    /// Angle of the entry point seen from the centre (rad, from east, counter-clockwise).
    pub angle: f64,
    /// Turning sense seen from above.
    pub direction: Direction,
}

/// A flight in minimum time, as the solver found it and as an independent integration sees it.
#[derive(Debug, Clone)]
pub struct Transition {
    /// The model whose states and controls are listed.
    pub model: Model,
    /// Time of flight (s).
    pub duration: f64,
    /// Length of the path (m).
    pub length: f64,
    /// Knot times from the start of the transition (s), ascending from 0 to `duration`.
    pub knots: Vec<f64>,
    /// The state at every knot, in the model's order and SI units.
    pub states: Vec<Vec<f64>>,
    /// [`control_nodes`](Self::control_nodes) controls for every segment in turn, in the model's order and SI units.
    pub controls: Vec<Vec<f64>>,
    /// Equally spaced nodes of the control in a segment, both ends included: 1 is a constant control, 2 a linear one, 3 a
    /// quadratic one.
    pub control_nodes: usize,
    /// How the solver ended.
    pub status: SolverStatus,
    /// Iterations of the solver.
    pub iterations: usize,
    /// Greatest violation of the optimality conditions, scaled (dimensionless).
    pub dual_residual: f64,
    /// Greatest violation of the transcribed equations and bounds, scaled (dimensionless).
    pub primal_residual: f64,
    /// How far the integrated controls end from the wanted state.
    pub miss: Miss,
    /// Greatest speed on the way (m/s).
    pub max_speed: f64,
    /// Greatest tilt of the thrust axis from the vertical (rad).
    pub max_tilt: f64,
}

/// How a solve ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SolverStatus {
    /// To the requested tolerance.
    Solved,
    /// To a looser tolerance, stated by the residuals.
    Acceptable,
    /// Not at all: iteration limit, infeasible, or broken off.
    Failed,
}

/// Distance between the wanted end state and the one that an independent integration of the controls reaches.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Miss {
    /// Position (m).
    pub position: f64,
    /// Velocity (m/s).
    pub velocity: f64,
    /// Attitude (rad); what the model leaves open, such as the yaw on the pad, does not count.
    pub attitude: f64,
}

/// A candidate entry and what became of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// The entry; `None` for the flight to the pad.
    pub entry: Option<Entry>,
    /// What became of it.
    pub outcome: Outcome,
}

/// What became of a candidate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outcome {
    /// Solved, with the time of flight (s) to compare.
    Solved {
        /// Time of flight (s).
        duration: f64,
    },
    /// Slower than another by an estimate, not a proof: from a solve on a third of the segments, from the duality gap of a solve
    /// that was broken off, or from what other entries of the leg take longer than their bounds.
    Slower {
        /// Time of flight by that estimate (s).
        duration: f64,
    },
    /// Not solved because a certified lower bound (s) already exceeds the time of the best.
    ProvenWorse {
        /// The bound (s).
        lower_bound: f64,
    },
    /// The solver failed; never counted as discarded.
    Failed {
        /// Final residual of the equations and bounds, scaled.
        primal_residual: f64,
        /// Final residual of the optimality conditions, scaled.
        dual_residual: f64,
    },
}

/// Values found beside lower bounds that hold over every allocation, order, entry, direction and admissible motion; in a plan that a
/// [`Replanner`](crate::Replanner) has changed, over all of those with which its flights can go on from the last event: what has been
/// flown, or is being flown to its end, stays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certificate {
    /// Time until the last vehicle is back (s), waiting included.
    pub makespan: f64,
    /// No plan can have a smaller makespan (s).
    pub makespan_lower_bound: f64,
    /// Sum of the vehicles' times in the air (s).
    pub total: f64,
    /// No plan can have a smaller total (s).
    pub total_lower_bound: f64,
}

/// Where two airborne vehicles come closest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// The two vehicles, ascending.
    pub vehicles: [usize; 2],
    /// When (s after the mission's start).
    pub time: f64,
    /// How close (m).
    pub distance: f64,
}

/// What the operator should know before flying.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// A vehicle flies longer than the mission's endurance.
    Endurance {
        /// The vehicle.
        vehicle: usize,
        /// Its time in the air (s).
        duration: f64,
        /// The endurance (s).
        endurance: f64,
    },
    /// A vehicle needs more energy than its battery can give.
    Battery {
        /// The vehicle.
        vehicle: usize,
        /// Energy of its flight (J), see [`Plan::energy`].
        energy: f64,
        /// Energy that may be used (J).
        usable: f64,
    },
    /// Endurance or battery are too small for so few vehicles.
    MoreVehicles {
        /// How many vehicles, or flights with a fresh battery each, the mission needs: found by routing with leg times scaled to those
        /// of this plan, so an estimate.
        needed: usize,
    },
    /// One flight each is too long for endurance or battery: batteries are swapped on the pads.
    Sorties {
        /// Flights, by as many vehicles as there are.
        flights: usize,
    },
    /// The camera does not see a target all the way round ([`Plan::shares_in_view`]).
    OutOfView {
        /// The target that is in view least; the first of several.
        target: usize,
        /// The share of its loiter during which it is in view, below 1.
        share: f64,
    },
    /// There are more vehicles than routes.
    Spare {
        /// How many vehicles stay at the depot.
        vehicles: usize,
    },
    /// Candidate entries that the solver could not solve and whose times are therefore unknown.
    FailedCandidates {
        /// The vehicle.
        vehicle: usize,
        /// The leg.
        leg: usize,
        /// How many.
        candidates: usize,
    },
}

/// One moment of a vehicle's flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Seconds after the mission's start.
    pub time: f64,
    /// East, north, up (m).
    pub position: [f64; 3],
    /// World frame (m/s).
    pub velocity: [f64; 3],
    /// World frame (m/s^2).
    pub acceleration: [f64; 3],
    /// Body to world, unit quaternion (w, x, y, z).
    pub attitude: [f64; 4],
    /// Body frame (rad/s).
    pub body_rates: [f64; 3],
    /// Collective thrust (N).
    pub collective_thrust: f64,
    /// What the vehicle is doing.
    pub phase: Phase,
    /// The circle that it flies to or around; `None` on the way back and on the pad.
    pub circle: Option<usize>,
}

/// What a vehicle is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Phase {
    /// Flying between circles, or from or to the pad.
    Transition,
    /// Circling.
    Loiter,
    /// Hovering at the pad, before or after its flight.
    Pad,
}

impl Certificate {
    /// How far the makespan can be above the best possible, as a share: 0.2 is 20 %.
    #[must_use]
    pub fn makespan_gap(&self) -> f64 {
        self.makespan / self.makespan_lower_bound - 1.0
    }

    /// How far the total can be above the best possible, as a share: 0.2 is 20 %.
    #[must_use]
    pub fn total_gap(&self) -> f64 {
        self.total / self.total_lower_bound - 1.0
    }
}

impl Plan {
    /// Flights from take-off to landing: with one sortie each the number of vehicles that fly.
    #[must_use]
    pub fn flights(&self) -> usize {
        self.vehicles.iter().filter(|planned| !planned.legs.is_empty()).count()
    }
}

impl Leg {
    /// When the transition ends and the loiter, if there is one, begins (s after the mission's start).
    #[must_use]
    pub fn arrival_time(&self) -> f64 {
        self.start_time + self.transition.duration
    }

    /// When the leg is over (s after the mission's start).
    #[must_use]
    pub fn end_time(&self) -> f64 {
        self.arrival_time() + self.loiter.map_or(0.0, |loiter| loiter.duration)
    }
}

impl VehiclePlan {
    /// Time from take-off to the return (s); 0 for a spare vehicle.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.end_time() - self.start_time()
    }

    /// When the vehicle takes off (s after the mission's start); later than 0 where it waits for others to pass.
    #[must_use]
    pub fn start_time(&self) -> f64 {
        self.legs.first().map_or(0.0, |leg| leg.start_time)
    }

    /// When the vehicle is back (s after the mission's start); 0 for a spare vehicle.
    #[must_use]
    pub fn end_time(&self) -> f64 {
        self.legs.last().map_or(0.0, Leg::end_time)
    }

    /// Time in transitions (s).
    #[must_use]
    pub fn transition_time(&self) -> f64 {
        self.legs.iter().map(|leg| leg.transition.duration).sum()
    }

    /// Time in loiters (s).
    #[must_use]
    pub fn loiter_time(&self) -> f64 {
        self.legs.iter().filter_map(|leg| leg.loiter).map(|loiter| loiter.duration).sum()
    }

    /// Length of the whole flight (m).
    #[must_use]
    pub fn length(&self) -> f64 {
        self.legs
            .iter()
            .map(|leg| leg.transition.length + leg.loiter.map_or(0.0, |loiter| loiter.length))
            .sum()
    }
}
