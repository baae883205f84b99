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
    pub fn put_farther(
        &mut self,
        surroundings: &Surroundings,
        transition: &Transition,
        seen: &Examination,
    ) -> bool {
        match seen.closest {
            Some(closest) if seen.clearance < 0.0 => {
                self.enlarge(surroundings.keep_outs[closest], -seen.clearance, transition);
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
        let mut again = self.put_farther(surroundings, transition, seen);
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
            self.divide(surroundings);
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

    /// Puts one keep-out's boundary where the chord between two knots on it, as far apart as now, passes the keep-out by, and a little
    /// farther; adds the keep-out if it was not considered. A chord that comes as close as `d` where its nearer knot is `r` away reaches
    /// to the square root of `r^2 - d^2` on that side.
    fn enlarge(&mut self, entered: KeepOut, by: f64, transition: &Transition) {
        let [x, y] = entered.centre;
        let distances = transition.states.iter().map(|state| (state[0] - x).hypot(state[1] - y));
        let nearest = distances.fold(f64::INFINITY, f64::min);
        let reach = (nearest.powi(2) - (entered.radius - by).powi(2)).max(0.0).sqrt();
        let farther = |radius: f64| radius.max(entered.radius.hypot(reach)) + 0.01;
        match self.keep_outs.iter_mut().find(|keep_out| keep_out.centre == entered.centre) {
            Some(keep_out) => keep_out.radius = farther(keep_out.radius),
            None => self.keep_outs.push(KeepOut { radius: farther(entered.radius), ..entered }),
        }
    }

    /// With twice as many segments.
    fn divide(&mut self, surroundings: &Surroundings) {
        self.segments *= 2;
        self.keep_outs = self.as_asked(surroundings);
    }

    /// The keep-outs with their boundaries where they should be again: with other knots, others touch them.
    pub fn as_asked(&self, surroundings: &Surroundings) -> Vec<KeepOut> {
        let asked = |keep_out: &KeepOut| {
            let same = surroundings.keep_outs.iter().find(|other| other.centre == keep_out.centre);
            *same.unwrap_or(keep_out)
        };
        self.keep_outs.iter().map(asked).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mission::{Model, TransitionSettings};
    use crate::plan::SolverStatus;
    use nalgebra::Vector3;
    use quad_dynamics::{Motion, Vehicle, VehicleParameters};

    /// A transition straight east whose knots have these places.
    fn through(places: &[[f64; 2]]) -> Transition {
        Transition {
            model: Model::PointMass,
            duration: 1.0,
            length: 1.0,
            knots: (0..places.len()).map(|i| i as f64).collect(),
            states: places.iter().map(|&[x, y]| vec![x, y, 5.0, 10.0, 0.0, 0.0]).collect(),
            controls: Vec::new(),
            control_nodes: 1,
            status: SolverStatus::Solved,
            iterations: 1,
            dual_residual: 0.0,
            primal_residual: 0.0,
            miss: Miss::default(),
            max_speed: 10.0,
            max_tilt: 0.0,
        }
    }

    /// Where the boundary of a keep-out of 1.5 m around the origin is put when it is entered by so much (m).
    fn pushed(places: &[[f64; 2]], by: f64) -> f64 {
        let keep_out = KeepOut { centre: [0.0, 0.0], radius: 1.5 };
        let surroundings = Surroundings {
            keep_outs: &[keep_out],
            heights: [0.0, 50.0],
            settings: &TransitionSettings::default(),
            most_iterations: None,
        };
        let vehicle = Vehicle::new(VehicleParameters::survey_450()).expect("a preset");
        let seen = Examination {
            end: Motion::hover(&vehicle, Vector3::zeros(), 0.0),
            length: 1.0,
            max_speed: 10.0,
            max_tilt: 0.0,
            clearance: -by,
            closest: Some(0),
            height_violation: 0.0,
            limit_violation: 0.0,
        };
        let mut setting =
            Setting { keep_outs: vec![keep_out], heights: [0.0, 50.0], longest_step: 1.0, segments: 40 };
        assert!(setting.put_farther(&surroundings, &through(places), &seen));
        setting.keep_outs[0].radius
    }

    /// Two knots on the new boundary that lie as far apart as before pass the keep-out by.
    #[test]
    fn a_boundary_is_put_where_chords_pass_by() {
        // a knot beside the keep-out, one inside it, and none within 9 m
        for (east, north) in [(0.0, 1.5), (0.4, 0.2), (9.0, 1.497)] {
            let radius = pushed(&[[-20.0, north], [east, north], [20.0, north]], 1.5 - north.min(1.497));
            let passed = (radius.powi(2) - east.powi(2)).sqrt();
            assert!((1.5..1.6).contains(&passed), "{east} {north}: {radius} m, passed at {passed} m");
        }
    }
}
