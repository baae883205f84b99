//! Proof of optimality of a matching by its dual solution, checked by code of its own.
//!
//! Weak duality: with `slack(u, v) = weight - y(u) - y(v) - sum of z(B) over blossoms B that hold exactly one of u, v`,
//! every perfect matching weighs at least `sum y + sum z + n/2 min(0, least slack)`.

use super::solver::Matching;
use crate::metric::{Geometry, Metric};

/// Fewest members of a set for which boxes are used.
const BOXES_FROM: usize = 48;

/// What the dual solution of a matching proves.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Certificate {
    /// Whether the mates are a perfect matching and the blossoms are odd, nested, of non-negative dual and left by
    /// exactly one matched edge each.
    pub is_consistent: bool,
    /// The least slack over all pairs of vertices, at most zero.
    pub least_slack: f64,
    /// The greatest slack of a matched edge.
    pub greatest_matched_slack: f64,
    /// The weight of the matching, summed anew.
    pub weight: f64,
    /// A proven lower bound on the weight of every perfect matching, rounded down.
    pub lower_bound: f64,
}

impl Certificate {
    /// Whether the matching is proven to be within `tolerance` of the optimum.
    #[must_use]
    pub fn is_optimal_within(&self, tolerance: f64) -> bool {
        self.is_consistent && self.weight - self.lower_bound <= tolerance
    }
}

/// Checks feasibility and complementary slackness of the duals on the complete graph of `metric`.
///
/// # Complexity
/// `O(n log n)` typically for points, else `O(n^2)`, each times the depth of nesting.
#[must_use]
pub fn certificate(metric: &impl Metric, matching: &Matching) -> Certificate {
    let n = metric.len();
    let sets = Sets::new(matching);
    let is_consistent = is_perfect(n, matching.mates()) && sets.is_some();
    let Some(sets) = sets.filter(|_| is_consistent) else {
        let (least_slack, greatest_matched_slack) = (f64::NEG_INFINITY, f64::INFINITY);
        let (weight, lower_bound) = (f64::INFINITY, f64::NEG_INFINITY);
        return Certificate {
            is_consistent: false,
            least_slack,
            greatest_matched_slack,
            weight,
            lower_bound,
        };
    };
    let least_slack = sets.least_slack(metric, matching);
    let (mut weight, mut greatest_matched_slack) = (0.0, f64::NEG_INFINITY);
    for (u, v) in matching.edges() {
        weight += metric.distance(u, v);
        greatest_matched_slack = greatest_matched_slack.max(sets.slack(metric, matching, u, v));
    }
    let duals = || matching.duals().iter().copied().chain(matching.blossoms().iter().map(|b| b.dual));
    let objective: f64 = duals().sum();
    let magnitude: f64 = duals().map(f64::abs).sum();
    let rounding = magnitude * (n as f64 + 4.0) * f64::EPSILON;
    let lower_bound = objective + n as f64 / 2.0 * least_slack - rounding;
    Certificate { is_consistent, least_slack, greatest_matched_slack, weight, lower_bound }
}

fn is_perfect(n: usize, mates: &[usize]) -> bool {
    mates.len() == n && mates.iter().enumerate().all(|(u, &v)| v != u && mates.get(v) == Some(&u))
}

/// The nesting of the blossoms, from the lists of their vertices alone.
struct Sets {
    /// The smallest blossom around every blossom.
    parent: Vec<usize>,
    /// The smallest blossom around every vertex.
    innermost: Vec<usize>,
}

const OUTSIDE: usize = usize::MAX;

impl Sets {
    /// The nesting, unless the blossoms are no odd laminar family with one matched edge leaving each.
    fn new(matching: &Matching) -> Option<Sets> {
        let (n, blossoms) = (matching.mates().len(), matching.blossoms());
        if matching.duals().len() != n {
            return None;
        }
        let mut parent = vec![OUTSIDE; blossoms.len()];
        let mut innermost = vec![OUTSIDE; n];
        // The outermost of the sets seen so far around every vertex; sets come in order of size.
        let mut outermost = vec![OUTSIDE; n];
        let mut by_size: Vec<usize> = (0..blossoms.len()).collect();
        by_size.sort_by_key(|&k| blossoms[k].vertices.len());
        for k in by_size {
            let vertices = &blossoms[k].vertices;
            let mut covered = 0;
            for &v in vertices {
                let inner = *outermost.get(v)?;
                if inner == k {
                    return None;
                }
                if inner == OUTSIDE {
                    innermost[v] = k;
                } else if parent[inner] == OUTSIDE {
                    parent[inner] = k;
                    covered += blossoms[inner].vertices.len();
                } else if parent[inner] != k {
                    return None;
                }
                outermost[v] = k;
            }
            let direct = vertices.iter().filter(|&&v| innermost[v] == k).count();
            let leaving =
                vertices.iter().filter(|&&v| outermost.get(matching.mates()[v]) != Some(&k)).count();
            let is_odd = vertices.len() % 2 == 1;
            if covered + direct != vertices.len() || leaving != 1 || !is_odd || blossoms[k].dual < 0.0 {
                return None;
            }
        }
        Some(Sets { parent, innermost })
    }

    /// The slack of one pair, by walking outwards from both vertices.
    fn slack(&self, metric: &impl Metric, matching: &Matching, u: usize, v: usize) -> f64 {
        let around = |vertex: usize| {
            let outward = |&k: &usize| (self.parent[k] != OUTSIDE).then(|| self.parent[k]);
            let first = (self.innermost[vertex] != OUTSIDE).then(|| self.innermost[vertex]);
            std::iter::successors(first, outward)
        };
        let dual = |k: usize| matching.blossoms()[k].dual;
        let separate =
            |a: usize, b: usize| around(a).filter(|&k| around(b).all(|j| j != k)).map(dual).sum::<f64>();
        metric.distance(u, v) - matching.duals()[u] - matching.duals()[v] - separate(u, v) - separate(v, u)
    }

    /// The least slack of all pairs, at most zero: each set is searched for pairs that no smaller set holds.
    fn least_slack(&self, metric: &impl Metric, matching: &Matching) -> f64 {
        let n = metric.len();
        let mut least = 0.0_f64;
        // Radius of every vertex within the sets done so far, and the child it is in.
        let mut radius = matching.duals().to_vec();
        let mut child: Vec<usize> = (0..n).collect();
        let mut by_size: Vec<usize> = (0..matching.blossoms().len()).collect();
        by_size.sort_by_key(|&k| matching.blossoms()[k].vertices.len());
        let everything: Vec<usize> = (0..n).collect();
        for k in by_size.into_iter().map(Some).chain([None]) {
            let vertices = k.map_or(&everything, |k| &matching.blossoms()[k].vertices);
            let disks: Vec<Disk> =
                vertices.iter().map(|&v| Disk { vertex: v, child: child[v], radius: radius[v] }).collect();
            least = least.min(least_in_set(metric, disks));
            if let Some(k) = k {
                for &v in vertices {
                    radius[v] += matching.blossoms()[k].dual;
                    child[v] = n + k;
                }
            }
        }
        least
    }
}

#[derive(Clone, Copy)]
struct Disk {
    vertex: usize,
    child: usize,
    radius: f64,
}

fn least_in_set(metric: &impl Metric, mut disks: Vec<Disk>) -> f64 {
    match metric.geometry() {
        Geometry::Planar(points) if disks.len() >= BOXES_FROM => least_by_boxes(metric, points, &mut disks),
        Geometry::Spatial(points) if disks.len() >= BOXES_FROM => least_by_boxes(metric, points, &mut disks),
        _ => least_of_pairs(metric, &disks, &disks),
    }
}

fn least_of_pairs(metric: &impl Metric, these: &[Disk], those: &[Disk]) -> f64 {
    let mut least = 0.0_f64;
    for a in these {
        for b in those.iter().filter(|b| b.child != a.child) {
            least = least.min(metric.distance(a.vertex, b.vertex) - a.radius - b.radius);
        }
    }
    least
}

/// A box of disks: pairs of boxes that are far apart, or that lie in one child, need no look inside.
struct Cell<const D: usize> {
    low: [f64; D],
    high: [f64; D],
    greatest: f64,
    child: Option<usize>,
    begin: usize,
    end: usize,
    children: Option<[usize; 2]>,
}

fn least_by_boxes<const D: usize>(metric: &impl Metric, points: &[[f64; D]], disks: &mut [Disk]) -> f64 {
    let mut cells: Vec<Cell<D>> = Vec::new();
    let mut pending = vec![(0, disks.len(), None::<(usize, usize)>)];
    while let Some((begin, end, link)) = pending.pop() {
        let index = cells.len();
        if let Some((parent, side)) = link {
            cells[parent].children.get_or_insert([0; 2])[side] = index;
        }
        let mut cell = enclose(points, &disks[begin..end]);
        (cell.begin, cell.end) = (begin, end);
        if end - begin > 16 {
            let axis =
                (0..D).max_by(|&a, &b| (cell.high[a] - cell.low[a]).total_cmp(&(cell.high[b] - cell.low[b])));
            let axis = axis.unwrap_or(0);
            let middle = (end - begin) / 2;
            disks[begin..end].select_nth_unstable_by(middle, |a, b| {
                points[a.vertex][axis].total_cmp(&points[b.vertex][axis])
            });
            pending
                .extend([(begin, begin + middle, Some((index, 0))), (begin + middle, end, Some((index, 1)))]);
        }
        cells.push(cell);
    }
    let mut least = 0.0_f64;
    let mut pairs = vec![(0, 0)];
    while let Some((i, j)) = pairs.pop() {
        let (a, b) = (&cells[i], &cells[j]);
        if a.child.is_some() && a.child == b.child || separation(a, b) - a.greatest - b.greatest >= least {
            continue;
        }
        match (a.children, b.children) {
            (None, None) => {
                least = least.min(least_of_pairs(metric, &disks[a.begin..a.end], &disks[b.begin..b.end]));
            }
            (Some([p, q]), _) if i == j => pairs.extend([(p, p), (p, q), (q, q)]),
            (Some([p, q]), _) if b.children.is_none() || a.end - a.begin >= b.end - b.begin => {
                pairs.extend([(p, j), (q, j)]);
            }
            (_, Some([p, q])) => pairs.extend([(i, p), (i, q)]),
            (Some([p, q]), None) => pairs.extend([(p, j), (q, j)]),
        }
    }
    least
}

fn enclose<const D: usize>(points: &[[f64; D]], disks: &[Disk]) -> Cell<D> {
    let mut cell = Cell {
        low: [f64::INFINITY; D],
        high: [f64::NEG_INFINITY; D],
        greatest: f64::NEG_INFINITY,
        child: disks.first().map(|disk| disk.child),
        begin: 0,
        end: 0,
        children: None,
    };
    for disk in disks {
        for k in 0..D {
            cell.low[k] = cell.low[k].min(points[disk.vertex][k]);
            cell.high[k] = cell.high[k].max(points[disk.vertex][k]);
        }
        cell.greatest = cell.greatest.max(disk.radius);
        cell.child = cell.child.filter(|&child| child == disk.child);
    }
    cell
}

/// A lower bound on the distance between points of two boxes, the last digits given away.
fn separation<const D: usize>(a: &Cell<D>, b: &Cell<D>) -> f64 {
    let gap = |k: usize| (a.low[k] - b.high[k]).max(b.low[k] - a.high[k]).max(0.0);
    (0..D).map(|k| gap(k) * gap(k)).sum::<f64>().sqrt() * (1.0 - 1e-14)
}
