//! Who takes a target over, and where in its route, by modelled times.

use super::settled::Settled;
use crate::legs::Airspace;
use crate::mission::Objective;
use crate::plan::{Plan, VehiclePlan};
use crate::sorties::pause;
use crate::time_model::TimeModel;

/// What a circle's move from flight to flight must save to be made (s): solved legs scatter by a few tenths of a second.
const WORTHWHILE: f64 = 0.25;

/// A place in a flight's open route.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub flight: usize,
    pub position: usize,
}

/// Modelled flights of a team under way.
pub(super) struct Rounds<'a> {
    pub airspace: &'a Airspace<'a>,
    pub model: &'a TimeModel,
    /// A flight that takes longer (s) is too long for endurance or battery.
    pub limit: f64,
}

/// When a flight ends, and whether it is too long.
#[derive(Debug, Clone, Copy)]
struct Round {
    end: f64,
    /// Whether it begins or goes on at all after what is settled, or has been flown.
    is_flown: bool,
    is_too_long: bool,
}

impl Rounds<'_> {
    /// The place where a circle costs least: first in flights that are too long, then in what the mission minimises, then in added
    /// time. `None` if nobody can fly.
    pub(super) fn cheapest(
        &self,
        plan: &Plan,
        team: &[Settled],
        usable: &[bool],
        circle: usize,
    ) -> Option<Place> {
        let before = self.ends(plan, team, None);
        let [long, makespan, total] = sums(&before);
        let mut best: Option<([f64; 3], Place)> = None;
        for (flight, settled) in team.iter().enumerate() {
            if !can_take(plan, team, usable, flight) {
                continue;
            }
            for position in 0..=settled.open.len() {
                let rounds = self.ends(plan, team, Some((flight, &with(&settled.open, position, circle))));
                let [long_then, makespan_then, total_then] = sums(&rounds);
                let (long, added) = (long_then - long, total_then - total);
                let cost = match self.airspace.mission.objective {
                    Objective::Makespan => [long, makespan_then.max(makespan), added],
                    Objective::Total => [long, added, makespan_then],
                };
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, Place { flight, position }));
                }
            }
        }
        best.map(|(_, place)| place)
    }

    /// Moves open circles to flights of `helpers`, from the one that ends last where the mission minimises its makespan and from any other
    /// where it minimises the sum, as long as each move saves more than legs scatter around the model.
    pub(super) fn relieve(&self, plan: &Plan, team: &mut [Settled], usable: &[bool], helpers: &[usize]) {
        let mut helpers = helpers.to_vec();
        helpers.retain(|&flight| can_take(plan, team, usable, flight));
        while let Some((from, to)) = self.best_move(plan, team, &helpers) {
            let circle = team[from.flight].open.remove(from.position);
            team[to.flight].open.insert(to.position, circle);
        }
    }

    /// From where to where a circle should move.
    fn best_move(&self, plan: &Plan, team: &mut [Settled], helpers: &[usize]) -> Option<(Place, Place)> {
        let before = self.ends(plan, team, None);
        let is_makespan = self.airspace.mission.objective == Objective::Makespan;
        let last = (0..team.len()).max_by(|&a, &b| before[a].end.total_cmp(&before[b].end))?;
        let givers = (0..team.len()).filter(|&flight| !is_makespan || flight == last);
        let mut best = (WORTHWHILE, None);
        for from in givers {
            for index in 0..team[from].open.len() {
                let circle = team[from].open.remove(index);
                for &to in helpers {
                    let pair = if from == to { vec![from] } else { vec![from, to] };
                    let cost = |rounds: &[Round]| {
                        let ends = pair.iter().map(|&flight| rounds[flight].end);
                        if is_makespan { ends.fold(0.0, f64::max) } else { ends.sum::<f64>() }
                    };
                    let too_long =
                        |rounds: &[Round]| pair.iter().filter(|&&flight| rounds[flight].is_too_long).count();
                    for position in 0..=team[to].open.len() {
                        let longer = with(&team[to].open, position, circle);
                        let rounds = self.ends(plan, team, Some((to, &longer)));
                        let saved = cost(&before) - cost(&rounds);
                        if saved > best.0 && too_long(&rounds) <= too_long(&before) {
                            let [from, to] = [(from, index), (to, position)]
                                .map(|(flight, position)| Place { flight, position });
                            best = (saved, Some((from, to)));
                        }
                    }
                }
                team[from].open.insert(index, circle);
            }
        }
        best.1
    }

    /// All flights, one of them with another open route.
    fn ends(&self, plan: &Plan, team: &[Settled], other: Option<(usize, &[usize])>) -> Vec<Round> {
        let swap = pause(self.airspace.mission.swap_time.unwrap_or(0.0));
        let mut rounds: Vec<Round> = Vec::with_capacity(team.len());
        for (flight, settled) in team.iter().enumerate() {
            let planned = &plan.vehicles[flight];
            let open =
                other.filter(|&(index, _)| index == flight).map_or(&settled.open[..], |(_, open)| open);
            let before = (0..flight)
                .rev()
                .find(|&other| plan.vehicles[other].vehicle == planned.vehicle && rounds[other].is_flown);
            let earliest = before.map_or(0.0, |before| rounds[before].end + swap);
            rounds.push(self.round(planned, settled, open, earliest));
        }
        rounds
    }

    /// A flight of `open` circles after what is settled; one that is still on the ground begins at `earliest` (s) or later.
    fn round(&self, planned: &VehiclePlan, settled: &Settled, open: &[usize], earliest: f64) -> Round {
        if settled.here.is_none() && open.is_empty() {
            let is_flown = settled.landed && !planned.legs.is_empty();
            return Round {
                end: if is_flown { planned.end_time() } else { 0.0 },
                is_flown,
                is_too_long: false,
            };
        }
        let pad = [planned.pad[0], planned.pad[1]];
        let start = match settled.here {
            Some(_) => planned.start_time(),
            None => settled.time.max(earliest),
        };
        let mut here = settled.here.map_or(pad, |motion| [motion.position.x, motion.position.y]);
        let mut time = settled.here.map_or(start, |_| settled.time);
        for &circle in open {
            let there = &self.airspace.orbits[circle].circle;
            time += self.leg(here, there.centre, there.speed) + there.duration;
            here = there.centre;
        }
        let end = time + self.leg(here, pad, 0.0);
        Round { end, is_flown: true, is_too_long: end - start > self.limit }
    }

    fn leg(&self, [ax, ay]: [f64; 2], [bx, by]: [f64; 2], speed: f64) -> f64 {
        self.model.time_over([bx - ax, by - ay], speed)
    }
}

/// How many flights are too long, the latest end, and the sum of all ends.
fn sums(rounds: &[Round]) -> [f64; 3] {
    let long = rounds.iter().filter(|round| round.is_too_long).count() as f64;
    let latest = rounds.iter().map(|round| round.end).fold(0.0, f64::max);
    [long, latest, rounds.iter().map(|round| round.end).sum()]
}

/// Whether a flight can still take circles.
fn can_take(plan: &Plan, team: &[Settled], usable: &[bool], flight: usize) -> bool {
    let planned = &plan.vehicles[flight];
    usable[planned.vehicle] && !team[flight].landed && planned.lost_at.is_none()
}

/// A route with a circle put in.
fn with(open: &[usize], position: usize, circle: usize) -> Vec<usize> {
    let mut longer = open.to_vec();
    longer.insert(position, circle);
    longer
}
