//! Quantities over the time of one vehicle's flight: panels below each other on one time axis.

use super::axis::{tick_label, ticks};
use super::palette::{GREY, GRID, INK, colour};
use super::path::simplified;
use super::svg::{Anchor, Stroke, Svg, TextStyle, text_width};

/// What is drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Heading.
    pub title: String,
    /// The vehicle, from 0: its colour.
    pub vehicle: usize,
    /// Time of every sample (s), ascending.
    pub times: Vec<f64>,
    /// The panels, top to bottom.
    pub panels: Vec<Panel>,
    /// When the vehicle circles, and what.
    pub loiters: Vec<Band>,
}

/// One quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Name and unit: "speed (m/s)".
    pub title: String,
    /// One value per sample.
    pub values: Vec<f64>,
    /// Limits to draw.
    pub limits: Vec<Limit>,
}

/// A limit.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// What it is: "loiter budget".
    pub name: String,
    /// Its value, in the panel's unit.
    pub value: f64,
}

/// A stretch of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// From, to (s).
    pub span: [f64; 2],
    /// Its label.
    pub label: String,
}

const WIDTH: f64 = 900.0;
const LEFT: f64 = 66.0;
const RIGHT: f64 = 128.0;
const TOP: f64 = 66.0;
const PANEL: f64 = 150.0;
const GAP: f64 = 26.0;
const BOTTOM: f64 = 50.0;

const SMALL: TextStyle =
    TextStyle { size: 11.0, colour: GREY, anchor: Anchor::Middle, bold: false, halo: false };

/// Draws the profile.
#[must_use]
pub fn profile(profile: &Profile) -> String {
    let rows = profile.panels.len() as f64;
    let height = TOP + rows * PANEL + (rows - 1.0).max(0.0) * GAP + BOTTOM;
    let mut svg = Svg::new(WIDTH, height, &profile.title);
    let heading = TextStyle { size: 16.0, colour: INK, anchor: Anchor::Start, bold: true, halo: false };
    svg.text([LEFT, 26.0], &profile.title, heading);
    if !profile.loiters.is_empty() {
        svg.text(
            [WIDTH - RIGHT, 26.0],
            "shaded: circling the target named above",
            TextStyle { anchor: Anchor::End, ..SMALL },
        );
    }
    let end = profile.times.last().copied().unwrap_or(0.0).max(1e-3);
    let start = profile.times.first().copied().unwrap_or(0.0).min(end - 1e-3);
    let plotter = Plotter { profile, start, end };
    for (index, panel) in profile.panels.iter().enumerate() {
        let top = TOP + index as f64 * (PANEL + GAP);
        plotter.panel(&mut svg, panel, top, index == 0);
    }
    let time_ticks = ticks(start, end, 9);
    for &tick in &time_ticks {
        svg.text([plotter.x(tick), height - BOTTOM + 17.0], &tick_label(tick, &time_ticks), SMALL);
    }
    let axis = TextStyle { size: 12.0, colour: INK, ..SMALL };
    svg.text([(LEFT + WIDTH - RIGHT) / 2.0, height - 12.0], "time (s)", axis);
    svg.finish()
}

struct Plotter<'a> {
    profile: &'a Profile,
    start: f64,
    end: f64,
}

impl Plotter<'_> {
    fn x(&self, time: f64) -> f64 {
        LEFT + (WIDTH - LEFT - RIGHT) * (time - self.start) / (self.end - self.start)
    }

    fn panel(&self, svg: &mut Svg, panel: &Panel, top: f64, first: bool) {
        let (left, right, bottom) = (LEFT, WIDTH - RIGHT, top + PANEL);
        let high = highest(panel);
        let y = |value: f64| bottom - PANEL * value / high;
        self.bands(svg, top, first);
        let value_ticks = ticks(0.0, high, 4);
        for &tick in &value_ticks {
            svg.polyline(&[[left, y(tick)], [right, y(tick)]], Stroke::solid(GRID, 1.0));
            let style = TextStyle { anchor: Anchor::End, ..SMALL };
            svg.text([left - 7.0, y(tick) + 4.0], &tick_label(tick, &value_ticks), style);
        }
        for &tick in &ticks(self.start, self.end, 9) {
            svg.polyline(&[[self.x(tick), bottom], [self.x(tick), bottom + 4.0]], Stroke::solid(INK, 1.0));
        }
        let times = self.profile.times.iter();
        let line: Vec<[f64; 2]> =
            times.zip(&panel.values).map(|(&time, &value)| [self.x(time), y(value)]).collect();
        svg.polyline(&simplified(&line, 0.1), Stroke::solid(colour(self.profile.vehicle), 1.6));
        limits(svg, panel, y, right);
        svg.polyline(&[[left, top], [left, bottom], [right, bottom]], Stroke::solid(INK, 1.0));
        let style = TextStyle { size: 12.0, colour: INK, ..SMALL };
        svg.text_upwards([22.0, (top + bottom) / 2.0], &panel.title, style);
    }

    /// The loiters as shaded stretches; above the first panel stands what is circled, in two rows where it is crowded.
    fn bands(&self, svg: &mut Svg, top: f64, labelled: bool) {
        let mut free_from = [f64::NEG_INFINITY; 2];
        for band in &self.profile.loiters {
            let [from, to] = band.span.map(|time| self.x(time));
            svg.rectangle([from, top], [(to - from).max(0.0), PANEL], "#000000", 0.06);
            let (middle, half) = ((from + to) / 2.0, text_width(&band.label, SMALL.size) / 2.0);
            let row = free_from.iter().position(|&free| middle - half > free).filter(|_| labelled);
            if let Some(row) = row {
                svg.text([middle, top - 6.0 - 13.0 * row as f64], &band.label, SMALL);
                free_from[row] = middle + half + 3.0;
            }
        }
    }
}

/// The top of a panel's axis: everything that is drawn, and a little air.
fn highest(panel: &Panel) -> f64 {
    let limits = panel.limits.iter().map(|limit| limit.value);
    let values = panel.values.iter().copied().chain(limits).filter(|value| value.is_finite());
    let high = values.fold(0.0, f64::max);
    if high > 0.0 { 1.08 * high } else { 1.0 }
}

/// Dashed lines with their names at the right-hand side, pushed apart where they would overlap.
fn limits(svg: &mut Svg, panel: &Panel, y: impl Fn(f64) -> f64, right: f64) {
    const LINE: f64 = 12.0;
    let mut limits: Vec<&Limit> = panel.limits.iter().filter(|limit| limit.value.is_finite()).collect();
    limits.sort_by(|a, b| a.value.total_cmp(&b.value));
    let mut ceiling = f64::INFINITY;
    for limit in limits {
        let at = y(limit.value);
        svg.polyline(&[[LEFT, at], [right, at]], Stroke::solid(INK, 1.0).dashed(5.0, 4.0).faint(0.75));
        let text_at = (at + 4.0).min(ceiling);
        let style = TextStyle { anchor: Anchor::Start, colour: INK, ..SMALL };
        svg.text([right + 6.0, text_at], &limit.name, style);
        ceiling = text_at - LINE;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_and_loiters_are_drawn_and_labelled() {
        let picture = profile(&Profile {
            title: "vehicle 1".into(),
            vehicle: 0,
            times: (0..100).map(f64::from).collect(),
            panels: vec![Panel {
                title: "speed (m/s)".into(),
                values: (0..100).map(|i| (f64::from(i) * 0.1).sin().abs() * 5.0).collect(),
                limits: vec![
                    Limit { name: "limit".into(), value: 6.0 },
                    Limit { name: "none".into(), value: f64::INFINITY },
                ],
            }],
            loiters: vec![Band { span: [20.0, 40.0], label: "7".into() }],
        });
        assert_eq!(picture.matches("stroke-dasharray").count(), 1);
        assert!(picture.contains(">limit<") && !picture.contains(">none<") && picture.contains(">7<"));
        assert!(picture.contains("fill-opacity=\"0.06\""));
    }

    #[test]
    fn a_vehicle_that_never_flew_has_a_picture_too() {
        let empty =
            Profile { title: String::new(), vehicle: 3, times: vec![], panels: vec![], loiters: vec![] };
        assert!(profile(&empty).ends_with("</svg>\n"));
    }
}
