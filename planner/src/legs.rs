//! The legs of one route: the paper's Algorithm 1 from pad to circle to circle to pad.

use crate::bound::Envelope;
use crate::circles::Orbit;
use crate::entry::{self, Entrance};
use crate::error::Error;
use crate::mission::{Entries, Mission};
use crate::options::Watch;
use crate::plan::{Candidate, Entry, Leg, Loiter, Outcome, Transition};
use crate::transition::{Draft, Goal, Hint, Pilot, Unsolved};
use quad_dynamics::Motion;

/// Candidates solved between two comparisons with the bounds. A constant, and not the number of threads, so that the same
/// candidates are discarded on every machine.
const BATCH: usize = 2;

/// Everything that the legs of all routes share.
pub(crate) struct Airspace<'a> {
    pub mission: &'a Mission,
    pub orbits: &'a [Orbit],
    pub pilot: Pilot,
    pub envelope: Envelope,
    pub watch: Watch<'a>,
}

/// A solved candidate that is not flown yet.
struct Drafted {
    /// Where in the list of candidates.
    index: usize,
    entry: Entry,
    draft: Draft,
}

impl Drafted {
    fn duration(&self) -> f64 {
        self.draft.transition.duration
    }
}

/// The candidate that is flown.
struct Arrival {
    entry: Entry,
    transition: Transition,
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
        let hint = Hint::Time(self.envelope.least_time_between(here, &there));
        let solved = self.pilot.fly(here, Goal::Motion(there), &there, hint);
        let mut candidates = vec![Candidate { entry: Some(entry), outcome: outcome_of(solved.as_ref()) }];
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
    fn least_time(&self, from: &Motion, to: &Motion) -> f64 {
        let proved = self.envelope.least_time_between(from, to);
        self.pilot.agility().map_or(proved, |agility| agility.least_time(from, to, proved))
    }

    /// Solves the candidate entries of a circle in order of promise, discarding those that provably cannot win.
    fn to_circle(&self, here: &Motion, orbit: &Orbit) -> (Option<Arrival>, Vec<Candidate>) {
        let entrances = entry::entrances(here, orbit, self.mission.transition.entries, |from, to| {
            self.least_time(from, to)
        });
        let mut candidates: Vec<Candidate> = entrances
            .iter()
            .map(|entrance| Candidate {
                entry: Some(entrance.entry),
                outcome: Outcome::ProvenWorse { lower_bound: entrance.lower_bound },
            })
            .collect();
        let mut drafted: Vec<Drafted> = Vec::new();
        for batch in entry::by_promise(&entrances).chunks(BATCH) {
            if self.watch.should_stop() {
                break;
            }
            let fastest = drafted.iter().map(Drafted::duration).fold(f64::INFINITY, f64::min);
            let to_beat = if self.watch.exhaustive() { f64::INFINITY } else { fastest };
            let promising = |&i: &usize| entrances[i].lower_bound < to_beat;
            let open: Vec<usize> = batch.iter().copied().filter(promising).collect();
            let solved = self.draft_all(here, orbit, &entrances, &open, &drafted, to_beat);
            self.watch.advance(batch.len());
            for (index, outcome) in open.into_iter().zip(solved) {
                candidates[index].outcome = match &outcome {
                    Ok(draft) if draft.given_up => Outcome::Slower { duration: draft.transition.duration },
                    outcome => outcome_of(outcome.as_ref().map(|draft| &draft.transition)),
                };
                if let Ok(draft) = outcome {
                    drafted.push(Drafted { index, entry: entrances[index].entry, draft });
                }
            }
        }
        let Some(best) = self.polish_fastest(here, orbit, drafted, &mut candidates) else {
            return (None, candidates);
        };
        let freed = match self.mission.transition.entries {
            Entries::Free => self.freed(here, orbit, &best, &mut candidates),
            Entries::Sampled(_) => None,
        };
        (Some(freed.unwrap_or(best)), candidates)
    }

    /// The fastest draft that can be flown. A draft is polished if it is faster than what has been polished before; of equals
    /// the one that stands first in the list of candidates counts.
    fn polish_fastest(
        &self,
        here: &Motion,
        orbit: &Orbit,
        mut drafted: Vec<Drafted>,
        candidates: &mut [Candidate],
    ) -> Option<Arrival> {
        drafted.sort_by(|a, b| a.duration().total_cmp(&b.duration()).then_with(|| a.index.cmp(&b.index)));
        let mut best: Option<Arrival> = None;
        for Drafted { index, entry, draft } in drafted {
            let to_beat = best.as_ref().map_or(f64::INFINITY, |best| best.transition.duration);
            if draft.transition.duration >= to_beat && !self.watch.exhaustive() {
                break;
            }
            let polished = self.pilot.polish(here, Goal::Motion(orbit.at(entry)), &draft);
            candidates[index].outcome = outcome_of(polished.as_ref());
            best = match polished {
                Ok(transition) if transition.duration < to_beat => Some(Arrival { entry, transition }),
                _ => best,
            };
        }
        best
    }

    /// One candidate after the other, or side by side with the feature `rayon`; the results are in the order of `open`.
    fn draft_all(
        &self,
        here: &Motion,
        orbit: &Orbit,
        entrances: &[Entrance],
        open: &[usize],
        drafted: &[Drafted],
        to_beat: f64,
    ) -> Vec<Result<Draft, Unsolved>> {
        let solve = |&i: &usize| {
            let Entrance { entry, lower_bound } = entrances[i];
            let there = orbit.at(entry);
            let hint = neighbour(drafted, entry).map_or(Hint::Time(lower_bound), Hint::Neighbour);
            self.pilot.draft(here, Goal::Motion(there), &there, hint, to_beat)
        };
        #[cfg(feature = "rayon")]
        {
            use rayon::prelude::*;
            open.par_iter().map(solve).collect()
        }
        #[cfg(not(feature = "rayon"))]
        open.iter().map(solve).collect()
    }

    /// The best sampled arrival with its angle set free; kept only if it is faster.
    fn freed(
        &self,
        here: &Motion,
        orbit: &Orbit,
        sampled: &Arrival,
        candidates: &mut Vec<Candidate>,
    ) -> Option<Arrival> {
        let goal = Goal::Circle(orbit, sampled.entry.direction);
        let hint = Hint::Neighbour(&sampled.transition);
        let to_beat = sampled.transition.duration;
        let draft = self.pilot.draft(here, goal, &orbit.at(sampled.entry), hint, to_beat).ok()?;
        let transition = self.pilot.polish(here, goal, &draft).ok()?;
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

    pub(crate) fn to_pad(&self, here: &Motion, pad: [f64; 3]) -> (Option<Transition>, Vec<Candidate>) {
        let there = self.landing(pad);
        let hint = Hint::Time(self.least_time(here, &there));
        let solved = self.pilot.fly(here, Goal::Hover(there), &there, hint);
        let outcome = outcome_of(solved.as_ref());
        (solved.ok(), vec![Candidate { entry: None, outcome }])
    }
}

fn outcome_of(solved: Result<&Transition, &Unsolved>) -> Outcome {
    match solved {
        Ok(transition) => Outcome::Solved { duration: transition.duration },
        Err(&Unsolved { primal_residual, dual_residual }) => {
            Outcome::Failed { primal_residual, dual_residual }
        }
    }
}

/// The solved transition whose entry is next to `entry` on the circle, in the same direction, up to an eighth of a turn away.
fn neighbour(drafted: &[Drafted], entry: Entry) -> Option<&Transition> {
    let apart = |drafted: &Drafted| {
        let turn = (drafted.entry.angle - entry.angle).rem_euclid(std::f64::consts::TAU);
        turn.min(std::f64::consts::TAU - turn)
    };
    drafted
        .iter()
        .filter(|drafted| drafted.entry.direction == entry.direction)
        .filter(|drafted| apart(drafted) <= std::f64::consts::FRAC_PI_4 + 1e-9)
        .min_by(|a, b| apart(a).total_cmp(&apart(b)).then_with(|| a.index.cmp(&b.index)))
        .map(|drafted| &drafted.draft.transition)
}
