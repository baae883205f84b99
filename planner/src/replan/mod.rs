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
use crate::circles::{groups, orbits};
use crate::error::{Error, Problem};
use crate::legs::Airspace;
use crate::mission::{Mission, Target};
use crate::plan::{Approach, Leg, Plan, VehiclePlan};
use crate::planning::calibrated;
use crate::threads::side_by_side;
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
    /// which only has a safe distance. One that was merged with others leaves them.
    TargetMoves(usize, [f64; 2]),
    /// A vehicle drops out, in the air or on its pad; others take over what it has not completed.
    VehicleFails(usize),
    /// A vehicle that has not flown yet may (again) be used.
    VehicleReturns(usize),
    /// The steady wind is another one: towards east, north (m/s). Legs that have been started are flown to their ends as they were
    /// planned, later ones are planned for the new wind, from the same entries where they can be, and in the same order but for targets
    /// that others can take over with profit.
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
/// and none that has been circled is circled again. Targets that are circled as one stay together ([`Mission::groups`]); one that appears
/// joins a circle that is still open if none of its targets is farther away than [`Mission::merge_within`].
#[derive(Debug, Clone)]
pub struct Replanner {
    mission: Mission,
    plan: Plan,
    model: TimeModel,
    usable: Vec<bool>,
    /// Circles that nobody can fly now.
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
    /// [`Error::Mission`] with all that is wrong with the mission, or if the plan is not the mission's.
    pub fn new(mut mission: Mission, plan: Plan) -> Result<Self, Error> {
        let problems = mission.problems();
        if !problems.is_empty() {
            return Err(Error::Mission { problems });
        }
        let n = mission.fleet.vehicles;
        let is_its =
            |(i, planned): (usize, &VehiclePlan)| planned.vehicle == i || (i >= n && planned.vehicle < n);
        let fits = plan.vehicles.len() >= n && plan.vehicles.iter().enumerate().all(is_its);
        let groups = groups(&mission);
        if !plan.circles.iter().map(|circle| &circle.members).eq(&groups) || !fits {
            return Err(Error::Mission { problems: vec![Problem::NotReplannable] });
        }
        mission.groups = Some(groups);
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

    /// Changes the mission, and says which circles must find a place, which lose theirs, and who may take some from others.
    fn take_in(&mut self, time: f64, event: &Event) -> Result<Changes, Error> {
        let mut changes = Changes { wanted: std::mem::take(&mut self.waiting), ..Changes::default() };
        match *event {
            Event::TargetAppears(ref target) => {
                let appeared = self.mission.targets.len();
                self.mission.targets.push(target.clone());
                self.find_circle(time, appeared, &mut changes);
            }
            Event::TargetVanishes(target) => {
                let circle = self.circle_of(target)?;
                if !self.plan.skipped.contains(&target) {
                    self.plan.skipped.push(target);
                }
                // A circle is flown for whoever is left in it.
                if self.members(circle).iter().all(|member| self.plan.skipped.contains(member)) {
                    changes.wanted.retain(|&waiting| waiting != circle);
                    changes.gone.push(circle);
                }
            }
            Event::TargetMoves(target, position) => {
                self.move_target(time, (target, position), &mut changes)?
            }
            Event::VehicleFails(vehicle) => self.lose(time, vehicle, &mut changes)?,
            Event::VehicleReturns(vehicle) => {
                known(vehicle < self.usable.len(), "vehicle", vehicle)?;
                let own = || self.plan.vehicles.iter().filter(|planned| planned.vehicle == vehicle);
                known(own().all(|planned| planned.legs.is_empty()), "vehicle on its pad", vehicle)?;
                for planned in self.plan.vehicles.iter_mut().filter(|planned| planned.vehicle == vehicle) {
                    planned.lost_at = None;
                }
                self.usable[vehicle] = true;
                changes.relieved_by = vec![vehicle];
            }
            Event::WindChanges(wind) => {
                let earlier = std::mem::replace(&mut self.mission.environment.wind, wind);
                let latest = self.plan.earlier_winds.last().map_or(time, |&(until, _)| time.max(until));
                self.plan.earlier_winds.push((latest, earlier));
                self.model = self.model.in_wind(wind.into());
                changes.wind = true;
                changes.relieved_by = (0..self.plan.vehicles.len()).collect();
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
        let circle = self.circle_of(target)?;
        if self.plan.skipped.contains(&target) || self.is_settled(circle, time) {
            // Nobody circles it there; others keep their distance.
            let moved = self.mission.targets.len();
            self.plan.skipped.push(moved);
            changes.keep_outs.push(moved);
            self.mission.targets.push(Target { position, ..self.mission.targets[target].clone() });
            self.groups().push(vec![moved]);
            return Ok(());
        }
        self.mission.targets[target].position = position;
        changes.renew(circle);
        if self.members(circle).len() == 1 {
            changes.keep_outs.push(target);
        } else {
            self.groups()[circle].retain(|&member| member != target);
            self.find_circle(time, target, changes);
        }
        Ok(())
    }

    /// A target that is in no group yet joins the closest circle that is still open and to whose targets it is close enough, or gets a
    /// circle of its own.
    fn find_circle(&mut self, time: f64, target: usize, changes: &mut Changes) {
        changes.keep_outs.push(target);
        let [x, y] = self.mission.targets[target].position;
        // How far a circle's farthest target is away.
        let farthest = |circle: usize| {
            let distances = self.members(circle).iter().map(|&member| {
                let [a, b] = self.mission.targets[member].position;
                (x - a).hypot(y - b)
            });
            distances.fold(0.0, f64::max)
        };
        let is_open = |circle: usize| {
            let gone = self.members(circle).iter().all(|member| self.plan.skipped.contains(member));
            !gone && !self.is_settled(circle, time)
        };
        let circles = 0..self.mission.groups.as_ref().map_or(0, Vec::len);
        let near = circles.map(|circle| (farthest(circle), circle));
        let near = near.filter(|&(distance, circle)| distance < self.mission.merge_within && is_open(circle));
        match near.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((_, circle)) => {
                let members = &mut self.groups()[circle];
                members.push(target);
                members.sort_unstable();
                changes.renew(circle);
            }
            None => {
                self.groups().push(vec![target]);
                changes.wanted.push(self.groups().len() - 1);
            }
        }
    }

    /// The targets that are circled as one, by circle.
    fn groups(&mut self) -> &mut Vec<Vec<usize>> {
        self.mission.groups.get_or_insert_default()
    }

    fn members(&self, circle: usize) -> &[usize] {
        self.mission.groups.as_ref().and_then(|groups| groups.get(circle)).map_or(&[], Vec::as_slice)
    }

    fn circle_of(&self, target: usize) -> Result<usize, Error> {
        let groups = self.mission.groups.iter().flatten();
        let circle = groups.enumerate().find(|(_, members)| members.contains(&target));
        circle.map(|(circle, _)| circle).ok_or_else(|| unknown("target", target))
    }

    /// What a lost vehicle has not completed must find a place with others.
    fn lose(&mut self, time: f64, vehicle: usize, changes: &mut Changes) -> Result<(), Error> {
        known(vehicle < self.usable.len(), "vehicle", vehicle)?;
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

    /// Whether a circle has been flown, or is being flown, at a time.
    fn is_settled(&self, circle: usize, time: f64) -> bool {
        let legs = self.plan.vehicles.iter().flat_map(|vehicle| &vehicle.legs);
        legs.filter(|leg| leg.loiter.is_some_and(|loiter| loiter.circle == circle))
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
        for &circle in &changes.wanted {
            add_sorties(plan, &mut team, &self.mission, &self.usable, from);
            match rounds.cheapest(plan, &team, &self.usable, circle) {
                Some(place) => team[place.flight].open.insert(place.position, circle),
                None => waiting.push(circle),
            }
        }
        rounds.relieve(plan, &mut team, &self.usable, &changes.relieved_by);
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
        let is_wanted = |member: &usize| !self.plan.skipped.contains(member);
        let targets = waiting.iter().flat_map(|&circle| self.members(circle)).copied().filter(is_wanted);
        let targets = targets.collect();
        self.waiting = waiting;
        certify(&mut self.plan, &bounds);
        self.ways = Some(ways);
        warnings::renew(&mut self.plan, &self.mission, &vehicles);
        Ok(Update { vehicles, waiting: targets, conflict })
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
    /// Circles that must find a place in a route.
    wanted: Vec<usize>,
    /// Circles that lose theirs.
    gone: Vec<usize>,
    /// Targets whose safe distance is a new one.
    keep_outs: Vec<usize>,
    /// Flights that may take circles from others.
    relieved_by: Vec<usize>,
    /// Whether later legs are flown in another wind.
    wind: bool,
}

impl Changes {
    /// A circle that is another one now finds a new place.
    fn renew(&mut self, circle: usize) {
        self.gone.push(circle);
        self.wanted.retain(|&waiting| waiting != circle);
        self.wanted.push(circle);
    }
}

fn known(is_known: bool, what: &'static str, index: usize) -> Result<(), Error> {
    if is_known { Ok(()) } else { Err(unknown(what, index)) }
}

fn unknown(what: &'static str, index: usize) -> Error {
    Error::Mission { problems: vec![Problem::Unknown { what, index }] }
}

/// Whether every circle can be flown in every wind: a vehicle may still be on a leg that was planned for an earlier one.
fn flyable(airs: &Airs) -> Result<(), Error> {
    for air in airs.iter().filter(|air| air.orbits.len() != groups(&air.mission).len()) {
        let of_loiter = |source| Error::Mission { problems: vec![Problem::Loiter { target: 0, source }] };
        orbits(&air.mission).map_err(of_loiter)?;
    }
    Ok(())
}
