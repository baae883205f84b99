//! A transition as an independent integration of its controls sees it.

use super::flight::Flight;
use super::problem::KeepOut;
use crate::mission::Model;
use crate::plan::{Miss, Transition};
use nalgebra::{SVector, Vector2, Vector3};
use quad_dynamics::Motion;
use traj_opt::{IntegrateOptions, Trajectory};

/// Longest time between two looks at a trajectory (s): an acceleration of 25 m/s^2 takes a path 0.3 mm off the chord between them.
const LOOK_EVERY: f64 = 1e-2;

/// What was seen along the integrated trajectory.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Examination {
    /// The last moment.
    pub end: Motion,
    /// Length of the path (m).
    pub length: f64,
    /// Greatest speed (m/s).
    pub max_speed: f64,
    /// Greatest tilt (rad).
    pub max_tilt: f64,
    /// Least distance to a keep-out's centre minus its radius (m); infinite if there is none.
    pub clearance: f64,
    /// The keep-out where that is.
    pub closest: Option<usize>,
    /// Greatest overstepping of a height limit (m).
    pub height_violation: f64,
    /// Greatest overstepping of a bound on controls or states (each in its own unit), or of a limit (as a share).
    pub limit_violation: f64,
}

/// The control of segment `k` at the share `s` of its time: the polynomial through its nodes.
pub(crate) fn control<const NU: usize>(transition: &Transition, k: usize, s: f64) -> SVector<f64, NU> {
    let n = transition.control_nodes;
    let node = |i: usize| SVector::<f64, NU>::from_column_slice(&transition.controls[k * n + i]);
    match n {
        1 => node(0),
        2 => node(0) * (1.0 - s) + node(1) * s,
        _ => {
            node(0) * ((1.0 - s) * (1.0 - 2.0 * s))
                + node(1) * (4.0 * s * (1.0 - s))
                + node(2) * (s * (2.0 * s - 1.0))
        }
    }
}

/// Whether the arrays of a transition fit together and its model, so that nothing below can be out of range.
pub(crate) fn well_formed(transition: &Transition, nx: usize, nu: usize) -> bool {
    let knots = transition.knots.len();
    knots >= 2
        && (1..=3).contains(&transition.control_nodes)
        && transition.states.len() == knots
        && transition.controls.len() == (knots - 1) * transition.control_nodes
        && transition.states.iter().all(|state| state.len() == nx)
        && transition.controls.iter().all(|control| control.len() == nu)
        && transition.knots.windows(2).all(|pair| pair[0] < pair[1])
}

/// Segment `k` of a well-formed transition, its controls integrated from `state`; `None` if that fails.
fn integrated<const NX: usize, const NU: usize, F: Flight<NX, NU>>(
    flight: &F,
    transition: &Transition,
    k: usize,
    state: SVector<f64, NX>,
    options: &IntegrateOptions,
) -> Option<Trajectory<NX>> {
    let (from, to) = (transition.knots[k], transition.knots[k + 1]);
    let at = |t: f64| control::<NU>(transition, k, ((t - from) / (to - from)).clamp(0.0, 1.0));
    let mut segment = Trajectory::starting_at(from, state);
    segment.extend(|t, x| flight.derivative(t, x, &at(t)), to, options).ok()?;
    Some(segment)
}

/// Integrates the controls from `start`, with the knots as break points, and looks at the trajectory between knots too.
///
/// `None` if the arrays do not fit together or the integration fails.
pub(crate) fn examine<const NX: usize, const NU: usize, F: Flight<NX, NU>>(
    flight: &F,
    transition: &Transition,
    start: &Motion,
    keep_outs: &[KeepOut],
    heights: [f64; 2],
) -> Option<Examination> {
    if !well_formed(transition, NX, NU) {
        return None;
    }
    let initial = flight.state(start);
    let first = flight.motion(&initial, &control(transition, 0, 0.0));
    let mut seen = Examination {
        end: first,
        length: 0.0,
        max_speed: first.velocity.norm(),
        max_tilt: 0.0,
        clearance: f64::INFINITY,
        closest: None,
        height_violation: 0.0,
        limit_violation: 0.0,
    };
    let options = IntegrateOptions::default();
    let mut state = initial;
    let mut places = Vec::new();
    for (k, pair) in transition.knots.windows(2).enumerate() {
        let (from, to) = (pair[0], pair[1]);
        let at = |t: f64| control::<NU>(transition, k, ((t - from) / (to - from)).clamp(0.0, 1.0));
        let segment = integrated(flight, transition, k, state, &options)?;
        let looks = ((to - from) / LOOK_EVERY).ceil().max(1.0) as usize;
        places.clear();
        for look in 0..=looks {
            let time = from + (to - from) * look as f64 / looks as f64;
            seen.look(flight, &segment.state_at(time), &at(time), heights);
            places.push(seen.end.position.xy());
        }
        seen.keep_clear(&places, keep_outs);
        state = *segment.end_state();
    }
    Some(seen)
}

impl Examination {
    fn look<const NX: usize, const NU: usize, F: Flight<NX, NU>>(
        &mut self,
        flight: &F,
        state: &SVector<f64, NX>,
        control: &SVector<f64, NU>,
        heights: [f64; 2],
    ) {
        let moment = flight.motion(state, control);
        self.length += (moment.position - self.end.position).norm();
        self.max_speed = self.max_speed.max(moment.velocity.norm());
        self.max_tilt = self.max_tilt.max(moment.tilt());
        let z = moment.position.z;
        let (least, greatest) = flight.control_bounds();
        let (low, high) = flight.state_bounds();
        let mut limits = [0.0; 4];
        flight.limits(state, control, &mut limits[..flight.n_limits()]);
        let violation = (0..NU)
            .map(|i| (least[i] - control[i]).max(control[i] - greatest[i]))
            .chain((0..NX).map(|i| (low[i] - state[i]).max(state[i] - high[i])))
            .chain(limits.iter().take(flight.n_limits()).map(|limit| limit - 1.0))
            .fold(0.0, f64::max);
        self.limit_violation = self.limit_violation.max(violation);
        self.height_violation = self.height_violation.max(heights[0] - z).max(z - heights[1]);
        self.end = moment;
    }

    /// Least distance of a chain of places to keep-outs; those that are far from the rectangle around all places are passed over.
    fn keep_clear(&mut self, places: &[Vector2<f64>], keep_outs: &[KeepOut]) {
        let Some(&first) = places.first() else { return };
        let (low, high) = places.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
        for (i, keep_out) in keep_outs.iter().enumerate() {
            let centre = Vector2::from(keep_out.centre);
            let beyond = (low - centre).sup(&(centre - high)).sup(&Vector2::zeros());
            if beyond.norm() - keep_out.radius >= self.clearance {
                continue;
            }
            let chords = places.windows(2).map(|pair| distance_to_chord(&centre, &pair[0], &pair[1]));
            let nearest = chords.fold(f64::INFINITY, f64::min);
            if nearest - keep_out.radius < self.clearance {
                (self.clearance, self.closest) = (nearest - keep_out.radius, Some(i));
            }
        }
    }
}

/// Distance from a place to the straight line between two others.
fn distance_to_chord(place: &Vector2<f64>, a: &Vector2<f64>, b: &Vector2<f64>) -> f64 {
    let (along, offset) = (b - a, place - a);
    let squared = along.norm_squared();
    let share = if squared > 0.0 { (offset.dot(&along) / squared).clamp(0.0, 1.0) } else { 0.0 };
    (offset - along * share).norm()
}

/// How far the motion at the end is from the wanted one; a hover's yaw is free.
pub(crate) fn miss(model: Model, end: &Motion, goal: &Motion, free_yaw: bool) -> Miss {
    let up = |motion: &Motion| motion.attitude * Vector3::z();
    let attitude = match model {
        // Its attitude is a control and may jump.
        Model::PointMass => 0.0,
        _ if free_yaw && goal.tilt() == 0.0 => end.tilt(),
        _ if free_yaw => up(end).angle(&up(goal)),
        // The shaping knows no yaw: the thrust axis is what the acceleration decides.
        Model::JerkLimited => up(end).angle(&up(goal)),
        Model::ThrustRate | Model::RigidBody => end.attitude.angle_to(&goal.attitude),
    };
    Miss {
        position: (end.position - goal.position).norm(),
        velocity: (end.velocity - goal.velocity).norm(),
        attitude,
    }
}

/// The motion at a time (s after the transition's start); held at both ends.
pub(crate) type Path = Box<dyn Fn(f64) -> Motion + Send + Sync>;

/// The transition as a function of time, integrated from knot to knot; `None` if the arrays do not fit.
pub(crate) fn path<const NX: usize, const NU: usize, F: Flight<NX, NU> + Send + 'static>(
    flight: &F,
    transition: &Transition,
) -> Option<Path> {
    if !well_formed(transition, NX, NU) {
        return None;
    }
    let options = IntegrateOptions::default().with_tolerance(1e-8);
    let mut segments = Vec::with_capacity(transition.knots.len() - 1);
    for k in 0..transition.knots.len() - 1 {
        let knot = SVector::<f64, NX>::from_column_slice(&transition.states[k]);
        let segment = integrated(flight, transition, k, knot, &options)?;
        segments.push(segment);
    }
    let (flight, transition) = (flight.clone(), transition.clone());
    Some(Box::new(move |time| {
        let k =
            transition.knots.partition_point(|&knot| knot <= time).saturating_sub(1).min(segments.len() - 1);
        let (from, to) = (transition.knots[k], transition.knots[k + 1]);
        let time = time.clamp(from, to);
        let control = control::<NU>(&transition, k, (time - from) / (to - from));
        flight.motion(&segments[k].state_at(time), &control)
    }))
}
