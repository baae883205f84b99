//! The Delaunay triangulation of any finite set of points of the plane.

use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

/// A point that remembers its index.
struct Site {
    position: Point2<f64>,
    index: u32,
}

impl HasPosition for Site {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.position
    }
}

/// Edges that join all points and contain a minimum spanning tree: the Delaunay edges of distinct points, and a chain
/// through every set of coinciding ones.
///
/// The triangulation would refuse very large and very small coordinates and merge coinciding points, so they are scaled
/// to the unit square by a power of two and sorted first.
pub(crate) fn delaunay_edges(points: &[[f64; 2]]) -> Vec<(u32, u32)> {
    let mut sites = unit_square(points);
    let order = |a: &Site, b: &Site| {
        let (p, q) = (a.position, b.position);
        p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(a.index.cmp(&b.index))
    };
    sites.sort_unstable_by(order);
    let mut edges = Vec::with_capacity(3 * points.len());
    for pair in sites.windows(2) {
        if pair[0].position == pair[1].position {
            edges.push((pair[0].index, pair[1].index));
        }
    }
    sites.dedup_by(|later, kept| later.position == kept.position);
    let path: Vec<(u32, u32)> = sites.windows(2).map(|pair| (pair[0].index, pair[1].index)).collect();
    match DelaunayTriangulation::<Site>::bulk_load(sites) {
        Ok(triangulation) => edges.extend(triangulation.undirected_edges().map(|edge| {
            let [a, b] = edge.vertices();
            (a.data().index, b.data().index)
        })),
        // Cannot happen for coordinates in the unit square; a path keeps the points joined all the same.
        Err(_) => edges.extend(path),
    }
    edges
}

fn unit_square(points: &[[f64; 2]]) -> Vec<Site> {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for point in points {
        for k in 0..2 {
            low[k] = low[k].min(point[k]);
            high[k] = high[k].max(point[k]);
        }
    }
    let extent = (high[0] - low[0]).max(high[1] - low[1]);
    let exponent = if extent > 0.0 { extent.log2().ceil().clamp(-1000.0, 1000.0) as i32 } else { 0 };
    let factor = 2.0_f64.powi(-exponent);
    // Below this a coordinate counts as zero for the triangulation's predicates.
    let flush = |x: f64| if x.abs() < spade::MIN_ALLOWED_VALUE { 0.0 } else { x };
    let scaled = |x: f64, k: usize| flush((x - low[k]) * factor);
    let site = |(point, index): (&[f64; 2], u32)| Site {
        position: Point2::new(scaled(point[0], 0), scaled(point[1], 1)),
        index,
    };
    points.iter().zip(0..).map(site).collect()
}
