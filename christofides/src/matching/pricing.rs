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
            _ if metric.len() <= ALL_PAIRS_UP_TO => Index::Abstract,
            Geometry::Planar(points) => Index::Planar(KdTree::new(points)),
            Geometry::Spatial(points) => Index::Spatial(KdTree::new(points)),
            Geometry::Abstract => Index::Abstract,
        }
    }
}

/// All violated edges, at most [`PER_VERTEX`] of a vertex in a blossom.
pub(crate) fn violated(forest: &Forest, metric: &impl Metric, scale: Scale, index: &Index) -> Vec<Violation> {
    let mut pricing = Pricing::new(forest, metric, scale);
    match index {
        Index::Planar(tree) => pricing.search(tree),
        Index::Spatial(tree) => pricing.search(tree),
        Index::Abstract => pricing.search_all_pairs(),
    }
    pricing.found
}

struct Pricing<'a, M> {
    forest: &'a Forest,
    metric: &'a M,
    scale: Scale,
    /// Vertices in an order in which every blossom is a range.
    sequence: Vec<u32>,
    /// Where each vertex is in it.
    place: Vec<u32>,
    /// Full radii.
    radius: Vec<i64>,
    row: Vec<(i64, Violation)>,
    found: Vec<Violation>,
}

impl<'a, M: Metric> Pricing<'a, M> {
    fn new(forest: &'a Forest, metric: &'a M, scale: Scale) -> Self {
        let n = forest.n_vertices();
        let mut sequence = Vec::with_capacity(n);
        for vertex in 0..n as u32 {
            let top = forest.top(vertex);
            if forest.nodes[top as usize].first == vertex {
                sequence.extend(forest.vertices(top));
            }
        }
        let mut place = vec![0; n];
        for (k, &vertex) in sequence.iter().enumerate() {
            place[vertex as usize] = k as u32;
        }
        let radius = (0..n as u32).map(|vertex| forest.radius(vertex)).collect();
        Pricing { forest, metric, scale, sequence, place, radius, row: Vec::new(), found: Vec::new() }
    }

    fn range(&self, node: u32) -> Range<u32> {
        let first = self.place[self.forest.nodes[node as usize].first as usize];
        first..first + self.forest.nodes[node as usize].size
    }

    /// All blossoms, outer ones first, each with the sum of the duals of itself and those around it.
    fn blossoms(&self) -> Vec<(u32, i64)> {
        let nodes = &self.forest.nodes;
        let n = self.forest.n_vertices();
        let is_top = |node: &usize| nodes[*node].size > 0 && nodes[*node].parent == NONE;
        let mut list: Vec<(u32, i64)> =
            (n..nodes.len()).filter(is_top).map(|node| (node as u32, nodes[node].dual)).collect();
        let mut next = 0;
        while next < list.len() {
            let (blossom, around) = list[next];
            for &(child, _) in nodes[blossom as usize].cycle.iter().filter(|c| self.forest.is_blossom(c.0)) {
                list.push((child, around + nodes[child as usize].dual));
            }
            next += 1;
        }
        list
    }

    #[inline]
    fn check(&mut self, u: u32, v: u32, around: i64) {
        let weight = self.scale.weight(self.metric.distance(u as usize, v as usize));
        let slack = weight - self.radius[u as usize] - self.radius[v as usize] + 2 * around;
        if slack < 0 {
            self.row.push((slack, (u, v, weight)));
        }
    }

    fn keep_worst(&mut self) {
        if self.row.len() > PER_VERTEX {
            self.row.select_nth_unstable(PER_VERTEX);
            self.row.truncate(PER_VERTEX);
        }
        self.found.extend(self.row.drain(..).map(|(_, violation)| violation));
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
        for (blossom, around) in self.blossoms() {
            self.all_pairs_in(blossom, around);
        }
    }

    /// Every pair of vertices from different children of a blossom.
    fn all_pairs_in(&mut self, blossom: u32, around: i64) {
        let end = self.range(blossom).end;
        let forest = self.forest;
        for &(child, _) in &forest.nodes[blossom as usize].cycle {
            let range = self.range(child);
            for k in range.clone() {
                for other in range.end..end {
                    self.check(self.sequence[k as usize], self.sequence[other as usize], around);
                }
                self.keep_worst();
            }
        }
    }

    fn search<const D: usize>(&mut self, tree: &KdTree<D>) {
        let boxes = self.boxes(tree);
        let everything = 0..self.sequence.len() as u32;
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
        for (blossom, around) in self.blossoms() {
            let within = self.range(blossom);
            if within.len() <= ALL_PAIRS_UP_TO {
                self.all_pairs_in(blossom, around);
                continue;
            }
            // Of every pair at least one vertex is not in the largest child.
            let forest = self.forest;
            let cycle = &forest.nodes[blossom as usize].cycle;
            let largest = cycle.iter().map(|c| c.0).max_by_key(|&child| forest.nodes[child as usize].size);
            for child in cycle.iter().map(|c| c.0).filter(|&child| Some(child) != largest) {
                let own = self.range(child);
                for k in own.clone() {
                    let position = position_of[self.sequence[k as usize] as usize];
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
                    let place = self.place[vertex as usize];
                    let radius = self.scale.real(self.radius[vertex as usize]);
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
        let radius = self.scale.real(self.radius[u as usize] - 2 * query.around + UNIT);
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
                let place = self.place[v as usize];
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
