//! The middle of a long flight, which is the same for all that lead from circle to circle.
//!
//! Between speeding up and slowing down a fast flight over a long way cruises: straight, level, at full thrust, at the speed where
//! drag takes all that the weight leaves. Both ends approach that cruise exponentially within some lengths `1/k` of the drag, and
//! know nothing of each other. So a long flight is sketched without its middle: the end is moved towards the start along the line
//! between them, which leaves the direction of the cruise as it is, and the time of the middle is added.

use super::flight::Flight;
use super::problem::{Goal, KeepOut};
use super::solve::{self, Detail, Draft, Hint, Surroundings, Unsolved};
use crate::bound::Agility;
use crate::plan::Transition;
use nalgebra::Vector3;
use quad_dynamics::{GRAVITY, Motion};

/// How much of a flight is never left out, in lengths `1/k` of its drag `k |v| v`: from rest a vehicle is at 99.8 % of its greatest
/// speed after three of them, and braking takes less than one.
const KEPT: f64 = 4.0;
/// A middle shorter than this share of what is kept stays in.
const WORTHWHILE: f64 = 0.2;

/// A straight, level stretch at the greatest speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cruise {
    /// Where it leads (m).
    by: Vector3<f64>,
    /// How long it takes (s).
    time: f64,
    /// Length of what is flown before it, and after it (m).
    each_end: f64,
}

/// What [`solve::draft`] finds; a long flight is sketched without its cruise, and drafted from such a sketch if there is no neighbour.
pub(super) fn draft<const NX: usize, const NU: usize, F: Flight<NX, NU>>(
    flight: &F,
    start: &Motion,
    goal: Goal,
    towards: &Motion,
    hint: Hint,
    surroundings: &Surroundings,
    (detail, to_beat): (Detail, f64),
) -> Result<Draft, Unsolved> {
    let whole = |hint| solve::draft(flight, start, goal, towards, hint, surroundings, (detail, to_beat));
    let cruise = flight.agility().and_then(|agility| Cruise::between(&agility, start, towards));
    let Some((cruise, nearer)) = cruise.and_then(|cruise| Some((cruise, cruise.goal(goal)?))) else {
        return whole(hint);
    };
    let keep_outs = cruise.keep_outs(start, surroundings.keep_outs);
    let surroundings = Surroundings { keep_outs: &keep_outs, ..*surroundings };
    let sketch = |hint, to_beat: f64| {
        let (towards, how) = (cruise.nearer(towards), (Detail::Sketch, to_beat - cruise.time));
        let mut draft = solve::draft(flight, start, nearer, &towards, hint, &surroundings, how)?;
        draft.transition = cruise.inserted(draft.transition);
        draft.time += cruise.time;
        Ok::<_, Unsolved>(draft)
    };
    match (detail, hint) {
        (Detail::Sketch, Hint::Time(about)) => sketch(Hint::Time((about - cruise.time).max(0.0)), to_beat),
        (Detail::Sketch, Hint::Neighbour(it)) => sketch(Hint::Neighbour(&cruise.removed(it)), to_beat),
        // A sketch without the cruise is no solution on a coarser mesh.
        (_, Hint::Sketch(sketch)) => whole(Hint::Neighbour(&sketch.transition)),
        (Detail::Full, Hint::Neighbour(_)) => whole(hint),
        (Detail::Full, Hint::Time(about)) => {
            let sketch = sketch(Hint::Time((about - cruise.time).max(0.0)), f64::INFINITY);
            whole(sketch.as_ref().map_or(hint, |sketch| Hint::Neighbour(&sketch.transition)))
        }
    }
}

impl Cruise {
    /// What a flight may be sketched without; `None` if it is too short for that, or nothing is known of its cruise.
    fn between(agility: &Agility, start: &Motion, end: &Motion) -> Option<Self> {
        let [_, thrust] = agility.thrust;
        let mut offset = end.position - start.position;
        offset.z = 0.0;
        let kept = KEPT / agility.drag;
        let length = offset.norm() - kept;
        if length.is_nan() || length < WORTHWHILE * kept || thrust <= GRAVITY {
            return None;
        }
        let direction = offset.normalize();
        let squared = (thrust * thrust - GRAVITY * GRAVITY).sqrt() / agility.drag;
        let wind = Vector3::from(agility.wind);
        let along = wind.dot(&direction);
        let across = wind - direction * along;
        let speed = along + (squared - across.norm_squared()).max(0.0).sqrt();
        (speed > 0.0).then(|| Self { by: direction * length, time: length / speed, each_end: 0.5 * kept })
    }

    /// The end of the flight without it.
    fn nearer(&self, end: &Motion) -> Motion {
        end.translated(&-self.by)
    }

    /// The goal of the flight without it; `None` for a circle, which is not moved.
    fn goal<'a>(&self, goal: Goal<'a>) -> Option<Goal<'a>> {
        match goal {
            Goal::Motion(end) => Some(Goal::Motion(self.nearer(&end))),
            Goal::Hover(end) => Some(Goal::Hover(self.nearer(&end))),
            Goal::Circle(..) => None,
        }
    }

    /// The keep-outs of the flight without it: those beyond it nearer, those beside it left out.
    fn keep_outs(&self, start: &Motion, keep_outs: &[KeepOut]) -> Vec<KeepOut> {
        let length = self.by.norm();
        let moved = |keep_out: &KeepOut| {
            let [x, y] = keep_out.centre;
            let (dx, dy) = (x - start.position.x, y - start.position.y);
            let along = (dx * self.by.x + dy * self.by.y) / length;
            if along < self.each_end {
                Some(*keep_out)
            } else if along > self.each_end + length {
                Some(KeepOut { centre: [x - self.by.x, y - self.by.y], ..*keep_out })
            } else {
                None
            }
        };
        keep_outs.iter().filter_map(moved).collect()
    }

    /// A flight without it as the flight with it: the segment in the middle of its time is lengthened.
    fn inserted(&self, mut transition: Transition) -> Transition {
        let half = 0.5 * transition.duration;
        let after = transition.knots.partition_point(|&knot| knot <= half);
        transition.knots[after..].iter_mut().for_each(|knot| *knot += self.time);
        transition.states[after..].iter_mut().for_each(|state| self.shift(state, 1.0));
        transition.duration += self.time;
        transition.length += self.by.norm();
        transition
    }

    /// A flight as one without it: what lies as far from the middle of its time is left out.
    fn removed(&self, transition: &Transition) -> Transition {
        let mut shorter = transition.clone();
        let middle = 0.5 * transition.duration;
        // A knot in the middle of a flight into which the cruise was inserted is where it was but for rounding, and stays.
        let rounding = 1e-12 * transition.duration;
        let [first, last] = [middle - 0.5 * self.time + rounding, middle + 0.5 * self.time];
        let before = transition.knots.partition_point(|&knot| knot <= first);
        let after = transition.knots.partition_point(|&knot| knot <= last);
        if before == 0 || after == transition.knots.len() {
            return shorter;
        }
        shorter.knots.drain(before..after);
        shorter.states.drain(before..after);
        let n = transition.control_nodes;
        shorter.controls.drain(before * n..after * n);
        shorter.knots[before..].iter_mut().for_each(|knot| *knot -= self.time);
        shorter.states[before..].iter_mut().for_each(|state| self.shift(state, -1.0));
        shorter.duration -= self.time;
        shorter
    }

    fn shift(&self, state: &mut [f64], times: f64) {
        for (value, by) in state.iter_mut().zip(self.by.iter()) {
            *value += times * by;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mission::Model;
    use crate::plan::{Miss, SolverStatus};
    use quad_dynamics::{Vehicle, VehicleParameters};

    const AGILITY: Agility = Agility { thrust: [1.0, 17.66], drag: 0.05, turn_rate: 8.0, wind: [0.0; 3] };

    fn at(x: f64) -> Motion {
        let vehicle = Vehicle::new(VehicleParameters::survey_450()).unwrap();
        Motion::hover(&vehicle, [x, 0.0, 2.0].into(), 0.0)
    }

    #[test]
    fn only_long_flights_have_a_cruise_and_wind_changes_its_time() {
        assert_eq!(Cruise::between(&AGILITY, &at(0.0), &at(90.0)), None);
        assert_eq!(Cruise::between(&Agility { drag: 0.0, ..AGILITY }, &at(0.0), &at(900.0)), None);
        assert_eq!(Cruise::between(&Agility { thrust: [1.0, 9.0], ..AGILITY }, &at(0.0), &at(900.0)), None);
        let still = Cruise::between(&AGILITY, &at(0.0), &at(180.0)).unwrap();
        assert_eq!(still.by, Vector3::new(100.0, 0.0, 0.0));
        let speed = ((17.66f64.powi(2) - GRAVITY * GRAVITY).sqrt() / 0.05).sqrt();
        assert!((still.time - 100.0 / speed).abs() < 1e-9);
        let tail =
            Cruise::between(&Agility { wind: [3.0, 0.0, 0.0], ..AGILITY }, &at(0.0), &at(180.0)).unwrap();
        assert!((tail.time - 100.0 / (speed + 3.0)).abs() < 1e-9);
    }

    #[test]
    fn what_is_inserted_can_be_removed() {
        let cruise = Cruise::between(&AGILITY, &at(0.0), &at(180.0)).unwrap();
        let short = Transition {
            model: Model::PointMass,
            duration: 4.0,
            length: 80.0,
            knots: vec![0.0, 1.0, 2.0, 3.5, 4.0],
            states: [0.0, 10.0, 40.0, 70.0, 80.0].map(|x| vec![x, 0.0, 2.0, 1.0, 0.0, 0.0]).to_vec(),
            controls: [1.0, 2.0, 3.0, 4.0].map(|force| vec![force, 0.0, 0.0]).to_vec(),
            control_nodes: 1,
            status: SolverStatus::Solved,
            iterations: 0,
            dual_residual: 0.0,
            primal_residual: 0.0,
            miss: Miss::default(),
            max_speed: 0.0,
            max_tilt: 0.0,
        };
        let long = cruise.inserted(short.clone());
        assert_eq!(long.states[4][0], 180.0);
        let again = cruise.removed(&long);
        assert_eq!((again.states, again.controls), (short.states, short.controls));
        assert!(again.knots.iter().zip(&short.knots).all(|(a, b)| (a - b).abs() < 1e-9));
    }

    #[test]
    fn keep_outs_beside_the_cruise_are_left_out() {
        let cruise = Cruise::between(&AGILITY, &at(0.0), &at(180.0)).unwrap();
        let there = [10.0, 90.0, 175.0].map(|x| KeepOut { centre: [x, 1.0], radius: 2.0 });
        let left: Vec<_> = cruise.keep_outs(&at(0.0), &there).iter().map(|it| it.centre).collect();
        assert_eq!(left, [[10.0, 1.0], [75.0, 1.0]]);
    }
}
