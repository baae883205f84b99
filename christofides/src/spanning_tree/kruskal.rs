//! Kruskal's algorithm on the Delaunay triangulation, which contains a minimum spanning tree.

use crate::delaunay::delaunay_edges;
use crate::kd_tree::squared_distance;

/// A minimum spanning tree of points of the plane; `O(n log n)`.
pub(crate) fn kruskal(points: &[[f64; 2]]) -> Vec<[usize; 2]> {
    let n = points.len();
    let length = |(u, v): (u32, u32)| squared_distance(&points[u as usize], &points[v as usize]);
    let mut edges: Vec<(f64, (u32, u32))> =
        delaunay_edges(points).into_iter().map(|e| (length(e), e)).collect();
    edges.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let mut root: Vec<u32> = (0..n as u32).collect();
    let mut tree = Vec::with_capacity(n.saturating_sub(1));
    for (_, (u, v)) in edges {
        let (a, b) = (find(&mut root, u), find(&mut root, v));
        if a != b {
            root[a.max(b) as usize] = a.min(b);
            tree.push([u as usize, v as usize]);
        }
    }
    tree
}

fn find(root: &mut [u32], mut v: u32) -> u32 {
    while root[v as usize] != v {
        root[v as usize] = root[root[v as usize] as usize];
        v = root[v as usize];
    }
    v
}
