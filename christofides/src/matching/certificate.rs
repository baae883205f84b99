//! Proof of optimality of a matching by its dual solution, checked by code of its own.
//!
//! Weak duality: with `slack(u, v) = weight - y(u) - y(v) - sum of z(B) over blossoms B that hold exactly one of u, v`,
//! every perfect matching weighs at least `sum y + sum z + n/2 min(0, least slack)`.

use super::solver::Matching;
use crate::metric::{Geometry, Metric};
use std::ops::Range;

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
/// `O(n log^2 n)` typically for points, else `O(n^2)`.
#[must_use]
pub fn certificate(metric: &impl Metric, matching: &Matching) -> Certificate {
    let n = metric.len();
    let sets = if is_perfect(n, matching.mates()) { Sets::new(matching) } else { None };
    let nested = sets.map(|sets| (Family::new(&sets, matching), sets));
    let Some((family, sets)) = nested.filter(|(family, sets)| sets.are_left_once(family, matching.mates()))
    else {
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
    let least_slack = least_slack(&family, metric);
    let (mut weight, mut greatest_matched_slack) = (0.0, f64::NEG_INFINITY);
    for (u, v) in matching.edges() {
        weight += metric.distance(u, v);
        greatest_matched_slack = greatest_matched_slack.max(sets.slack(&family, metric, matching, u, v));
    }
    let duals = || matching.duals().iter().copied().chain(matching.blossoms().iter().map(|b| b.dual));
    let objective: f64 = duals().sum();
    let magnitude: f64 = duals().map(f64::abs).sum();
    let rounding = magnitude * (n as f64 + 4.0) * f64::EPSILON;
    let lower_bound = objective + n as f64 / 2.0 * least_slack - rounding;
    Certificate { is_consistent: true, least_slack, greatest_matched_slack, weight, lower_bound }
}

fn is_perfect(n: usize, mates: &[usize]) -> bool {
    mates.len() == n && mates.iter().enumerate().all(|(u, &v)| v != u && mates.get(v) == Some(&u))
}

/// The nesting of the blossoms.
struct Sets {
    /// The smallest blossom around every blossom.
    parent: Vec<usize>,
    /// The smallest blossom around every vertex.
    innermost: Vec<usize>,
}

const OUTSIDE: usize = usize::MAX;

impl Sets {
    /// The nesting, unless the blossoms are no odd laminar family of non-negative duals.
    fn new(matching: &Matching) -> Option<Sets> {
        let (n, blossoms) = (matching.mates().len(), matching.blossoms());
        let mut innermost = vec![OUTSIDE; n];
        let mut parent = vec![OUTSIDE; blossoms.len()];
        let mut size = vec![0; blossoms.len()];
        for (k, blossom) in blossoms.iter().enumerate() {
            for &v in &blossom.vertices {
                let slot = innermost.get_mut(v)?;
                if std::mem::replace(slot, k) != OUTSIDE {
                    return None;
                }
            }
            size[k] += blossom.vertices.len();
            // Parents come later, so that the nesting cannot be circular.
            if let Some(around) = blossom.parent {
                if around <= k || around >= blossoms.len() {
                    return None;
                }
                parent[k] = around;
                size[around] += size[k];
            }
            if size[k] % 2 == 0 || blossom.dual < 0.0 || blossom.dual.is_nan() {
                return None;
            }
        }
        (matching.duals().len() == n).then_some(Sets { parent, innermost })
    }

    /// The blossoms that hold `u` but not `v`, inner ones first.
    fn left<'a>(&'a self, family: &'a Family, u: usize, v: usize) -> impl Iterator<Item = usize> + 'a {
        let existing = |k: usize| (k != OUTSIDE).then_some(k);
        let outward = std::iter::successors(existing(self.innermost[u]), move |&k| existing(self.parent[k]));
        outward.take_while(move |&k| !family.range[k].contains(&family.number[v]))
    }

    /// Whether exactly one matched edge leaves each blossom.
    fn are_left_once(&self, family: &Family, mates: &[usize]) -> bool {
        let mut n_leaving = vec![0; self.parent.len()];
        for (u, &v) in mates.iter().enumerate() {
            self.left(family, u, v).for_each(|k| n_leaving[k] += 1);
        }
        n_leaving.iter().all(|&count| count == 1)
    }

    /// The slack of one pair.
    fn slack(&self, family: &Family, metric: &impl Metric, matching: &Matching, u: usize, v: usize) -> f64 {
        let blossoms = self.left(family, u, v).chain(self.left(family, v, u));
        let separating: f64 = blossoms.map(|k| matching.blossoms()[k].dual).sum();
        metric.distance(u, v) - matching.duals()[u] - matching.duals()[v] - separating
    }
}

/// The least slack of all pairs, at most zero.
///
/// Each set is searched for pairs from different children. Of each such pair at least one vertex is outside the largest
/// child; so only the others ask, and a vertex asks `O(log n)` times.
fn least_slack(family: &Family, metric: &impl Metric) -> f64 {
    match metric.geometry() {
        Geometry::Planar(points) => family.least_slack(metric, &mut Cells::new(points, family)),
        Geometry::Spatial(points) => family.least_slack(metric, &mut Cells::new(points, family)),
        Geometry::Abstract => family.least_slack(metric, &mut AllPairs),
    }
}

/// The sets as ranges of a numbering of the vertices, the set of all vertices last.
struct Family {
    /// Vertex of every number.
    vertex: Vec<usize>,
    /// Number of every vertex.
    number: Vec<usize>,
    /// Sum of the duals of the vertex and of all blossoms around it, by number.
    radius: Vec<f64>,
    /// Range of every blossom, then of all vertices.
    range: Vec<Range<usize>>,
    /// Ranges of the children of every set.
    children: Vec<Vec<Range<usize>>>,
    /// Sum of the duals of every set and of those around it.
    around: Vec<f64>,
}

impl Family {
    fn new(sets: &Sets, matching: &Matching) -> Self {
        let (n, blossoms) = (matching.mates().len(), matching.blossoms());
        let outside = blossoms.len();
        let index = |k: usize| if k == OUTSIDE { outside } else { k };
        let mut inner = vec![Vec::new(); outside + 1];
        let mut own = vec![Vec::new(); outside + 1];
        sets.parent.iter().enumerate().for_each(|(k, &parent)| inner[index(parent)].push(k));
        sets.innermost.iter().enumerate().for_each(|(v, &k)| own[index(k)].push(v));
        let mut family = Family {
            vertex: Vec::with_capacity(n),
            number: vec![0; n],
            radius: Vec::with_capacity(n),
            range: vec![0..0; outside + 1],
            children: vec![Vec::new(); outside + 1],
            around: vec![0.0; outside + 1],
        };
        // A set is met twice: its own vertices are numbered first, the range is known when all inside is done.
        let mut stack = vec![(outside, false)];
        while let Some((k, is_done)) = stack.pop() {
            if is_done {
                family.range[k].end = family.vertex.len();
                family.children[k]
                    .extend(inner[k].iter().map(|&child| family.range[child].clone()).collect::<Vec<_>>());
                continue;
            }
            family.around[k] =
                if k == outside { 0.0 } else { family.around[index(sets.parent[k])] + blossoms[k].dual };
            let first = family.vertex.len();
            family.range[k] = first..n;
            for &v in &own[k] {
                family.children[k].push(family.vertex.len()..family.vertex.len() + 1);
                family.number[v] = family.vertex.len();
                family.vertex.push(v);
                family.radius.push(matching.duals()[v] + family.around[k]);
            }
            stack.push((k, true));
            stack.extend(inner[k].iter().map(|&child| (child, false)));
        }
        family
    }

    fn least_slack<M: Metric>(&self, metric: &M, finder: &mut impl Finder) -> f64 {
        let mut least = 0.0_f64;
        for (k, children) in self.children.iter().enumerate() {
            let largest = (0..children.len()).max_by_key(|&c| children[c].len());
            for (_, own) in children.iter().enumerate().filter(|&(c, _)| Some(c) != largest) {
                for number in own.clone() {
                    let question = Question { number, own, within: &self.range[k], around: self.around[k] };
                    least = finder.least(self, metric, &question, least);
                }
            }
        }
        least
    }

    fn slack(&self, metric: &impl Metric, a: usize, b: usize, around: f64) -> f64 {
        metric.distance(self.vertex[a], self.vertex[b]) - self.radius[a] - self.radius[b] + 2.0 * around
    }
}

/// Which vertices of the range `within`, but not of `own`, have a slack with a vertex below what is known?
struct Question<'a> {
    number: usize,
    own: &'a Range<usize>,
    within: &'a Range<usize>,
    around: f64,
}

impl Question<'_> {
    fn asks_for(&self, number: usize) -> bool {
        self.within.contains(&number) && !self.own.contains(&number)
    }
}

trait Finder {
    fn least(&mut self, family: &Family, metric: &impl Metric, question: &Question<'_>, least: f64) -> f64;
}

struct AllPairs;

impl Finder for AllPairs {
    fn least(&mut self, family: &Family, metric: &impl Metric, question: &Question<'_>, least: f64) -> f64 {
        let others = question.within.clone().filter(|&number| question.asks_for(number));
        others
            .map(|other| family.slack(metric, question.number, other, question.around))
            .fold(least, f64::min)
    }
}

/// A box of vertices: their coordinates, numbers and greatest radius.
struct Cell<const D: usize> {
    low: [f64; D],
    high: [f64; D],
    greatest: f64,
    first: usize,
    last: usize,
    /// Positions in the list of numbers.
    span: Range<usize>,
    children: Option<[usize; 2]>,
}

struct Cells<'a, const D: usize> {
    points: &'a [[f64; D]],
    cells: Vec<Cell<D>>,
    numbers: Vec<usize>,
    stack: Vec<usize>,
}

impl<'a, const D: usize> Cells<'a, D> {
    fn new(points: &'a [[f64; D]], family: &Family) -> Self {
        let mut numbers: Vec<usize> = (0..points.len()).collect();
        let mut cells: Vec<Cell<D>> = Vec::new();
        let mut pending = vec![(0..points.len(), None::<(usize, usize)>)];
        while let Some((span, link)) = pending.pop() {
            let index = cells.len();
            if let Some((parent, side)) = link {
                cells[parent].children.get_or_insert([0; 2])[side] = index;
            }
            let part = &mut numbers[span.clone()];
            let cell = enclose(points, family, part, span.clone());
            if part.len() > 12 {
                let width = |k: usize| cell.high[k] - cell.low[k];
                let axis = (0..D).max_by(|&a, &b| width(a).total_cmp(&width(b))).unwrap_or(0);
                let coordinate = |number: &usize| points[family.vertex[*number]][axis];
                let half = part.len() / 2;
                part.select_nth_unstable_by(half, |a, b| coordinate(a).total_cmp(&coordinate(b)));
                let middle = span.start + half;
                pending
                    .extend([(span.start..middle, Some((index, 0))), (middle..span.end, Some((index, 1)))]);
            }
            cells.push(cell);
        }
        Cells { points, cells, numbers, stack: Vec::new() }
    }
}

fn enclose<const D: usize>(
    points: &[[f64; D]],
    family: &Family,
    numbers: &[usize],
    span: Range<usize>,
) -> Cell<D> {
    let (low, high) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
    let mut cell =
        Cell { low, high, greatest: f64::NEG_INFINITY, first: usize::MAX, last: 0, span, children: None };
    for &number in numbers {
        let point = &points[family.vertex[number]];
        for k in 0..D {
            cell.low[k] = cell.low[k].min(point[k]);
            cell.high[k] = cell.high[k].max(point[k]);
        }
        cell.greatest = cell.greatest.max(family.radius[number]);
        (cell.first, cell.last) = (cell.first.min(number), cell.last.max(number));
    }
    cell
}

impl<const D: usize> Finder for Cells<'_, D> {
    fn least(
        &mut self,
        family: &Family,
        metric: &impl Metric,
        question: &Question<'_>,
        mut least: f64,
    ) -> f64 {
        let point = &self.points[family.vertex[question.number]];
        let radius = family.radius[question.number] - 2.0 * question.around;
        self.stack.push(0);
        while let Some(index) = self.stack.pop() {
            let cell = &self.cells[index];
            let is_outside = cell.last < question.within.start || cell.first >= question.within.end;
            let is_own = question.own.start <= cell.first && cell.last < question.own.end;
            if is_outside || is_own || separation(cell, point) - radius - cell.greatest >= least {
                continue;
            }
            if let Some(children) = cell.children {
                self.stack.extend(children);
                continue;
            }
            for &other in self.numbers[cell.span.clone()].iter().filter(|&&other| question.asks_for(other)) {
                least = least.min(family.slack(metric, question.number, other, question.around));
            }
        }
        least
    }
}

/// A lower bound on the distance from a point to those of a box, the last digits given away.
fn separation<const D: usize>(cell: &Cell<D>, point: &[f64; D]) -> f64 {
    let gap = |k: usize| (cell.low[k] - point[k]).max(point[k] - cell.high[k]).max(0.0);
    (0..D).map(|k| gap(k) * gap(k)).sum::<f64>().sqrt() * (1.0 - 1e-14)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::min_weight_perfect_matching;
    use crate::matrix::FromFn;
    use proptest::prelude::*;

    #[test]
    fn mates_are_mutual() {
        assert!(is_perfect(4, &[1, 0, 3, 2]));
        for mates in [&[1, 2, 3, 0][..], &[0, 1, 3, 2], &[1, 0, 3, 9], &[1, 0]] {
            assert!(!is_perfect(4, mates), "{mates:?}");
        }
    }

    /// Two triangles far apart: an edge in each, and one between them that leaves either blossom. Three between them prove nothing.
    #[test]
    fn a_blossom_is_left_once() {
        let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [50.0, 0.0], [51.0, 0.0], [50.0, 1.0]];
        let metric = crate::Points(&points);
        let mut matching = min_weight_perfect_matching(&metric).unwrap();
        assert!(!matching.blossoms().is_empty() && certificate(&metric, &matching).is_consistent);
        matching.mates = vec![3, 4, 5, 0, 1, 2];
        let proof = certificate(&metric, &matching);
        assert!(!proof.is_consistent && !proof.is_optimal_within(1e300));
    }

    /// Whatever range is asked for, and wherever it begins or ends in a cell: the cells that are passed over hold nothing that is less.
    #[test]
    fn cells_pass_over_nothing() {
        const N: u32 = 40;
        let points: Vec<[f64; 2]> =
            (0..N).map(|i| [0.4 * f64::from(i), 0.1 * f64::from(i * i % 7)]).collect();
        let numbers: Vec<usize> = (0..points.len()).collect();
        let family = |unit: f64| Family {
            vertex: numbers.clone(),
            number: numbers.clone(),
            radius: (0..N).map(|i| unit * f64::from(i * 5 % 11)).collect(),
            range: vec![],
            children: vec![],
            around: vec![],
        };
        // radii that outweigh distances, and none
        for family in [family(1.0), family(0.0)] {
            let metric = crate::Points(&points);
            let mut cells = Cells::new(&points, &family);
            let mut compare = |number: usize, own: Range<usize>, within: Range<usize>| {
                for around in [0.0, 1.5] {
                    let question = Question { number, own: &own, within: &within, around };
                    let [found, all] = [
                        cells.least(&family, &metric, &question, f64::INFINITY),
                        AllPairs.least(&family, &metric, &question, f64::INFINITY),
                    ];
                    assert_eq!(found, all, "{number} of {own:?} in {within:?}");
                }
            };
            for number in 0..points.len() {
                for start in 0..=number {
                    for end in number + 1..=points.len() {
                        compare(number, start..end, 0..points.len());
                        compare(number, number..number + 1, start..end);
                    }
                }
            }
        }
    }

    /// An optimum on whole distances, where its duals are exact, with `shift` added to the dual of every vertex.
    fn shifted(places: &[i32], shift: f64) -> (Matching, Certificate) {
        let distance = |i: usize, j: usize| f64::from((places[i] - places[j]).abs());
        let metric = FromFn::metric(places.len(), distance);
        let mut matching = min_weight_perfect_matching(&metric).unwrap();
        matching.duals.iter_mut().for_each(|dual| *dual += shift);
        let proof = certificate(&metric, &matching);
        (matching, proof)
    }

    proptest! {
        /// More in every dual makes edges infeasible by twice as much, which the bound takes back; less makes it weaker
        /// by what was taken. Between neither and the weight is there more than the rounding that is announced.
        #[test]
        fn shifted_duals_prove_no_more(
            places in prop::collection::vec(-99..99i32, 2..40).prop_map(|mut p| { p.truncate(p.len() / 2 * 2); p }),
            shift in prop::sample::select(vec![0.0, 0.5, 3.0, 1024.0, 1e6, 1e-3, 1e12, 1.0 / 3.0]),
        ) {
            let n = places.len() as f64;
            let rounding = |matching: &Matching| {
                let blossoms = matching.blossoms().iter().map(|blossom| blossom.dual);
                matching.duals().iter().copied().chain(blossoms).map(f64::abs).sum::<f64>() * (n + 4.0) * f64::EPSILON
            };
            let (more, proof) = shifted(&places, shift);
            let lost = more.weight() - proof.lower_bound;
            prop_assert!(proof.is_consistent && proof.weight == more.weight());
            prop_assert!((0.0..=2.0 * rounding(&more) + 1e-12).contains(&lost), "{lost} {proof:?}");
            prop_assert!(rounding(&more) == 0.0 || lost > 0.0);
            prop_assert!((proof.least_slack + 2.0 * shift).abs() <= 2.0 * rounding(&more));
            let (less, proof) = shifted(&places, -shift);
            let lost = less.weight() - n * shift - proof.lower_bound;
            prop_assert!(proof.least_slack == 0.0 || proof.least_slack >= -2.0 * rounding(&less));
            prop_assert!(lost.abs() <= (n + 2.0) * rounding(&less) + 1e-12, "{lost} {proof:?}");
        }
    }
}
