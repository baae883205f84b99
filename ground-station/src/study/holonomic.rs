//! Time of a quadcopter's transition over that of a holonomic vehicle, by distance.
//!
//! The quadcopter circles a first target and flies to the circle around a second, in the least time over all entries and both
//! directions. The holonomic vehicle leaves the same point and moves at the loiter speed in any direction at once: its time is
//! the least distance to the second circle over that speed. The distance is that least distance, in loiter radii, from 1 on:
//! towards 0 the ratio has no bound. Where the quadcopter leaves the first circle is drawn: the depot lies in a random direction.

use super::tally::Row;
use super::{Trials, solver};
use crate::failure::Failure;
use planner::{Entries, Mission, Options, Target};
use std::f64::consts::TAU;

/// Runs the study for every distance between the circles (in loiter radii), with the vehicle and settings of a mission.
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
    let tallies = trials.run(distances.len(), |cell, draw| {
        // The exit is anywhere on the circle; the centres lie so that distances around the wanted one come out.
        let gap = distances[cell] * mission.loiter.radius;
        let bearing = draw.between(0.0, TAU);
        one(mission, entries, gap, bearing)
    })?;
    let row = |(&x, tally)| Row { series: "ratio of times".to_owned(), x, tally };
    Ok(distances.iter().zip(tallies).map(row).collect())
}

/// The ratio for two circles whose rims are `gap` (m) apart.
fn one(settings: &Mission, entries: usize, gap: f64, bearing: f64) -> Result<f64, Failure> {
    let radius = settings.loiter.radius;
    let second = [2.0 * radius + gap, 0.0];
    let mut mission = settings.clone();
    mission.targets = vec![Target::at([0.0, 0.0]), Target::at(second)];
    mission.fleet.vehicles = 1;
    mission.merge_within = 0.0;
    // Outside both circles.
    let away = 8.0 * radius + gap;
    mission.depot = [away * bearing.cos(), away * bearing.sin()];
    mission.transition.entries = Entries::Sampled(entries);
    let plan = planner::plan(&mission, &Options::default()).map_err(solver)?;
    let legs = plan.vehicles.first().map(|vehicle| vehicle.legs.as_slice()).unwrap_or_default();
    let [from, to, ..] = legs else { return Err(solver("no transition between the circles")) };
    let (Some(left), Some(reached)) = (from.loiter, to.loiter) else { return Err(solver("no circles")) };
    let (left_circle, next) = (&plan.circles[left.circle], &plan.circles[reached.circle]);
    let sign = f64::from(crate::words::sign(left.entry.direction));
    let angle = left.entry.angle + sign * left_circle.sweep;
    let exit = [left_circle.centre[0] + radius * angle.cos(), left_circle.centre[1] + radius * angle.sin()];
    let distance = (exit[0] - next.centre[0]).hypot(exit[1] - next.centre[1]) - next.radius;
    Ok(to.transition.duration / (distance / next.speed))
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
