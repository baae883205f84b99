//! The state of the primal-dual search: nested blossoms, their duals as functions of time, alternating trees.
//!
//! All alternating trees grow at once, with one clock. A top-level node (vertex or blossom) is labelled plus (even
//! distance from an exposed root; its dual rises with the clock), minus (its dual falls) or free (in no tree). The dual
//! of a node is stored as its value when its label last changed; nothing is touched while the clock runs.
//!
//! The *radius* of a vertex is its own dual plus those of all blossoms around it, so that the slack of an edge between
//! two different top-level nodes is `weight - radius(u) - radius(v)`. All vertices of a top-level node share the moving
//! part of the radius, which is kept once per node in a `Group`.

use super::graph::Graph;
use super::queue::EventQueue;

pub(crate) const NONE: u32 = u32::MAX;
/// A time that never comes.
pub(crate) const NEVER: i64 = i64::MAX;

/// The side of its alternating tree that a top-level node is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i8)]
pub(crate) enum Label {
    /// At odd distance from the root: the dual falls.
    Minus = -1,
    /// In no tree.
    Free = 0,
    /// At even distance from the root: the dual rises.
    Plus = 1,
}

/// An edge by its ends; `inner` lies in the node that the edge is stored with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Link {
    pub inner: u32,
    pub outer: u32,
}

impl Link {
    pub const ABSENT: Link = Link { inner: NONE, outer: NONE };

    pub fn is_absent(self) -> bool {
        self.outer == NONE
    }

    pub fn reversed(self) -> Link {
        Link { inner: self.outer, outer: self.inner }
    }
}

/// A vertex or a blossom. Vertices are nodes `0..n`, blossoms follow.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    /// The dual when the label last changed.
    pub dual: i64,
    /// The time when the label last changed.
    pub since: i64,
    /// The enclosing blossom.
    pub parent: u32,
    /// The alternating tree, for top-level nodes that are not free.
    pub tree: u32,
    /// The next node in the list of the tree.
    pub next_in_tree: u32,
    /// The matched edge; meaningful for top-level nodes only.
    pub mate: Link,
    /// The edge to the parent in the tree, for nodes labelled minus.
    pub up: Link,
    /// First vertex of the node in the list of vertices.
    pub first: u32,
    /// Last vertex of the node in the list of vertices.
    pub last: u32,
    /// The group of the node when it is at the top level: that of its largest child.
    pub group: u32,
    /// Number of vertices.
    pub size: u32,
    /// Mark of the search for a common ancestor.
    pub stamp: u32,
    /// First child of a blossom; the children form a cycle.
    pub first_child: u32,
    /// The next child of the same blossom, absent for the last one.
    pub next_child: u32,
    /// The edge to the next child of the same blossom, for the last one to the first.
    pub onward: Link,
}

impl Node {
    pub fn new(first: u32, size: u32) -> Self {
        Node {
            dual: 0,
            since: 0,
            parent: NONE,
            tree: NONE,
            next_in_tree: NONE,
            mate: Link::ABSENT,
            up: Link::ABSENT,
            first,
            last: first,
            group: first,
            size,
            stamp: 0,
            first_child: NONE,
            next_child: NONE,
            onward: Link::ABSENT,
        }
    }
}

/// What the vertices of one top-level node share.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Group {
    /// Added to every vertex' own offset.
    pub offset: i64,
    /// The top-level node.
    pub node: u32,
    /// Its label.
    pub label: Label,
}

/// A vertex' part of its radius, and its group.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    pub offset: i64,
    pub group: u32,
}

/// The whole state of the search.
#[derive(Debug, Default)]
pub(crate) struct Forest {
    pub graph: Graph,
    pub nodes: Vec<Node>,
    pub groups: Vec<Group>,
    pub places: Vec<Place>,
    /// Next vertex in the list of the vertices of a node.
    pub next_vertex: Vec<u32>,
    /// First node of the list of every tree; the root's vertex numbers the tree.
    pub tree_head: Vec<u32>,
    pub recycled: Vec<u32>,
    /// When the next event of a vertex or the end of a blossom is due.
    pub due: Vec<i64>,
    pub queue: EventQueue,
    pub now: i64,
    pub n_trees: usize,
    pub stamp: u32,
    pub scratch: Vec<u32>,
    /// Storage of the cycle that is shrunk or expanded: children, each with the edge that joins it to the next.
    pub cycle: Vec<(u32, Link)>,
}

impl Forest {
    /// Starts afresh with `n` exposed vertices and all duals zero.
    pub fn reset(&mut self, n: usize) {
        let vertices = 0..n as u32;
        self.nodes.clear();
        self.nodes.extend(vertices.clone().map(|v| Node::new(v, 1)));
        self.groups.clear();
        self.groups.extend(vertices.clone().map(|node| Group { offset: 0, node, label: Label::Free }));
        self.places.clear();
        self.places.extend(vertices.map(|group| Place { offset: 0, group }));
        self.next_vertex.clear();
        self.next_vertex.resize(n, NONE);
        self.tree_head.clear();
        self.tree_head.resize(n, NONE);
        self.recycled.clear();
        self.due.clear();
        self.due.resize(n, NEVER);
        self.queue.clear();
        (self.now, self.n_trees, self.stamp) = (0, 0, 0);
    }

    pub fn n_vertices(&self) -> usize {
        self.places.len()
    }

    #[inline]
    pub fn group_of(&self, vertex: u32) -> Group {
        self.groups[self.places[vertex as usize].group as usize]
    }

    /// The top-level node around a vertex.
    #[inline]
    pub fn top(&self, vertex: u32) -> u32 {
        self.group_of(vertex).node
    }

    #[inline]
    pub fn label(&self, node: u32) -> Label {
        self.groups[self.nodes[node as usize].group as usize].label
    }

    #[inline]
    pub fn radius(&self, vertex: u32) -> i64 {
        let place = self.places[vertex as usize];
        let group = self.groups[place.group as usize];
        place.offset + group.offset + group.label as i64 * self.now
    }

    pub fn is_blossom(&self, node: u32) -> bool {
        node as usize >= self.n_vertices()
    }

    /// The dual of a top-level node now.
    pub fn dual(&self, node: u32) -> i64 {
        let record = &self.nodes[node as usize];
        record.dual + self.label(node) as i64 * (self.now - record.since)
    }

    /// Gives a top-level node another label, its dual and radii continuing from where they are.
    pub fn relabel(&mut self, node: u32, label: Label) {
        let dual = self.dual(node);
        let record = &mut self.nodes[node as usize];
        (record.dual, record.since) = (dual, self.now);
        let group = &mut self.groups[record.group as usize];
        group.offset += (group.label as i64 - label as i64) * self.now;
        group.label = label;
    }

    /// Lowers the dual of a top-level node.
    pub fn lower_dual(&mut self, node: u32, amount: i64) {
        let record = &mut self.nodes[node as usize];
        record.dual -= amount;
        self.groups[record.group as usize].offset -= amount;
    }

    /// Adds a top-level node to the list of a tree.
    pub fn enlist(&mut self, node: u32, tree: u32) {
        let record = &mut self.nodes[node as usize];
        record.tree = tree;
        record.next_in_tree = self.tree_head[tree as usize];
        self.tree_head[tree as usize] = node;
    }

    /// The vertices of a node.
    pub fn vertices(&self, node: u32) -> impl Iterator<Item = u32> + '_ {
        let record = &self.nodes[node as usize];
        let last = record.last;
        let mut next = Some(record.first);
        std::iter::from_fn(move || {
            let vertex = next?;
            next = (vertex != last).then(|| self.next_vertex[vertex as usize]);
            Some(vertex)
        })
    }

    /// The children of a blossom in cyclic order; none for a vertex.
    pub fn children(&self, blossom: u32) -> impl Iterator<Item = u32> + '_ {
        let mut next = self.nodes[blossom as usize].first_child;
        std::iter::from_fn(move || {
            let child = (next != NONE).then_some(next)?;
            next = self.nodes[child as usize].next_child;
            Some(child)
        })
    }

    /// The child of `blossom` that contains `vertex`.
    pub fn child_around(&self, blossom: u32, vertex: u32) -> u32 {
        let mut child = vertex;
        while self.nodes[child as usize].parent != blossom {
            child = self.nodes[child as usize].parent;
        }
        child
    }

    /// Moves the vertices of `node` into `group`, their radii unchanged; `node` is no longer (or not yet) at the top.
    pub fn regroup(&mut self, node: u32, group: u32) {
        let target = self.groups[group as usize];
        let base = target.offset + target.label as i64 * self.now;
        let (mut vertex, last) = (self.nodes[node as usize].first, self.nodes[node as usize].last);
        loop {
            let radius = self.radius(vertex);
            self.places[vertex as usize] = Place { offset: radius - base, group };
            if vertex == last {
                return;
            }
            vertex = self.next_vertex[vertex as usize];
        }
    }
}
