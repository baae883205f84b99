//! Bounds, scales and starting point of a solve.

use super::barrier::Box;
use super::boundary::BoundaryRows;
use super::layout::Layout;
use super::program::Program;
use crate::error::BoundKind;
use crate::{Bounds, Error, Guess, Problem, Scales, Transcription};
use nalgebra::SVector;

/// Refuses inconsistent bounds.
pub(crate) fn validate<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &P,
    bounds: &Bounds<NX, NU>,
) -> Result<(), Error> {
    let check = |what, index, lower: f64, upper: f64| {
        let empty = lower == f64::INFINITY || upper == f64::NEG_INFINITY;
        if lower <= upper && !empty {
            Ok(())
        } else {
            Err(Error::InconsistentBounds { what, index, lower, upper })
        }
    };
    for i in 0..NX {
        check(BoundKind::State, i, bounds.state_lower[i], bounds.state_upper[i])?;
        check(BoundKind::InitialState, i, bounds.initial_lower[i], bounds.initial_upper[i])?;
        check(BoundKind::TerminalState, i, bounds.terminal_lower[i], bounds.terminal_upper[i])?;
    }
    for i in 0..NU {
        check(BoundKind::Control, i, bounds.control_lower[i], bounds.control_upper[i])?;
    }
    let (lower, upper) = (bounds.final_time_lower, bounds.final_time_upper);
    check(BoundKind::FinalTime, 0, lower, upper)?;
    if !bounds.initial_time.is_finite() || upper <= bounds.initial_time {
        return Err(Error::InconsistentBounds {
            what: BoundKind::FinalTime,
            index: 0,
            lower: bounds.initial_time,
            upper,
        });
    }
    for i in 0..problem.n_path() {
        let (lower, upper) = problem.path_bounds(i);
        check(BoundKind::Path, i, lower, upper)?;
    }
    for i in 0..problem.n_boundary() {
        let (lower, upper) = problem.boundary_bounds(i);
        check(BoundKind::Boundary, i, lower, upper)?;
    }
    Ok(())
}

/// Magnitudes from the guess and, where both are finite, the bounds.
pub(crate) fn default_scales<const NX: usize, const NU: usize>(
    bounds: &Bounds<NX, NU>,
    guess: &Guess<NX, NU>,
) -> Scales<NX, NU> {
    let magnitude = |lower: f64, upper: f64, seen: f64| {
        let width = upper - lower;
        if width.is_finite() && width > 0.0 { 0.5 * width } else { seen.max(1.0) }
    };
    let mut state = SVector::zeros();
    for i in 0..NX {
        let (mut low, mut high): (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);
        for j in 0..=8 {
            let v = guess.sample(j as f64 / 8.0).0[i];
            (low, high) = (low.min(v), high.max(v));
        }
        for v in [bounds.initial_lower[i], bounds.terminal_lower[i]] {
            if v.is_finite() {
                (low, high) = (low.min(v), high.max(v));
            }
        }
        state[i] = magnitude(bounds.state_lower[i], bounds.state_upper[i], high - low);
    }
    let control = SVector::from_fn(|i, _| {
        magnitude(bounds.control_lower[i], bounds.control_upper[i], guess.sample(0.5).1[i].abs())
    });
    Scales { state, control, time: (guess.final_time() - bounds.initial_time).max(1e-3) }
}

/// Free components of the start state.
pub(crate) fn free_start<const NX: usize, const NU: usize>(bounds: &Bounds<NX, NU>, out: &mut Vec<usize>) {
    out.clear();
    out.extend((0..NX).filter(|&i| bounds.initial_lower[i] != bounds.initial_upper[i]));
}

/// Fills the bounds of all variables.
pub(crate) fn fill_bounds<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    rows: &BoundaryRows,
    out: &mut Box,
) {
    out.reset(layout.n_variables);
    let b = &program.bounds;
    for knot in 0..=layout.n_segments {
        for i in 0..NX {
            let (mut lower, mut upper) = (b.state_lower[i], b.state_upper[i]);
            for (at, l, u) in [
                (0, b.initial_lower[i], b.initial_upper[i]),
                (layout.n_segments, b.terminal_lower[i], b.terminal_upper[i]),
            ] {
                if knot == at {
                    // a fixed component needs no bound: it is removed, or held by its boundary row
                    (lower, upper) = if l == u {
                        (f64::NEG_INFINITY, f64::INFINITY)
                    } else {
                        (lower.max(l), upper.min(u))
                    };
                }
            }
            out.lower[layout.state(knot) + i] = lower;
            out.upper[layout.state(knot) + i] = upper;
        }
    }
    for i in layout.controls..layout.middles {
        out.lower[i] = b.control_lower[(i - layout.controls) % NU.max(1)];
        out.upper[i] = b.control_upper[(i - layout.controls) % NU.max(1)];
    }
    // the middle states of the compressed form are no variables
    let first = if program.transcription == Transcription::CompressedHermiteSimpson {
        layout.time
    } else {
        layout.middles
    };
    for i in first..layout.time {
        out.lower[i] = b.state_lower[(i - layout.middles) % NX];
        out.upper[i] = b.state_upper[(i - layout.middles) % NX];
    }
    if program.free_time {
        out.lower[layout.time] = b.final_time_lower.max(b.initial_time);
        out.upper[layout.time] = b.final_time_upper;
    }
    for i in layout.path_slacks..layout.boundary_slacks {
        let row = (i - layout.path_slacks) % layout.n_path.max(1);
        (out.lower[i], out.upper[i]) = program.problem.path_bounds(row);
    }
    for (row, slack) in rows.slack.iter().enumerate() {
        if let Some(slack) = slack {
            let i = layout.boundary_slacks + slack;
            (out.lower[i], out.upper[i]) = program.problem.boundary_bounds(row);
        }
    }
}

/// Samples the guess onto the mesh; slacks are set later from the constraint values.
pub(crate) fn fill_guess<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    guess: &Guess<NX, NU>,
    w: &mut Vec<f64>,
) {
    w.clear();
    w.resize(layout.n_variables, 0.0);
    let f = program.mesh.fractions();
    for k in 0..=layout.n_segments {
        w[layout.state(k)..layout.state(k + 1)].copy_from_slice(guess.sample(f[k]).0.as_slice());
    }
    for k in 0..layout.n_segments {
        let width = f[k + 1] - f[k];
        for (local, s) in program.transcription.control_points().iter().enumerate() {
            // a constant control takes the middle of its segment
            let s = if layout.m == layout.nu { 0.5 } else { *s };
            let at = layout.control(k, local);
            w[at..at + NU].copy_from_slice(guess.sample(f[k] + s * width).1.as_slice());
        }
        for i in 0..layout.n_inner {
            let s = if layout.has_middle { 0.5 } else { program.transcription.control_points()[i] };
            let at = layout.inner(k, i);
            w[at..at + NX].copy_from_slice(guess.sample(f[k] + s * width).0.as_slice());
        }
    }
    let b = &program.bounds;
    for i in 0..NX {
        if b.initial_lower[i] == b.initial_upper[i] {
            w[i] = b.initial_lower[i];
        }
    }
    w[layout.time] = if program.free_time { guess.final_time() } else { b.final_time_lower };
}

/// Scale of every variable; zero for those that are fixed.
pub(crate) fn variable_scales<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    layout: &Layout,
    out: &mut Vec<f64>,
) {
    out.clear();
    out.resize(layout.n_variables, 1.0);
    for i in 0..layout.controls {
        out[i] = program.scales.state[i % NX];
    }
    for i in layout.controls..layout.middles {
        out[i] = program.scales.control[(i - layout.controls) % NU.max(1)];
    }
    for i in layout.middles..layout.time {
        out[i] = program.scales.state[(i - layout.middles) % NX];
    }
    out[layout.time] = if program.free_time { program.scales.time } else { 0.0 };
    let b = &program.bounds;
    for i in 0..NX {
        if b.initial_lower[i] == b.initial_upper[i] {
            out[i] = 0.0;
        }
    }
}
