//! The legs of one route: the paper's Algorithm 1 from pad to circle to circle to pad.

use crate::airs::Air;
use crate::bound::Envelope;
use crate::circles::Orbit;
use crate::entry::{self, Entrance};
use crate::error::Error;
use crate::mission::{Entries, Mission};
use crate::options::{Options, Watch};
use crate::plan::{Candidate, Entry, Leg, Loiter, Outcome, Transition};
use crate::planning::envelope;
use crate::race::{Arrival, Race};
use crate::threads::side_by_side;
use crate::transition::{Detail, Goal, Hint, Pilot, Unsolved};
use quad_dynamics::Motion;

/// Candidates sketched between two comparisons with the bounds. A constant, and not the number of threads, so that the same
/// candidates are discarded on every machine.
const BATCH: usize = 2;

/// What setting its angle free gains at most about a sampled entry (s), and an estimate of its time is off.
const FREE_GAIN: f64 = 0.03;

/// Everything that the legs of all routes share.
pub(crate) struct Airspace<'a> {
    pub mission: &'a Mission,
    pub orbits: &'a [Orbit],
    pub pilot: Pilot,
    pub envelope: Envelope,
    pub watch: Watch<'a>,
}

impl<'a> Airspace<'a> {
    /// Of one wind, watched by nobody.
    pub(crate) fn of(air: &'a Air) -> Self {
        Self {
            mission: &air.mission,
            orbits: &air.orbits,
            pilot: air.pilot.clone(),
            envelope: envelope(&air.mission, &air.orbits),
            watch: Watch::new(Options::default(), 0),
        }
    }
}

impl Airspace<'_> {
    /// How many candidates a route with `stops` circles has; what progress counts.
    pub(crate) fn n_candidates(&self, stops: usize) -> usize {
        if stops == 0 { 0 } else { stops * entry::n_entrances(self.mission.transition.entries) + 1 }
    }

    /// Flies a route from its pad and back, each leg by the fastest of its candidates, starting at time 0.
    pub(crate) fn fly(&self, vehicle: usize, pad: [f64; 3], route: &[usize]) -> Result<Vec<Leg>, Error> {
        let legs = self.fly_by(vehicle, pad, route, |_, here, orbit| self.to_circle(here, orbit))?;
        // The way home, where there is one, has a single candidate.
        self.watch.advance(usize::from(!legs.is_empty()));
        Ok(legs)
    }

    /// Flies a route by given entries, one per circle; with [`Entries::Free`] each is where the search starts. Where two
    /// consecutive entries are those of `known` legs of the same route, the known leg is flown.
    pub(crate) fn fly_entries(
        &self,
        vehicle: usize,
        pad: [f64; 3],
        route: &[usize],
        entries: &[Entry],
        known: &[Leg],
    ) -> Result<Vec<Leg>, Error> {
        let same = |index: usize| {
            known.get(index).and_then(|leg| leg.loiter).map(|loiter| loiter.entry) == Some(entries[index])
        };
        self.fly_by(vehicle, pad, route, |index, here, orbit| {
            if same(index) && (index == 0 || same(index - 1)) {
                let Leg { ref transition, ref candidates, .. } = known[index];
                let arrival = Arrival { entry: entries[index], transition: transition.clone() };
                return (Some(arrival), candidates.clone());
            }
            self.to_entry(here, orbit, entries[index])
        })
    }

    fn fly_by(
        &self,
        vehicle: usize,
        pad: [f64; 3],
        route: &[usize],
        to_next: impl Fn(usize, &Motion, &Orbit) -> (Option<Arrival>, Vec<Candidate>),
    ) -> Result<Vec<Leg>, Error> {
        let mut legs: Vec<Leg> = Vec::with_capacity(route.len() + 1);
        if route.is_empty() {
            return Ok(legs);
        }
        let mut here = self.take_off(pad, route);
        let mut time = 0.0;
        for (index, &circle) in route.iter().enumerate() {
            let orbit = &self.orbits[circle];
            let (arrival, candidates) = to_next(index, &here, orbit);
            if self.watch.should_stop() {
                return Err(Error::Stopped);
            }
            let Some(Arrival { entry, transition }) = arrival else {
                return Err(Error::Leg { vehicle, leg: legs.len(), circle: Some(circle), candidates });
            };
            here = orbit.exit(entry);
            let loiter =
                Loiter { circle, entry, duration: orbit.circle.duration, length: orbit.loiter.length() };
            legs.push(Leg { start_time: time, transition, loiter: Some(loiter), candidates });
            time = legs[legs.len() - 1].end_time();
        }
        let (transition, candidates) = self.to_pad(&here, pad);
        match transition {
            Some(transition) => legs.push(Leg { start_time: time, transition, loiter: None, candidates }),
            None => return Err(Error::Leg { vehicle, leg: legs.len(), circle: None, candidates }),
        }
        Ok(legs)
    }

    /// The transition to one entry of a circle.
    fn to_entry(&self, here: &Motion, orbit: &Orbit, entry: Entry) -> (Option<Arrival>, Vec<Candidate>) {
        let there = orbit.at(entry);
        let hint = Hint::Time(self.least_time(here, &there));
        let solved = self.pilot.fly(here, Goal::Motion(there), &there, hint);
        let mut candidates = vec![Candidate { entry: Some(entry), outcome: outcome_of(&solved) }];
        let arrival = solved.ok().map(|transition| Arrival { entry, transition });
        let freed = match (self.mission.transition.entries, &arrival) {
            (Entries::Free, Some(arrival)) => self.freed(here, orbit, arrival, &mut candidates),
            _ => None,
        };
        (freed.or(arrival), candidates)
    }

    /// The transition to one entry of a circle or, if that cannot be solved, to the best of all; where it enters; what became
    /// of the candidates.
    pub(crate) fn reach(
        &self,
        here: &Motion,
        orbit: &Orbit,
        entry: Entry,
    ) -> (Option<Transition>, Entry, Vec<Candidate>) {
        let (arrival, candidates) = match self.to_entry(here, orbit, entry) {
            (None, _) => self.to_circle(here, orbit),
            reached => reached,
        };
        match arrival {
            Some(Arrival { entry, transition }) => (Some(transition), entry, candidates),
            None => (None, entry, candidates),
        }
    }

    /// No admissible motion leads from one motion to the other sooner (s).
    pub(crate) fn least_time(&self, from: &Motion, to: &Motion) -> f64 {
        let proved = self.envelope.least_time_between(from, to);
        self.pilot.agility().map_or(proved, |agility| agility.least_time(from, to, proved))
    }

    /// Solves the candidate entries of a circle in order of promise, discarding those that provably cannot win.
    fn to_circle(&self, here: &Motion, orbit: &Orbit) -> (Option<Arrival>, Vec<Candidate>) {
        let entrances = entry::entrances(here, orbit, self.mission.transition.entries, |from, to| {
            self.least_time(from, to)
        });
        let mut race = Race::new(&entrances, self.watch.exhaustive());
        self.solve_promising(here, orbit, &entrances, &mut race, Detail::Sketch);
        self.watch.advance(entrances.len());
        loop {
            // Some sketches are made again; and once polishing has failed or taken time, others can win after all.
            self.solve_promising(here, orbit, &entrances, &mut race, Detail::Sketch);
            self.solve_promising(here, orbit, &entrances, &mut race, Detail::Full);
            let Some((index, draft)) = race.take_fastest() else { break };
            let goal = Goal::Motion(orbit.at(entrances[index].entry));
            race.polished(index, self.pilot.polish(here, goal, draft));
        }
        let (best, mut candidates) = race.finish();
        let Some(best) = best else { return (None, candidates) };
        if self.mission.transition.entries != Entries::Free {
            return (Some(best), candidates);
        }
        let other = self.best_of_other_direction(here, orbit, &best, &candidates);
        let starts = [Some(best), other].into_iter().flatten();
        let fastest = starts
            .map(|start| self.freed(here, orbit, &start, &mut candidates).unwrap_or(start))
            .min_by(|a, b| a.transition.duration.total_cmp(&b.transition.duration));
        (fastest, candidates)
    }

    /// The fastest sampled arrival in the other direction than `best`, if it is so close that its angle set free may win.
    fn best_of_other_direction(
        &self,
        here: &Motion,
        orbit: &Orbit,
        best: &Arrival,
        candidates: &[Candidate],
    ) -> Option<Arrival> {
        let time = |candidate: &Candidate| match candidate.outcome {
            Outcome::Solved { duration } | Outcome::Slower { duration } => Some((candidate.entry?, duration)),
            _ => None,
        };
        let others =
            candidates.iter().filter_map(time).filter(|(entry, _)| entry.direction != best.entry.direction);
        let (entry, duration) = others.min_by(|a, b| a.1.total_cmp(&b.1))?;
        if duration > best.transition.duration + FREE_GAIN {
            return None;
        }
        let there = orbit.at(entry);
        let transition = self.pilot.fly(here, Goal::Motion(there), &there, Hint::Time(duration)).ok()?;
        Some(Arrival { entry, transition })
    }

    /// Solves all candidates that could win at some detail, the most promising first.
    fn solve_promising(
        &self,
        here: &Motion,
        orbit: &Orbit,
        entrances: &[Entrance],
        race: &mut Race,
        detail: Detail,
    ) {
        let batch_size = match detail {
            Detail::Sketch => BATCH,
            Detail::Full => 1,
        };
        for batch in race.by_promise().chunks(batch_size) {
            if self.watch.should_stop() {
                return;
            }
            let to_beat = race.to_beat(detail);
            let batch: Vec<usize> =
                batch.iter().copied().filter(|&index| race.is_promising(index, detail, to_beat)).collect();
            let solve = |&index: &usize| {
                let there = orbit.at(entrances[index].entry);
                let hint = race.hint(index, detail, to_beat);
                self.pilot.draft(here, Goal::Motion(there), &there, hint, (detail, to_beat))
            };
            for (index, solved) in batch.iter().copied().zip(side_by_side(&batch, solve)) {
                race.solved(index, detail, solved);
            }
        }
    }

    /// The best sampled arrival with its angle set free; kept only if it is faster.
    fn freed(
        &self,
        here: &Motion,
        orbit: &Orbit,
        sampled: &Arrival,
        candidates: &mut Vec<Candidate>,
    ) -> Option<Arrival> {
        if !self.pilot.can_enter_anywhere(orbit) {
            return self.freed_by_search(here, orbit, sampled, candidates);
        }
        let goal = Goal::Circle(orbit, sampled.entry.direction);
        let hint = Hint::Neighbour(&sampled.transition);
        let to_beat = sampled.transition.duration;
        let towards = orbit.at(sampled.entry);
        let draft = self.pilot.draft(here, goal, &towards, hint, (Detail::Full, to_beat)).ok()?;
        let transition = self.pilot.polish(here, goal, draft).ok()?;
        if transition.duration >= sampled.transition.duration {
            return None;
        }
        let end = transition.states.last()?;
        let [x, y] = orbit.circle.centre;
        let entry = Entry { angle: (end[1] - y).atan2(end[0] - x), ..sampled.entry };
        candidates.push(Candidate {
            entry: Some(entry),
            outcome: Outcome::Solved { duration: transition.duration },
        });
        Some(Arrival { entry, transition })
    }

    /// The same where the attitude changes round the circle: the angle is sought, first at half the distance of two samples
    /// and then at ever smaller steps on the side that was faster.
    fn freed_by_search(
        &self,
        here: &Motion,
        orbit: &Orbit,
        sampled: &Arrival,
        candidates: &mut Vec<Candidate>,
    ) -> Option<Arrival> {
        const HALVINGS: usize = 4;
        let mut step = 2.0 * std::f64::consts::PI / entry::n_entrances(Entries::Free) as f64;
        let mut best: Option<Arrival> = None;
        for _ in 0..HALVINGS {
            let centre = best.as_ref().unwrap_or(sampled);
            let tried = [step, -step].map(|turn| {
                let entry = Entry { angle: centre.entry.angle + turn, ..sampled.entry };
                let there = orbit.at(entry);
                let (goal, hint) = (Goal::Motion(there), Hint::Neighbour(&centre.transition));
                let to_beat = centre.transition.duration;
                let draft = self.pilot.draft(here, goal, &there, hint, (Detail::Full, to_beat)).ok()?;
                let transition = self.pilot.polish(here, goal, draft).ok()?;
                (transition.duration < to_beat).then_some(Arrival { entry, transition })
            });
            let faster = tried
                .into_iter()
                .flatten()
                .min_by(|a, b| a.transition.duration.total_cmp(&b.transition.duration));
            best = faster.or(best);
            step *= 0.5;
        }
        let Arrival { entry, transition } = best.as_ref()?;
        let outcome = Outcome::Solved { duration: transition.duration };
        candidates.push(Candidate { entry: Some(*entry), outcome });
        best
    }

    pub(crate) fn to_pad(&self, here: &Motion, pad: [f64; 3]) -> (Option<Transition>, Vec<Candidate>) {
        let there = self.landing(pad);
        let hint = Hint::Time(self.least_time(here, &there));
        let solved = self.pilot.fly(here, Goal::Hover(there), &there, hint);
        let outcome = outcome_of(&solved);
        (solved.ok(), vec![Candidate { entry: None, outcome }])
    }
}

/// What became of the only candidate of a leg.
fn outcome_of(solved: &Result<Transition, Unsolved>) -> Outcome {
    match solved {
        Ok(transition) => Outcome::Solved { duration: transition.duration },
        Err(unsolved) => unsolved.into(),
    }
}
