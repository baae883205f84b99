//! The program over the routes known so far.

use super::cuts::{Triple, count};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

/// Prizes of targets (the depot, node 0, has none) and charges of cuts.
#[derive(Debug, Clone)]
pub(super) struct Prices {
    pub prizes: Vec<f64>,
    pub charges: Vec<f64>,
}

impl Prices {
    pub fn sum(&self) -> f64 {
        self.prizes.iter().sum::<f64>() - self.charges.iter().sum::<f64>()
    }

    /// What a route collects.
    pub fn collected(&self, route: &[usize], cuts: &[Triple]) -> f64 {
        let charges = cuts.iter().zip(&self.charges).map(|(cut, charge)| count(cut, route) as f64 * charge);
        route.iter().map(|&i| self.prizes[i]).sum::<f64>() - charges.sum::<f64>()
    }

    /// `share` of these and the rest of others.
    pub fn mixed(&self, share: f64, others: &Self) -> Self {
        let mix = |a: &[f64], b: &[f64]| -> Vec<f64> {
            a.iter().zip(b).map(|(x, y)| share * x + (1.0 - share) * y).collect()
        };
        Self { prizes: mix(&self.prizes, &others.prizes), charges: mix(&self.charges, &others.charges) }
    }

    pub fn divided_by(self, divisor: f64) -> Self {
        let divide = |list: Vec<f64>| list.into_iter().map(|x| x / divisor).collect();
        Self { prizes: divide(self.prizes), charges: divide(self.charges) }
    }
}

/// Prices of the greatest sum under which no route collects more than 1, and the shares in which routes are taken. Neither need be exact: pricing decides
/// what they prove.
pub(super) fn master(nodes: usize, routes: &[&[usize]], cuts: &[Triple]) -> Option<(Prices, Vec<f64>)> {
    let (targets, n) = (nodes - 1, nodes - 1 + cuts.len());
    let (mut rows, mut columns, mut values) = (vec![], vec![], vec![]);
    let mut entry = |row: usize, column: usize, value: f64| {
        rows.push(row);
        columns.push(column);
        values.push(value);
    };
    for (row, route) in routes.iter().enumerate() {
        let mut visits = route.to_vec();
        visits.sort_unstable();
        for same in visits.chunk_by(|a, b| a == b) {
            entry(row, same[0] - 1, same.len() as f64);
        }
        for (cut, triple) in cuts.iter().enumerate() {
            let times = count(triple, route);
            if times > 0 {
                entry(row, targets + cut, -(times as f64));
            }
        }
    }
    for i in 0..n {
        entry(routes.len() + i, i, -1.0);
    }
    let n_rows = routes.len() + n;
    let a = CscMatrix::new_from_triplets(n_rows, n, rows, columns, values);
    let b: Vec<f64> = (0..n_rows).map(|row| if row < routes.len() { 1.0 } else { 0.0 }).collect();
    let objective: Vec<f64> = (0..n).map(|i| if i < targets { -1.0 } else { 1.0 }).collect();
    let settings = DefaultSettings { verbose: false, max_iter: 100, ..DefaultSettings::default() };
    let p = CscMatrix::zeros((n, n));
    let cones = [SupportedConeT::NonnegativeConeT(n_rows)];
    let mut solver = DefaultSolver::new(&p, &objective, &a, &b, &cones, settings).ok()?;
    solver.solve();
    if !matches!(solver.solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved) {
        return None;
    }
    let found = solver.solution.x.iter().map(|x| x.max(0.0));
    let prizes = std::iter::once(0.0).chain(found.clone().take(targets)).collect();
    let prices = Prices { prizes, charges: found.skip(targets).collect() };
    Some((prices, solver.solution.z[..routes.len()].to_vec()))
}
