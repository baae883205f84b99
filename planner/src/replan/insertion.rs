//! Who takes a target over, and where in its route, by modelled times.

use super::settled::Settled;
use crate::legs::Airspace;
use crate::mission::Objective;
use crate::plan::Plan;
use crate::time_model::TimeModel;

/// A place in a vehicle's open route.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub vehicle: usize,
    pub position: usize,
}

/// The place where a target costs least: first in what the mission minimises, then in added time. `None` if nobody can fly.
pub(super) fn cheapest(
    airspace: &Airspace,
    model: &TimeModel,
    plan: &Plan,
    team: &[Settled],
    usable: &[bool],
    target: usize,
) -> Option<Place> {
    let rounds = Rounds { airspace, model, plan };
    let ends: Vec<f64> =
        (0..team.len()).map(|vehicle| rounds.end(vehicle, &team[vehicle], &team[vehicle].open)).collect();
    let makespan = ends.iter().copied().fold(0.0, f64::max);
    let mut best: Option<([f64; 2], Place)> = None;
    for (vehicle, settled) in team.iter().enumerate().filter(|&(i, settled)| usable[i] && !settled.landed) {
        for position in 0..=settled.open.len() {
            let end = rounds.end(vehicle, settled, &with(&settled.open, position, target));
            let added = end - ends[vehicle];
            let cost = match airspace.mission.objective {
                Objective::Makespan => [end.max(makespan), added],
                Objective::Total => [added, end],
            };
            if best.is_none_or(|(least, _)| cost < least) {
                best = Some((cost, Place { vehicle, position }));
            }
        }
    }
    best.map(|(_, place)| place)
}

/// Moves open circles of the vehicle that is last back to one that can help, as long as that makes the mission shorter.
pub(super) fn relieve(
    airspace: &Airspace,
    model: &TimeModel,
    plan: &Plan,
    team: &mut [Settled],
    helper: usize,
) {
    let rounds = Rounds { airspace, model, plan };
    loop {
        let ends: Vec<f64> =
            (0..team.len()).map(|vehicle| rounds.end(vehicle, &team[vehicle], &team[vehicle].open)).collect();
        let Some(last) = (0..team.len()).max_by(|&a, &b| ends[a].total_cmp(&ends[b])) else { return };
        if last == helper {
            return;
        }
        let mut best = (ends[last] * (1.0 - 1e-9), None);
        for from in 0..team[last].open.len() {
            let mut shorter = team[last].open.clone();
            let circle = shorter.remove(from);
            let left = rounds.end(last, &team[last], &shorter);
            for position in 0..=team[helper].open.len() {
                let longer = with(&team[helper].open, position, circle);
                let end = left.max(rounds.end(helper, &team[helper], &longer));
                if end < best.0 {
                    best = (end, Some((from, position)));
                }
            }
        }
        let Some((from, position)) = best.1 else { return };
        let circle = team[last].open.remove(from);
        team[helper].open.insert(position, circle);
    }
}

/// A route with a circle put in.
fn with(open: &[usize], position: usize, circle: usize) -> Vec<usize> {
    let mut longer = open.to_vec();
    longer.insert(position, circle);
    longer
}

/// Modelled flights from circle to circle.
struct Rounds<'a> {
    airspace: &'a Airspace<'a>,
    model: &'a TimeModel,
    plan: &'a Plan,
}

impl Rounds<'_> {
    /// When a vehicle would be back (s) that flies `open` circles after what is settled.
    fn end(&self, vehicle: usize, settled: &Settled, open: &[usize]) -> f64 {
        if open.is_empty() && settled.here.is_none() {
            return self.plan.vehicles[vehicle].end_time().min(settled.time);
        }
        let pad = self.plan.vehicles[vehicle].pad;
        let mut here = settled.here.map_or([pad[0], pad[1]], |motion| [motion.position.x, motion.position.y]);
        let mut time = settled.time;
        for &circle in open {
            let there = &self.airspace.orbits[circle].circle;
            time += self.leg(here, there.centre, there.speed) + there.duration;
            here = there.centre;
        }
        time + self.leg(here, [pad[0], pad[1]], 0.0)
    }

    fn leg(&self, [ax, ay]: [f64; 2], [bx, by]: [f64; 2], speed: f64) -> f64 {
        self.model.time_over([bx - ax, by - ay], speed)
    }
}
