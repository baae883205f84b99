//! The map of a plan: targets, circles, tours and trajectories in equal axes, with a legend beside it.

mod legend;
mod view;

use super::axis::{tick_label, ticks};
use super::labels::{Area, Labels};
use super::palette::{GREY, GRID, INK, colour};
use super::path::simplified;
use super::svg::{Anchor, Stroke, Svg, TextStyle, text_width};
use legend::legend;
use view::{LEFT, TOP, View};

/// What is drawn. Positions are east, north (m).
#[derive(Debug, Clone, PartialEq)]
pub struct MapScene {
    /// Heading.
    pub title: String,
    /// Where the team starts.
    pub depot: [f64; 2],
    /// The targets.
    pub targets: Vec<MapTarget>,
    /// The vehicles.
    pub vehicles: Vec<MapVehicle>,
}

/// A target.
#[derive(Debug, Clone, PartialEq)]
pub struct MapTarget {
    /// Its number or name.
    pub label: String,
    /// Where it is.
    pub position: [f64; 2],
    /// What is kept from it (m).
    pub safe_distance: f64,
}

/// A vehicle with all it does.
#[derive(Debug, Clone, PartialEq)]
pub struct MapVehicle {
    /// Where it starts.
    pub pad: [f64; 2],
    /// Its circles, in the order of its route.
    pub circles: Vec<MapCircle>,
    /// The path it flies.
    pub track: Vec<[f64; 2]>,
    /// A line for the legend.
    pub caption: String,
}

/// A circle as it is flown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapCircle {
    /// Where its middle is.
    pub centre: [f64; 2],
    /// Its radius (m).
    pub radius: f64,
    /// +1 counter-clockwise, -1 clockwise.
    pub direction: i8,
    /// Where it is entered (rad, from east, counter-clockwise).
    pub entry: f64,
}

const BOTTOM: f64 = 48.0;
/// Least width of the legend.
const LEGEND: f64 = 236.0;
/// Room for the legend's lines.
const LEAST_HEIGHT: f64 = 430.0;

const SMALL: TextStyle =
    TextStyle { size: 11.0, colour: GREY, anchor: Anchor::Middle, bold: false, halo: false };

/// Draws the map.
#[must_use]
pub fn map(scene: &MapScene) -> String {
    let view = View::of(scene);
    let height = TOP + view.size[1].max(LEAST_HEIGHT) + BOTTOM;
    // The space beside the map, the symbols and the margin.
    let caption = |vehicle: &MapVehicle| text_width(&vehicle.caption, SMALL.size) + 72.0;
    let beside = scene.vehicles.iter().map(caption).fold(LEGEND, f64::max);
    let mut svg = Svg::new(LEFT + view.size[0] + beside, height, &scene.title);
    let heading = TextStyle { size: 16.0, colour: INK, anchor: Anchor::Start, bold: true, halo: false };
    svg.text([LEFT, 28.0], &scene.title, heading);
    axes(&mut svg, &view);
    for target in &scene.targets {
        svg.disc(view.at(target.position), view.scale * target.safe_distance, "#000000", 0.07);
    }
    let mut labels = Labels::on(view.paper().shrunk(5.0));
    for (index, vehicle) in scene.vehicles.iter().enumerate() {
        tour(&mut svg, &view, vehicle, index);
    }
    for (index, vehicle) in scene.vehicles.iter().enumerate() {
        let track: Vec<[f64; 2]> = vehicle.track.iter().map(|&point| view.at(point)).collect();
        let track = simplified(&track, 0.08);
        svg.polyline(&track, Stroke::solid(colour(index), 1.7));
        labels.avoid(&track);
    }
    for (index, vehicle) in scene.vehicles.iter().enumerate() {
        for circle in &vehicle.circles {
            direction(&mut svg, &view, circle, index);
        }
    }
    depot(&mut svg, &view, scene, &mut labels);
    targets(&mut svg, &view, scene, &mut labels);
    legend(&mut svg, &view, scene);
    svg.finish()
}

fn axes(svg: &mut Svg, view: &View) {
    let Area { low: [left, top], high: [right, bottom] } = view.paper();
    let high = view.high();
    let east_ticks = ticks(view.low()[0], high[0], 8);
    for &tick in &east_ticks {
        let [x, _] = view.at([tick, 0.0]);
        svg.polyline(&[[x, top], [x, bottom]], Stroke::solid(GRID, 1.0));
        svg.polyline(&[[x, bottom], [x, bottom + 4.0]], Stroke::solid(INK, 1.0));
        svg.text([x, bottom + 17.0], &tick_label(tick, &east_ticks), SMALL);
    }
    let north_ticks = ticks(view.low()[1], high[1], 8);
    for &tick in &north_ticks {
        let [_, y] = view.at([0.0, tick]);
        svg.polyline(&[[left, y], [right, y]], Stroke::solid(GRID, 1.0));
        svg.polyline(&[[left - 4.0, y], [left, y]], Stroke::solid(INK, 1.0));
        let style = TextStyle { anchor: Anchor::End, ..SMALL };
        svg.text([left - 8.0, y + 4.0], &tick_label(tick, &north_ticks), style);
    }
    let frame = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
    svg.polyline(&frame, Stroke::solid(INK, 1.0));
    let style = TextStyle { size: 12.0, colour: INK, ..SMALL };
    svg.text([(left + right) / 2.0, bottom + 37.0], "east (m)", style);
    svg.text_upwards([18.0, (top + bottom) / 2.0], "north (m)", style);
}

/// The straight lines that the route search saw: pad, centres in order, pad.
fn tour(svg: &mut Svg, view: &View, vehicle: &MapVehicle, index: usize) {
    if vehicle.circles.is_empty() {
        return;
    }
    let centres = vehicle.circles.iter().map(|circle| circle.centre);
    let corners = std::iter::once(vehicle.pad).chain(centres).chain(std::iter::once(vehicle.pad));
    let line: Vec<[f64; 2]> = corners.map(|corner| view.at(corner)).collect();
    svg.polyline(&line, Stroke::solid(colour(index), 1.0).dashed(4.0, 4.0).faint(0.6));
}

/// Arrow heads on a circle, and the circle itself where the track is too small to show it.
fn direction(svg: &mut Svg, view: &View, circle: &MapCircle, index: usize) {
    let centre = view.at(circle.centre);
    let radius = view.radius(circle);
    if view.is_symbol(circle) {
        svg.disc(centre, radius, "#ffffff", 1.0);
        svg.ring(centre, radius, Stroke::solid(colour(index), 1.3));
    }
    let length = (0.45 * radius).clamp(5.5, 9.0);
    let turns: &[f64] = if radius > 14.0 { &[0.25, 0.75] } else { &[0.5] };
    for turn in turns {
        let angle = circle.entry + f64::from(circle.direction) * turn * std::f64::consts::TAU;
        svg.polygon(&arrow_head(centre, radius, angle, circle.direction, length), colour(index));
    }
}

/// A triangle on the circle at an angle (counter-clockwise from east) that points along the flight.
fn arrow_head(centre: [f64; 2], radius: f64, angle: f64, direction: i8, length: f64) -> [[f64; 2]; 3] {
    let sign = f64::from(direction);
    // The paper's y axis points down.
    let outward = [angle.cos(), -angle.sin()];
    let along = [-sign * angle.sin(), -sign * angle.cos()];
    let middle = [centre[0] + radius * outward[0], centre[1] + radius * outward[1]];
    let corner = |forward: f64, side: f64| {
        [0, 1].map(|axis| middle[axis] + length * (forward * along[axis] + side * outward[axis]))
    };
    [corner(0.6, 0.0), corner(-0.5, 0.45), corner(-0.5, -0.45)]
}

fn depot(svg: &mut Svg, view: &View, scene: &MapScene, labels: &mut Labels) {
    for (index, vehicle) in scene.vehicles.iter().enumerate() {
        let at = view.at(vehicle.pad);
        svg.disc(at, 4.5, "#ffffff", 1.0);
        svg.ring(at, 3.5, Stroke::solid(colour(index), 2.0));
        labels.take(Area::around(at, [9.0, 9.0]));
    }
    let at = view.at(scene.depot);
    depot_symbol(svg, at);
    labels.take(Area::around(at, [13.0, 13.0]));
    let middle = labels.place(at, 9.0, [text_width("depot", 11.0), 11.0]);
    let style = TextStyle { colour: INK, halo: true, ..SMALL };
    svg.text([middle[0], middle[1] + 4.0], "depot", style);
}

fn depot_symbol(svg: &mut Svg, [x, y]: [f64; 2]) {
    svg.polygon(&[[x, y - 6.5], [x + 6.5, y], [x, y + 6.5], [x - 6.5, y]], INK);
}

fn targets(svg: &mut Svg, view: &View, scene: &MapScene, labels: &mut Labels) {
    let crowded = scene.targets.len() > 40;
    let (size, dot) = if crowded { (9.0, 1.6) } else { (12.0, 2.6) };
    for target in &scene.targets {
        let at = view.at(target.position);
        svg.disc(at, dot, INK, 1.0);
        labels.take(Area::around(at, [4.0 * dot; 2]));
    }
    for target in &scene.targets {
        let at = view.at(target.position);
        let around = scene.vehicles.iter().flat_map(|vehicle| &vehicle.circles);
        let symbol = around.filter(|circle| view.is_symbol(circle));
        let gap = if symbol.count() > 0 { 8.5 } else { dot + 2.0 };
        let middle = labels.place(at, gap, [text_width(&target.label, size), size]);
        let style = TextStyle { size, colour: INK, bold: !crowded, halo: true, anchor: Anchor::Middle };
        svg.text([middle[0], middle[1] + 0.36 * size], &target.label, style);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(centre: [f64; 2]) -> MapCircle {
        MapCircle { centre, radius: 3.0, direction: 1, entry: 0.3 }
    }

    fn scene(spread: f64) -> MapScene {
        let target =
            |number: usize, position| MapTarget { label: number.to_string(), position, safe_distance: 1.5 };
        MapScene {
            title: "field".into(),
            depot: [0.0, 0.0],
            targets: vec![target(1, [spread, 0.5 * spread]), target(2, [0.2 * spread, spread])],
            vehicles: vec![MapVehicle {
                pad: [0.0, 0.0],
                circles: vec![circle([spread, 0.5 * spread]), circle([0.2 * spread, spread])],
                track: vec![
                    [0.0, 0.0],
                    [spread, 0.5 * spread - 3.0],
                    [0.2 * spread, spread - 3.0],
                    [0.0, 0.0],
                ],
                caption: "vehicle 1".into(),
            }],
        }
    }

    #[test]
    fn axes_are_equal_and_everything_is_inside() {
        let scene = scene(40.0);
        let view = View::of(&scene);
        let [origin, east, north] = [view.at([0.0, 0.0]), view.at([1.0, 0.0]), view.at([0.0, 1.0])];
        assert!((east[0] - origin[0] - (origin[1] - north[1])).abs() < 1e-9);
        let paper = view.paper();
        for target in &scene.targets {
            let at = Area::around(view.at(target.position), [2.0 * view.scale * 3.0; 2]);
            assert!((paper.overlap(&at) - 36.0 * view.scale * view.scale).abs() < 1e-6);
        }
    }

    #[test]
    fn the_parts_are_there() {
        let near = map(&scene(40.0));
        for part in [">1<", ">2<", ">depot<", ">vehicle 1<", ">east (m)<", ">N<", ">5 m<", "stroke-dasharray"]
        {
            assert!(near.contains(part), "{part}");
        }
        assert!(near.contains("circle and its direction"));
        assert!(map(&scene(2000.0)).contains("not to scale"));
    }

    #[test]
    fn arrow_heads_point_along_the_flight() {
        for (direction, up) in [(1, true), (-1, false)] {
            let [tip, left, right] = arrow_head([0.0, 0.0], 10.0, 0.0, direction, 5.0);
            assert_eq!(tip[1] < left[1].min(right[1]), up);
        }
    }

    #[test]
    fn an_empty_scene_is_a_map_too() {
        let empty = MapScene { title: "<&>".into(), depot: [5.0, 5.0], targets: vec![], vehicles: vec![] };
        assert!(map(&empty).ends_with("</svg>\n"));
    }
}
