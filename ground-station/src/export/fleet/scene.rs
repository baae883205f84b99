//! A plan in geographic coordinates: what map formats show.

use crate::command::sampled;
use crate::export::members;
use crate::failure::Failure;
use crate::geodesy::Origin;
use crate::input::MissionFile;
use crate::words;
use planner::{Plan, Target};
use std::f64::consts::TAU;

/// Longitude, latitude (degrees), height above the ground (m).
pub type Point = [f64; 3];

/// What there is to show.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    pub name: String,
    pub depot: Point,
    pub targets: Vec<(Target, Point)>,
    pub vehicles: Vec<Vehicle>,
}

/// A vehicle's circles, as closed lines with the targets in them, and its flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Vehicle {
    pub number: usize,
    /// Its vehicle, and which of its flights where that has several.
    pub name: String,
    /// The same as numbers.
    pub flight: [usize; 2],
    pub circles: Vec<(String, Vec<Point>)>,
    /// Seconds after the mission's start.
    pub times: Vec<f64>,
    pub path: Vec<Point>,
    /// Degrees from north, clockwise.
    pub headings: Vec<f64>,
}

/// Corners of a circle.
const CORNERS: usize = 48;

impl Scene {
    /// The scene of a plan, its flights sampled at `rate` (Hz).
    pub fn new(file: &MissionFile, plan: &Plan, origin: &Origin, rate: f64) -> Result<Self, Failure> {
        let point = |position: [f64; 2], height: f64| point(origin, position, height);
        let mission = &file.mission;
        let mut vehicles = Vec::new();
        for (index, vehicle) in
            plan.vehicles.iter().enumerate().filter(|(_, vehicle)| !vehicle.legs.is_empty())
        {
            let circles = vehicle.route.iter().filter_map(|&circle| plan.circles.get(circle)).map(|circle| {
                (
                    members(circle),
                    ring(circle.centre, circle.radius).map(|place| point(place, circle.height)).collect(),
                )
            });
            let samples = sampled(file, plan, index, rate)?;
            let heading = |q: [f64; 4]| {
                let [w, x, y, z] = q;
                90.0 - (2.0 * (x * y + w * z)).atan2(1.0 - 2.0 * (y * y + z * z)).to_degrees()
            };
            vehicles.push(Vehicle {
                number: index + 1,
                name: words::flight(plan, index),
                flight: words::flight_numbers(plan, index),
                circles: circles.collect(),
                times: samples.iter().map(|sample| (sample.time * 1e3).round() / 1e3).collect(),
                path: samples.iter().map(|s| point([s.position[0], s.position[1]], s.position[2])).collect(),
                headings: samples.iter().map(|sample| heading(sample.attitude).rem_euclid(360.0)).collect(),
            });
        }
        Ok(Self {
            name: mission.name.clone(),
            depot: point(mission.depot, 0.0),
            targets: mission
                .targets
                .iter()
                .map(|target| (target.clone(), point(target.position, 0.0)))
                .collect(),
            vehicles,
        })
    }

    /// The targets as a table that missions can name.
    pub fn table(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        // Writing into memory does not fail.
        let _ = writer.write_record(["id", "name", "lat", "lon", "radius", "height", "safe_distance"]);
        for (index, (target, [longitude, latitude, _])) in self.targets.iter().enumerate() {
            let number = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
            let _ = writer.write_record([
                (index + 1).to_string(),
                target.name.clone(),
                latitude.to_string(),
                longitude.to_string(),
                number(target.radius),
                number(target.height),
                number(target.safe_distance),
            ]);
        }
        String::from_utf8_lossy(&writer.into_inner().unwrap_or_default()).into_owned()
    }
}

/// A tenth of a millimetre, and millimetres of height: files stay short and equal.
fn point(origin: &Origin, position: [f64; 2], height: f64) -> Point {
    let [latitude, longitude] = origin.geographic(position).map(|degrees| (degrees * 1e9).round() / 1e9);
    [longitude, latitude, (height * 1e3).round() / 1e3]
}

/// A circle counter-clockwise, its first point again at the end.
pub fn ring(centre: [f64; 2], radius: f64) -> impl Iterator<Item = [f64; 2]> {
    (0..=CORNERS).map(move |corner| {
        let (sin, cos) = (TAU * (corner % CORNERS) as f64 / CORNERS as f64).sin_cos();
        [centre[0] + radius * cos, centre[1] + radius * sin]
    })
}
