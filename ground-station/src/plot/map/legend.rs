//! The legend beside the map: vehicles, symbols, scale bar, north arrow.

use super::view::{LEFT, TOP, View};
use super::{MapScene, SMALL, arrow_head, depot_symbol};
use crate::plot::axis::round_step;
use crate::plot::palette::{GREY, INK, colour};
use crate::plot::svg::{Anchor, Stroke, Svg, TextStyle};

/// Draws the legend.
pub(super) fn legend(svg: &mut Svg, view: &View, scene: &MapScene) {
    let mut pen = Pen { svg, x: LEFT + view.size[0] + 22.0, y: TOP + 10.0 };
    pen.heading("Vehicles");
    for (index, vehicle) in scene.vehicles.iter().enumerate() {
        let y = pen.y - 4.0;
        pen.svg.polyline(&[[pen.x, y], [pen.x + 24.0, y]], Stroke::solid(colour(index), 2.4));
        pen.entry(&vehicle.caption);
    }
    pen.y += 12.0;
    pen.heading("Symbols");
    symbols(&mut pen, view, scene);
    pen.y += 14.0;
    scale_bar(&mut pen, view);
    north_arrow(pen.svg, [pen.x + 166.0, pen.y]);
}

/// Writes the legend line by line.
struct Pen<'a> {
    svg: &'a mut Svg,
    x: f64,
    y: f64,
}

impl Pen<'_> {
    fn heading(&mut self, text: &str) {
        let style = TextStyle { size: 12.0, colour: INK, anchor: Anchor::Start, bold: true, halo: false };
        self.svg.text([self.x, self.y], text, style);
        self.y += 20.0;
    }

    fn entry(&mut self, text: &str) {
        let style = TextStyle { colour: INK, anchor: Anchor::Start, ..SMALL };
        self.svg.text([self.x + 34.0, self.y], text, style);
        self.y += 18.0;
    }

    fn middle(&self) -> [f64; 2] {
        [self.x + 12.0, self.y - 4.0]
    }
}

fn symbols(pen: &mut Pen<'_>, view: &View, scene: &MapScene) {
    let line = |pen: &Pen<'_>| [[pen.x, pen.y - 4.0], [pen.x + 24.0, pen.y - 4.0]];
    let (trajectory, straight) = (line(pen), Stroke::solid(GREY, 1.7));
    pen.svg.polyline(&trajectory, straight);
    pen.entry("trajectory");
    let dashes = line(pen);
    pen.svg.polyline(&dashes, Stroke::solid(GREY, 1.0).dashed(4.0, 4.0));
    pen.entry("tour");
    let middle = pen.middle();
    pen.svg.ring(middle, 6.0, Stroke::solid(GREY, 1.5));
    pen.svg.polygon(&arrow_head(middle, 6.0, 0.0, 1, 6.5), GREY);
    let mut circles = scene.vehicles.iter().flat_map(|vehicle| &vehicle.circles);
    let symbolic = circles.any(|circle| view.is_symbol(circle));
    pen.entry(if symbolic { "circle (not to scale), direction" } else { "circle and its direction" });
    let middle = pen.middle();
    if view.scale * scene.targets.iter().map(|target| target.safe_distance).fold(0.0, f64::max) > 3.0 {
        pen.svg.disc(middle, 7.5, "#000000", 0.1);
        pen.svg.disc(middle, 2.6, INK, 1.0);
        pen.entry("target, safe distance");
    } else {
        pen.svg.disc(middle, 2.0, INK, 1.0);
        pen.entry("target");
    }
    let middle = pen.middle();
    depot_symbol(pen.svg, middle);
    pen.entry("depot");
    let middle = pen.middle();
    pen.svg.ring(middle, 3.5, Stroke::solid(GREY, 2.0));
    pen.entry("pad of a vehicle");
}

fn scale_bar(pen: &mut Pen<'_>, view: &View) {
    let length = round_step(60.0 / view.scale);
    let (from, to) = (pen.x, pen.x + view.scale * length);
    let y = pen.y;
    let half = (from + to) / 2.0;
    pen.svg.polyline(&[[from, y], [to, y]], Stroke::solid(INK, 1.5));
    for x in [from, half, to] {
        pen.svg.polyline(&[[x, y - 4.0], [x, y + 4.0]], Stroke::solid(INK, 1.5));
    }
    let text = if length < 1000.0 { format!("{length} m") } else { format!("{} km", length / 1000.0) };
    pen.svg.text([half, y + 18.0], &text, TextStyle { colour: INK, ..SMALL });
}

fn north_arrow(svg: &mut Svg, [x, y]: [f64; 2]) {
    svg.polygon(&[[x, y - 16.0], [x + 6.5, y + 8.0], [x, y + 3.0]], INK);
    let outline = [[x, y - 16.0], [x - 6.5, y + 8.0], [x, y + 3.0], [x, y - 16.0]];
    svg.polyline(&outline, Stroke::solid(INK, 1.0));
    let style = TextStyle { size: 12.0, colour: INK, anchor: Anchor::Middle, bold: true, halo: false };
    svg.text([x, y + 22.0], "N", style);
}
