//! Edges of the complete graph that the duals do not yet satisfy.
//!
//! The slack of a pair is its weight less the two radii, counted up to the smallest blossom around both. So every blossom
//! (and the set of all vertices) is searched for pairs from different children. One k-d tree serves all of them: vertices
//! are numbered so that every blossom is a range, and boxes know the greatest radius and the range of their vertices.

use super::forest::{Forest, NONE};
use super::quantise::{Scale, UNIT};
use crate::kd_tree::{KdTree, squared_distance};
use crate::metric::{Geometry, Metric};
use std::ops::Range;

/// Most violated edges that one vertex adds in a round.
const PER_VERTEX: usize = 6;

/// Up to this number of vertices of a blossom all pairs are looked at.
const ALL_PAIRS_UP_TO: usize = 24;

/// Up to this number of vertices pairs are enumerated rather than searched for in a k-d tree.
const DENSE_UP_TO: usize = crate::candidates::DENSE_UP_TO;

/// A violated edge and its weight.
pub(crate) type Violation = (u32, u32, i64);

/// The k-d tree of the points of a metric, if it has any.
#[derive(Debug)]
pub(crate) enum Index {
    Planar(KdTree<2>),
    Spatial(KdTree<3>),
    Abstract,
}

impl Index {
    pub fn new(metric: &impl Metric) -> Self {
        match metric.geometry() {
            _ if metric.len() <= DENSE_UP_TO => Index::Abstract,
            Geometry::Planar(points) => Index::Planar(KdTree::new(points)),
            Geometry::Spatial(points) => Index::Spatial(KdTree::new(points)),
            Geometry::Abstract => Index::Abstract,
        }
    }
}

/// Storage of the search.
#[derive(Debug, Default)]
pub(crate) struct Prices {
    /// Vertices in an order in which every blossom is a range.
    sequence: Vec<u32>,
    /// Where each vertex is in it.
    place: Vec<u32>,
    /// Full radii.
    radius: Vec<i64>,
    row: Vec<(i64, Violation)>,
    blossoms: Vec<(u32, i64)>,
    /// The violated edges.
    pub found: Vec<Violation>,
}

/// Finds all violated edges, at most [`PER_VERTEX`] of a vertex in a blossom.
pub(crate) fn find_violated(
    forest: &Forest,
    metric: &impl Metric,
    scale: Scale,
    index: &Index,
    prices: &mut Prices,
) {
    prices.fill(forest);
    let mut pricing = Pricing { forest, metric, scale, prices };
    match index {
        Index::Planar(tree) => pricing.search(tree),
        Index::Spatial(tree) => pricing.search(tree),
        Index::Abstract => pricing.search_all_pairs(),
    }
}

impl Prices {
    fn fill(&mut self, forest: &Forest) {
        let n = forest.n_vertices();
        self.found.clear();
        self.sequence.clear();
        for vertex in 0..n as u32 {
            let top = forest.top(vertex);
            if forest.nodes[top as usize].first == vertex {
                self.sequence.extend(forest.vertices(top));
            }
        }
        self.place.resize(n, 0);
        for (k, &vertex) in self.sequence.iter().enumerate() {
            self.place[vertex as usize] = k as u32;
        }
        self.radius.clear();
        self.radius.extend((0..n as u32).map(|vertex| forest.radius(vertex)));
        self.list_blossoms(forest);
    }

    /// All blossoms, outer ones first, each with the sum of the duals of itself and those around it.
    fn list_blossoms(&mut self, forest: &Forest) {
        let nodes = &forest.nodes;
        let is_top = |node: &usize| nodes[*node].size > 0 && nodes[*node].parent == NONE;
        let list = &mut self.blossoms;
        list.clear();
        list.extend(
            (forest.n_vertices()..nodes.len()).filter(is_top).map(|node| (node as u32, nodes[node].dual)),
        );
        let mut next = 0;
        while next < list.len() {
            let (blossom, around) = list[next];
            for child in forest.children(blossom).filter(|&child| forest.is_blossom(child)) {
                list.push((child, around + nodes[child as usize].dual));
            }
            next += 1;
        }
    }
}

struct Pricing<'a, M> {
    forest: &'a Forest,
    metric: &'a M,
    scale: Scale,
    prices: &'a mut Prices,
}

impl<M: Metric> Pricing<'_, M> {
    fn range(&self, node: u32) -> Range<u32> {
        let first = self.prices.place[self.forest.nodes[node as usize].first as usize];
        first..first + self.forest.nodes[node as usize].size
    }

    #[inline]
    fn check(&mut self, u: u32, v: u32, around: i64) {
        let weight = self.scale.weight(self.metric.distance(u as usize, v as usize));
        let slack = weight - self.prices.radius[u as usize] - self.prices.radius[v as usize] + 2 * around;
        if slack < 0 {
            self.prices.row.push((slack, (u, v, weight)));
        }
    }

    fn keep_worst(&mut self) {
        if self.prices.row.len() > PER_VERTEX {
            self.prices.row.select_nth_unstable(PER_VERTEX);
            self.prices.row.truncate(PER_VERTEX);
        }
        self.prices.found.extend(self.prices.row.drain(..).map(|(_, violation)| violation));
    }

    fn search_all_pairs(&mut self) {
        let n = self.forest.n_vertices() as u32;
        for u in 0..n {
            let top = self.forest.top(u);
            for v in u + 1..n {
                if self.forest.top(v) != top {
                    self.check(u, v, 0);
                }
            }
            self.keep_worst();
        }
        for k in 0..self.prices.blossoms.len() {
            let (blossom, around) = self.prices.blossoms[k];
            self.all_pairs_in(blossom, around);
        }
    }

    /// Every pair of vertices from different children of a blossom.
    fn all_pairs_in(&mut self, blossom: u32, around: i64) {
        let end = self.range(blossom).end;
        let forest = self.forest;
        for child in forest.children(blossom) {
            let range = self.range(child);
            for k in range.clone() {
                for other in range.end..end {
                    self.check(
                        self.prices.sequence[k as usize],
                        self.prices.sequence[other as usize],
                        around,
                    );
                }
                self.keep_worst();
            }
        }
    }

    fn search<const D: usize>(&mut self, tree: &KdTree<D>) {
        let boxes = self.boxes(tree);
        let everything = 0..self.prices.sequence.len() as u32;
        for position in 0..tree.order.len() {
            let own = self.range(self.forest.top(tree.order[position]));
            let query =
                Query { position, own, within: everything.clone(), around: 0, from: position as u32 + 1 };
            self.query(tree, &boxes, &query);
        }
        let mut position_of = vec![0; tree.order.len()];
        for (position, &vertex) in tree.order.iter().enumerate() {
            position_of[vertex as usize] = position;
        }
        for k in 0..self.prices.blossoms.len() {
            let (blossom, around) = self.prices.blossoms[k];
            let within = self.range(blossom);
            if within.len() <= ALL_PAIRS_UP_TO {
                self.all_pairs_in(blossom, around);
                continue;
            }
            // Of every pair at least one vertex is not in the largest child.
            let forest = self.forest;
            let largest = forest.children(blossom).max_by_key(|&child| forest.nodes[child as usize].size);
            for child in forest.children(blossom).filter(|&child| Some(child) != largest) {
                let own = self.range(child);
                for k in own.clone() {
                    let position = position_of[self.prices.sequence[k as usize] as usize];
                    let query = Query { position, own: own.clone(), within: within.clone(), around, from: 0 };
                    self.query(tree, &boxes, &query);
                }
            }
        }
    }

    /// For every box of the tree the greatest radius and the range of its vertices.
    fn boxes<const D: usize>(&self, tree: &KdTree<D>) -> Vec<Summary> {
        let empty = Summary { radius: f64::NEG_INFINITY, low: NONE, high: 0 };
        let mut boxes = vec![empty; tree.nodes.len()];
        for k in (0..tree.nodes.len()).rev() {
            let node = &tree.nodes[k];
            let mut summary = empty;
            if node.left != 0 {
                summary = boxes[node.left as usize].join(boxes[node.left as usize + 1]);
            } else {
                for &vertex in &tree.order[node.range()] {
                    let place = self.prices.place[vertex as usize];
                    let radius = self.scale.real(self.prices.radius[vertex as usize]);
                    summary = summary.join(Summary { radius, low: place, high: place });
                }
            }
            boxes[k] = summary;
        }
        boxes
    }

    /// Checks the vertices of `query.within` that are not in `query.own` and near enough to be violated.
    fn query<const D: usize>(&mut self, tree: &KdTree<D>, boxes: &[Summary], query: &Query) {
        let u = tree.order[query.position];
        let point = &tree.points[query.position];
        // One unit more than the radii: rounding of a weight cannot hide a violation.
        let radius = self.scale.real(self.prices.radius[u as usize] - 2 * query.around + UNIT);
        let Query { own, within, .. } = query;
        let mut stack = [0_u32; 64];
        let mut len = 1;
        while len > 0 {
            len -= 1;
            let index = stack[len] as usize;
            let (node, summary) = (&tree.nodes[index], boxes[index]);
            let reach = radius + summary.radius;
            let is_outside = summary.high < within.start || summary.low >= within.end;
            let is_own = summary.low >= own.start && summary.high < own.end;
            if node.end <= query.from || is_outside || is_own || reach < 0.0 {
                continue;
            }
            if node.squared_distance(point) > reach * reach {
                continue;
            }
            if node.left != 0 {
                stack[len] = node.left;
                stack[len + 1] = node.left + 1;
                len += 2;
                continue;
            }
            for position in node.range() {
                let v = tree.order[position];
                let place = self.prices.place[v as usize];
                let is_far = squared_distance(point, &tree.points[position]) > reach * reach;
                if !is_far
                    && position >= query.from as usize
                    && within.contains(&place)
                    && !own.contains(&place)
                {
                    self.check(u, v, query.around);
                }
            }
        }
        self.keep_worst();
    }
}

#[derive(Debug, Clone, Copy)]
struct Summary {
    radius: f64,
    low: u32,
    high: u32,
}

impl Summary {
    fn join(self, other: Summary) -> Summary {
        let (low, high) = (self.low.min(other.low), self.high.max(other.high));
        Summary { radius: self.radius.max(other.radius), low, high }
    }
}

/// A vertex whose partners are sought.
struct Query {
    /// Position of the vertex in the tree.
    position: usize,
    /// The range of the child that it is in.
    own: Range<u32>,
    /// The range of the blossom.
    within: Range<u32>,
    /// Sum of the duals of the blossom and those around it.
    around: i64,
    /// Only positions from here on are looked at.
    from: u32,
}
