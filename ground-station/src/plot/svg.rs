//! A small writer of SVG: shapes with presentation attributes, two decimals, escaped text.

use std::fmt::Write;

/// Where a text hangs on its point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// It begins there.
    Start,
    /// It is centred there.
    Middle,
    /// It ends there.
    End,
}

/// How a text looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextStyle {
    /// Height of the letters (px).
    pub size: f64,
    /// Colour.
    pub colour: &'static str,
    /// Where it hangs on its point.
    pub anchor: Anchor,
    /// Bold letters.
    pub bold: bool,
    /// A white rim, which keeps it readable on lines.
    pub halo: bool,
}

/// How a line looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Colour.
    pub colour: &'static str,
    /// Width (px).
    pub width: f64,
    /// Lengths of dash and gap (px); solid if `None`.
    pub dash: Option<[f64; 2]>,
    /// From 0 (invisible) to 1.
    pub opacity: f64,
}

impl Stroke {
    /// A solid line.
    #[must_use]
    pub const fn solid(colour: &'static str, width: f64) -> Self {
        Self { colour, width, dash: None, opacity: 1.0 }
    }

    /// The same line, dashed.
    #[must_use]
    pub const fn dashed(self, dash: f64, gap: f64) -> Self {
        Self { dash: Some([dash, gap]), ..self }
    }

    /// The same line, fainter.
    #[must_use]
    pub const fn faint(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }
}

/// A picture being written.
#[derive(Debug, Clone)]
pub struct Svg {
    text: String,
}

impl Svg {
    /// An empty white picture; the title is for screen readers and browser tabs.
    #[must_use]
    pub fn new(width: f64, height: f64, title: &str) -> Self {
        let (width, height) = (number(width), number(height));
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n"
        );
        let _ = writeln!(text, "<title>{}</title>", escaped(title));
        let _ = writeln!(text, "<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>");
        Self { text }
    }

    /// The finished document.
    #[must_use]
    pub fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }

    /// A line through points.
    pub fn polyline(&mut self, points: &[[f64; 2]], stroke: Stroke) {
        if points.len() > 1 {
            let path = path_of(points);
            let _ = writeln!(self.text, "<path d=\"{path}\" fill=\"none\"{}/>", attributes(stroke));
        }
    }

    /// A filled polygon.
    pub fn polygon(&mut self, points: &[[f64; 2]], fill: &str) {
        let _ = writeln!(self.text, "<path d=\"{}Z\" fill=\"{fill}\"/>", path_of(points));
    }

    /// A filled rectangle.
    pub fn rectangle(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], fill: &str, opacity: f64) {
        let (x, y, width, height) = (number(x), number(y), number(width), number(height));
        let _ = writeln!(
            self.text,
            "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"{fill}\" fill-opacity=\"{}\"/>",
            number(opacity)
        );
    }

    /// A circle with a rim.
    pub fn ring(&mut self, [x, y]: [f64; 2], radius: f64, stroke: Stroke) {
        let (x, y, radius) = (number(x), number(y), number(radius));
        let _ = writeln!(
            self.text,
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"none\"{}/>",
            attributes(stroke)
        );
    }

    /// A filled circle.
    pub fn disc(&mut self, [x, y]: [f64; 2], radius: f64, fill: &str, opacity: f64) {
        let (x, y, radius) = (number(x), number(y), number(radius));
        let opacity = number(opacity);
        let _ = writeln!(
            self.text,
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"{fill}\" fill-opacity=\"{opacity}\"/>"
        );
    }

    /// A line of text; `at` is on its base line.
    pub fn text(&mut self, at: [f64; 2], text: &str, style: TextStyle) {
        self.write_text(at, text, style, "");
    }

    /// A line of text that reads upwards.
    pub fn text_upwards(&mut self, at: [f64; 2], text: &str, style: TextStyle) {
        let turn = format!(" transform=\"rotate(-90 {} {})\"", number(at[0]), number(at[1]));
        self.write_text(at, text, style, &turn);
    }

    fn write_text(&mut self, [x, y]: [f64; 2], text: &str, style: TextStyle, extra: &str) {
        let anchor = match style.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let weight = if style.bold { " font-weight=\"bold\"" } else { "" };
        let halo = if style.halo {
            " stroke=\"#ffffff\" stroke-width=\"3\" stroke-opacity=\"0.85\" paint-order=\"stroke\""
        } else {
            ""
        };
        let _ = writeln!(
            self.text,
            "<text x=\"{}\" y=\"{}\" font-size=\"{}\" fill=\"{}\" text-anchor=\"{anchor}\"{weight}{halo}{extra}>{}</text>",
            number(x),
            number(y),
            number(style.size),
            style.colour,
            escaped(text)
        );
    }
}

/// How wide a text of a sans-serif face is, near enough to keep things apart (px).
#[must_use]
pub fn text_width(text: &str, size: f64) -> f64 {
    0.58 * size * text.chars().count() as f64
}

fn attributes(stroke: Stroke) -> String {
    let mut text = format!(" stroke=\"{}\" stroke-width=\"{}\"", stroke.colour, number(stroke.width));
    if let Some([dash, gap]) = stroke.dash {
        let _ = write!(text, " stroke-dasharray=\"{} {}\"", number(dash), number(gap));
    }
    if stroke.opacity < 1.0 {
        let _ = write!(text, " stroke-opacity=\"{}\"", number(stroke.opacity));
    }
    text
}

fn path_of(points: &[[f64; 2]]) -> String {
    let mut path = String::new();
    for (index, [x, y]) in points.iter().enumerate() {
        let _ = write!(path, "{}{} {}", if index == 0 { "M" } else { "L" }, number(*x), number(*y));
    }
    path
}

/// At most two decimals, no trailing zeros, no negative zero; what is not finite becomes 0, since SVG has no word for it.
fn number(value: f64) -> String {
    let text = format!("{:.2}", if value.is_finite() { value } else { 0.0 });
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            // XML 1.0 has no way to write the other control characters.
            control if control.is_control() => escaped.push(' '),
            other => escaped.push(other),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_finite() {
        for (value, text) in
            [(1.0, "1"), (-0.001, "0"), (2.345, "2.35"), (f64::NAN, "0"), (1e3, "1000"), (0.5, "0.5")]
        {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn text_is_escaped() {
        let mut svg = Svg::new(10.0, 10.0, "a < b & \u{1}");
        let style = TextStyle { size: 9.0, colour: "#000", anchor: Anchor::End, bold: true, halo: true };
        svg.text([1.0, 2.0], "</svg>", style);
        let text = svg.finish();
        assert!(text.contains("<title>a &lt; b &amp;  </title>") && text.contains("&lt;/svg&gt;"));
        assert_eq!(text.matches("</svg>").count(), 1);
    }
}
