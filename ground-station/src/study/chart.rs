//! Curves with the range of their values, from the rows of a study.

use super::tally::Row;
use crate::plot::{Anchor, Stroke, Svg, TextStyle, colour, tick_label, ticks};

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 480.0;
const LEFT: f64 = 70.0;
const RIGHT: f64 = 30.0;
const TOP: f64 = 60.0;
const BOTTOM: f64 = 56.0;
const SMALL: TextStyle =
    TextStyle { size: 11.0, colour: "#6b6b6b", anchor: Anchor::Middle, bold: false, halo: false };

/// What stands beside the curves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Words<'a> {
    /// Above.
    pub title: &'a str,
    /// Below.
    pub x: &'a str,
    /// On the left.
    pub y: &'a str,
    /// Bars from the least to the greatest value.
    pub shows_range: bool,
}

/// The words for a study's chart.
#[must_use]
pub fn words_of(study: &str) -> Words<'static> {
    match study {
        "cost" => {
            Words { title: "path cost per vehicle (mean)", x: "targets n", y: "metres", shows_range: false }
        }
        "procedures" => Words {
            title: "length of Procedure 1 over Procedure 2 (mean, least, greatest)",
            x: "arrivals r",
            y: "ratio",
            shows_range: true,
        },
        _ => Words {
            title: "transition time, quadcopter over holonomic vehicle (mean, least, greatest)",
            x: "distance to the next circle (loiter radii)",
            y: "ratio",
            shows_range: true,
        },
    }
}

/// The chart as SVG.
#[must_use]
pub fn chart(rows: &[Row], words: Words<'_>) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT, words.title);
    let heading = TextStyle { size: 15.0, colour: "#222222", anchor: Anchor::Start, bold: true, halo: false };
    svg.text([LEFT, 24.0], words.title, heading);
    let rows: Vec<&Row> = rows.iter().filter(|row| row.tally.count > 0).collect();
    let highest = |row: &&Row| if words.shows_range { row.tally.greatest } else { row.tally.mean() };
    let high = 1.05 * rows.iter().map(highest).fold(1e-9, f64::max);
    let widest = rows.iter().map(|row| row.x).fold(1e-9, f64::max) * 1.03;
    let x = |value: f64| LEFT + (WIDTH - LEFT - RIGHT) * value / widest;
    let y = |value: f64| HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * value / high;
    let (across, up) = (ticks(0.0, widest, 8), ticks(0.0, high, 6));
    for &tick in &up {
        svg.polyline(&[[LEFT, y(tick)], [WIDTH - RIGHT, y(tick)]], Stroke::solid("#e9e9e9", 1.0));
        let style = TextStyle { anchor: Anchor::End, ..SMALL };
        svg.text([LEFT - 7.0, y(tick) + 4.0], &tick_label(tick, &up), style);
    }
    for &tick in &across {
        svg.text([x(tick), HEIGHT - BOTTOM + 17.0], &tick_label(tick, &across), SMALL);
    }
    let mut names: Vec<&str> = rows.iter().map(|row| row.series.as_str()).collect();
    names.dedup();
    for (index, name) in names.iter().enumerate() {
        let curve: Vec<&&Row> = rows.iter().filter(|row| row.series == *name).collect();
        let line: Vec<[f64; 2]> = curve.iter().map(|row| [x(row.x), y(row.tally.mean())]).collect();
        svg.polyline(&line, Stroke::solid(colour(index), 2.0));
        for row in curve {
            if words.shows_range {
                let bar = [[x(row.x), y(row.tally.least)], [x(row.x), y(row.tally.greatest)]];
                svg.polyline(&bar, Stroke::solid(colour(index), 1.2));
            }
            svg.disc([x(row.x), y(row.tally.mean())], 3.5, colour(index), 1.0);
        }
        let style =
            TextStyle { size: 12.0, colour: colour(index), anchor: Anchor::Start, bold: false, halo: false };
        svg.text([LEFT + 110.0 * (index % 6) as f64, 44.0], name, style);
    }
    let axis = TextStyle { size: 12.0, colour: "#222222", ..SMALL };
    svg.text([(LEFT + WIDTH - RIGHT) / 2.0, HEIGHT - 14.0], words.x, axis);
    svg.text_upwards([20.0, (TOP + HEIGHT - BOTTOM) / 2.0], words.y, axis);
    svg.finish()
}
