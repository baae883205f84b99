//! Plans that follow events while the team flies (the paper's Algorithm 3).
//!
//! | step | file |
//! |---|---|
//! | what of a flight is settled at a moment, and where it can still be changed | `settled.rs` |
//! | who takes a target over, and where in its route | `insertion.rs` |
//! | the legs of a changed route: those that stay are kept, the others solved | `refly.rs` |
//! | lower bounds over every continuation | `outlook.rs` |
//! | vehicles that would come too close wait for each other | `give_way.rs` |
//! | further flights with fresh batteries | `sorties.rs` |
//! | the winds that flights meet | `skies.rs` |

#[cfg(test)]
mod continuations;
mod give_way;
mod insertion;
mod outlook;
mod refly;
mod settled;
mod skies;
mod sorties;

use crate::airs::Airs;
use crate::circles::orbits;
use crate::error::{Error, Problem};
use crate::legs::{Airspace, side_by_side};
use crate::mission::{Mission, Target};
use crate::plan::{Approach, Leg, Plan, VehiclePlan};
use crate::planning::calibrated;
use crate::time_model::TimeModel;
use crate::warnings;
use insertion::Rounds;
use mtsp::lower_bound::LowerBounds;
use outlook::{Outlook, Ways};
use settled::Settled;
use skies::Skies;
use sorties::{add_sorties, drop_unused, follow_on};
use std::sync::Arc;

/// Something that happens while the team flies. Targets and vehicles are numbered from 0.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Event {
    /// There is a new target; it gets the next index.
    TargetAppears(Target),
    /// A target need not be circled any more; its safe distance is kept all the same.
    TargetVanishes(usize),
    /// A target is somewhere else: east, north (m). One that has been circled is not circled again: it becomes another target,
    /// which only has a safe distance.
    TargetMoves(usize, [f64; 2]),
    /// A vehicle drops out, in the air or on its pad; others take over what it has not completed.
    VehicleFails(usize),
    /// A vehicle that has not flown yet may (again) be used.
    VehicleReturns(usize),
    /// The steady wind is another one: towards east, north (m/s). Legs that have been started are flown to their ends as they were
    /// planned, later ones are planned for the new wind, in the same order and from the same entries where they can be.
    WindChanges([f64; 2]),
}

/// What an event has changed.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Update {
    /// The flights that are different now, by their places in [`Plan::vehicles`], ascending: with one flight each these are the vehicles.
    pub vehicles: Vec<usize>,
    /// Targets that wait because no vehicle is left that could take them; they are tried again at every later event.
    pub waiting: Vec<usize>,
    /// Where airborne vehicles come closer than the mission's separation from now on although none could give way in time: an
    /// operator must decide.
    pub conflict: Option<Approach>,
}

/// A mission in flight: takes events, hands out updated plans.
///
/// What is being flown stays as it is: a vehicle in a loiter finishes it, one on its way to a circle flies there, unless that
/// target is gone or the way now breaks a safe distance; then it turns off at the next knot of its trajectory that is at least
/// [`Replanner::REACTION`] seconds away. Vehicles that would come too close wait for each other, on a pad or by further turns of a
/// loiter. Where batteries are swapped ([`Mission::swap_time`]) a target that fits into no flight within the endurance, and one battery
/// at the plan's greatest mean power, gets another flight; later flights of a vehicle follow the one before. No waiting target is lost,
/// and none that has been circled is circled again.
#[derive(Debug, Clone)]
pub struct Replanner {
    mission: Mission,
    plan: Plan,
    model: TimeModel,
    usable: Vec<bool>,
    waiting: Vec<usize>,
    /// No flight should take longer (s).
    limit: f64,
    /// Least times of legs as the last event needed them.
    ways: Option<Arc<Ways>>,
}

impl Replanner {
    /// Time between an event and the first change of what is being flown (s).
    pub const REACTION: f64 = 0.1;

    /// Takes over a plan that is about to be flown.
    ///
    /// # Errors
    /// [`Error::Mission`] with all that is wrong with the mission, if the plan is not the mission's, or if the mission merges targets
    /// (`merge_within` above 0): then a target has no circle of its own that could move.
    pub fn new(mission: Mission, plan: Plan) -> Result<Self, Error> {
        let problems = mission.problems();
        if !problems.is_empty() {
            return Err(Error::Mission { problems });
        }
        let n = mission.fleet.vehicles;
        let is_its =
            |(i, planned): (usize, &VehiclePlan)| planned.vehicle == i || (i >= n && planned.vehicle < n);
        let fits = plan.vehicles.len() >= n && plan.vehicles.iter().enumerate().all(is_its);
        if mission.merge_within > 0.0 || plan.circles.len() != mission.targets.len() || !fits {
            return Err(Error::Mission { problems: vec![Problem::NotReplannable] });
        }
        let usable = vec![true; n];
        let limit = longest_flight(&plan, &mission);
        let model = {
            let airs = Airs::new(&plan, &mission);
            flyable(&airs)?;
            let skies = Skies::new(&airs);
            let airspace = skies.now();
            let flown = plan.vehicles.iter();
            calibrated(airspace, flown.map(|flown| (flown.pad, &flown.route[..], &flown.legs[..])))
        };
        Ok(Self { mission, plan, model, usable, waiting: Vec::new(), limit, ways: None })
    }

    /// The plan as it stands.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The mission as it stands: targets that have appeared are in it, and those that have vanished still are.
    #[must_use]
    pub fn mission(&self) -> &Mission {
        &self.mission
    }

    /// Takes in an event at `time` (s after the mission's start); on an error everything stays as it was.
    ///
    /// # Errors
    /// [`Error::Mission`] if the event makes the mission impossible to fly or names a target or vehicle that there is not;
    /// [`Error::Leg`] if no way could be found to a target.
    ///
    /// # Complexity
    /// Mostly the optimal control problems of the changed legs: two for a target that appears, one for one that vanishes, those of all later legs for a
    /// new wind.
    pub fn apply(&mut self, time: f64, event: &Event) -> Result<Update, Error> {
        let attempt = |limit: f64| {
            let mut next = self.clone();
            let changes = next.take_in(time, event)?;
            let places = !changes.wanted.is_empty();
            let update = next.refly(time, changes, limit)?;
            Ok::<_, Error>((next, update, places))
        };
        let (mut next, mut update, places) = attempt(self.limit)?;
        // Solved flights scatter around the model: a limit that was too loose is tightened, if that helps.
        let mut limit = self.limit;
        for _ in 0..MOST_LIMITS {
            let share =
                update.vehicles.iter().map(|&flight| self.limit / next.plan.vehicles[flight].duration());
            let share = share.fold(1.0, f64::min);
            if share >= 1.0 || !places {
                break;
            }
            limit *= share;
            let tighter = attempt(limit)?;
            if too_long(&tighter.0.plan, self.limit) < too_long(&next.plan, self.limit) {
                (next, update) = (tighter.0, tighter.1);
            }
        }
        *self = next;
        Ok(update)
    }

    /// Changes the mission, and says which targets must find a place, which lose theirs, and whether to share out anew.
    fn take_in(&mut self, time: f64, event: &Event) -> Result<Changes, Error> {
        let mut changes = Changes { wanted: std::mem::take(&mut self.waiting), ..Changes::default() };
        match *event {
            Event::TargetAppears(ref target) => {
                changes.wanted.push(self.mission.targets.len());
                changes.keep_outs.push(self.mission.targets.len());
                self.mission.targets.push(target.clone());
            }
            Event::TargetVanishes(target) => {
                self.known(target < self.mission.targets.len(), "target", target)?;
                changes.wanted.retain(|&waiting| waiting != target);
                changes.gone.push(target);
                if !self.plan.skipped.contains(&target) {
                    self.plan.skipped.push(target);
                }
            }
            Event::TargetMoves(target, position) => {
                self.move_target(time, (target, position), &mut changes)?
            }
            Event::VehicleFails(vehicle) => self.lose(time, vehicle, &mut changes)?,
            Event::VehicleReturns(vehicle) => {
                self.known(vehicle < self.usable.len(), "vehicle", vehicle)?;
                let own = || self.plan.vehicles.iter().filter(|planned| planned.vehicle == vehicle);
                self.known(own().all(|planned| planned.legs.is_empty()), "vehicle on its pad", vehicle)?;
                for planned in self.plan.vehicles.iter_mut().filter(|planned| planned.vehicle == vehicle) {
                    planned.lost_at = None;
                }
                self.usable[vehicle] = true;
                changes.relieved_by = Some(vehicle);
            }
            Event::WindChanges(wind) => {
                let earlier = std::mem::replace(&mut self.mission.environment.wind, wind);
                let latest = self.plan.earlier_winds.last().map_or(time, |&(until, _)| time.max(until));
                self.plan.earlier_winds.push((latest, earlier));
                self.model = self.model.in_wind(wind.into());
                changes.wind = true;
            }
        }
        for &target in &changes.keep_outs {
            self.plan.known_since.retain(|&(known, _)| known != target);
            self.plan.known_since.push((target, time));
        }
        let problems = self.mission.problems();
        if problems.is_empty() { Ok(changes) } else { Err(Error::Mission { problems }) }
    }

    /// A target that has been circled becomes another one, which nobody circles; any other is circled where it is now.
    fn move_target(
        &mut self,
        time: f64,
        (target, position): (usize, [f64; 2]),
        changes: &mut Changes,
    ) -> Result<(), Error> {
        self.known(target < self.mission.targets.len(), "target", target)?;
        if self.plan.skipped.contains(&target) || self.is_settled(target, time) {
            // Nobody circles it there; others keep their distance.
            self.plan.skipped.push(self.mission.targets.len());
            changes.keep_outs.push(self.mission.targets.len());
            let moved = Target { position, ..self.mission.targets[target].clone() };
            self.mission.targets.push(moved);
        } else {
            self.mission.targets[target].position = position;
            changes.keep_outs.push(target);
            changes.gone.push(target);
            changes.wanted.retain(|&waiting| waiting != target);
            changes.wanted.push(target);
        }
        Ok(())
    }

    /// What a lost vehicle has not completed must find a place with others.
    fn lose(&mut self, time: f64, vehicle: usize, changes: &mut Changes) -> Result<(), Error> {
        self.known(vehicle < self.usable.len(), "vehicle", vehicle)?;
        self.usable[vehicle] = false;
        for planned in self.plan.vehicles.iter_mut().filter(|planned| planned.vehicle == vehicle) {
            let done = planned.legs.iter().take_while(|leg| leg.end_time() <= time).count();
            if done < planned.legs.len() {
                changes.wanted.extend(planned.route.drain(done.min(planned.route.len())..));
                planned.legs.truncate(done);
                planned.lost_at = Some(time);
            }
        }
        Ok(())
    }

    fn known(&self, is_known: bool, what: &'static str, index: usize) -> Result<(), Error> {
        if is_known {
            return Ok(());
        }
        Err(Error::Mission { problems: vec![Problem::Unknown { what, index }] })
    }

    /// Whether a target has been circled, or is being circled, at a time.
    fn is_settled(&self, target: usize, time: f64) -> bool {
        let legs = self.plan.vehicles.iter().flat_map(|vehicle| &vehicle.legs);
        legs.filter(|leg| leg.loiter.is_some_and(|loiter| loiter.circle == target))
            .any(|leg| leg.arrival_time() <= time)
    }

    /// Finds new routes and flies what has changed.
    fn refly(&mut self, time: f64, changes: Changes, limit: f64) -> Result<Update, Error> {
        let airs = Airs::new(&self.plan, &self.mission);
        flyable(&airs)?;
        let skies = Skies::new(&airs);
        let airspace = skies.now();
        let plan = &mut self.plan;
        let (known, from) = (plan.vehicles.len(), skies.airs.from(time));
        let ends: Vec<f64> = plan.vehicles.iter().map(VehiclePlan::end_time).collect();
        let mut team: Vec<Settled> =
            (0..known).map(|flight| Settled::at(&skies, &plan.vehicles[flight], time, &changes)).collect();
        for settled in &mut team {
            settled.open.retain(|circle| !changes.gone.contains(circle));
        }
        let rounds = Rounds { airspace, model: &self.model, limit };
        let mut waiting = Vec::new();
        for &target in &changes.wanted {
            add_sorties(plan, &mut team, &self.mission, &self.usable, from);
            match rounds.cheapest(plan, &team, &self.usable, target) {
                Some(place) => team[place.flight].open.insert(place.position, target),
                None => waiting.push(target),
            }
        }
        if let Some(vehicle) = changes.relieved_by {
            rounds.relieve(plan, &mut team, vehicle);
        }
        drop_unused(plan, &mut team, known);
        let ways = Ways::of(airspace, &team, self.ways.as_ref());
        let bounds = Outlook::new(&ways, airspace, &self.plan, (&team, &self.usable), time).bounds();
        self.plan.circles = airspace.orbits.iter().map(|orbit| orbit.circle.clone()).collect();
        let team: Vec<(usize, Settled)> = team.into_iter().enumerate().collect();
        let legs = side_by_side(&team, |(flight, settled)| {
            let planned = &self.plan.vehicles[*flight];
            if planned.lost_at.is_some() {
                return Ok(None);
            }
            refly::fly(&skies, &self.model, *flight, planned, settled, &changes)
        })
        .into_iter()
        .collect::<Result<_, _>>()?;
        let mut vehicles = take_over(&mut self.plan, airspace, time, legs);
        self.plan.skipped.sort_unstable();
        vehicles.extend(follow_on(&mut self.plan, &ends, from, self.mission.swap_time.unwrap_or(0.0)));
        let (waiting_for_others, closest) = give_way::give_way(&mut self.plan, &self.mission, time);
        vehicles.extend(waiting_for_others);
        vehicles.sort_unstable();
        vehicles.dedup();
        self.plan.closest_approach = closest;
        let conflict = closest.filter(|approach| approach.distance < self.mission.fleet.separation);
        self.waiting.clone_from(&waiting);
        certify(&mut self.plan, &bounds);
        self.ways = Some(ways);
        warnings::renew(&mut self.plan, &self.mission, &vehicles);
        Ok(Update { vehicles, waiting, conflict })
    }
}

/// Hands the new legs to their flights; returns the flights that are different now.
fn take_over(plan: &mut Plan, airspace: &Airspace, time: f64, legs: Vec<Option<Vec<Leg>>>) -> Vec<usize> {
    let mut vehicles = Vec::new();
    for (vehicle, legs) in legs.into_iter().enumerate() {
        let planned = &plan.vehicles[vehicle];
        if let Some(lost) = planned.lost_at {
            vehicles.extend((lost == time).then_some(vehicle));
            continue;
        }
        if let Some(legs) = legs {
            let planned = &mut plan.vehicles[vehicle];
            planned.route = legs.iter().filter_map(|leg| Some(leg.loiter?.circle)).collect();
            if planned.legs.first().is_none_or(|leg| leg.start_time > time) {
                planned.heading = airspace.heading(planned.pad, &planned.route);
            }
            planned.legs = legs;
            vehicles.push(vehicle);
        }
    }
    vehicles
}

/// Times of the plan beside bounds over everything that could still be flown.
fn certify(plan: &mut Plan, bounds: &LowerBounds) {
    let flown = || plan.vehicles.iter();
    plan.certificate.makespan = flown().map(|vehicle| vehicle.end_time()).fold(0.0, f64::max);
    plan.certificate.total = flown().map(|vehicle| vehicle.duration()).sum();
    plan.certificate.makespan_lower_bound = bounds.makespan;
    plan.certificate.total_lower_bound = bounds.total_cost;
}

/// Tighter limits on flights that are tried.
const MOST_LIMITS: usize = 2;

/// By how much flights are too long together (s).
fn too_long(plan: &Plan, limit: f64) -> f64 {
    plan.vehicles.iter().map(|planned| (planned.duration() - limit).max(0.0)).sum()
}

/// The longest flight (s) within the endurance, and on one battery at the greatest mean power of a plan's flights.
fn longest_flight(plan: &Plan, mission: &Mission) -> f64 {
    let usable = mission.fleet.vehicle.parameters().battery.usable_energy();
    let Some(sampler) = plan.sampler(mission) else { return mission.fleet.endurance };
    let flown = (0..plan.vehicles.len()).filter(|&flight| !plan.vehicles[flight].legs.is_empty());
    let powers = flown.filter_map(|flight| Some(sampler.energy(flight)? / plan.vehicles[flight].duration()));
    mission.fleet.endurance.min(usable / powers.fold(f64::MIN_POSITIVE, f64::max))
}

/// What an event asks for.
#[derive(Debug, Default)]
struct Changes {
    /// Targets that must find a place in a route.
    wanted: Vec<usize>,
    /// Targets that lose theirs.
    gone: Vec<usize>,
    /// Targets whose safe distance is a new one.
    keep_outs: Vec<usize>,
    /// A vehicle that can take targets from others.
    relieved_by: Option<usize>,
    /// Whether later legs are flown in another wind.
    wind: bool,
}

/// Whether every circle can be flown in every wind: a vehicle may still be on a leg that was planned for an earlier one.
fn flyable(airs: &Airs) -> Result<(), Error> {
    for air in airs.iter().filter(|air| air.orbits.len() != air.mission.targets.len()) {
        let of_loiter = |source| Error::Mission { problems: vec![Problem::Loiter { target: 0, source }] };
        orbits(&air.mission).map_err(of_loiter)?;
    }
    Ok(())
}
