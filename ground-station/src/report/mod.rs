//! What is printed when a plan is done: a table of the vehicles, totals, the certificate, warnings, files.

mod table;
mod warnings;

pub use table::Table;
pub use warnings::warning_lines;

use crate::execution::{CircleOutcome, Execution};
use crate::words;
use planner::{Miss, Mission, Plan, VehiclePlan, Verification};

/// A vehicle's line of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct VehicleRow {
    /// The vehicle, and which of its flights: "2", "2 flight 3".
    pub name: String,
    /// The targets in the order of its route: "3 1 4+5".
    pub targets: String,
    /// How many they are.
    pub count: usize,
    /// Metres.
    pub length: f64,
    /// When it takes off (s after the mission's start); later than 0 where it waits for others to pass.
    pub start: f64,
    /// Seconds in transitions.
    pub transit: f64,
    /// Seconds in loiters.
    pub loiters: f64,
    /// Seconds from take-off to the return.
    pub total: f64,
    /// Electrical energy of the flight (J).
    pub energy: f64,
    /// Greatest speed (m/s).
    pub top_speed: f64,
    /// Greatest tilt (rad).
    pub top_tilt: f64,
    /// Worst integrated miss over its legs.
    pub miss: Miss,
}

/// The table of the vehicles, with the team's line at the end.
#[must_use]
pub fn vehicle_table(rows: &[VehicleRow]) -> Table {
    let mut table = Table::new(&[
        "vehicle",
        "targets",
        "length",
        "takes off",
        "in transit",
        "in loiters",
        "total",
        "energy",
        "top speed",
        "top tilt",
        "worst integrated miss",
    ]);
    for row in rows.iter().chain([&team_row(rows)]) {
        table.push(cells(row));
    }
    table
}

fn cells(row: &VehicleRow) -> Vec<String> {
    let name = row.name.clone();
    if row.count == 0 {
        return vec![name, "none: stays at the depot".to_owned()];
    }
    vec![
        name,
        if row.targets.is_empty() {
            row.count.to_string()
        } else {
            format!("{}: {}", row.count, row.targets)
        },
        format!("{:.1} m", row.length),
        format!("{:.2} s", row.start),
        format!("{:.2} s", row.transit),
        format!("{:.2} s", row.loiters),
        format!("{:.2} s", row.total),
        format!("{:.1} kJ", 1e-3 * row.energy),
        format!("{:.2} m/s", row.top_speed),
        format!("{:.1} deg", row.top_tilt.to_degrees()),
        miss_text(&row.miss),
    ]
}

/// Sums over the team; for speed, tilt and miss the greatest.
fn team_row(rows: &[VehicleRow]) -> VehicleRow {
    let sum = |of: fn(&VehicleRow) -> f64| rows.iter().map(of).sum();
    let most = |of: fn(&VehicleRow) -> f64| rows.iter().map(of).fold(0.0, f64::max);
    VehicleRow {
        name: "team".to_owned(),
        targets: String::new(),
        count: rows.iter().map(|row| row.count).sum(),
        length: sum(|row| row.length),
        start: rows.iter().filter(|row| row.count > 0).map(|row| row.start).reduce(f64::min).unwrap_or(0.0),
        transit: sum(|row| row.transit),
        loiters: sum(|row| row.loiters),
        total: sum(|row| row.total),
        energy: sum(|row| row.energy),
        top_speed: most(|row| row.top_speed),
        top_tilt: most(|row| row.top_tilt),
        miss: rows.iter().fold(Miss::default(), |worst, row| worst_of(worst, row.miss)),
    }
}

/// The worse of two misses, each component by itself.
#[must_use]
pub fn worst_of(a: Miss, b: Miss) -> Miss {
    Miss {
        position: a.position.max(b.position),
        velocity: a.velocity.max(b.velocity),
        attitude: a.attitude.max(b.attitude),
    }
}

/// A miss in centimetres, centimetres per second and degrees.
#[must_use]
pub fn miss_text(miss: &Miss) -> String {
    format!(
        "{:.2} cm, {:.2} cm/s, {:.3} deg",
        100.0 * miss.position,
        100.0 * miss.velocity,
        miss.attitude.to_degrees()
    )
}

/// Values beside lower bounds that no plan can beat, and where two vehicles come closest.
#[must_use]
pub fn certificate_lines(plan: &Plan) -> Vec<String> {
    let certificate = &plan.certificate;
    let line = |name: &str, value: f64, bound: f64, gap: f64| {
        let above = if gap.is_finite() {
            format!(", at most {:.1} % above the best", 100.0 * gap)
        } else {
            String::new()
        };
        format!("{name} {value:.2} s; no plan can be below {bound:.2} s{above}")
    };
    let mut lines = vec![
        line(
            "makespan  ",
            certificate.makespan,
            certificate.makespan_lower_bound,
            certificate.makespan_gap(),
        ),
        line("total time", certificate.total, certificate.total_lower_bound, certificate.total_gap()),
    ];
    lines.extend(gain_line(plan));
    if let Some(approach) = plan.closest_approach {
        lines.push(format!(
            "closest approach {:.2} m: vehicles {} and {} at {:.2} s",
            approach.distance,
            words::flight(plan, approach.vehicles[0]),
            words::flight(plan, approach.vehicles[1]),
            approach.time
        ));
    }
    lines
}

/// How the vehicles fly their plans unless they are told otherwise, and what they then see of their targets.
#[must_use]
pub fn execution_line(executions: &[Execution]) -> Option<String> {
    let seen = executions.iter().flat_map(|execution| &execution.circles).map(|circle| circle.seen);
    let least = seen.reduce(f64::min)?.to_degrees();
    Some(format!("execution: streamed; at least {least:.0} degrees of every target are seen"))
}

/// The share of its circle during which each target is in the picture; nothing without a camera.
#[must_use]
pub fn camera_line(mission: &Mission, plan: &Plan) -> Option<String> {
    let shares = plan.shares_in_view(mission)?;
    let partly: Vec<String> = (shares.iter().enumerate())
        .filter(|(_, share)| **share < 1.0)
        .map(|(target, share)| format!("target {} {:.0} %", target + 1, 100.0 * share))
        .collect();
    Some(match partly.is_empty() {
        true => "in the picture: every target all the way round its circle".to_owned(),
        false => format!("in the picture for a part of its circle only: {}", partly.join(", ")),
    })
}

/// What entries chosen for the whole route gain over the fastest entry of every leg by itself, if anything.
fn gain_line(plan: &Plan) -> Option<String> {
    let flown = || plan.vehicles.iter().filter(|vehicle| !vehicle.legs.is_empty());
    let together: f64 = flown().map(VehiclePlan::duration).sum();
    let leg_by_leg: f64 = flown().map(|vehicle| vehicle.leg_by_leg).sum();
    let gain = leg_by_leg - together;
    // Below what the line can show there is nothing to say.
    (gain >= 0.005).then(|| {
        let share = 100.0 * gain / leg_by_leg;
        format!("entries for the whole route save {gain:.2} s ({share:.1} %) of {leg_by_leg:.2} s leg by leg")
    })
}

/// How every vehicle flies its plan and what becomes of its circles.
#[must_use]
pub fn execution_table(plan: &Plan, executions: &[Execution]) -> Table {
    let mut table = Table::new(&["vehicle", "way", "takes", "circles: radius flown, angle seen"]);
    for (index, execution) in
        executions.iter().enumerate().filter(|(_, execution)| !execution.circles.is_empty())
    {
        let circle = |circle: &CircleOutcome| {
            format!("{}: {:.1} m, {:.0} deg", circle.name, circle.radius, circle.seen.to_degrees())
        };
        table.push(vec![
            words::flight(plan, index),
            words::word(&words::WAYS, &execution.way).to_owned(),
            format!("{:.1} s", execution.duration),
            execution.circles.iter().map(circle).collect::<Vec<_>>().join("; "),
        ]);
    }
    table
}

/// What the independent check saw: the worst of every flight and of all; `name` is that of a flight (from 0).
#[must_use]
pub fn verification_text(verification: &Verification, name: &dyn Fn(usize) -> String) -> String {
    let mut table =
        Table::new(&["verified", "legs", "worst integrated miss", "worst bound overstep", "least clearance"]);
    let vehicles = verification.legs.iter().map(|leg| leg.vehicle + 1).max().unwrap_or(0);
    for vehicle in 0..=vehicles {
        // One line per vehicle, and after the last the line of all.
        let legs = verification.legs.iter().filter(|leg| leg.vehicle == vehicle || vehicle == vehicles);
        let (mut count, mut miss, mut bound, mut clearance) = (0, Miss::default(), 0f64, f64::INFINITY);
        for leg in legs {
            count += 1;
            miss = worst_of(miss, leg.miss);
            bound = bound.max(leg.bound_violation);
            clearance = clearance.min(leg.clearance);
        }
        let name = if vehicle == vehicles { "all".to_owned() } else { format!("vehicle {}", name(vehicle)) };
        if count > 0 {
            let clearance = if clearance.is_finite() { format!("{clearance:.3} m") } else { "-".to_owned() };
            table.push(vec![name, count.to_string(), miss_text(&miss), format!("{bound:.1e}"), clearance]);
        }
    }
    table.render()
}

#[cfg(test)]
mod tests {
    use super::*;
    use planner::LegCheck;

    fn row(count: usize, targets: &str) -> VehicleRow {
        VehicleRow {
            name: "1".into(),
            targets: targets.into(),
            count,
            length: 100.0,
            start: 0.25,
            transit: 20.0,
            loiters: 10.0,
            total: 30.0,
            energy: 4500.0,
            top_speed: 9.5,
            top_tilt: 0.7,
            miss: Miss { position: 0.001, velocity: 0.002, attitude: 0.001 },
        }
    }

    #[test]
    fn the_table_names_every_vehicle_and_sums_the_team() {
        let spare =
            VehicleRow { length: 0.0, transit: 0.0, loiters: 0.0, total: 0.0, energy: 0.0, ..row(0, "") };
        let named = |name: &str, row: VehicleRow| VehicleRow { name: name.into(), ..row };
        let rows = [row(3, "3 1 4"), named("2", row(2, "2+5")), named("3", spare)];
        let text = vehicle_table(&rows).render();
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].starts_with("vehicle  targets") && lines[0].ends_with("worst integrated miss"));
        assert!(
            lines[2].starts_with("1        3: 3 1 4") && lines[2].ends_with("0.10 cm, 0.20 cm/s, 0.057 deg")
        );
        assert!(lines[3].contains("2: 2+5"));
        assert_eq!(lines[4], "3        none: stays at the depot");
        assert!(
            lines[5].starts_with("team     5")
                && lines[5].contains("200.0 m")
                && lines[5].contains("60.00 s")
                && lines[5].contains("9.0 kJ")
        );
    }

    #[test]
    fn verification_lists_vehicles_and_all() {
        let check = |vehicle, leg, position| LegCheck {
            vehicle,
            leg,
            miss: Miss { position, ..Miss::default() },
            bound_violation: 0.0,
            clearance: 0.5 + position,
        };
        let verification = Verification {
            legs: vec![check(0, 0, 0.01), check(0, 1, 0.02), check(2, 0, 0.03)],
            failures: vec![],
        };
        let text = verification_text(&verification, &|vehicle| (vehicle + 1).to_string());
        let lines: Vec<&str> = text.lines().skip(2).collect();
        assert_eq!(lines.len(), 3, "{text}");
        assert!(
            lines[0].starts_with("vehicle 1  2 ")
                && lines[0].contains("2.00 cm")
                && lines[0].ends_with("0.510 m")
        );
        assert!(lines[1].starts_with("vehicle 3  1 ") && lines[2].starts_with("all        3 "), "{text}");
        assert!(lines[2].contains("3.00 cm"));
    }
}
