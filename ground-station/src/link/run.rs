//! The loop of a session: a clock, a connection, a log and an operator around the [`Session`].

use super::frames::frame;
use super::session::{Event, Request, Session};
use super::tlog::TelemetryLog;
use super::transport::Transport;
use crate::events::{self, TimedEvent};
use crate::failure::Failure;
use crate::problem::abridged;
use crate::words::SAFE_ACTIONS;
use std::time::{SystemTime, UNIX_EPOCH};

/// Our own system and component (`MAV_COMP_ID_MISSIONPLANNER`).
const SYSTEM: u8 = 255;
const COMPONENT: u8 = 190;

/// What a session runs with.
pub struct Surroundings<'a> {
    /// The connection.
    pub transport: Transport,
    /// Its name, for messages.
    pub address: String,
    /// Where every frame is noted.
    pub log: Option<TelemetryLog>,
    /// Seconds since the session's start.
    pub clock: &'a dyn Fn() -> f64,
    /// Called again and again with the time: does what an operator has asked for since, and follows events.
    pub attend: &'a mut dyn FnMut(&mut Session, f64),
    /// Who is told what happens.
    pub tell: &'a mut dyn FnMut(&Event),
}

/// Runs a session to its end.
///
/// # Errors
///
/// [`Failure::Link`] if the connection breaks, [`Failure::Write`] if the log cannot be written, [`Failure::Flight`] if
/// vehicles did not do what was asked.
pub fn run(session: &mut Session, surroundings: &mut Surroundings<'_>) -> Result<(), Failure> {
    let mut sequence = 0;
    loop {
        let now = (surroundings.clock)();
        (surroundings.attend)(session, now);
        for (system, message) in session.poll(now) {
            let bytes = frame(SYSTEM, COMPONENT, sequence, &message);
            sequence = sequence.wrapping_add(1);
            // What a full link does not take is repeated by whoever waits for an answer.
            if surroundings.transport.send(system, &bytes).map_err(broken(&surroundings.address))? {
                note(&mut surroundings.log, &bytes)?;
            }
        }
        session.take_events().iter().for_each(&mut *surroundings.tell);
        if session.is_over() {
            break;
        }
        for received in surroundings.transport.receive().map_err(broken(&surroundings.address))? {
            note(&mut surroundings.log, &received.frame)?;
            session.receive(&received, (surroundings.clock)());
        }
    }
    surroundings.log.as_mut().map_or(Ok(()), TelemetryLog::flush)?;
    let failures = session.failures();
    if failures.is_empty() { Ok(()) } else { Err(Failure::Flight(failures)) }
}

fn broken(address: &str) -> impl Fn(std::io::Error) -> Failure + use<> {
    let address = address.to_owned();
    move |source| Failure::Link { address: address.clone(), source }
}

fn note(log: &mut Option<TelemetryLog>, frame: &[u8]) -> Result<(), Failure> {
    let Some(log) = log else { return Ok(()) };
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    log.add(since.as_micros() as u64, frame)
}

/// What an operator says.
#[derive(Debug, Clone, PartialEq)]
pub enum Line {
    /// Hold, return or land.
    Request(Request),
    /// Something that the plan has to follow.
    Event(TimedEvent),
}

/// Reads a line of an operator: `hold`, `return` or `land`, for all vehicles or for the one whose number follows; or an event as
/// [`events`] reads it, without a time for one that happens now.
///
/// # Errors
///
/// What is wrong with it, in plain words.
pub fn parse_line(line: &str) -> Result<Option<Line>, String> {
    let mut words = line.split('#').next().unwrap_or_default().split_whitespace();
    let Some(word) = words.next() else { return Ok(None) };
    if let Some(&(_, action)) = SAFE_ACTIONS.iter().find(|(known, _)| *known == word) {
        let vehicle = words.next().map(str::parse).transpose();
        if let (Ok(vehicle), None) = (vehicle, words.next()) {
            return Ok(Some(Line::Request(Request { vehicle, action })));
        }
    }
    let event = match word.parse::<f64>() {
        Ok(_) => events::parse(line),
        Err(_) => events::parse(&format!("0 {line}")),
    };
    event.map(|event| event.map(Line::Event)).map_err(|_| {
        format!(
            "\"{}\" is not known: say hold, return or land, with a vehicle's number or without; or an event: appears EAST NORTH, \
             moves TARGET EAST NORTH, vanishes TARGET, fails VEHICLE, with the time before it or for now",
            abridged(line.trim())
        )
    })
}

#[cfg(test)]
mod tests {
    use super::{Line, Request, TimedEvent, parse_line};
    use crate::link::settings::SafeAction;
    use planner::Event;

    #[test]
    fn an_operators_lines() {
        let request = |vehicle, action| Ok(Some(Line::Request(Request { vehicle, action })));
        assert_eq!(parse_line("hold\n"), request(None, SafeAction::Hold));
        assert_eq!(parse_line(" return 2 # now"), request(Some(2), SafeAction::Return));
        assert_eq!((parse_line(""), parse_line("# later")), (Ok(None), Ok(None)));
        let event = |time, event| Ok(Some(Line::Event(TimedEvent { time, event })));
        assert_eq!(parse_line("vanishes 2"), event(0.0, Event::TargetVanishes(1)));
        assert_eq!(parse_line("12.5 fails 1"), event(12.5, Event::VehicleFails(0)));
        for line in ["stop", "hold two", "land 1 2", "fails", "-1 fails 2", "appears 1"] {
            assert!(parse_line(line).is_err_and(|problem| problem.contains(line)), "{line}");
        }
    }
}
