//! Prim's algorithm on the complete graph, without a heap.

use crate::metric::Metric;

/// The tree that grows from vertex 0 by its nearest outside vertex (Prim 1957); `O(n^2)` time, `O(n)` memory.
pub(crate) fn prim(metric: &impl Metric) -> Vec<[usize; 2]> {
    let n = metric.len();
    let mut tree = Vec::with_capacity(n.saturating_sub(1));
    // Vertices outside the tree with their nearest vertex inside.
    let mut outside: Vec<(usize, usize, f64)> = (1..n).map(|v| (v, 0, metric.distance(v, 0))).collect();
    while let Some(position) = nearest(&outside) {
        let (added, parent, _) = outside.swap_remove(position);
        tree.push([parent, added]);
        for (v, from, least) in &mut outside {
            let distance = metric.distance(*v, added);
            if distance < *least {
                (*from, *least) = (added, distance);
            }
        }
    }
    tree
}

fn nearest(outside: &[(usize, usize, f64)]) -> Option<usize> {
    let mut best = 0;
    for (k, candidate) in outside.iter().enumerate() {
        if candidate.2 < outside[best].2 {
            best = k;
        }
    }
    (!outside.is_empty()).then_some(best)
}
