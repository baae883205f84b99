//! Colours that people with any colour vision can tell apart, on white paper.

/// Okabe and Ito (2008) without its yellow, which is too faint for lines on white, and with a dark wine as the eighth.
const COLOURS: [&str; 8] =
    ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#444444", "#882255"];

/// The colour of a vehicle, numbered from 0; from the ninth on they repeat, and labels tell them apart.
#[must_use]
pub fn colour(vehicle: usize) -> &'static str {
    COLOURS[vehicle % COLOURS.len()]
}

/// Text and axes.
pub const INK: &str = "#222222";
/// What stays in the background: captions, ticks.
pub const GREY: &str = "#6b6b6b";
/// Grid lines.
pub const GRID: &str = "#e9e9e9";
