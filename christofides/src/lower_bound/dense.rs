//! Ascent on 1-trees of the complete graph.

use super::LowerBound;
use crate::metric::Metric;

/// Subgradient ascent with a step that halves when the bound does not rise; every 1-tree is minimal on the complete graph.
pub(crate) fn ascend(metric: &impl Metric, iterations: usize) -> LowerBound {
    let n = metric.len();
    if n < 3 {
        let value = if n == 2 { 2.0 * metric.distance(0, 1) } else { 0.0 };
        return LowerBound { value, multipliers: vec![0.0; n] };
    }
    let mut pi = vec![0.0; n];
    let mut degree = vec![0_i32; n];
    let mut previous = vec![0_i32; n];
    let mut best = LowerBound { value: 0.0, multipliers: pi.clone() };
    let mut step = 0.0;
    for iteration in 0..=iterations {
        let value = one_tree(metric, &pi, &mut degree);
        if iteration == 0 {
            step = 0.1 * value / n as f64;
        }
        if value > best.value {
            best.value = value;
            best.multipliers.copy_from_slice(&pi);
        }
        if degree.iter().all(|&d| d == 2) {
            break;
        }
        let period = (iterations / 20).max(5);
        if iteration > 0 && iteration % period == 0 {
            step *= 0.6;
        }
        for v in 0..n {
            pi[v] += step * (0.7 * f64::from(degree[v] - 2) + 0.3 * f64::from(previous[v]));
            previous[v] = degree[v] - 2;
        }
    }
    best
}

/// The value of the least 1-tree with vertex 0 outside the tree, rounded down, and the degrees.
fn one_tree(metric: &impl Metric, pi: &[f64], degree: &mut [i32]) -> f64 {
    let n = metric.len();
    degree.fill(0);
    let cost = |i: usize, j: usize| metric.distance(i, j) + pi[i] + pi[j];
    let mut outside: Vec<(usize, usize, f64)> = (2..n).map(|v| (v, 1, cost(1, v))).collect();
    let mut total = 0.0;
    let mut magnitude = 0.0;
    while !outside.is_empty() {
        let position = (0..outside.len()).fold(0, |a, b| if outside[b].2 < outside[a].2 { b } else { a });
        let (added, parent, least) = outside.swap_remove(position);
        degree[added] += 1;
        degree[parent] += 1;
        total += least;
        magnitude += least.abs();
        for (v, from, least) in &mut outside {
            let c = cost(*v, added);
            if c < *least {
                (*from, *least) = (added, c);
            }
        }
    }
    let mut nearest: Vec<(f64, usize)> = (1..n).map(|v| (cost(0, v), v)).collect();
    nearest.sort_by(|a, b| a.0.total_cmp(&b.0));
    for &(least, v) in &nearest[..2] {
        total += least;
        magnitude += least.abs();
        degree[v] += 1;
        degree[0] += 1;
    }
    let shift: f64 = pi.iter().sum();
    magnitude += pi.iter().map(|p| 4.0 * p.abs()).sum::<f64>();
    total - 2.0 * shift - magnitude * (n as f64 + 4.0) * f64::EPSILON
}
