//! First trajectories for the solver.

use super::examine::{control, well_formed};
use super::flight::Flight;
use super::problem::KeepOut;
use crate::plan::Transition;
use nalgebra::{SVector, UnitQuaternion, Vector3};
use quad_dynamics::Motion;
use quad_dynamics::frames::to_wxyz;
use traj_opt::Guess;

/// Samples of a guess over the flight.
const SAMPLES: usize = 40;
/// How far (m) a guess passes outside a keep-out that stands in its way.
const BERTH: f64 = 0.5;

/// A path from `start` to `end` in `duration` (s): a cubic that meets both velocities (or, if `straight`, the straight line),
/// bent around the keep-outs in its way, while the attitude turns evenly and the thrust holds a hover.
pub(crate) fn guess<const NX: usize, const NU: usize, F: Flight<NX, NU>>(
    flight: &F,
    start: &Motion,
    end: &Motion,
    keep_outs: &[KeepOut],
    duration: f64,
    straight: bool,
    free_yaw: bool,
) -> Guess<NX, NU> {
    let (from, mut to) = (start.attitude, end.attitude);
    if free_yaw {
        // Keep the nose where it is: only the tilt must go.
        let (_, _, yaw) = from.euler_angles();
        let turned = UnitQuaternion::from_euler_angles(0.0, 0.0, yaw);
        to = if end.tilt() == 0.0 { turned } else { end.attitude * turned };
    }
    let position = |s: f64| {
        let point =
            if straight { start.position.lerp(&end.position, s) } else { cubic(start, end, duration, s) };
        around(point, start, end, keep_outs)
    };
    let (first, last) = (flight.state(start), flight.state(end));
    let control = flight.hover_control();
    Guess::from_fn(duration, SAMPLES, |s| {
        // Whatever else the model's state holds goes evenly from one end to the other.
        let mut state: SVector<f64, NX> = first * (1.0 - s) + last * s;
        let (p, step) = (position(s), 1e-4);
        let (before, after) = ((s - step).max(0.0), (s + step).min(1.0));
        let (back, ahead) = (position(before), position(after));
        for axis in 0..3 {
            state[axis] = p[axis];
            if !straight {
                state[3 + axis] = (ahead[axis] - back[axis]) / ((after - before) * duration);
            }
        }
        if let Some(q) = F::ATTITUDE {
            let turned = from.try_slerp(&to, s, 1e-9).unwrap_or(from);
            state.fixed_rows_mut::<4>(q).copy_from(&to_wxyz(&turned));
        }
        (state, control)
    })
}

/// A solved transition, bent so that it ends in another motion: the difference at the end is spread over the flight with
/// the square of time, so that the start stays as it is. `None` if its arrays do not fit the model.
pub(crate) fn bent<const NX: usize, const NU: usize, F: Flight<NX, NU>>(
    flight: &F,
    neighbour: &Transition,
    end: &Motion,
) -> Option<Guess<NX, NU>> {
    if !well_formed(neighbour, NX, NU) {
        return None;
    }
    let states: Vec<SVector<f64, NX>> =
        neighbour.states.iter().map(|state| SVector::from_column_slice(state)).collect();
    let last = states[states.len() - 1];
    let mut wanted = flight.state(end);
    if let Some(q) = F::ATTITUDE
        && wanted.fixed_rows::<4>(q).dot(&last.fixed_rows::<4>(q)) < 0.0
    {
        // The same attitude, on the side of the double cover where the neighbour ends.
        let flipped = -wanted.fixed_rows::<4>(q);
        wanted.fixed_rows_mut::<4>(q).copy_from(&flipped);
    }
    let fractions: Vec<f64> = neighbour.knots.iter().map(|knot| knot / neighbour.duration).collect();
    let bend = |(state, s): (SVector<f64, NX>, &f64)| {
        let mut state = state + (wanted - last) * (s * s);
        if let Some(q) = F::ATTITUDE {
            let norm = state.fixed_rows::<4>(q).norm().max(f64::MIN_POSITIVE);
            state.fixed_rows_mut::<4>(q).unscale_mut(norm);
        }
        state
    };
    let states: Vec<SVector<f64, NX>> = states.into_iter().zip(&fractions).map(bend).collect();
    let segments = neighbour.knots.len() - 1;
    let controls = (0..=segments).map(|k| control(neighbour, k.min(segments - 1), 0.0)).collect();
    Guess::from_samples(neighbour.duration, fractions, states, controls).ok()
}

/// The cubic Hermite curve through both positions with both velocities.
fn cubic(start: &Motion, end: &Motion, duration: f64, s: f64) -> Vector3<f64> {
    let (a, b) = ((1.0 + 2.0 * s) * (1.0 - s).powi(2), s * (1.0 - s).powi(2));
    let (c, d) = (s * s * (3.0 - 2.0 * s), s * s * (s - 1.0));
    start.position * a + start.velocity * (b * duration) + end.position * c + end.velocity * (d * duration)
}

/// Pushes a point out of every keep-out, away from its centre: to the side on which the centre does not lie.
fn around(point: Vector3<f64>, start: &Motion, end: &Motion, keep_outs: &[KeepOut]) -> Vector3<f64> {
    let (mut x, mut y) = (point.x, point.y);
    let chord = [end.position[0] - start.position[0], end.position[1] - start.position[1]];
    let length = chord[0].hypot(chord[1]);
    for keep_out in keep_outs {
        let (dx, dy) = (x - keep_out.centre[0], y - keep_out.centre[1]);
        let wanted = keep_out.radius + BERTH;
        let away = dx.hypot(dy);
        if away >= wanted || length == 0.0 {
            continue;
        }
        // The whole chord passes on one side of the centre: the side on which its nearest point lies.
        let normal = [-chord[1] / length, chord[0] / length];
        let offset = normal[0] * (start.position[0] - keep_out.centre[0])
            + normal[1] * (start.position[1] - keep_out.centre[1]);
        let side = if offset < 0.0 { -1.0 } else { 1.0 };
        let across = normal[0] * dx + normal[1] * dy;
        let along_squared = (away * away - across * across).max(0.0);
        let push = side * (wanted * wanted - along_squared).max(0.0).sqrt() - across;
        x += normal[0] * push;
        y += normal[1] * push;
    }
    Vector3::new(x, y, point.z)
}
