//! Leg times by distance alone, calibrated on transitions that are solved before anything is allocated.
//!
//! A few short routes are tried from the depot and back: circles that lie close together, entries by the whole-route model, every leg
//! sketched once. The least-squares line through their times stands for all legs.
//!
//! Solved legs scatter around any function of the distance alone, since entries and exits move them: example `leg_times`, 92 legs of
//! 2.2 to 2.3 s among 100 targets in 300 m x 300 m, is off by 0.25 s (root mean square) and at most 0.58 s where every leg is the fastest
//! by itself, by 0.09 s and at most 0.50 s where entries are chosen for whole routes.

use crate::legs::Airspace;
use crate::threads::side_by_side;
use crate::transition::{Detail, Goal, Hint};
use quad_dynamics::Motion;

/// Routes that are tried, and the circles of each.
const ROUTES: usize = 4;
const STOPS: usize = 4;

/// `t = offset + slope m`, where `m` (s) is the least time for the distance at loiter speed, and `depot` (s) more where a leg starts or
/// ends on a pad.
///
/// In still air `m` is an increasing and concave function of the distance, a metric, and 0 at 0. With `offset >= 0`, `slope > 0` and
/// `2 depot + offset >= 0` the times satisfy the triangle inequality, so Christofides' bound holds for them: `f(x + y) + f(0) <= f(x) + f(y)`
/// for a concave `f`, so a detour over a circle or over the depot takes no less than the direct leg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LegModel {
    offset: f64,
    slope: f64,
    depot: f64,
}

/// A leg that was solved: its least time at loiter speed, what it took (s), and whether it starts or ends on a pad.
#[derive(Debug, Clone, Copy)]
struct Solved {
    least: f64,
    time: f64,
    at_depot: bool,
}

impl LegModel {
    /// The model of a mission, whose least times (s) between nodes are given: 0 for the depot, `i + 1` for circle `i`.
    pub(crate) fn calibrated(airspace: &Airspace, least: impl Fn(usize, usize) -> f64 + Sync) -> Self {
        let routes = routes(airspace);
        let solved = side_by_side(&routes, |route| airspace.try_route(route, &least));
        Self::fitted(&solved.concat())
    }

    /// The least-squares fit to all legs at once: the slope that legs between circles and those of the depot share, about the mean of
    /// either. What they do not determine is as for the least times.
    fn fitted(solved: &[Solved]) -> Self {
        let groups = [false, true].map(|at_depot| solved.iter().filter(move |leg| leg.at_depot == at_depot));
        let [between, depot] = groups.clone().map(|group| {
            let n = group.clone().count().max(1) as f64;
            [|leg: &Solved| leg.least, |leg: &Solved| leg.time]
                .map(|of| group.clone().map(of).sum::<f64>() / n)
        });
        let (mut spread, mut rise) = (0.0, 0.0);
        for (group, [least, time]) in groups.into_iter().zip([between, depot]) {
            for leg in group {
                spread += (leg.least - least).powi(2);
                rise += (leg.least - least) * (leg.time - time);
            }
        }
        let slope = if rise > 0.0 { rise / spread } else { 1.0 };
        let excess = |[least, time]: [f64; 2]| time - slope * least;
        let offset = excess(between).max(0.0);
        Self { offset, slope, depot: (excess(depot) - offset).max(-0.5 * offset) }
    }

    /// About how long a leg takes whose least time at loiter speed is given (s).
    pub(crate) fn time(&self, least: f64, at_depot: bool) -> f64 {
        self.offset + self.slope * least + if at_depot { self.depot } else { 0.0 }
    }
}

/// Routes of circles that lie close to each other, begun all over the mission; every circle in one of them at most.
fn routes(airspace: &Airspace) -> Vec<Vec<usize>> {
    let orbits = airspace.orbits;
    let n = orbits.len();
    let mut is_open = vec![true; n];
    let distance = |a: usize, b: usize| {
        let [[a, b], [x, y]] = [orbits[a].circle.centre, orbits[b].circle.centre];
        (x - a).hypot(y - b)
    };
    let mut routes = Vec::new();
    for start in (0..ROUTES).map(|route| route * n / ROUTES) {
        let mut route = Vec::new();
        let mut next = (start..n).find(|&circle| is_open[circle]);
        while let Some(circle) = next.filter(|_| route.len() < STOPS) {
            is_open[circle] = false;
            route.push(circle);
            let open = (0..n).filter(|&other| is_open[other]);
            next = open.min_by(|&a, &b| distance(circle, a).total_cmp(&distance(circle, b)));
        }
        routes.push(route);
    }
    routes
}

impl Airspace<'_> {
    /// The legs of a route with entries by the model of whole routes, as far as they can be sketched.
    fn try_route(&self, route: &[usize], least: impl Fn(usize, usize) -> f64) -> Vec<Solved> {
        let Some(&first) = route.first() else { return Vec::new() };
        let [x, y] = self.orbits[first].circle.centre;
        let distance = |pad: &[f64; 3]| (pad[0] - x).hypot(pad[1] - y);
        let pads = self.mission.pads();
        let Some(&pad) = pads.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))) else {
            return Vec::new();
        };
        let (entries, _) = self.shortest_path(pad, route, &self.time_model());
        let mut here = self.take_off(pad, route);
        let mut solved = Vec::new();
        let mut sketch = |from: &Motion, to: Motion, goal: Goal, nodes: [usize; 2]| {
            let hint = Hint::Time(self.least_time(from, &to));
            let sketch = self.pilot.draft(from, goal, &to, hint, (Detail::Sketch, f64::INFINITY));
            if let Ok(sketch) = sketch {
                let least = least(nodes[0], nodes[1]);
                solved.push(Solved { least, time: sketch.time, at_depot: nodes.contains(&0) });
            }
        };
        let mut node = 0;
        for (&circle, entry) in route.iter().zip(entries) {
            let orbit = &self.orbits[circle];
            let there = orbit.at(entry);
            sketch(&here, there, Goal::Motion(there), [node, circle + 1]);
            (here, node) = (orbit.exit(entry), circle + 1);
        }
        let home = self.landing(pad);
        sketch(&here, home, Goal::Hover(home), [node, 0]);
        solved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leg(least: f64, time: f64, at_depot: bool) -> Solved {
        Solved { least, time, at_depot }
    }

    #[test]
    fn a_line_and_a_constant_are_recovered() {
        let solved = [leg(1.0, 1.7, false), leg(3.0, 4.1, false), leg(5.0, 7.2, true), leg(4.0, 6.0, true)];
        let model = LegModel::fitted(&solved);
        for leg in solved {
            assert!((model.time(leg.least, leg.at_depot) - leg.time).abs() < 1e-12, "{model:?}");
        }
    }

    #[test]
    fn what_legs_do_not_determine_keeps_the_triangle_inequality() {
        let least = LegModel { offset: 0.0, slope: 1.0, depot: 0.0 };
        assert_eq!(LegModel::fitted(&[]), least);
        assert_eq!(LegModel::fitted(&[leg(2.0, 3.5, true)]), LegModel { depot: 1.5, ..least });
        // One leg, falling times, a line below 0, depot legs that are much faster than others.
        for solved in [
            vec![leg(2.0, 3.0, false)],
            vec![leg(1.0, 4.0, false), leg(2.0, 3.0, false)],
            vec![leg(1.0, 0.5, false), leg(2.0, 3.0, false)],
            vec![leg(1.0, 2.0, false), leg(2.0, 3.0, false), leg(2.0, 0.5, true)],
            vec![leg(0.0, 0.0, false), leg(0.0, 0.0, false)],
        ] {
            let model = LegModel::fitted(&solved);
            assert!(model.offset >= 0.0 && model.slope > 0.0, "{model:?}");
            assert!(2.0 * model.depot + model.offset >= 0.0, "{model:?}");
        }
    }
}
