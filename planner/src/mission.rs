//! What is asked for: the targets, the fleet, how to circle and how to fly in between.
//!
//! Everything is SI with angles in radians, in the local east-north-up frame (x east, y north, z up, heights above the
//! ground). Files, degrees and geographic coordinates belong to the caller.

use nalgebra::Vector3;
use quad_dynamics::{Camera, LoiterYaw, ShapingLimits, Vehicle};

/// A mission: who flies where, and within which limits.
///
/// Fields are public because a mission is plain data; [`Mission::problems`](Self::problems) says all that is wrong with
/// one, and [`plan`](crate::plan) refuses a mission that has any.
///
/// With the feature `serde` a mission is read from and written to any self-describing format: keys are the names of the fields,
/// unknown ones are refused, and all but `fleet.vehicles`, `fleet.vehicle` and `targets` have the defaults of [`Mission::new`]. A limit
/// that is infinite is left out.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Mission {
    /// A name for people.
    #[cfg_attr(feature = "serde", serde(default))]
    pub name: String,
    /// Where the team starts and ends: east, north (m).
    #[cfg_attr(feature = "serde", serde(default))]
    pub depot: [f64; 2],
    /// The vehicles.
    pub fleet: Fleet,
    /// How targets are circled.
    #[cfg_attr(feature = "serde", serde(default))]
    pub loiter: LoiterSettings,
    /// How vehicles fly between circles.
    #[cfg_attr(feature = "serde", serde(default))]
    pub transition: TransitionSettings,
    /// Time to swap a vehicle's battery on its pad (s); `None` if each flies once. Where endurance or battery are too small for one
    /// flight each, vehicles then fly several sorties.
    #[cfg_attr(feature = "serde", serde(default))]
    pub swap_time: Option<f64>,
    /// The camera that must see the targets; `None` if nobody asks.
    #[cfg_attr(feature = "serde", serde(default))]
    pub camera: Option<CameraSettings>,
    /// What they fly through.
    #[cfg_attr(feature = "serde", serde(default))]
    pub environment: Environment,
    /// What must be circled.
    pub targets: Vec<Target>,
    /// Targets whose cluster has at most this diameter (m) are circled as one; 0 leaves every target alone.
    #[cfg_attr(feature = "serde", serde(default))]
    pub merge_within: f64,
    /// Which targets are circled as one, each in exactly one group; `None` for those that `merge_within` says. A
    /// [`Replanner`](crate::Replanner) sets it, since what is being flown is not merged anew whenever a target moves.
    #[cfg_attr(feature = "serde", serde(default))]
    pub groups: Option<Vec<Vec<usize>>>,
    /// What is minimised over the routes.
    #[cfg_attr(feature = "serde", serde(default))]
    pub objective: Objective,
    /// How routes are found.
    #[cfg_attr(feature = "serde", serde(default))]
    pub pipeline: Pipeline,
    /// Seed of everything random.
    #[cfg_attr(feature = "serde", serde(default = "default_seed"))]
    pub seed: u64,
}

/// The vehicles of a mission, all alike.
#[derive(Debug, Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Fleet {
    /// How many there are, at least 1.
    pub vehicles: usize,
    /// The parameters of each.
    pub vehicle: Vehicle,
    /// Least distance between two vehicles in the air (m); also sets how far apart the pads lie.
    #[cfg_attr(feature = "serde", serde(default = "default_separation"))]
    pub separation: f64,
    /// Longest flight of a vehicle (s); infinite if there is no limit.
    #[cfg_attr(
        feature = "serde",
        serde(
            with = "crate::unlimited",
            default = "crate::unlimited::none",
            skip_serializing_if = "crate::unlimited::is"
        )
    )]
    pub endurance: f64,
}

/// How targets are circled. Defaults: radius 3 m, height 1.5 m, one full circle, thrust budget 0.6.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct LoiterSettings {
    /// Radius of the circle (m), unless a target has its own.
    pub radius: f64,
    /// Height above the ground (m), unless a target has its own.
    pub height: f64,
    /// Angle flown around each target (rad); `2 pi` is one full circle, more is overlap.
    pub sweep: f64,
    /// Share of the greatest thrust that a loiter may use, in (0, 1].
    pub thrust_budget: f64,
    /// Where the nose points.
    pub yaw: LoiterYaw,
    /// Greatest speed on the circle (m/s); infinite if there is no limit.
    #[cfg_attr(
        feature = "serde",
        serde(with = "crate::unlimited", skip_serializing_if = "crate::unlimited::is")
    )]
    pub speed_limit: f64,
    /// Greatest horizontal acceleration on the circle (m/s^2), as an autopilot limits it; infinite if there is no limit.
    #[cfg_attr(
        feature = "serde",
        serde(with = "crate::unlimited", skip_serializing_if = "crate::unlimited::is")
    )]
    pub acceleration_limit: f64,
}

impl Default for LoiterSettings {
    fn default() -> Self {
        Self {
            radius: 3.0,
            height: 1.5,
            sweep: std::f64::consts::TAU,
            thrust_budget: 0.6,
            yaw: LoiterYaw::AlongTrack,
            speed_limit: f64::INFINITY,
            acceleration_limit: f64::INFINITY,
        }
    }
}

/// How vehicles fly between circles.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct TransitionSettings {
    /// The model whose minimum time is sought.
    pub model: Model,
    /// Which entries of the next circle are tried.
    pub entries: Entries,
    /// Segments of the mesh, at least 4.
    pub segments: usize,
    /// How the optimal control problem is made finite.
    pub transcription: Transcription,
    /// Share of the greatest thrust (and of the body-rate limits) that a transition may use, in (0, 1].
    pub thrust_budget: f64,
    /// Distance kept from every target (m, horizontal), unless a target has its own.
    pub safe_distance: f64,
    /// Least and greatest height above the ground on the way (m).
    pub heights: [f64; 2],
    /// Limits of the jerk-limited model; the others ignore them. Default: ArduCopter's.
    pub shaping: ShapingLimits,
}

impl Default for TransitionSettings {
    fn default() -> Self {
        Self {
            model: Model::ThrustRate,
            entries: Entries::Sampled(16),
            segments: 40,
            transcription: Transcription::RungeKutta,
            thrust_budget: 0.9,
            safe_distance: 1.5,
            heights: [0.5, 30.0],
            shaping: ShapingLimits::arducopter(),
        }
    }
}

/// The camera of every vehicle, and what it looks at.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct CameraSettings {
    /// The camera: mount and angles of view.
    pub camera: Camera,
    /// Height above the ground of what must be in the picture (m): the middle of a plant, or of a person.
    pub target_height: f64,
}

/// What the vehicles fly through. Default: still air.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct Environment {
    /// Steady wind (m/s): the velocity of the air towards east and north, everywhere and all the time.
    pub wind: [f64; 2],
}

impl Environment {
    /// The velocity of the air (m/s, east-north-up).
    pub(crate) fn air(&self) -> Vector3<f64> {
        let [east, north] = self.wind;
        Vector3::new(east, north, 0.0)
    }

    /// Whether the air moves.
    pub(crate) fn is_windy(&self) -> bool {
        self.wind != [0.0, 0.0]
    }
}

/// A model of the vehicle for transitions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Model {
    /// Position and velocity under a thrust vector.
    PointMass,
    /// Position, velocity and acceleration under bounded jerk: what an autopilot's shaping leaves of the others.
    JerkLimited,
    /// Position, velocity and attitude under collective thrust and body rates.
    ThrustRate,
    /// Position, velocity, attitude and body rates under four rotor thrusts.
    RigidBody,
}

/// Which entries of the next circle are tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Entries {
    /// So many equally spaced angles, each in both directions.
    Sampled(usize),
    /// The angle is a variable of the optimal control problem, in both directions.
    Free,
}

/// How the optimal control problem is made finite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Transcription {
    /// Multiple shooting with piecewise-constant controls and Runge-Kutta steps: its controls can be flown as they are.
    RungeKutta,
    /// Hermite-Simpson collocation.
    HermiteSimpson,
    /// Trapezoidal collocation.
    Trapezoidal,
}

/// Something to circle.
#[derive(Debug, Clone, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields, default))]
pub struct Target {
    /// A name for people; empty if it has none.
    pub name: String,
    /// East, north (m).
    pub position: [f64; 2],
    /// Radius of its circle (m), instead of the mission's.
    pub radius: Option<f64>,
    /// Height of its circle (m), instead of the mission's.
    pub height: Option<f64>,
    /// Distance kept from it (m), instead of the mission's.
    pub safe_distance: Option<f64>,
}

impl Target {
    /// A target at `position` (east, north in m) with the mission's radius, height and safe distance.
    #[must_use]
    pub fn at(position: [f64; 2]) -> Self {
        Self { position, ..Self::default() }
    }
}

/// What is minimised over the routes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Objective {
    /// The time of the longest route: what batteries and daylight ask for.
    #[default]
    Makespan,
    /// The sum over the routes, as in the paper. Without a balance rule one vehicle may do everything.
    Total,
}

/// How routes are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum Pipeline {
    /// The paper's: k-means, Christofides in each cluster, and the fastest entry leg by leg.
    Paper,
    /// Routes optimised for the objective, entries chosen for whole routes.
    #[default]
    Optimised,
}

/// Seed unless another is given.
const SEED: u64 = 1;
/// Separation (m) unless another is given.
const SEPARATION: f64 = 3.0;

#[cfg(feature = "serde")]
fn default_seed() -> u64 {
    SEED
}

#[cfg(feature = "serde")]
fn default_separation() -> f64 {
    SEPARATION
}

impl Mission {
    /// A mission for `vehicles` vehicles of the given kind around `targets`, from a depot at the origin, with default
    /// settings.
    #[must_use]
    pub fn new(vehicle: Vehicle, vehicles: usize, targets: Vec<Target>) -> Self {
        Self {
            name: String::new(),
            depot: [0.0, 0.0],
            fleet: Fleet { vehicles, vehicle, separation: SEPARATION, endurance: f64::INFINITY },
            loiter: LoiterSettings::default(),
            transition: TransitionSettings::default(),
            swap_time: None,
            camera: None,
            environment: Environment::default(),
            targets,
            merge_within: 0.0,
            groups: None,
            objective: Objective::default(),
            pipeline: Pipeline::default(),
            seed: SEED,
        }
    }
}
