//! Planned against flown.

use nalgebra::{SVector, Vector3};

use crate::motion::Motion;

/// How well a plan was followed (what Fig. 9 of Gao, Mandal and Bhattacharya 2020 compares).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Tracking {
    /// Root mean square of the distance to where the vehicle should be at that time, m.
    pub rms_error: f64,
    /// Greatest such distance, m.
    pub max_error: f64,
    /// Root mean square of the distance to the planned path, m.
    pub rms_cross_track: f64,
    /// Greatest distance to the planned path, m.
    pub max_cross_track: f64,
    /// Mean time by which the vehicle is late at the nearest place of the path, s; negative if early.
    pub time_lag: f64,
    /// Flown length over planned length, minus 1; 0 for a plan without length.
    pub extra_length: f64,
    /// Share of the plan's time that was flown with finite states: 1, or less if the flight broke off.
    pub completed: f64,
}

/// How far around the planned time the nearest place of the path is looked for, s.
const WINDOW: f64 = 1.0;
/// Slower than this the time at the nearest place means nothing, m/s.
const LEAST_SPEED: f64 = 0.2;

impl Tracking {
    /// Compares recorded states, every `record_every` plan samples of `step` seconds, with the plan.
    pub(super) fn new(plan: &[Motion], states: &[SVector<f64, 17>], record_every: usize, step: f64) -> Self {
        let interval = step * record_every as f64;
        let planned: Vec<Vector3<f64>> =
            plan.iter().step_by(record_every).map(|motion| motion.position).collect();
        let flown: Vec<Vector3<f64>> =
            states.iter().map(|state| state.fixed_rows::<3>(0).into_owned()).collect();
        let n_finite = flown.iter().take_while(|p| p.iter().all(|x| x.is_finite())).count();
        let flown = &flown[..n_finite];
        let reach = (WINDOW / interval).ceil().max(1.0) as usize;
        let mut sums = [0.0; 2];
        let mut greatest = [0.0_f64; 2];
        let (mut lag, mut n_moving) = (0.0, 0.0);
        for (i, position) in flown.iter().enumerate() {
            let error = (position - planned[i]).norm();
            let (cross, place) = nearest(&planned, i, reach, position);
            for (k, value) in [error, cross].into_iter().enumerate() {
                sums[k] += value * value;
                greatest[k] = greatest[k].max(value);
            }
            if plan[i * record_every].velocity.norm() > LEAST_SPEED {
                lag += (i as f64 - place) * interval;
                n_moving += 1.0;
            }
        }
        let mean = |sum: f64, n: f64| if n > 0.0 { sum / n } else { 0.0 };
        let n = flown.len() as f64;
        let planned_length = length(&planned[..n_finite]);
        Self {
            rms_error: mean(sums[0], n).sqrt(),
            max_error: greatest[0],
            rms_cross_track: mean(sums[1], n).sqrt(),
            max_cross_track: greatest[1],
            time_lag: mean(lag, n_moving),
            extra_length: if planned_length > 0.0 { length(flown) / planned_length - 1.0 } else { 0.0 },
            completed: n / planned.len() as f64,
        }
    }
}

/// Distance to the polyline near point `i`, and where on it (in points).
fn nearest(path: &[Vector3<f64>], i: usize, reach: usize, position: &Vector3<f64>) -> (f64, f64) {
    let last = path.len() - 1;
    let mut best = ((position - path[i]).norm(), i as f64);
    for k in i.saturating_sub(reach)..i.saturating_add(reach).min(last) {
        let edge = path[k + 1] - path[k];
        let squared = edge.norm_squared();
        let share =
            if squared > 0.0 { ((position - path[k]).dot(&edge) / squared).clamp(0.0, 1.0) } else { 0.0 };
        let distance = (position - path[k] - edge * share).norm();
        if distance < best.0 {
            best = (distance, k as f64 + share);
        }
    }
    best
}

fn length(path: &[Vector3<f64>]) -> f64 {
    path.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
}
