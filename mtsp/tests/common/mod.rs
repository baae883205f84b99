//! Small instances, hard ones among them, and their exact optima by dynamic programming over subsets.
#![allow(dead_code)]

use christofides::{Metric, Points};
use mtsp::{End, Objective, Problem};
use proptest::prelude::*;

/// An instance: nodes in the plane (the depot first) and service costs.
#[derive(Debug, Clone)]
pub struct Instance {
    pub nodes: Vec<[f64; 2]>,
    pub service: Vec<f64>,
    pub vehicles: usize,
}

impl Instance {
    pub fn metric(&self) -> Points<'_, 2> {
        Points(&self.nodes)
    }
}

/// Instances of up to `n` targets: spread, on a coarse grid (ties, duplicates), on a line, tiny or huge; with and without service.
pub fn instance(n: usize) -> impl Strategy<Value = Instance> {
    let nodes = prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 1..=n + 1);
    (0usize..5, nodes, 1usize..4, 0.0..0.5f64, any::<bool>()).prop_map(|(kind, raw, vehicles, s, served)| {
        let scale = [1.0, 1.0, 1.0, 1e-90, 1e90][kind];
        let nodes: Vec<[f64; 2]> = raw
            .into_iter()
            .map(|(x, y)| match kind {
                1 => [(2.0 * x).round(), (2.0 * y).round()],
                2 => [x, 0.0],
                _ => [scale * x, scale * y],
            })
            .collect();
        let service =
            (0..nodes.len()).map(|i| if served { scale * s * (i % 3) as f64 } else { 0.0 }).collect();
        Instance { nodes, service, vehicles }
    })
}

/// The least value of an objective, exactly: best route of each subset for each vehicle, then the best partition.
pub fn optimum<M: Metric>(problem: &Problem<'_, M>, objective: Objective) -> f64 {
    let full = (1usize << problem.targets().len()) - 1;
    let mut value = vec![f64::INFINITY; full + 1];
    value[0] = 0.0;
    for vehicle in 0..problem.vehicles() {
        let cost = subset_costs(problem, vehicle);
        let mut next = vec![f64::INFINITY; full + 1];
        for set in 0..=full {
            let mut part = set;
            loop {
                let (rest, own) = (value[set & !part], cost[part]);
                let joined = if objective == Objective::Total { rest + own } else { rest.max(own) };
                next[set] = next[set].min(joined);
                if part == 0 {
                    break;
                }
                part = (part - 1) & set;
            }
        }
        value = next;
    }
    value[full]
}

/// The least length of a route of `vehicle` through each subset of targets; infinite if it may not serve them.
fn subset_costs<M: Metric>(problem: &Problem<'_, M>, vehicle: usize) -> Vec<f64> {
    let (targets, metric) = (problem.targets(), problem.metric());
    let n = targets.len();
    let mut reach = vec![vec![f64::INFINITY; n]; 1 << n];
    let mut cost = vec![f64::INFINITY; 1 << n];
    cost[0] = 0.0;
    for set in 1usize..1 << n {
        for last in (0..n).filter(|&i| set >> i & 1 == 1) {
            let rest = set & !(1 << last);
            let service = problem.service()[targets[last]];
            reach[set][last] = if rest == 0 {
                metric.distance(problem.start(vehicle), targets[last]) + service
            } else {
                (0..n)
                    .filter(|&i| rest >> i & 1 == 1)
                    .map(|i| reach[rest][i] + metric.distance(targets[i], targets[last]) + service)
                    .fold(f64::INFINITY, f64::min)
            };
            let home = match problem.end(vehicle) {
                End::At(node) => metric.distance(targets[last], node),
                End::Open => 0.0,
            };
            cost[set] = cost[set].min(reach[set][last] + home);
        }
        let forbidden = (0..n).any(|i| set >> i & 1 == 1 && !problem.allows(vehicle, targets[i]));
        if forbidden || cost[set] > problem.limit(vehicle) {
            cost[set] = f64::INFINITY;
        }
    }
    cost
}
