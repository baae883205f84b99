//! The loop of a session: a clock, a connection, a log and an operator around the [`Session`].

use super::frames::frame;
use super::session::{Event, Request, Session};
use super::tlog::TelemetryLog;
use super::transport::Transport;
use crate::failure::Failure;
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
    /// What an operator has asked for since the last call.
    pub requests: &'a mut dyn FnMut() -> Vec<Request>,
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
        for request in (surroundings.requests)() {
            session.ask(request, now);
        }
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

/// Reads a line of an operator: `hold`, `return` or `land`, for all vehicles or for the one whose number follows.
///
/// # Errors
///
/// What is wrong with it, in plain words.
pub fn parse_request(line: &str) -> Result<Option<Request>, String> {
    let remedy = || {
        format!(
            "\"{}\" is not known: say hold, return or land, with a vehicle's number or without",
            line.trim()
        )
    };
    let mut words = line.split_whitespace();
    let Some(word) = words.next().filter(|word| !word.starts_with('#')) else { return Ok(None) };
    let action = SAFE_ACTIONS
        .iter()
        .find(|(known, _)| *known == word)
        .map(|&(_, action)| action)
        .ok_or_else(remedy)?;
    let vehicle = words.next().map(|number| number.parse().map_err(|_| remedy())).transpose()?;
    if words.next().is_some() { Err(remedy()) } else { Ok(Some(Request { vehicle, action })) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::link::settings::SafeAction;

    #[test]
    fn an_operators_lines() {
        assert_eq!(parse_request("hold\n"), Ok(Some(Request { vehicle: None, action: SafeAction::Hold })));
        assert_eq!(
            parse_request(" return 2 "),
            Ok(Some(Request { vehicle: Some(2), action: SafeAction::Return }))
        );
        assert_eq!((parse_request(""), parse_request("# later")), (Ok(None), Ok(None)));
        for line in ["stop", "hold two", "land 1 2"] {
            assert!(parse_request(line).is_err(), "{line}");
        }
    }
}
