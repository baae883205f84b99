//! Edges of the complete graph that the duals do not yet satisfy.
//!
//! The slack of a pair is its weight less the two radii up to the smallest blossom around both. So every blossom (and
//! the set of all vertices) is searched on its own for pairs from different children, with the radii of its children.

use super::forest::{Forest, NONE};
use super::quantise::Scale;
use crate::kd_tree::{KdTree, squared_distance};
use crate::metric::{Geometry, Metric};

/// Most violated edges that one vertex adds in a round.
const PER_VERTEX: usize = 6;

/// Below this number of members all pairs are looked at.
const ALL_PAIRS_UP_TO: usize = 24;

/// A vertex seen from a blossom: the child it is in, and its radius up to that child.
#[derive(Debug, Clone, Copy)]
struct Member {
    vertex: u32,
    child: u32,
    radius: i64,
}

/// A violated edge and its weight.
pub(crate) type Violation = (u32, u32, i64);

/// All sets whose pairs are to be searched, one after the other.
pub(crate) fn violated(forest: &Forest, metric: &impl Metric, scale: Scale) -> Vec<Violation> {
    let n = forest.n_vertices() as u32;
    let mut found = Vec::new();
    let mut search = Search { metric, scale, row: Vec::new(), found: &mut found };
    let everything: Vec<Member> = (0..n)
        .map(|vertex| Member { vertex, child: forest.top(vertex), radius: forest.radius(vertex) })
        .collect();
    search.set(&everything);
    let mut inner = vec![0; n as usize];
    for member in &everything {
        inner[member.vertex as usize] = member.radius;
    }
    let mut stack: Vec<u32> = (n..forest.nodes.len() as u32)
        .filter(|&node| forest.nodes[node as usize].size > 0 && forest.nodes[node as usize].parent == NONE)
        .collect();
    let mut members = Vec::new();
    while let Some(blossom) = stack.pop() {
        members.clear();
        let dual = forest.dual_at_rest(blossom);
        for &(child, _) in &forest.nodes[blossom as usize].cycle {
            for vertex in forest.vertices(child) {
                inner[vertex as usize] -= dual;
                members.push(Member { vertex, child, radius: inner[vertex as usize] });
            }
            if forest.is_blossom(child) {
                stack.push(child);
            }
        }
        search.set(&members);
    }
    found
}

struct Search<'a, M> {
    metric: &'a M,
    scale: Scale,
    row: Vec<(i64, Violation)>,
    found: &'a mut Vec<Violation>,
}

impl<M: Metric> Search<'_, M> {
    fn set(&mut self, members: &[Member]) {
        match self.metric.geometry() {
            _ if members.len() <= ALL_PAIRS_UP_TO => self.all_pairs(members),
            Geometry::Planar(points) => self.by_tree(members, points),
            Geometry::Spatial(points) => self.by_tree(members, points),
            Geometry::Abstract => self.all_pairs(members),
        }
    }

    fn all_pairs(&mut self, members: &[Member]) {
        for (k, member) in members.iter().enumerate() {
            for other in members[k + 1..].iter().filter(|other| other.child != member.child) {
                self.check(member, other);
            }
            self.keep_worst();
        }
    }

    #[inline]
    fn check(&mut self, member: &Member, other: &Member) {
        let weight = self.scale.weight(self.metric.distance(member.vertex as usize, other.vertex as usize));
        let slack = weight - member.radius - other.radius;
        if slack < 0 {
            self.row.push((slack, (member.vertex, other.vertex, weight)));
        }
    }

    fn keep_worst(&mut self) {
        if self.row.len() > PER_VERTEX {
            self.row.sort_unstable();
        }
        self.found.extend(self.row.drain(..).take(PER_VERTEX).map(|(_, violation)| violation));
    }

    /// Skips boxes that are too far for every radius in them, or that lie in the same child as the vertex.
    fn by_tree<const D: usize>(&mut self, members: &[Member], points: &[[f64; D]]) {
        let positions: Vec<[f64; D]> = members.iter().map(|member| points[member.vertex as usize]).collect();
        let tree = KdTree::new(&positions);
        let sorted: Vec<Member> = tree.order.iter().map(|&k| members[k as usize]).collect();
        // One unit more than the dual: rounding of a weight cannot hide a violation.
        let radii: Vec<f64> = sorted.iter().map(|member| self.scale.real(member.radius + 4)).collect();
        let (greatest, child) = summarise(&tree, &sorted, &radii);
        let mut stack = Vec::new();
        for (position, member) in sorted.iter().enumerate() {
            stack.push(0_u32);
            while let Some(index) = stack.pop() {
                let node = &tree.nodes[index as usize];
                let reach = radii[position] + greatest[index as usize];
                let skip = node.end as usize <= position + 1
                    || child[index as usize] == member.child
                    || reach < 0.0
                    || node.squared_distance(&tree.points[position]) > reach * reach;
                if skip {
                    continue;
                }
                if node.left != 0 {
                    stack.extend([node.left, node.left + 1]);
                    continue;
                }
                for other in
                    node.range().filter(|&other| other > position && sorted[other].child != member.child)
                {
                    let reach = radii[position] + radii[other];
                    if reach >= 0.0
                        && squared_distance(&tree.points[position], &tree.points[other]) <= reach * reach
                    {
                        self.check(member, &sorted[other]);
                    }
                }
            }
            self.keep_worst();
        }
    }
}

/// For every box the greatest radius, and the child if it is the same for all its members.
fn summarise<const D: usize>(tree: &KdTree<D>, sorted: &[Member], radii: &[f64]) -> (Vec<f64>, Vec<u32>) {
    let mut greatest = vec![f64::NEG_INFINITY; tree.nodes.len()];
    let mut child = vec![NONE; tree.nodes.len()];
    for index in (0..tree.nodes.len()).rev() {
        let node = &tree.nodes[index];
        if node.left != 0 {
            let left = node.left as usize;
            greatest[index] = greatest[left].max(greatest[left + 1]);
            child[index] = if child[left] == child[left + 1] { child[left] } else { NONE };
            continue;
        }
        child[index] = sorted[node.begin as usize].child;
        for position in node.range() {
            greatest[index] = greatest[index].max(radii[position]);
            if sorted[position].child != child[index] {
                child[index] = NONE;
            }
        }
    }
    (greatest, child)
}
