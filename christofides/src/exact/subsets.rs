//! Dynamic programming over subsets (Bellman 1962; Held and Karp 1962).

use crate::metric::Metric;
use crate::tour::Ends;

/// The best tour over a few vertices (the table has `2^n n` entries): the best path from vertex 0 whose end is charged the way back.
pub(crate) fn tour(metric: &impl Metric) -> Vec<usize> {
    search(metric, Ends::Start(0), |v| metric.distance(v, 0))
}

/// The best path over a few vertices.
pub(crate) fn path(metric: &impl Metric, ends: Ends) -> Vec<usize> {
    let closing = |v| match ends {
        Ends::Both(_, end) if v != end => f64::INFINITY,
        _ => 0.0,
    };
    search(metric, ends, closing)
}

/// `best[set][last]`: the shortest path through `set` that ends at `last`.
fn search(metric: &impl Metric, ends: Ends, closing: impl Fn(usize) -> f64) -> Vec<usize> {
    let n = metric.len();
    if n == 0 {
        return Vec::new();
    }
    let distances: Vec<f64> = (0..n * n).map(|k| metric.distance(k / n, k % n)).collect();
    let mut best = vec![f64::INFINITY; n << n];
    for v in 0..n {
        let may_start = match ends {
            Ends::Free => true,
            Ends::Start(start) | Ends::Both(start, _) => v == start,
        };
        if may_start {
            best[n * (1 << v) + v] = 0.0;
        }
    }
    for set in 1..1_usize << n {
        for last in 0..n {
            let length = best[n * set + last];
            if length == f64::INFINITY {
                continue;
            }
            for next in (0..n).filter(|next| set >> next & 1 == 0) {
                let slot = &mut best[n * (set | 1 << next) + next];
                *slot = slot.min(length + distances[last * n + next]);
            }
        }
    }
    trace(n, &distances, &best, closing)
}

fn trace(n: usize, distances: &[f64], best: &[f64], closing: impl Fn(usize) -> f64) -> Vec<usize> {
    let mut set = (1 << n) - 1;
    let least = |set: usize, onward: &dyn Fn(usize) -> f64| {
        let length = |&last: &usize| best[n * set + last] + onward(last);
        (0..n).filter(|last| set >> last & 1 == 1).min_by(|a, b| length(a).total_cmp(&length(b))).unwrap_or(0)
    };
    let mut last = least(set, &closing);
    let mut order = vec![last];
    while order.len() < n {
        set &= !(1 << last);
        let next = last;
        last = least(set, &|v| distances[v * n + next]);
        order.push(last);
    }
    order.reverse();
    order
}
