//! Length of Procedure 1 over that of Procedure 2 when r targets arrive after the first round.
//!
//! Procedure 1 is Algorithm 2 twice: the vehicles fly home after the first round, the targets of the second are clustered and
//! toured afresh from the depot. Procedure 2 is Algorithm 3: the new targets are absorbed by the clusters with the nearest
//! centroids, and every vehicle tours its cluster again from where its first trip ended.
//!
//! The paper's text says that the second round executes Algorithm 2 "on the updated set of targets", hence all of them, and
//! that vehicles return to the depot; that is the default. Other readings can be chosen: [`Meaning`].

use super::tally::Row;
use super::{Trials, cost::DEPOT, solver};
use crate::failure::Failure;
use planner::christofides::Points;
use planner::cluster::{KMeansOptions, kmeans};
use planner::mtsp::{Problem, RoundsCost, assign, procedure_1, procedure_2};

/// What the second round visits, and which flights count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Meaning {
    /// The second round visits the new targets only, not all again.
    pub new_only: bool,
    /// Flights to the depot, between the rounds and at the end, do not count.
    pub without_home: bool,
}

/// Runs the study for every number of arrivals; the paper has n = 100 and m = 8.
///
/// # Errors
///
/// [`Failure::Refused`] if a round has fewer targets than there are vehicles.
pub fn run(
    trials: &Trials,
    targets: usize,
    vehicles: usize,
    arrivals: &[usize],
    meaning: Meaning,
) -> Result<Vec<Row>, Failure> {
    let fewest = arrivals.iter().copied().filter(|_| meaning.new_only).fold(targets, usize::min);
    if fewest < vehicles {
        return Err(Failure::Refused(format!(
            "{fewest} targets cannot be divided among {vehicles} vehicles"
        )));
    }
    let tallies = trials.run(arrivals.len(), |cell, draw| {
        let rounds = [draw.points(targets), draw.points(arrivals[cell])];
        ratio(&rounds, vehicles, trials.seed, meaning)
    })?;
    let series = format!(
        "second round: {}; flights home {}",
        if meaning.new_only { "new targets" } else { "all targets" },
        if meaning.without_home { "left out" } else { "counted" }
    );
    let row = |(&arrivals, tally)| Row { series: series.clone(), x: arrivals as f64, tally };
    Ok(arrivals.iter().zip(tallies).map(row).collect())
}

fn ratio(rounds: &[Vec<[f64; 2]>; 2], vehicles: usize, seed: u64, meaning: Meaning) -> Result<f64, Failure> {
    let length = |cost: &RoundsCost| match meaning.without_home {
        true => cost.rounds.iter().sum(),
        false => cost.total(),
    };
    if meaning.new_only {
        let first = |round: &Vec<[f64; 2]>| procedure_1(DEPOT, std::slice::from_ref(round), vehicles, seed);
        let [a, b] = [first(&rounds[0]).map_err(solver)?, first(&rounds[1]).map_err(solver)?];
        return Ok((length(&a) + length(&b)) / new_only(rounds, vehicles, seed, meaning)?);
    }
    let first = procedure_1(DEPOT, rounds, vehicles, seed).map_err(solver)?;
    let second = procedure_2(DEPOT, rounds, vehicles, seed).map_err(solver)?;
    Ok(length(&first) / length(&second))
}

/// Length of Procedure 2 when the second round visits the new targets only.
fn new_only(
    rounds: &[Vec<[f64; 2]>; 2],
    vehicles: usize,
    seed: u64,
    meaning: Meaning,
) -> Result<f64, Failure> {
    let [first, second] = rounds;
    let partition = kmeans(first, vehicles, &KMeansOptions::default().with_seed(seed)).map_err(solver)?;
    let (mut sum, ends) = open_routes(DEPOT, first, &partition.labels, vehicles)?;
    let distance = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    let mut taken = vec![Vec::new(); vehicles];
    for &target in second {
        let near = |&a: &usize, &b: &usize| {
            let to = |v: usize| distance(partition.centroids[v], target);
            to(a).total_cmp(&to(b))
        };
        if let Some(vehicle) = (0..vehicles).min_by(near) {
            taken[vehicle].push(target);
        }
    }
    for (end, targets) in ends.into_iter().zip(&taken) {
        let (length, last) = open_routes(end, targets, &vec![0; targets.len()], 1)?;
        sum += length;
        if !meaning.without_home {
            sum += distance(last[0], DEPOT);
        }
    }
    Ok(sum)
}

/// Length of routes through labelled targets without a way home, and where each ends.
fn open_routes(
    start: [f64; 2],
    targets: &[[f64; 2]],
    labels: &[usize],
    vehicles: usize,
) -> Result<(f64, Vec<[f64; 2]>), Failure> {
    let nodes: Vec<[f64; 2]> = [start].iter().chain(targets).copied().collect();
    let metric = Points(&nodes);
    let problem = Problem::new(&metric, vehicles).map_err(solver)?.with_open_routes();
    let solution = assign(&problem, labels).map_err(solver)?;
    let ends = solution.routes.iter().map(|route| nodes[route.last().copied().unwrap_or(0)]).collect();
    Ok((solution.total_cost, ends))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::Shard;

    /// With flights home counted Procedure 1 is longer in every trial; without them by less.
    #[test]
    fn procedure_2_is_shorter() -> Result<(), Failure> {
        let trials = Trials { count: 12, seed: 1, shard: Shard { index: 0, count: 1 }, quiet: true };
        for new_only in [false, true] {
            let rows = |without_home| run(&trials, 40, 4, &[16, 40], Meaning { new_only, without_home });
            let (with, without) = (rows(false)?, rows(true)?);
            assert!(with.iter().all(|row| row.tally.mean() > 1.0), "{with:?}");
            assert!(with.iter().zip(&without).all(|(a, b)| a.tally.mean() > b.tally.mean()), "{without:?}");
        }
        Ok(())
    }
}
