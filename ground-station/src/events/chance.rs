//! Targets that come, go and move by chance.

use super::TimedEvent;
use crate::study::Draw;
use planner::{Event, Mission, Target};

/// How often something happens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrivals {
    /// Events per minute, at least 0: half of them targets that appear, a quarter each that vanish and that move.
    pub rate: f64,
    /// Seed of times, kinds and places.
    pub seed: u64,
}

/// A Poisson process of events over a mission.
pub struct Chance {
    draw: Draw,
    rate: f64,
    time: f64,
}

impl Chance {
    /// Begins at the mission's start.
    #[must_use]
    pub fn new(arrivals: Arrivals) -> Self {
        Self { draw: Draw::new(arrivals.seed, 0, 0), rate: arrivals.rate / 60.0, time: 0.0 }
    }

    /// The next event before a time (s); `None` when there is none any more.
    ///
    /// Places are uniform in the rectangle of the targets and the depot. A place that is too close to a target is left to the
    /// planner to refuse.
    pub fn next(&mut self, mission: &Mission, until: f64) -> Option<TimedEvent> {
        self.time -= (1.0 - self.draw.between(0.0, 1.0)).ln() / self.rate;
        // False for a rate of 0 too: the time is then infinite.
        if self.time < until {
            Some(TimedEvent { time: self.time, event: self.event(mission) })
        } else {
            None
        }
    }

    fn event(&mut self, mission: &Mission) -> Event {
        let place = self.place(mission);
        let (kind, which) = (self.draw.between(0.0, 4.0), self.draw.between(0.0, 1.0));
        let target = (which * mission.targets.len() as f64) as usize;
        match kind {
            kind if kind < 2.0 || mission.targets.is_empty() => Event::TargetAppears(Target::at(place)),
            kind if kind < 3.0 => Event::TargetVanishes(target),
            _ => Event::TargetMoves(target, place),
        }
    }

    fn place(&mut self, mission: &Mission) -> [f64; 2] {
        let mut corners = [mission.depot; 2];
        for target in &mission.targets {
            for (axis, &value) in target.position.iter().enumerate() {
                corners[0][axis] = corners[0][axis].min(value);
                corners[1][axis] = corners[1][axis].max(value);
            }
        }
        [0, 1].map(|axis| self.draw.between(corners[0][axis], corners[1][axis]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_come_as_often_as_asked_and_are_the_same_again() -> Result<(), crate::failure::Failure> {
        let mission = crate::input::built_in()?.mission;
        let all = |rate| {
            let mut chance = Chance::new(Arrivals { rate, seed: 3 });
            std::iter::from_fn(|| chance.next(&mission, 6000.0)).collect::<Vec<_>>()
        };
        let events = all(10.0);
        assert!((900..1100).contains(&events.len()), "{}", events.len());
        assert!(events.windows(2).all(|pair| pair[0].time <= pair[1].time));
        let appearing = events.iter().filter(|timed| matches!(timed.event, Event::TargetAppears(_))).count();
        assert!((420..580).contains(&appearing), "{appearing}");
        assert_eq!(events, all(10.0));
        assert!(all(0.0).is_empty());
        Ok(())
    }
}
