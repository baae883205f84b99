//! Minimum-time flights to five entries on the near semicircle of a circle, from hover at three distances (the paper's Fig. 3).
//!
//! The faster of both directions is shown for each entry.

use super::solver;
use crate::failure::Failure;
use crate::plot::colour;
use planner::{Entries, Mission, Options, Pipeline, Target};
use std::f64::consts::PI;
use std::fmt::Write;

/// One flight: to an entry (rad from the line to the start, counter-clockwise), from a distance (m).
#[derive(Debug, Clone, PartialEq)]
pub struct Flight {
    /// Distance of the start from the centre (m).
    pub distance: f64,
    /// The entry's angle, 0 nearest to the start.
    pub entry: f64,
    /// +1 for counter-clockwise.
    pub direction: i8,
    /// Time of flight (s).
    pub duration: f64,
    /// Times from the start of the flight (s).
    pub times: Vec<f64>,
    /// Positions (m): the centre at the origin, the start on the positive x axis.
    pub path: Vec<[f64; 3]>,
}

/// Entries on the semicircle.
const ENTRIES: usize = 5;
/// Samples per second.
const RATE: f64 = 50.0;

/// All flights, with the vehicle and settings of a mission; distances in loiter radii from the centre.
///
/// # Errors
///
/// [`Failure::Refused`] if a flight cannot be solved.
pub fn run(mission: &Mission, distances: &[f64]) -> Result<Vec<Flight>, Failure> {
    let mut flights = Vec::new();
    for &distance in distances {
        for index in 0..ENTRIES {
            let entry = -PI / 2.0 + PI * index as f64 / (ENTRIES - 1) as f64;
            flights.push(one(mission, distance * mission.loiter.radius, entry)?);
        }
    }
    Ok(flights)
}

/// The planner tries the entry at angle 0 when it tries one: the start is turned instead, and the path turned back. Leg by leg it
/// takes the faster direction.
fn one(settings: &Mission, distance: f64, entry: f64) -> Result<Flight, Failure> {
    let mut mission = settings.clone();
    mission.targets = vec![Target::at([0.0, 0.0])];
    mission.fleet.vehicles = 1;
    mission.merge_within = 0.0;
    mission.pipeline = Pipeline::Paper;
    mission.depot = [distance * entry.cos(), -distance * entry.sin()];
    mission.transition.entries = Entries::Sampled(1);
    let plan = planner::plan(&mission, &Options::default()).map_err(solver)?;
    let leg =
        plan.vehicles.first().and_then(|vehicle| vehicle.legs.first()).ok_or_else(|| solver("no flight"))?;
    let (duration, start) = (leg.transition.duration, leg.start_time);
    let direction = leg.loiter.map_or(1, |loiter| crate::words::sign(loiter.entry.direction));
    let steps = (duration * RATE).ceil() as usize;
    let mut flight = Flight { distance, entry, direction, duration, times: Vec::new(), path: Vec::new() };
    let (sin, cos) = entry.sin_cos();
    for step in 0..=steps {
        let time = (step as f64 / RATE).min(duration);
        let sample = plan.sample(&mission, 0, start + time).ok_or(Failure::Sampling { vehicle: 0 })?;
        let [x, y, z] = sample.position;
        flight.times.push(time);
        flight.path.push([cos * x - sin * y, sin * x + cos * y, z]);
    }
    Ok(flight)
}

/// The flights as a table.
#[must_use]
pub fn to_csv(flights: &[Flight]) -> String {
    let mut text = "distance_m,entry_deg,direction,duration_s,time_s,x_m,y_m,z_m\n".to_owned();
    for flight in flights {
        for (time, [x, y, z]) in flight.times.iter().zip(&flight.path) {
            let (distance, entry) = (flight.distance, flight.entry.to_degrees());
            let _ = writeln!(
                text,
                "{distance},{entry},{},{:.6},{time:.3},{x:.6},{y:.6},{z:.6}",
                flight.direction, flight.duration
            );
        }
    }
    text
}

/// The flights as a picture: one panel per distance, all to the same scale.
#[must_use]
pub fn picture(flights: &[Flight], radius: f64) -> String {
    use crate::plot::{Anchor, Stroke, Svg, TextStyle};
    const WIDTH: f64 = 900.0;
    let mut distances: Vec<f64> = flights.iter().map(|flight| flight.distance).collect();
    distances.dedup();
    let farthest = distances.iter().copied().fold(radius, f64::max);
    let reach =
        flights.iter().flat_map(|flight| &flight.path).map(|[_, y, _]| y.abs()).fold(radius, f64::max);
    let scale = (WIDTH - 80.0) / (farthest + 2.0 * radius);
    let panel = 2.0 * (reach + 0.3 * radius) * scale + 30.0;
    let mut svg =
        Svg::new(WIDTH, panel * distances.len() as f64 + 20.0, "minimum-time flights to five entries");
    let style = TextStyle { size: 12.0, colour: "#222222", anchor: Anchor::Start, bold: false, halo: true };
    for (row, &distance) in distances.iter().enumerate() {
        let middle = [40.0 + 1.2 * radius * scale, 10.0 + panel * (row as f64 + 0.5)];
        let place = |x: f64, y: f64| [middle[0] + scale * x, middle[1] - scale * y];
        svg.ring(middle, radius * scale, Stroke::solid("#8ecae6", 2.0));
        for (index, flight) in flights.iter().filter(|flight| flight.distance == distance).enumerate() {
            let line: Vec<[f64; 2]> = flight.path.iter().map(|[x, y, _]| place(*x, *y)).collect();
            svg.polyline(&line, Stroke::solid(colour(index), 1.6));
            let end = place(1.02 * radius * flight.entry.cos(), 1.02 * radius * flight.entry.sin());
            svg.disc(end, 3.0, colour(index), 1.0);
        }
        let times: Vec<String> = flights
            .iter()
            .filter(|flight| flight.distance == distance)
            .map(|flight| format!("{:.0} deg {:.2} s", flight.entry.to_degrees(), flight.duration))
            .collect();
        let text = format!("from {distance:.1} m: {}", times.join(", "));
        svg.text([20.0, 20.0 + panel * row as f64], &text, style);
        svg.disc(place(distance, 0.0), 4.0, "#222222", 1.0);
    }
    svg.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fans_start_and_end_where_they_should() -> Result<(), Failure> {
        let mut mission = crate::input::built_in()?.mission;
        mission.transition.segments = 20;
        let radius = mission.loiter.radius;
        let flights = run(&mission, &[4.0])?;
        assert_eq!(flights.len(), ENTRIES);
        for flight in &flights {
            let ends = [flight.path.first(), flight.path.last()].map(|end| end.copied().unwrap_or_default());
            assert!((ends[0][0] - 4.0 * radius).hypot(ends[0][1]) < 1e-6, "{ends:?}");
            let entry = [radius * flight.entry.cos(), radius * flight.entry.sin()];
            assert!((ends[1][0] - entry[0]).hypot(ends[1][1] - entry[1]) < 0.02, "{ends:?} {entry:?}");
        }
        // Mirror images take the same time.
        assert!((flights[0].duration - flights[4].duration).abs() < 1e-3 * flights[0].duration);
        Ok(())
    }
}
