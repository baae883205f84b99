//! How fast a vehicle can possibly be through the air on the way, for the bound in `agility.rs`.
//!
//! With thrust over mass at most `f` and the drag `-k |v| v`, the horizontal and the vertical speed obey, in time,
//!
//! ```text
//!     |v_h|' <= f - k |v_h|^2,         up: v_z' <= f - g,      down: -v_z' <= f + g,
//! ```
//!
//! and, backwards from the end, where drag has helped to slow down and `W` bounds `|v|`,
//!
//! ```text
//!     d|v_h|/dq <= f + k W |v_h|,      up: dv_z/dq <= f + g + k W v_z,      down: -dv_z/dq <= f - g + k W |v_z|.
//! ```
//!
//! `|v|` itself never exceeds the larger of its first value and `sqrt((f + g)/k)`, by `|v|' <= f + g - k |v|^2`. By the
//! comparison theorem the solutions of the equalities are bounds.

use super::agility::{Agility, Passage};
use quad_dynamics::GRAVITY;

/// Bounds on the speed by time and time to go, tabulated: a look-up takes the next entry, which is never smaller.
#[derive(Debug, Clone)]
pub(super) struct Speeds {
    /// Never exceeded (m/s).
    top: f64,
    /// Between two entries (s).
    step: f64,
    /// Horizontal, upward and downward speed (m/s) reached so long after the start.
    reached: Vec<[f64; 3]>,
    /// The same, slowed down in time when so much is left.
    slowed: Vec<[f64; 3]>,
    /// About how fast along the offset a good flight is (m/s), so long after the start and before the end.
    likely: [Vec<f64>; 2],
}

/// What is known of the speed at one moment.
#[derive(Debug, Clone, Copy)]
pub(super) struct Speed {
    /// Never exceeded (m/s).
    pub most: f64,
    /// A guess (m/s), whether the flight speeds up or cruises there; `None` while it slows down.
    pub likely: Option<f64>,
}

/// Entries of a table.
const ENTRIES: usize = 200;

impl Speeds {
    /// Tables up to `horizon` (s); later moments have the bound of no time at all.
    pub(super) fn new(agility: &Agility, passage: &Passage, horizon: f64) -> Self {
        let Agility { thrust: [_, thrust], drag, .. } = *agility;
        let top = ((thrust + GRAVITY) / drag).sqrt().max(passage.velocities[0].norm());
        let [start, end] = passage.velocities.map(|v| [v.xy().norm(), v.z.max(0.0), (-v.z).max(0.0)]);
        // The model may not hover; then nothing accelerates it upwards.
        let (surplus, deficit) = ((thrust - GRAVITY).max(0.0), thrust + GRAVITY);
        let terminal = (thrust / drag).sqrt();
        let head_start = (start[0] / terminal).atanh();
        let reached = |time: f64| {
            let horizontal = if drag <= 0.0 {
                start[0] + thrust * time
            } else if head_start.is_finite() {
                terminal * (head_start + time * (thrust * drag).sqrt()).tanh()
            } else {
                start[0]
            };
            [horizontal, start[1] + surplus * time, start[2] + deficit * time]
        };
        let slowed_from = |top: f64, left: f64| {
            let rate = drag * top;
            let growth = (rate * left).exp_m1();
            let lasting = if drag > 0.0 { growth / rate } else { left };
            [(end[0], thrust), (end[1], deficit), (end[2], surplus)].map(|(last, push)| {
                if drag > 0.0 { last * (1.0 + growth) + push * lasting } else { last + push * left }
            })
        };
        // First with the speed that is never exceeded, then with what that leaves.
        let slowed = |left: f64| slowed_from(size(slowed_from(top, left)).min(top), left);
        let step = horizon / ENTRIES as f64;
        // Thrust that also carries the weight, along the offset; slowing down, drag helps.
        let level = (thrust * thrust - GRAVITY * GRAVITY).max(0.0).sqrt();
        let along = passage.offset(horizon).try_normalize(0.0).unwrap_or_default();
        let [s_0, s_1] = passage.velocities.map(|v| v.dot(&along));
        let march = |first: f64, sign: f64| {
            let mut s = first;
            (0..=ENTRIES)
                .map(|_| {
                    let now = s;
                    s += step * (level - sign * drag * s * s.abs()).max(0.0);
                    now
                })
                .collect()
        };
        let likely = [march(s_0, 1.0), march(s_1, -1.0)];
        let times = || (0..=ENTRIES).map(|i| i as f64 * step);
        Self {
            top,
            step,
            reached: times().map(reached).collect(),
            slowed: times().map(slowed).collect(),
            likely,
        }
    }

    /// The speed in a span of the time to go (s) that ends with the flight of `time` (s) at the latest.
    pub(super) fn within(&self, [from, to]: [f64; 2], time: f64) -> Speed {
        let index = |time: f64| (time / self.step).ceil() as usize;
        let entry =
            |table: &[[f64; 3]], time: f64| table.get(index(time)).copied().unwrap_or([f64::INFINITY; 3]);
        let (reached, slowed) = (entry(&self.reached, time - from), entry(&self.slowed, to));
        let most = size(std::array::from_fn(|i| slowed[i].min(reached[i]))).min(self.top);
        let guess = |table: &[f64], time: f64| table.get(index(time)).copied().unwrap_or(f64::INFINITY);
        let [before, after] = [guess(&self.likely[0], time - to), guess(&self.likely[1], from)];
        Speed { most, likely: (before < after).then_some(before.clamp(0.0, most)) }
    }
}

fn size([horizontal, up, down]: [f64; 3]) -> f64 {
    horizontal.hypot(up.max(down))
}
