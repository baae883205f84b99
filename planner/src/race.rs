//! The candidate entries of one circle: drafted in order of promise, the fastest draft polished, until none that is left can be
//! faster than what can be flown.

use crate::entry::Entrance;
use crate::plan::{Candidate, Entry, Outcome, Transition};
use crate::transition::{Draft, Unsolved};

/// The candidate that is flown.
pub(crate) struct Arrival {
    pub entry: Entry,
    pub transition: Transition,
}

/// How far a candidate has come.
enum Standing {
    /// Not looked at, but for its lower bound.
    Open,
    /// Given up when something else was faster.
    Slower(Draft),
    /// Drafted to the end.
    Drafted(Draft),
    /// Polished; its time of flight (s).
    Polished(f64),
    Failed(Unsolved),
}

/// All candidates of a circle.
pub(crate) struct Race<'a> {
    entrances: &'a [Entrance],
    standings: Vec<Standing>,
    best: Option<Arrival>,
    /// Whether every candidate is drafted to the end and polished.
    exhaustive: bool,
}

impl<'a> Race<'a> {
    pub(crate) fn new(entrances: &'a [Entrance], exhaustive: bool) -> Self {
        let standings = entrances.iter().map(|_| Standing::Open).collect();
        Self { entrances, standings, best: None, exhaustive }
    }

    /// What a candidate must stay below to be worth anything (s): the best that can be flown, or the fastest draft.
    pub(crate) fn to_beat(&self) -> f64 {
        if self.exhaustive {
            return f64::INFINITY;
        }
        let drafts = self.standings.iter().filter_map(|standing| match standing {
            Standing::Drafted(draft) => Some(draft.transition.duration),
            _ => None,
        });
        drafts.fold(self.flown(), f64::min)
    }

    /// Time of the best that can be flown (s).
    fn flown(&self) -> f64 {
        self.best.as_ref().map_or(f64::INFINITY, |best| best.transition.duration)
    }

    /// Whether a candidate could still stay below `to_beat` (s): by its bound, or by the time at which it was given up.
    pub(crate) fn is_promising(&self, index: usize, to_beat: f64) -> bool {
        match &self.standings[index] {
            Standing::Open => self.entrances[index].lower_bound < to_beat,
            Standing::Slower(draft) => draft.transition.duration < to_beat,
            _ => false,
        }
    }

    /// Takes down what became of a draft.
    pub(crate) fn drafted(&mut self, index: usize, outcome: Result<Draft, Unsolved>) {
        self.standings[index] = match outcome {
            Ok(draft) if draft.is_complete => Standing::Drafted(draft),
            Ok(draft) => Standing::Slower(draft),
            Err(unsolved) => Standing::Failed(unsolved),
        };
    }

    /// Hands out the fastest draft if it is to be polished; of equals the one that stands first.
    pub(crate) fn take_fastest(&mut self) -> Option<(usize, Draft)> {
        let limit = if self.exhaustive { f64::INFINITY } else { self.flown() };
        let mut fastest: Option<(usize, f64)> = None;
        for (index, standing) in self.standings.iter().enumerate() {
            if let Standing::Drafted(draft) = standing
                && draft.transition.duration < fastest.map_or(limit, |(_, duration)| duration)
            {
                fastest = Some((index, draft.transition.duration));
            }
        }
        let (index, duration) = fastest?;
        match std::mem::replace(&mut self.standings[index], Standing::Polished(duration)) {
            Standing::Drafted(draft) => Some((index, draft)),
            _ => None,
        }
    }

    /// Takes down what became of a polished draft.
    pub(crate) fn polished(&mut self, index: usize, outcome: Result<Transition, Unsolved>) {
        self.standings[index] = match outcome {
            Ok(transition) => {
                let duration = transition.duration;
                if duration < self.flown() {
                    self.best = Some(Arrival { entry: self.entrances[index].entry, transition });
                }
                Standing::Polished(duration)
            }
            Err(unsolved) => Standing::Failed(unsolved),
        };
    }

    /// The drafted transition whose entry is next to `entry` on the circle, in the same direction, up to an eighth of a turn
    /// away.
    pub(crate) fn neighbour(&self, entry: Entry) -> Option<&Transition> {
        let apart = |other: Entry| {
            let turn = (other.angle - entry.angle).rem_euclid(std::f64::consts::TAU);
            turn.min(std::f64::consts::TAU - turn)
        };
        let drafts =
            self.entrances.iter().zip(&self.standings).filter_map(|(entrance, standing)| match standing {
                Standing::Slower(draft) | Standing::Drafted(draft) => {
                    Some((entrance.entry, &draft.transition))
                }
                _ => None,
            });
        drafts
            .filter(|(other, _)| other.direction == entry.direction)
            .map(|(other, transition)| (apart(other), transition))
            .filter(|(apart, _)| *apart <= std::f64::consts::FRAC_PI_4 + 1e-9)
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, transition)| transition)
    }

    /// The best that can be flown, and what became of every candidate.
    pub(crate) fn finish(self) -> (Option<Arrival>, Vec<Candidate>) {
        let outcome = |(entrance, standing): (&Entrance, &Standing)| Candidate {
            entry: Some(entrance.entry),
            outcome: match standing {
                Standing::Open => Outcome::ProvenWorse { lower_bound: entrance.lower_bound },
                Standing::Slower(draft) => Outcome::Slower { duration: draft.transition.duration },
                Standing::Drafted(draft) => Outcome::Solved { duration: draft.transition.duration },
                &Standing::Polished(duration) => Outcome::Solved { duration },
                Standing::Failed(unsolved) => unsolved.into(),
            },
        };
        let candidates = self.entrances.iter().zip(&self.standings).map(outcome).collect();
        (self.best, candidates)
    }
}
