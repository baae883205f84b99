//! The paper's two procedures for targets that come in rounds.

use crate::cluster_first::cluster_routes;
use crate::error::Error;
use crate::problem::{Problem, check_fleet};
use christofides::Points;
use cluster::{KMeansOptions, kmeans};

/// What a procedure costs over all rounds.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct RoundsCost {
    /// Length flown by all vehicles in each round, flights home in between not counted.
    pub rounds: Vec<f64>,
    /// Flights home after each round but the last, and home at the very end.
    pub home: Vec<f64>,
}

impl RoundsCost {
    /// Everything flown.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.rounds.iter().sum::<f64>() + self.home.iter().sum::<f64>()
    }
}

/// Procedure 1: every round starts afresh at the depot; the targets known by then are clustered and toured anew.
///
/// Round `k` visits all targets of `rounds[..=k]` (persistent surveillance). Vehicles fly home after each round, which is listed apart.
///
/// # Arguments
/// * `depot`, `rounds`: positions in metres; `rounds[k]` are the targets that appear before round k.
///
/// # Errors
/// [`Error::NoVehicles`], [`Error::TooManyVehicles`], [`Error::Clusters`] and [`Error::InvalidDistance`] for positions that are not finite.
pub fn procedure_1(
    depot: [f64; 2],
    rounds: &[Vec<[f64; 2]>],
    vehicles: usize,
    seed: u64,
) -> Result<RoundsCost, Error> {
    let mut cost = RoundsCost { rounds: vec![], home: vec![] };
    let mut nodes = vec![depot];
    for round in rounds {
        nodes.extend(round);
        let labels = kmeans(&nodes[1..], vehicles.max(1), &KMeansOptions::default().with_seed(seed))?.labels;
        let (length, last) = tour(&nodes, &labels, vehicles)?;
        cost.rounds.push(length);
        cost.home.push(last.iter().map(|&p| distance(depot, p)).sum());
    }
    Ok(cost)
}

/// Procedure 2 (Algorithm 3): the first round as in [`procedure_1`]; later targets are absorbed by the cluster with the nearest
/// centroid, and each vehicle tours its own cluster again from where its last trip ended, with no flight home in between.
///
/// # Errors
/// Those of [`procedure_1`].
pub fn procedure_2(
    depot: [f64; 2],
    rounds: &[Vec<[f64; 2]>],
    vehicles: usize,
    seed: u64,
) -> Result<RoundsCost, Error> {
    check_fleet(vehicles)?;
    let mut cost = RoundsCost { rounds: vec![], home: vec![] };
    let mut here = vec![depot; vehicles];
    let mut clusters: Vec<Vec<[f64; 2]>> = vec![vec![]; vehicles];
    for round in rounds {
        if clusters.iter().all(Vec::is_empty) {
            let labels = kmeans(round, vehicles.max(1), &KMeansOptions::default().with_seed(seed))?.labels;
            for (&target, label) in round.iter().zip(labels) {
                clusters.get_mut(label).ok_or(Error::NoVehicles)?.push(target);
            }
        } else {
            for &target in round {
                let nearest = (0..vehicles).min_by(|&a, &b| {
                    centre_distance(&clusters[a], target).total_cmp(&centre_distance(&clusters[b], target))
                });
                clusters[nearest.ok_or(Error::NoVehicles)?].push(target);
            }
        }
        let mut sum = 0.0;
        for (position, cluster) in here.iter_mut().zip(&clusters) {
            let mut nodes = vec![*position];
            nodes.extend(cluster);
            let (length, last) = tour(&nodes, &vec![0; cluster.len()], 1)?;
            sum += length;
            *position = last[0];
        }
        cost.rounds.push(sum);
        cost.home.push(0.0);
    }
    if let Some(home) = cost.home.last_mut() {
        *home = here.iter().map(|&p| distance(depot, p)).sum();
    }
    Ok(cost)
}

/// Length of open routes through labelled targets (the first node is where all start), and where each vehicle ends.
fn tour(nodes: &[[f64; 2]], labels: &[usize], vehicles: usize) -> Result<(f64, Vec<[f64; 2]>), Error> {
    let metric = Points(nodes);
    let problem = Problem::new(&metric, vehicles)?.with_open_routes();
    let routes = cluster_routes(&problem, labels)?;
    let length = routes.iter().enumerate().map(|(v, route)| problem.route_length(v, route)).sum();
    let last = routes.iter().map(|route| nodes[route.last().copied().unwrap_or(0)]).collect();
    Ok((length, last))
}

fn centre_distance(cluster: &[[f64; 2]], target: [f64; 2]) -> f64 {
    if cluster.is_empty() {
        return f64::INFINITY;
    }
    let n = cluster.len() as f64;
    let sum = cluster.iter().fold([0.0, 0.0], |s, p| [s[0] + p[0], s[1] + p[1]]);
    distance([sum[0] / n, sum[1] / n], target)
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
