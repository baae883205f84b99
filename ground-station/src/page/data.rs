//! What the page shows, as plain data.

use crate::command::{rows, sampled};
use crate::execution::{Execution, Way, execution};
use crate::export::members;
use crate::export::qgc::vehicle_mission;
use crate::failure::Failure;
use crate::input::MissionFile;
use crate::plot::{self, vehicle_profile};
use crate::report::{camera_line, certificate_lines, execution_table, vehicle_table, warning_lines};
use crate::words;
use planner::{Plan, Sample};
use serde::Serialize;

/// Everything on the page. Units: m, s, degrees, N.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[allow(missing_docs)] // names say it all
pub struct PageData {
    pub title: String,
    pub subtitle: String,
    /// When the last vehicle is back.
    pub duration: f64,
    /// Time between two samples.
    pub step: f64,
    /// West, south, east, north.
    pub extent: [f64; 4],
    pub depot: [f64; 2],
    pub targets: Vec<TargetData>,
    pub vehicles: Vec<VehicleData>,
    pub charts: Vec<ChartData>,
    /// Headings first.
    pub table: Vec<Vec<String>>,
    /// Headings first.
    pub execution: Vec<Vec<String>>,
    pub certificate: Vec<String>,
    pub warnings: Vec<String>,
}

/// A target.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct TargetData {
    pub label: String,
    pub east: f64,
    pub north: f64,
    pub safe_distance: f64,
}

/// A vehicle's circles and its flight, sampled from `start` on; the last sample is at `end`.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct VehicleData {
    /// Its number.
    pub number: usize,
    /// The same, and which of its flights where it has several.
    pub name: String,
    pub colour: &'static str,
    pub pad: [f64; 2],
    pub start: f64,
    pub end: f64,
    pub circles: Vec<CircleData>,
    pub east: Vec<f64>,
    pub north: Vec<f64>,
    pub up: Vec<f64>,
    pub speed: Vec<f64>,
    pub tilt: Vec<f64>,
    pub thrust: Vec<f64>,
}

/// A circle of a route.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct CircleData {
    pub label: String,
    pub east: f64,
    pub north: f64,
    pub radius: f64,
}

/// A quantity over time: the column of the vehicles that it draws, and its limits.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct ChartData {
    pub column: &'static str,
    pub title: String,
    pub unit: &'static str,
    pub limits: Vec<LimitData>,
}

/// A line across a chart.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
#[allow(missing_docs)]
pub struct LimitData {
    pub name: String,
    pub value: f64,
}

impl PageData {
    /// The page of a plan, its flights sampled at `rate` (Hz).
    ///
    /// # Errors
    ///
    /// [`Failure::Sampling`] if the plan belongs to another mission.
    pub fn new(file: &MissionFile, plan: &Plan, rate: f64) -> Result<Self, Failure> {
        let mission = &file.mission;
        let tracks: Vec<Vec<Sample>> = (0..plan.vehicles.len())
            .map(|index| sampled(file, plan, index, rate))
            .collect::<Result<_, _>>()?;
        let executions: Vec<Execution> = (plan.vehicles.iter().zip(&tracks))
            .map(|(vehicle, track)| {
                let flown = vehicle_mission(file, plan, vehicle);
                execution(Way::Stream, file.autopilot, &flown, vehicle.duration(), track)
            })
            .collect();
        let mut warnings = warning_lines(plan);
        for (index, execution) in executions.iter().enumerate() {
            let name = words::flight(plan, index);
            warnings.extend(execution.warnings.iter().map(|warning| format!("vehicle {name}: {warning}")));
        }
        let autopilot = words::word(&words::AUTOPILOTS, &file.autopilot);
        let name = if mission.name.is_empty() { "mission" } else { &mission.name };
        Ok(Self {
            title: format!("{name}: {} targets, {} vehicles", mission.targets.len(), mission.fleet.vehicles),
            subtitle: format!("makespan {:.1} s, {autopilot}, streamed", plan.certificate.makespan),
            duration: plan.certificate.makespan,
            step: 1.0 / rate,
            extent: extent(file, plan),
            depot: mission.depot,
            targets: targets(file),
            vehicles: (tracks.iter().enumerate()).map(|(index, track)| vehicle(plan, index, track)).collect(),
            charts: charts(file, plan),
            table: vehicle_table(&rows(file, plan)?).rows().to_vec(),
            execution: execution_table(plan, &executions).rows().to_vec(),
            certificate: certificate_lines(plan).into_iter().chain(camera_line(mission, plan)).collect(),
            warnings,
        })
    }
}

fn extent(file: &MissionFile, plan: &Plan) -> [f64; 4] {
    let [east, north] = file.mission.depot;
    let mut extent = [east, north, east, north];
    let mut include = |[x, y]: [f64; 2], rim: f64| {
        extent =
            [extent[0].min(x - rim), extent[1].min(y - rim), extent[2].max(x + rim), extent[3].max(y + rim)];
    };
    plan.circles.iter().for_each(|circle| include(circle.centre, circle.radius));
    plan.vehicles.iter().for_each(|vehicle| include([vehicle.pad[0], vehicle.pad[1]], 0.0));
    extent
}

fn targets(file: &MissionFile) -> Vec<TargetData> {
    let common = file.mission.transition.safe_distance;
    let target = |(index, target): (usize, &planner::Target)| TargetData {
        label: (index + 1).to_string(),
        east: target.position[0],
        north: target.position[1],
        safe_distance: target.safe_distance.unwrap_or(common),
    };
    file.mission.targets.iter().enumerate().map(target).collect()
}

fn vehicle(plan: &Plan, index: usize, track: &[Sample]) -> VehicleData {
    // A millimetre, and as much of the other units, is more than a screen shows.
    let column = |of: &dyn Fn(&Sample) -> f64| track.iter().map(|sample| thousandths(of(sample))).collect();
    let planned = &plan.vehicles[index];
    let circle = |&circle: &usize| {
        let circle = plan.circles.get(circle)?;
        let [east, north] = circle.centre;
        Some(CircleData { label: members(circle), east, north, radius: circle.radius })
    };
    VehicleData {
        number: planned.vehicle + 1,
        name: words::flight(plan, index),
        colour: plot::colour(index),
        pad: [planned.pad[0], planned.pad[1]],
        start: planned.start_time(),
        end: planned.end_time(),
        circles: planned.route.iter().filter_map(circle).collect(),
        east: column(&|sample| sample.position[0]),
        north: column(&|sample| sample.position[1]),
        up: column(&|sample| sample.position[2]),
        speed: column(&plot::speed),
        tilt: column(&|sample| plot::tilt(sample).to_degrees()),
        thrust: column(&|sample| sample.collective_thrust),
    }
}

fn thousandths(value: f64) -> f64 {
    (value * 1e3).round() / 1e3
}

/// The panels of the pictures, whose limits are the same for all vehicles.
fn charts(file: &MissionFile, plan: &Plan) -> Vec<ChartData> {
    let panels = vehicle_profile(file, plan, 0, &[]).panels;
    let columns = [("speed", "m/s"), ("tilt", "deg"), ("thrust", "N")];
    let chart = |(panel, (column, unit)): (plot::Panel, (&'static str, &'static str))| {
        let finite = panel.limits.into_iter().filter(|limit| limit.value.is_finite());
        let limits = finite.map(|limit| LimitData { name: limit.name, value: thousandths(limit.value) });
        ChartData { column, title: panel.title, unit, limits: limits.collect() }
    };
    panels.into_iter().zip(columns).map(chart).collect()
}
