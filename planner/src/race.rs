//! The candidate entries of one circle: sketched in order of promise, the fastest sketches drafted, the fastest draft polished,
//! until none that is left can be faster than what can be flown.

use crate::entry::Entrance;
use crate::plan::{Candidate, Entry, Outcome, Transition};
use crate::transition::{Detail, Draft, Hint, Unsolved};

/// How much slower than the fastest sketch of a leg a sketch may be to be drafted: so many seconds, and a share of its time.
const MARGIN: [f64; 2] = [0.03, 0.002];

/// What an entry that is not sketched is expected to take longer than its bound, as a share of the least such excess that the
/// sketches of its leg show, and at most so much (s): along a short leg the excess differs little; along a long one it is great where
/// the bounds are loose, and the entries that are sketched first are just those.
const EXPECTED_SHARE: f64 = 0.5;
const MOST_EXPECTED: f64 = 0.5;

/// A sketch that exceeds its bound by so much (s) more than a neighbour's does is caught in a local minimum that the neighbour has not
/// met, a turn the other way round for example: along a circle the excess changes slowly as long as the flights are alike.
const JUMP: f64 = 0.1;

/// The candidate that is flown.
pub(crate) struct Arrival {
    pub entry: Entry,
    pub transition: Transition,
}

/// How far a candidate has come.
enum Standing {
    /// Not looked at, but for its lower bound.
    Open,
    /// No sketch could be made.
    Unsketched,
    /// Given up at this detail when something else was faster.
    Slower(Detail, Draft),
    /// Solved to the end at this detail.
    Solved(Detail, Draft),
    /// Polished; its time of flight (s).
    Polished(f64),
    Failed(Unsolved),
}

/// All candidates of a circle.
pub(crate) struct Race<'a> {
    entrances: &'a [Entrance],
    standings: Vec<Standing>,
    /// Times of complete sketches (s), infinite where there is none or the candidate has failed.
    sketched: Vec<f64>,
    /// Which candidates were sketched again, from a better neighbour's trajectory.
    is_again: Vec<bool>,
    best: Option<Arrival>,
    /// Whether every candidate is drafted to the end and polished.
    exhaustive: bool,
}

impl<'a> Race<'a> {
    pub(crate) fn new(entrances: &'a [Entrance], exhaustive: bool) -> Self {
        let standings = entrances.iter().map(|_| Standing::Open).collect();
        Self {
            entrances,
            standings,
            sketched: vec![f64::INFINITY; entrances.len()],
            is_again: vec![false; entrances.len()],
            best: None,
            exhaustive,
        }
    }

    /// What a candidate must stay below at some detail to be worth anything (s).
    pub(crate) fn to_beat(&self, detail: Detail) -> f64 {
        if self.exhaustive {
            return f64::INFINITY;
        }
        let drafts = self.standings.iter().filter_map(|standing| match standing {
            Standing::Solved(Detail::Full, draft) => Some(draft.time),
            _ => None,
        });
        let solved = drafts.fold(self.flown(), f64::min);
        match detail {
            Detail::Full => solved,
            // Where a draft or a polished transition turned out slower than a sketch, that sketch may win after all.
            Detail::Sketch => {
                let fastest = self.sketched.iter().copied().fold(f64::INFINITY, f64::min);
                let close = MARGIN[0] + fastest * (1.0 + MARGIN[1]);
                if solved.is_finite() { close.max(solved) } else { close }
            }
        }
    }

    /// Time of the best that can be flown (s).
    fn flown(&self) -> f64 {
        self.best.as_ref().map_or(f64::INFINITY, |best| best.transition.duration)
    }

    /// The neighbour from whose trajectory a sketch should be made again, if that could be faster than what it has to beat (s).
    fn better_neighbour(&self, index: usize, to_beat: f64) -> Option<&Draft> {
        let (Standing::Slower(Detail::Sketch, draft) | Standing::Solved(Detail::Sketch, draft)) =
            &self.standings[index]
        else {
            return None;
        };
        let Entrance { entry, lower_bound } = self.entrances[index];
        if self.exhaustive || self.is_again[index] {
            return None;
        }
        let better = |excess: f64| lower_bound + excess + JUMP < draft.time && lower_bound + excess < to_beat;
        self.neighbours(entry)
            .map(|(other, theirs)| (theirs.time - other.lower_bound, theirs))
            .filter(|(excess, _)| better(*excess))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, theirs)| theirs)
    }

    /// Whether a candidate should be solved at a detail, given what it has to beat there (s).
    pub(crate) fn is_promising(&self, index: usize, detail: Detail, to_beat: f64) -> bool {
        match (&self.standings[index], detail) {
            (Standing::Open, Detail::Sketch) => self.expected(index) < to_beat,
            (Standing::Unsketched, Detail::Full) => self.entrances[index].lower_bound < to_beat,
            (Standing::Slower(given_up, draft), _) if *given_up == detail => {
                draft.time < to_beat || self.better_neighbour(index, to_beat).is_some()
            }
            (Standing::Solved(Detail::Sketch, _), Detail::Sketch) => {
                self.better_neighbour(index, to_beat).is_some()
            }
            (Standing::Solved(Detail::Sketch, draft), Detail::Full) => {
                draft.time < self.to_beat(Detail::Sketch)
            }
            _ => false,
        }
    }

    /// The least that a sketch takes longer than its bound (s); 0 without sketches and in an exhaustive race.
    fn least_excess(&self) -> f64 {
        let excesses =
            self.entrances.iter().zip(&self.sketched).map(|(entrance, time)| time - entrance.lower_bound);
        let least = excesses.fold(f64::INFINITY, f64::min);
        if least.is_finite() && !self.exhaustive { least.max(0.0) } else { 0.0 }
    }

    /// What a candidate that has not been sketched is expected to take at least (s); its lower bound in an exhaustive race.
    fn expected(&self, index: usize) -> f64 {
        self.entrances[index].lower_bound + (EXPECTED_SHARE * self.least_excess()).min(MOST_EXPECTED)
    }

    /// The candidates by ascending time of their trajectories or, where there is none, lower bound; ties by index.
    pub(crate) fn by_promise(&self) -> Vec<usize> {
        let promise = |index: usize| match &self.standings[index] {
            Standing::Slower(_, draft) | Standing::Solved(_, draft) => draft.time,
            _ => self.entrances[index].lower_bound,
        };
        let mut order: Vec<usize> = (0..self.entrances.len()).collect();
        order.sort_by(|&a, &b| promise(a).total_cmp(&promise(b)));
        order
    }

    /// Takes down what became of a solve at a detail.
    pub(crate) fn solved(&mut self, index: usize, detail: Detail, outcome: Result<Draft, Unsolved>) {
        if detail == Detail::Sketch
            && let Standing::Slower(_, before) | Standing::Solved(_, before) = &self.standings[index]
        {
            self.is_again[index] = true;
            if outcome.as_ref().map_or(true, |draft| draft.time >= before.time) {
                return;
            }
        }
        self.standings[index] = match (outcome, detail) {
            (Ok(draft), _) if draft.is_complete => {
                if detail == Detail::Sketch {
                    self.sketched[index] = draft.time;
                }
                Standing::Solved(detail, draft)
            }
            (Ok(draft), _) => Standing::Slower(detail, draft),
            (Err(_), Detail::Sketch) => Standing::Unsketched,
            (Err(unsolved), Detail::Full) => self.failed(index, unsolved),
        };
    }

    fn failed(&mut self, index: usize, unsolved: Unsolved) -> Standing {
        self.sketched[index] = f64::INFINITY;
        Standing::Failed(unsolved)
    }

    /// Hands out the fastest draft if it is to be polished; of equals the one that stands first.
    pub(crate) fn take_fastest(&mut self) -> Option<(usize, Draft)> {
        let limit = if self.exhaustive { f64::INFINITY } else { self.flown() };
        let mut fastest: Option<(usize, f64)> = None;
        for (index, standing) in self.standings.iter().enumerate() {
            if let Standing::Solved(Detail::Full, draft) = standing
                && draft.time < fastest.map_or(limit, |(_, duration)| duration)
            {
                fastest = Some((index, draft.time));
            }
        }
        let (index, duration) = fastest?;
        match std::mem::replace(&mut self.standings[index], Standing::Polished(duration)) {
            Standing::Solved(_, draft) => Some((index, draft)),
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
            Err(unsolved) => self.failed(index, unsolved),
        };
    }

    /// What a solve at some detail starts from. A first sketch has a guess of its own: a neighbour's trajectory takes no
    /// less time and leads into the neighbour's local minimum.
    pub(crate) fn hint(&self, index: usize, detail: Detail, to_beat: f64) -> Hint<'_> {
        let own = match &self.standings[index] {
            Standing::Slower(_, draft) | Standing::Solved(_, draft) => Some(draft),
            _ => None,
        };
        let Entrance { entry, lower_bound } = self.entrances[index];
        let apart = |other: &Entrance| apart(other.entry.angle, entry.angle);
        let nearest = || self.neighbours(entry).min_by(|a, b| apart(a.0).total_cmp(&apart(b.0)));
        let neighbour = match (detail, own) {
            (Detail::Full, Some(draft)) => return Hint::Sketch(draft),
            (Detail::Full, None) => nearest().map(|(_, draft)| draft),
            (Detail::Sketch, own) => self.better_neighbour(index, to_beat).or(own),
        };
        neighbour.map_or(Hint::Time(lower_bound), |draft| Hint::Neighbour(&draft.transition))
    }

    /// The solved candidates whose entries lie up to an eighth of a turn from `entry`, in the same direction.
    fn neighbours(&self, entry: Entry) -> impl Iterator<Item = (&Entrance, &Draft)> {
        let is_near = move |other: Entry| {
            other.direction == entry.direction
                && apart(other.angle, entry.angle) <= std::f64::consts::FRAC_PI_4 + 1e-9
        };
        self.entrances.iter().zip(&self.standings).filter_map(move |(entrance, standing)| match standing {
            Standing::Solved(_, draft) if is_near(entrance.entry) => Some((entrance, draft)),
            _ => None,
        })
    }

    /// The best that can be flown, and what became of every candidate.
    pub(crate) fn finish(self) -> (Option<Arrival>, Vec<Candidate>) {
        let flown = self.flown();
        let outcome = |(index, standing): (usize, &Standing)| match standing {
            Standing::Open | Standing::Unsketched => match self.entrances[index].lower_bound {
                lower_bound if lower_bound >= flown => Outcome::ProvenWorse { lower_bound },
                _ => Outcome::Slower { duration: self.expected(index) },
            },
            Standing::Slower(_, draft) | Standing::Solved(Detail::Sketch, draft) => {
                Outcome::Slower { duration: draft.time }
            }
            Standing::Solved(Detail::Full, draft) => Outcome::Solved { duration: draft.time },
            &Standing::Polished(duration) => Outcome::Solved { duration },
            Standing::Failed(unsolved) => unsolved.into(),
        };
        let outcomes = self.standings.iter().enumerate().map(outcome);
        let candidates = self
            .entrances
            .iter()
            .zip(outcomes)
            .map(|(entrance, outcome)| Candidate { entry: Some(entrance.entry), outcome });
        let candidates = candidates.collect();
        (self.best, candidates)
    }
}

/// The angle between two directions (rad).
fn apart(a: f64, b: f64) -> f64 {
    let turn = (a - b).rem_euclid(std::f64::consts::TAU);
    turn.min(std::f64::consts::TAU - turn)
}
