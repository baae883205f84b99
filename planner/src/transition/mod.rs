//! Minimum-time flights from a moment of one loiter to a moment of the next, or from and to hover.
//!
//! | step | file |
//! |---|---|
//! | what a model must tell | `flight.rs`, for each model in `models.rs` |
//! | the optimal control problem | `problem.rs` |
//! | first trajectories | `guess.rs` |
//! | long flights, sketched without their middle | `cruise.rs` |
//! | solving, and solving again with what was overstepped put farther away | `solve.rs` |
//! | what gets stricter from one solve to the next | `setting.rs` |
//! | looking at the result between the knots, without the solver | `examine.rs` |

mod cruise;
mod early_end;
mod examine;
mod flight;
mod guess;
mod models;
mod problem;
mod setting;
mod solve;

pub(crate) use examine::{Examination, Path, miss};
pub(crate) use problem::Goal;
pub(crate) use solve::{Detail, Draft, Hint, Unsolved};

use crate::bound::Agility;
use crate::circles::Orbit;
use crate::mission::{Mission, Model, TransitionSettings};
use crate::plan::{Entry, Transition};
use flight::Flight;
use models::{JerkLimitedFlight, PointMassFlight, RigidBodyFlight, ThrustRateFlight};
use nalgebra::Vector3;
use problem::KeepOut;
use quad_dynamics::Motion;
use solve::Surroundings;

/// The mission's model with everything that its transitions have in common.
#[derive(Debug, Clone)]
pub(crate) struct Pilot {
    airframe: Airframe,
    keep_outs: Vec<KeepOut>,
    settings: TransitionSettings,
    /// Iterations after which a solve has failed.
    most_iterations: Option<usize>,
}

/// One of the models.
#[derive(Debug, Clone)]
enum Airframe {
    PointMass(PointMassFlight),
    JerkLimited(JerkLimitedFlight),
    ThrustRate(ThrustRateFlight),
    RigidBody(RigidBodyFlight),
}

/// Calls a function that is generic over the model's sizes with the model at hand.
macro_rules! with_flight {
    ($airframe:expr, $flight:ident => $call:expr) => {
        match $airframe {
            Airframe::PointMass($flight) => $call,
            Airframe::JerkLimited($flight) => $call,
            Airframe::ThrustRate($flight) => $call,
            Airframe::RigidBody($flight) => $call,
        }
    };
}

impl Pilot {
    pub(crate) fn new(mission: &Mission, orbits: &[Orbit]) -> Self {
        let settings = mission.transition.clone();
        let vehicle = &mission.fleet.vehicle;
        let wind = mission.environment.air();
        let airframe = match settings.model {
            Model::PointMass => Airframe::PointMass(PointMassFlight::new(vehicle, &settings, wind)),
            Model::JerkLimited => Airframe::JerkLimited(JerkLimitedFlight::new(vehicle, &settings, wind)),
            Model::ThrustRate => Airframe::ThrustRate(ThrustRateFlight::new(vehicle, &settings, wind)),
            Model::RigidBody => Airframe::RigidBody(RigidBodyFlight::new(vehicle, &settings, wind, orbits)),
        };
        let keep_outs = (0..mission.targets.len())
            .map(|i| KeepOut { centre: mission.targets[i].position, radius: mission.safe_distance(i) })
            .collect();
        Self { airframe, keep_outs, settings, most_iterations: None }
    }

    /// With a limit of iterations for each solve.
    pub(crate) fn with_most_iterations(self, most_iterations: Option<usize>) -> Self {
        Self { most_iterations, ..self }
    }

    /// Whether [`Goal::Circle`] can be asked for: its attitude must be the same all the way round, if the model has one.
    pub(crate) fn can_enter_anywhere(&self, orbit: &Orbit) -> bool {
        orbit.loiter.is_even() || matches!(self.airframe, Airframe::PointMass(_) | Airframe::JerkLimited(_))
    }

    /// What a lower bound on the time of a transition may count on.
    pub(crate) fn agility(&self) -> Option<Agility> {
        with_flight!(&self.airframe, flight => flight.agility())
    }

    /// The fastest transition to a goal; guesses lead `towards` (for a circle a promising entry).
    pub(crate) fn fly(
        &self,
        start: &Motion,
        goal: Goal,
        towards: &Motion,
        hint: Hint,
    ) -> Result<Transition, Unsolved> {
        let draft = self.draft(start, goal, towards, hint, (Detail::Full, f64::INFINITY))?;
        self.polish(start, goal, draft)
    }

    /// The same, only to learn how fast it is; given up early if it takes longer than `to_beat` (s).
    pub(crate) fn draft(
        &self,
        start: &Motion,
        goal: Goal,
        towards: &Motion,
        hint: Hint,
        (detail, to_beat): (Detail, f64),
    ) -> Result<Draft, Unsolved> {
        let surroundings = self.surroundings();
        with_flight!(&self.airframe, flight => cruise::draft(flight, start, goal, towards, hint, &surroundings, (detail, to_beat)))
    }

    /// The transition of a draft as it can be flown.
    pub(crate) fn polish(&self, start: &Motion, goal: Goal, draft: Draft) -> Result<Transition, Unsolved> {
        let surroundings = self.surroundings();
        with_flight!(&self.airframe, flight => solve::polish(flight, start, goal, draft, &surroundings))
    }

    fn surroundings(&self) -> Surroundings<'_> {
        Surroundings {
            keep_outs: &self.keep_outs,
            heights: self.settings.heights,
            settings: &self.settings,
            most_iterations: self.most_iterations,
        }
    }

    /// The transition as an independent integration of its controls sees it; `None` if it is malformed.
    pub(crate) fn examine(&self, transition: &Transition, start: &Motion) -> Option<Examination> {
        self.examine_near(transition, start, &self.keep_outs)
    }

    /// The same, without the safe distances of some targets.
    pub(crate) fn examine_without(
        &self,
        transition: &Transition,
        start: &Motion,
        targets: &[usize],
    ) -> Option<Examination> {
        let mut keep_outs = self.keep_outs.clone();
        for &target in targets {
            if let Some(keep_out) = keep_outs.get_mut(target) {
                keep_out.radius = f64::NEG_INFINITY;
            }
        }
        self.examine_near(transition, start, &keep_outs)
    }

    fn examine_near(
        &self,
        transition: &Transition,
        start: &Motion,
        keep_outs: &[KeepOut],
    ) -> Option<Examination> {
        let heights = self.settings.heights;
        with_flight!(&self.airframe, flight => examine::examine(flight, transition, start, keep_outs, heights))
    }

    /// The transition as a function of time; `None` if it is malformed.
    pub(crate) fn path(&self, transition: &Transition) -> Option<Path> {
        with_flight!(&self.airframe, flight => examine::path(flight, transition))
    }
}

/// The mission's vehicle hovering at `position` in its wind, its nose in a direction (rad, from east, counter-clockwise).
pub(crate) fn hover(mission: &Mission, position: [f64; 3], heading: f64) -> Motion {
    let air = mission.environment.air();
    Motion::hover_in_wind(&mission.fleet.vehicle, Vector3::from(position), heading, air)
}

impl Orbit {
    /// The vehicle's motion where the circle is entered.
    pub(crate) fn at(&self, entry: Entry) -> Motion {
        let [x, y] = self.circle.centre;
        self.loiter.state(entry.angle, entry.direction).translated(&Vector3::new(x, y, self.circle.height))
    }

    /// The vehicle's motion where it leaves a circle that it entered at `entry`: a sweep further on.
    pub(crate) fn exit(&self, entry: Entry) -> Motion {
        self.at(Entry { angle: self.loiter.exit_angle(entry.angle, entry.direction), ..entry })
    }

    /// Where a vehicle that entered at `entry` is `time` (s) later.
    pub(crate) fn after(&self, entry: Entry, time: f64) -> Motion {
        self.at(Entry {
            angle: entry.angle + entry.direction.sign() * self.loiter.angular_speed() * time,
            ..entry
        })
    }
}
