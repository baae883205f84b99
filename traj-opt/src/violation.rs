//! Which constraint a trajectory violates, where, and by how much: between the knots, and where a solve failed.

use crate::nlp::interior_point::Memory;
use crate::nlp::program::Program;
use crate::{Problem, Solution};
use nalgebra::SVector;

/// What is violated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum ConstraintKind {
    /// A bound on a component of the state.
    State,
    /// A bound on a component of the control.
    Control,
    /// A path constraint.
    Path,
    /// The equation of motion of a component of the state, over the segment that ends at the time given.
    Dynamics,
    /// A boundary constraint.
    Boundary,
    /// A fixed component of the end state.
    TerminalState,
    /// A constraint that links a phase to the one before.
    Linkage,
    /// The duration of a phase.
    Duration,
    /// A second-order cone.
    Cone,
}

impl std::fmt::Display for ConstraintKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::State => "bound on state",
            Self::Control => "bound on control",
            Self::Path => "path constraint",
            Self::Dynamics => "equation of motion of state",
            Self::Boundary => "boundary constraint",
            Self::TerminalState => "terminal value of state",
            Self::Linkage => "linkage constraint",
            Self::Duration => "duration",
            Self::Cone => "cone",
        })
    }
}

/// What the solver calls a constraint, in the words of the problem that the user wrote: within its phase, on its clock.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Location {
    /// What it is.
    pub kind: ConstraintKind,
    /// Component of the state or control of the phase, or index of its path, boundary or linkage constraint.
    pub index: usize,
    /// Number of the phase, from 0; a linkage belongs to the later one.
    pub phase: usize,
    /// Time on the clock of the phase, s.
    pub time: f64,
}

/// The greatest violation found along a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Violation {
    /// What is violated.
    pub kind: ConstraintKind,
    /// Component of the state or control, or index of the path or boundary constraint, within the phase.
    pub index: usize,
    /// Number of the phase, from 0; 0 for a problem of a single phase.
    pub phase: usize,
    /// Time on the clock of the phase, s.
    pub time: f64,
    /// Distance beyond the bound, in the units of the constraint; infinite where its value is not a number.
    pub amount: f64,
}

impl std::fmt::Display for Violation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { kind, index, phase, time, amount } = self;
        write!(f, "{kind} {index} of phase {phase} violated by {amount:.3e} at time {time:.6}")
    }
}

impl Violation {
    pub(crate) fn at(location: Location, amount: f64) -> Self {
        let Location { kind, index, phase, time } = location;
        Self { kind, index, phase, time, amount }
    }
}

/// The residual of the transcribed constraints that is greatest relative to its scale.
pub(crate) fn greatest_residual<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    memory: &Memory<NX, NU>,
) -> Option<Violation> {
    let (layout, values) = (&memory.layout, &memory.values);
    let tf = memory.w[layout.time];
    let knots = program.mesh.fractions();
    // what a location needs of the state, start time and durations, is the same at every knot
    let start = program.state(layout, &memory.w, 0);
    let mut worst = (0.0, None);
    let mut see = |kind, index, fraction, residual: f64, scale: f64| {
        let amount = if residual.is_nan() { f64::INFINITY } else { residual.abs() };
        if amount / scale > worst.0 {
            let location = program.problem.locate(kind, index, program.time_at(fraction, tf), &start);
            worst = (amount / scale, Some(Violation::at(location, amount)));
        }
    };
    for k in 0..layout.n_segments {
        let inner = &values.middle[k * layout.n_inner..(k + 1) * layout.n_inner];
        for defect in inner.iter().chain([&values.defect[k]]) {
            for i in 0..NX {
                see(ConstraintKind::Dynamics, i, knots[k + 1], defect[i], memory.states.scale[i]);
            }
        }
    }
    for (i, residual) in values.path.iter().enumerate() {
        let (point, row) = (i / layout.n_path, i % layout.n_path);
        see(ConstraintKind::Path, row, layout.points[point].fraction, *residual, memory.path_scale[row]);
    }
    for (i, residual) in values.boundary.iter().enumerate() {
        let (kind, index) = match memory.rows.fixed.get(i.wrapping_sub(memory.rows.n_functions)) {
            Some(&component) => (ConstraintKind::TerminalState, component),
            None => (ConstraintKind::Boundary, i),
        };
        see(kind, index, 1.0, *residual, memory.boundary_scale[i]);
    }
    worst.1
}

impl<const NX: usize, const NU: usize> Solution<NX, NU> {
    /// The greatest violation of state bounds, control bounds and path constraints at `samples + 1` equidistant times of
    /// each segment, both ends included (`samples` 0 counts as 1); `None` if there is none. Amounts of different units are
    /// compared as they are; of equal ones the first is returned.
    ///
    /// State and control are the interpolants of the solution. It is a sampled value, hence a lower bound on the greatest
    /// violation of the interpolants. Cost: `samples + 1` evaluations of the path functions a segment.
    #[must_use]
    pub fn greatest_violation<P: Problem<NX, NU>>(&self, problem: &P, samples: usize) -> Option<Violation> {
        let samples = samples.max(1);
        let mut worst = None;
        let mut path = vec![0.0; problem.n_path()];
        for k in 0..self.times().len() - 1 {
            let (start, end) = (self.times()[k], self.times()[k + 1]);
            for i in 0..=samples {
                let time = start + (end - start) * (i as f64 / samples as f64);
                let (x, u) = (self.state_at(time), self.control_in_segment(k, time));
                worst_at(problem, time, &x, &u, &mut path, &mut worst);
            }
        }
        worst
    }
}

/// Greatest violation in every segment relative to `1 + |bound|`, that of control bounds times the segment's share of the flight.
pub(crate) fn segment_violations<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    solution: &Solution<NX, NU>,
    problem: &P,
    samples: usize,
) -> Vec<f64> {
    let bounds = problem.bounds();
    let mut path = vec![0.0; problem.n_path()];
    let limits: Vec<(f64, f64)> = (0..path.len()).map(|i| problem.path_bounds(i)).collect();
    let beyond = |value: f64, (lower, upper): (f64, f64)| {
        let below = if lower.is_finite() { (lower - value) / (1.0 + lower.abs()) } else { 0.0 };
        let above = if upper.is_finite() { (value - upper) / (1.0 + upper.abs()) } else { 0.0 };
        below.max(above).max(0.0)
    };
    let segment = |ends: (usize, &[f64])| {
        let (k, ends) = ends;
        let mut worst: f64 = 0.0;
        let share = (ends[1] - ends[0]) / (solution.final_time() - solution.initial_time());
        for i in 0..=samples {
            let time = ends[0] + (ends[1] - ends[0]) * (i as f64 / samples as f64);
            let (x, u) = (solution.state_at(time), solution.control_in_segment(k, time));
            for i in 0..NX {
                worst = worst.max(beyond(x[i], (bounds.state_lower[i], bounds.state_upper[i])));
            }
            for i in 0..NU {
                let excess = beyond(u[i], (bounds.control_lower[i], bounds.control_upper[i]));
                worst = worst.max(excess * share);
            }
            problem.path(time, &x, &u, &mut path);
            worst = path.iter().zip(&limits).map(|(v, l)| beyond(*v, *l)).fold(worst, f64::max);
        }
        worst
    };
    solution.times().windows(2).enumerate().map(segment).collect()
}

/// Replaces `worst` by any greater violation at one point.
fn worst_at<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &P,
    time: f64,
    x: &SVector<f64, NX>,
    u: &SVector<f64, NU>,
    path: &mut [f64],
    worst: &mut Option<Violation>,
) {
    let bounds = problem.bounds();
    let mut see = |kind, index, value: f64, lower: f64, upper: f64| {
        let excess = if value.is_nan() { f64::INFINITY } else { (lower - value).max(value - upper) };
        if excess > worst.map_or(0.0, |w: Violation| w.amount) {
            *worst = Some(Violation::at(problem.locate(kind, index, time, x), excess));
        }
    };
    for i in 0..NX {
        see(ConstraintKind::State, i, x[i], bounds.state_lower[i], bounds.state_upper[i]);
    }
    for i in 0..NU {
        see(ConstraintKind::Control, i, u[i], bounds.control_lower[i], bounds.control_upper[i]);
    }
    problem.path(time, x, u, path);
    for (i, &value) in path.iter().enumerate() {
        let (lower, upper) = problem.path_bounds(i);
        see(ConstraintKind::Path, i, value, lower, upper);
    }
}
