//! Events of a mission that is under way, as a file lists them and as chance sends them.
//!
//! A file has one event a line; `#` begins a comment. Targets and vehicles are numbered from 1, as in the tables; a target that
//! appears gets the next number. Times are seconds after the mission's start, positions metres east and north:
//!
//! ```text
//! 12.5 appears 14.0 -6.5
//! 20   moves 3 10.0 -4.0
//! 25   vanishes 7
//! 30   fails 2
//! 41   returns 2
//! ```

mod chance;

pub use chance::{Arrivals, Chance};

use crate::failure::{Failure, reason};
use crate::problem::{Problem, abridged};
use planner::{Event, Target};
use std::path::Path;

/// An event and when it happens.
#[derive(Debug, Clone, PartialEq)]
pub struct TimedEvent {
    /// Seconds after the mission's start.
    pub time: f64,
    /// What happens.
    pub event: Event,
}

const REMEDY: &str = "give TIME appears EAST NORTH, TIME moves TARGET EAST NORTH, TIME vanishes TARGET, \
                      TIME fails VEHICLE or TIME returns VEHICLE";

/// Farther than any vehicle of this kind flies (m).
const FARTHEST: f64 = 1e6;

/// Reads a file of events; they come back in the order of time, those of one moment as they are listed.
///
/// # Errors
///
/// [`Failure::Input`] with every line that is wrong.
pub fn read(path: &Path) -> Result<Vec<TimedEvent>, Failure> {
    let file = path.display().to_string();
    let problem = |line, message| Problem { file: file.clone(), line, key: String::new(), message };
    let text = std::fs::read_to_string(path).map_err(|error| {
        let message = format!("cannot be read ({}): give the name of a file of events", reason(&error));
        Failure::Input(vec![problem(None, message)])
    })?;
    let (mut events, mut problems) = (Vec::new(), Vec::new());
    for (index, line) in text.lines().enumerate() {
        match parse(line) {
            Ok(event) => events.extend(event),
            Err(message) => problems.push(problem(Some(index + 1), message)),
        }
    }
    events.sort_by(|a, b| a.time.total_cmp(&b.time));
    if problems.is_empty() { Ok(events) } else { Err(Failure::Input(problems)) }
}

/// Reads one line; nothing for a blank line or a comment.
///
/// # Errors
///
/// What is wrong with it and what is right, in plain words.
pub fn parse(line: &str) -> Result<Option<TimedEvent>, String> {
    let line = line.split('#').next().unwrap_or_default();
    let words: Vec<&str> = line.split_whitespace().collect();
    let Some((time, rest)) = words.split_first() else { return Ok(None) };
    let event = number(time, 0.0).zip(event_of(rest)).map(|(time, event)| TimedEvent { time, event });
    event.map(Some).ok_or_else(|| format!("\"{}\" is not an event: {REMEDY}", abridged(line)))
}

fn event_of(words: &[&str]) -> Option<Event> {
    let place = |east, north| Some([number(east, -FARTHEST)?, number(north, -FARTHEST)?]);
    Some(match *words {
        ["appears", east, north] => Event::TargetAppears(Target::at(place(east, north)?)),
        ["moves", target, east, north] => Event::TargetMoves(index(target)?, place(east, north)?),
        ["vanishes", target] => Event::TargetVanishes(index(target)?),
        ["fails", vehicle] => Event::VehicleFails(index(vehicle)?),
        ["returns", vehicle] => Event::VehicleReturns(index(vehicle)?),
        _ => return None,
    })
}

fn number(word: &str, least: f64) -> Option<f64> {
    word.parse().ok().filter(|number| (least..=FARTHEST).contains(number))
}

/// People count from 1.
fn index(word: &str) -> Option<usize> {
    word.parse::<usize>().ok()?.checked_sub(1)
}

/// What happens, in words for a log.
#[must_use]
pub fn words(event: &Event, targets: usize) -> String {
    match event {
        Event::TargetAppears(target) => {
            let [east, north] = target.position;
            format!("target {} appears at {east:.1} m east, {north:.1} m north", targets + 1)
        }
        Event::TargetMoves(target, [east, north]) => {
            format!("target {} moves to {east:.1} m east, {north:.1} m north", target + 1)
        }
        Event::TargetVanishes(target) => format!("target {} vanishes", target + 1),
        Event::VehicleFails(vehicle) => format!("vehicle {} fails", vehicle + 1),
        Event::VehicleReturns(vehicle) => format!("vehicle {} can be used again", vehicle + 1),
        other => format!("{other:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn lines_are_events() {
        let event = |line: &str| parse(line).ok().flatten().map(|timed| (timed.time, timed.event));
        assert_eq!(
            event("12.5 appears 14 -6.5"),
            Some((12.5, Event::TargetAppears(Target::at([14.0, -6.5]))))
        );
        assert_eq!(event(" 0 moves 3 1 2 # away"), Some((0.0, Event::TargetMoves(2, [1.0, 2.0]))));
        assert_eq!(event("7 vanishes 1"), Some((7.0, Event::TargetVanishes(0))));
        assert_eq!(event("7 fails 2"), Some((7.0, Event::VehicleFails(1))));
        assert_eq!(event("7 returns 2"), Some((7.0, Event::VehicleReturns(1))));
        assert_eq!((parse(""), parse("  # nothing")), (Ok(None), Ok(None)));
        for line in [
            "appears 1 2",
            "-1 fails 1",
            "nan fails 1",
            "1 fails 0",
            "1 fails",
            "1 fails 1 2",
            "1 appears inf 2",
            "1 moves 1 2",
        ] {
            let message = parse(line).expect_err(line);
            assert!(message.contains(line) && message.contains("TIME fails VEHICLE"), "{message}");
        }
    }

    proptest! {
        /// Any text is an event, nothing, or a problem; what is read is finite.
        #[test]
        fn any_line_is_answered(line in "([0-9.eE+-]{0,6} (appears|moves|vanishes|fails|returns) ?[0-9.na -]{0,20})|\\PC{0,60}") {
            if let Ok(Some(timed)) = parse(&line) {
                prop_assert!(timed.time >= 0.0 && timed.time.is_finite());
            }
        }
    }
}
