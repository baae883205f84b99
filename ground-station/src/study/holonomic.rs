//! Time of a quadcopter's transition over that of a holonomic vehicle, by distance.
//!
//! The quadcopter circles a first target and flies to the circle around a second, in the least time over all entries and both
//! directions. The holonomic vehicle leaves the same point and moves at the loiter speed in any direction at once: its time is
//! the least distance to the second circle over that speed. The distance is that least distance, in loiter radii, from 1 on:
//! towards 0 the ratio has no bound. Where the second circle lies is drawn: within a right angle to both sides of the way
//! straight out of the first one.

use super::tally::Row;
use super::{Trials, solver};
use crate::failure::Failure;
use planner::{Entries, Loiter, Mission, Options, Pipeline, Plan, Target};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Runs the study for every distance from the exit to the second circle (in loiter radii), with the vehicle and settings of a
/// mission.
///
/// # Errors
///
/// [`Failure::Refused`] if a transition cannot be solved.
pub fn run(
    trials: &Trials,
    mission: &Mission,
    entries: usize,
    distances: &[f64],
) -> Result<Vec<Row>, Failure> {
    let radius = mission.loiter.radius;
    let mut settings = mission.clone();
    settings.targets = vec![Target::at([0.0, 0.0])];
    settings.fleet.vehicles = 1;
    settings.merge_within = 0.0;
    settings.depot = [-8.0 * radius, 0.0];
    // Leg by leg, the fastest of all entries; for the whole route another might be chosen.
    settings.pipeline = Pipeline::Paper;
    settings.transition.entries = Entries::Sampled(entries);
    // Left on the side away from the depot: the second target is then the farther one, and not in the way to the first.
    settings.loiter.sweep = PI;
    let first = first_loiter(&planner::plan(&settings, &Options::default()).map_err(solver)?)?;
    let sign = f64::from(crate::words::sign(first.entry.direction));
    settings.loiter.sweep = TAU - (sign * first.entry.angle).rem_euclid(TAU);
    let tallies = trials.run(distances.len(), |cell, draw| {
        let away = (distances[cell] + 1.0) * radius;
        let (sin, cos) = draw.between(-FRAC_PI_2, FRAC_PI_2).sin_cos();
        one(&settings, [radius + away * cos, away * sin])
    })?;
    let row = |(&x, tally)| Row { series: "ratio of times".to_owned(), x, tally };
    Ok(distances.iter().zip(tallies).map(row).collect())
}

/// The ratio for a second target at `second` (m).
fn one(settings: &Mission, second: [f64; 2]) -> Result<f64, Failure> {
    let mut mission = settings.clone();
    mission.targets.push(Target::at(second));
    let plan = planner::plan(&mission, &Options::default()).map_err(solver)?;
    let leg = plan.vehicles.first().and_then(|vehicle| vehicle.legs.get(1));
    let (Some(leg), first) = (leg, first_loiter(&plan)?) else { return Err(solver("no second flight")) };
    let (circle, next) = (&plan.circles[0], &plan.circles[1]);
    let sign = f64::from(crate::words::sign(first.entry.direction));
    let (sin, cos) = (first.entry.angle + sign * circle.sweep).sin_cos();
    let [x, y] = [circle.centre[0] + circle.radius * cos, circle.centre[1] + circle.radius * sin];
    let distance = (x - next.centre[0]).hypot(y - next.centre[1]) - next.radius;
    Ok(leg.transition.duration / (distance / next.speed))
}

/// The circle around the first target, which is flown first.
fn first_loiter(plan: &Plan) -> Result<Loiter, Failure> {
    let loiter = plan.vehicles.first().and_then(|vehicle| vehicle.legs.first()?.loiter);
    loiter.filter(|loiter| loiter.circle == 0).ok_or_else(|| solver("the first target is not the first"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Shard;

    #[test]
    fn far_targets_are_reached_sooner_than_at_loiter_speed() -> Result<(), Failure> {
        let trials = Trials { count: 2, seed: 1, shard: Shard { index: 0, count: 1 }, quiet: true };
        let mut mission = crate::input::built_in()?.mission;
        mission.transition.segments = 20;
        let rows = run(&trials, &mission, 4, &[2.0, 12.0])?;
        assert!(rows[1].tally.mean() < rows[0].tally.mean() && rows[1].tally.mean() < 1.0, "{rows:?}");
        assert!(rows.iter().all(|row| row.tally.greatest < 3.0), "{rows:?}");
        Ok(())
    }
}
