//! Values on the command line: words and numbers in ranges.

use crate::execution::Way;
use crate::export::fleet::Format;
use crate::geodesy::Origin;
use crate::input::Autopilot;
use crate::link::settings::SafeAction;
use crate::study::Shard;
use crate::words::{self, TRANSCRIPTIONS};
use clap::ValueEnum;
use planner::Transcription;
use planner::mtsp::Objective;

/// One of the words of a table.
pub(super) fn parse_word<T: Copy>(words: &[(&'static str, T)], text: &str) -> Result<T, String> {
    let found = words.iter().find(|(word, _)| *word == text).map(|&(_, value)| value);
    let list = || words.iter().map(|(word, _)| *word).collect::<Vec<_>>().join(", ");
    found.ok_or_else(|| format!("give one of {}", list()))
}

pub(super) fn parse_way(text: &str) -> Result<Way, String> {
    parse_word(&words::WAYS, text)
}

pub(super) fn parse_action(text: &str) -> Result<SafeAction, String> {
    parse_word(&words::SAFE_ACTIONS, text)
}

pub(super) fn parse_positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| *number > 0.0 && number.is_finite());
    number.ok_or_else(|| "give a number above 0".to_owned())
}

/// PX4 lets go below 2 Hz; above 100 Hz radios are full.
pub(super) fn parse_setpoint_rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate| (4.0..=100.0).contains(rate));
    rate.ok_or_else(|| "give a number of setpoints per second from 4 to 100".to_owned())
}

/// A firmware.
pub(super) fn parse_autopilot(text: &str) -> Result<Autopilot, String> {
    parse_word(&words::AUTOPILOTS, text)
}

/// A format of `export`.
pub(super) fn parse_format(text: &str) -> Result<Format, String> {
    const FORMATS: [(&str, Format); 5] = [
        ("plan", Format::Plan),
        ("waypoints", Format::Waypoints),
        ("kml", Format::Kml),
        ("geojson", Format::GeoJson),
        ("csv", Format::Csv),
    ];
    parse_word(&FORMATS, text)
}

/// What routes are made short for.
pub(super) fn parse_objective(text: &str) -> Result<Objective, String> {
    parse_word(&[("makespan", Objective::Makespan), ("total", Objective::Total)], text)
}

pub(super) fn parse_not_negative(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| *number >= 0.0 && number.is_finite());
    number.ok_or_else(|| "give a number, 0 or more".to_owned())
}

/// `EAST,NORTH`, up to a storm.
pub(super) fn parse_wind(text: &str) -> Result<[f64; 2], String> {
    const STORM: f64 = 40.0;
    let read = || {
        let (east, north) = text.split_once(',')?;
        let wind = [east.trim().parse().ok()?, north.trim().parse::<f64>().ok()?];
        wind.iter().all(|part: &f64| part.abs() <= STORM).then_some(wind)
    };
    read().ok_or_else(|| format!("give EAST,NORTH in m/s, each at most {STORM}: 3,-2"))
}

/// `I/N`, both from 1.
pub(super) fn parse_shard(text: &str) -> Result<Shard, String> {
    let read = || {
        let (index, count) = text.split_once('/')?;
        let (index, count): (usize, usize) = (index.parse().ok()?, count.parse().ok()?);
        (1..=count).contains(&index).then(|| Shard { index: index - 1, count })
    };
    read().ok_or_else(|| "give a part and the number of parts: 2/8".to_owned())
}

/// `latitude,longitude[,altitude]`.
pub(super) fn parse_origin(text: &str) -> Result<Origin, String> {
    const REMEDY: &str = "give LATITUDE,LONGITUDE or LATITUDE,LONGITUDE,ALTITUDE in degrees and metres";
    let numbers: Option<Vec<f64>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    let (latitude, longitude, altitude) = match numbers.as_deref() {
        Some(&[latitude, longitude]) => (latitude, longitude, 0.0),
        Some(&[latitude, longitude, altitude]) => (latitude, longitude, altitude),
        _ => return Err(REMEDY.to_owned()),
    };
    let is_inside =
        latitude.abs() <= 89.0 && longitude.abs() <= 180.0 && (-500.0..=9000.0).contains(&altitude);
    if is_inside { Ok(Origin { latitude, longitude, altitude }) } else { Err(REMEDY.to_owned()) }
}

/// A transcription on the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TranscriptionWord(pub(super) Transcription);

const WORDS: [TranscriptionWord; 3] = [
    TranscriptionWord(TRANSCRIPTIONS[0].1),
    TranscriptionWord(TRANSCRIPTIONS[1].1),
    TranscriptionWord(TRANSCRIPTIONS[2].1),
];

impl ValueEnum for TranscriptionWord {
    fn value_variants<'a>() -> &'a [Self] {
        &WORDS
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        Some(clap::builder::PossibleValue::new(crate::words::word(&TRANSCRIPTIONS, &self.0)))
    }
}

/// A rate that makes a table of sensible length.
pub(super) fn parse_rate(text: &str) -> Result<f64, String> {
    const RATES: std::ops::RangeInclusive<f64> = 0.1..=1000.0;
    let rate = text.parse().ok().filter(|rate| RATES.contains(rate));
    rate.ok_or_else(|| "give a number of samples per second from 0.1 to 1000".to_owned())
}
