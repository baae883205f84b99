//! The program over the routes known so far.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};

/// Prizes of the greatest sum of which none of the routes collects more than 1; the depot, node 0, has none. They need not be exact: pricing
/// decides what they prove.
pub(super) fn prizes(nodes: usize, routes: &[&[usize]]) -> Option<Vec<f64>> {
    let n = nodes - 1;
    let (mut rows, mut columns, mut values) = (vec![], vec![], vec![]);
    for (row, route) in routes.iter().enumerate() {
        let mut visits = route.to_vec();
        visits.sort_unstable();
        for same in visits.chunk_by(|a, b| a == b) {
            rows.push(row);
            columns.push(same[0] - 1);
            values.push(same.len() as f64);
        }
    }
    for i in 0..n {
        rows.push(routes.len() + i);
        columns.push(i);
        values.push(-1.0);
    }
    let n_rows = routes.len() + n;
    let a = CscMatrix::new_from_triplets(n_rows, n, rows, columns, values);
    let b: Vec<f64> = (0..n_rows).map(|row| if row < routes.len() { 1.0 } else { 0.0 }).collect();
    let settings = DefaultSettings { verbose: false, max_iter: 100, ..DefaultSettings::default() };
    let p = CscMatrix::zeros((n, n));
    let cones = [SupportedConeT::NonnegativeConeT(n_rows)];
    let mut solver = DefaultSolver::new(&p, &vec![-1.0; n], &a, &b, &cones, settings).ok()?;
    solver.solve();
    if !matches!(solver.solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved) {
        return None;
    }
    let mut prizes = vec![0.0];
    prizes.extend(solver.solution.x.iter().map(|x| x.max(0.0)));
    Some(prizes)
}
