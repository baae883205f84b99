//! 2-opt and Or-opt over all pairs of edges.

use crate::metric::Metric;

/// Least gain relative to the edges changed: smaller ones are rounding.
const LEAST_GAIN: f64 = 1e-12;

/// Repeats the first improving exchange of two edges or move of up to three vertices until there is none.
pub(crate) fn improve(metric: &impl Metric, order: &mut [usize]) {
    let n = order.len();
    while n >= 4 && (two_opt_move(metric, order) || or_opt_move(metric, order)) {}
}

fn two_opt_move(metric: &impl Metric, order: &mut [usize]) -> bool {
    let n = order.len();
    let mut improved = false;
    for i in 0..n - 1 {
        for j in i + 2..n {
            let (a, b, c, d) = (order[i], order[i + 1], order[j], order[(j + 1) % n]);
            if a == d {
                continue;
            }
            let removed = metric.distance(a, b) + metric.distance(c, d);
            let added = metric.distance(a, c) + metric.distance(b, d);
            if removed - added > LEAST_GAIN * (removed.abs() + added.abs()) {
                order[i + 1..=j].reverse();
                improved = true;
            }
        }
    }
    improved
}

fn or_opt_move(metric: &impl Metric, order: &mut [usize]) -> bool {
    let n = order.len();
    for len in 1..=3.min(n - 3) {
        for i in 0..n {
            // The segment starts at position 1 of the rotated tour.
            order.rotate_left(1);
            let _ = i;
            let (before, first, last, after) = (order[0], order[1], order[len], order[len + 1]);
            let freed = metric.distance(before, first) + metric.distance(last, after)
                - metric.distance(before, after);
            for k in len + 1..n {
                let (u, v) = (order[k], order[(k + 1) % n]);
                let base = metric.distance(u, v);
                let straight = metric.distance(u, first) + metric.distance(last, v) - base;
                let turned = metric.distance(u, last) + metric.distance(first, v) - base;
                let added = straight.min(turned);
                if freed - added > LEAST_GAIN * (freed.abs() + added.abs() + base.abs()) {
                    order[1..=k].rotate_left(len);
                    if turned < straight {
                        order[k + 1 - len..=k].reverse();
                    }
                    return true;
                }
            }
        }
    }
    false
}
