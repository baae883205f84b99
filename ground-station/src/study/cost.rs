//! Path cost per vehicle against the number of targets and vehicles.
//!
//! Algorithm 2: k-means into m clusters, Christofides' tour of each, started at its target nearest to the depot in the middle
//! of the square; every vehicle flies from the depot and back. The cost per vehicle is the sum of all routes over m.

use super::tally::Row;
use super::{Trials, solver};
use crate::failure::Failure;
use planner::christofides::Points;
use planner::cluster::{KMeansOptions, kmeans};
use planner::mtsp::{Problem, assign};

/// Where all vehicles start (m).
pub const DEPOT: [f64; 2] = [0.0, 0.0];

/// Runs the study for every number of targets and of vehicles; lengths in metres.
///
/// # Errors
///
/// [`Failure::Refused`] if a number of targets is below that of vehicles.
pub fn run(trials: &Trials, targets: &[usize], vehicles: &[usize]) -> Result<Vec<Row>, Failure> {
    let cells: Vec<(usize, usize)> =
        vehicles.iter().flat_map(|&m| targets.iter().map(move |&n| (n, m))).collect();
    if let Some((n, m)) = cells.iter().find(|(n, m)| n < m) {
        return Err(Failure::Refused(format!(
            "{n} targets cannot be divided among {m} vehicles: give more targets"
        )));
    }
    let tallies = trials.run(cells.len(), |cell, draw| {
        let (n, m) = cells[cell];
        one(&draw.points(n), m, trials.seed)
    })?;
    let row = |(&(n, m), tally)| Row { series: format!("m = {m}"), x: n as f64, tally };
    Ok(cells.iter().zip(tallies).map(row).collect())
}

fn one(targets: &[[f64; 2]], vehicles: usize, seed: u64) -> Result<f64, Failure> {
    let labels = kmeans(targets, vehicles, &KMeansOptions::default().with_seed(seed)).map_err(solver)?.labels;
    let nodes: Vec<[f64; 2]> = [DEPOT].iter().chain(targets).copied().collect();
    let metric = Points(&nodes);
    let problem = Problem::new(&metric, vehicles).map_err(solver)?;
    let solution = assign(&problem, &labels).map_err(solver)?;
    Ok(solution.total_cost / vehicles as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Shard;

    const TRIALS: Trials = Trials { count: 12, seed: 3, shard: Shard { index: 0, count: 1 }, quiet: true };

    #[test]
    fn more_vehicles_fly_less_each_and_more_targets_more() -> Result<(), Failure> {
        let rows = run(&TRIALS, &[20, 60], &[2, 8])?;
        let means: Vec<f64> = rows.iter().map(|row| row.tally.mean()).collect();
        assert!(
            means[0] < means[1] && means[2] < means[3] && means[2] < means[0] && means[3] < means[1],
            "{means:?}"
        );
        assert!(run(&TRIALS, &[3], &[5]).is_err());
        Ok(())
    }

    #[test]
    fn shards_are_the_whole() -> Result<(), Failure> {
        let whole = run(&TRIALS, &[20], &[3])?[0].tally;
        let part = |index| run(&Trials { shard: Shard { index, count: 3 }, ..TRIALS }, &[20], &[3]);
        let parts = part(0)?[0].tally.and(part(1)?[0].tally).and(part(2)?[0].tally);
        assert_eq!((parts.count, parts.least, parts.greatest), (whole.count, whole.least, whole.greatest));
        assert!((parts.sum - whole.sum).abs() < 1e-6);
        Ok(())
    }
}
