//! What may change from one solve of a transition to the next, and how it gets stricter.

use super::examine::Examination;
use super::problem::KeepOut;
use super::solve::Surroundings;
use crate::mission::Transcription;
use crate::plan::{Miss, Transition};

/// Misses (m, m/s, rad) above this are worth a finer integration inside the transcription: a tenth of what is tolerated.
const GOOD_MISS: Miss = Miss { position: 0.005, velocity: 0.005, attitude: 0.002 };
/// Overstepping of heights and limits between knots that is worth another solve (m, rad/s, share of a limit).
const GOOD_BOUND: f64 = 0.002;
/// By how much a step is shorter than what the miss of the one before asks for.
const SAFETY: f64 = 1.2;

/// What a transition is solved with.
pub(super) struct Setting {
    /// Those that are considered, with the radii that are kept.
    pub keep_outs: Vec<KeepOut>,
    /// Least and greatest height (m).
    pub heights: [f64; 2],
    /// Longest Runge-Kutta step (s).
    pub longest_step: f64,
    pub segments: usize,
}

impl Setting {
    /// Runge-Kutta steps a segment, where segments last `uniform` (s) on average; the longest about half as long again.
    pub fn substeps(&self, uniform: f64) -> usize {
        (1.5 * uniform / self.longest_step).ceil().clamp(1.0, 64.0) as usize
    }

    /// Puts the keep-out that is entered farthest away; false if none is entered.
    pub fn put_farther(&mut self, surroundings: &Surroundings, seen: &Examination) -> bool {
        match seen.closest {
            Some(closest) if seen.clearance < 0.0 => {
                self.enlarge(surroundings.keep_outs[closest], -seen.clearance);
                true
            }
            _ => false,
        }
    }

    /// Makes the setting stricter where the examination saw something overstepped, with at most `most_segments`; false if there was
    /// nothing.
    pub fn adjust(
        &mut self,
        surroundings: &Surroundings,
        most_segments: usize,
        transition: &Transition,
        seen: &Examination,
    ) -> bool {
        let mut again = self.put_farther(surroundings, seen);
        // A collocation scheme is judged by its own equations, and its miss is what the caller asked to see.
        if surroundings.settings.transcription != Transcription::RungeKutta {
            return again;
        }
        if seen.height_violation > GOOD_BOUND {
            self.heights = narrowed(self.heights, surroundings.heights, seen.height_violation);
            again = true;
        }
        if seen.limit_violation > GOOD_BOUND && self.segments < most_segments {
            // Between knots a limit is overstepped by the square of their distance.
            self.segments *= 2;
            again = true;
        }
        if excess(&transition.miss) > 1.0 {
            self.longest_step = self.finer_step(transition);
            again = true;
        }
        again
    }

    /// The longest Runge-Kutta step (s) with which the integrated controls should lead where they must: the miss falls with the
    /// fourth power of the step. At least one step more for each segment.
    fn finer_step(&self, transition: &Transition) -> f64 {
        let uniform = transition.duration / self.segments as f64;
        let step = 1.5 * uniform / self.substeps(uniform) as f64;
        step / (SAFETY * excess(&transition.miss).max(1.0).powf(0.25))
    }

    /// Pushes one keep-out's boundary outwards by what it was entered, and a little more; adds it if it was not considered.
    fn enlarge(&mut self, entered: KeepOut, by: f64) {
        let margin = 1.3 * by + 0.01;
        match self.keep_outs.iter_mut().find(|keep_out| keep_out.centre == entered.centre) {
            Some(keep_out) => keep_out.radius += margin,
            None => self.keep_outs.push(KeepOut { radius: entered.radius + margin, ..entered }),
        }
    }
}

/// A miss over what is good enough; infinite if it is not a number.
fn excess(miss: &Miss) -> f64 {
    let Miss { position, velocity, attitude } = *miss;
    let parts = [position / GOOD_MISS.position, velocity / GOOD_MISS.velocity, attitude / GOOD_MISS.attitude];
    parts.into_iter().fold(0.0, |worst, part| if part.is_nan() { f64::INFINITY } else { worst.max(part) })
}

/// Height limits drawn in by what was overstepped, but never by more than a tenth of their range.
fn narrowed(heights: [f64; 2], wanted: [f64; 2], by: f64) -> [f64; 2] {
    let most = 0.1 * (wanted[1] - wanted[0]);
    [(heights[0] + by).min(wanted[0] + most), (heights[1] - by).max(wanted[1] - most)]
}
