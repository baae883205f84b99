//! The event loop: trees grow, meet and dissolve.

use super::forest::{Forest, Label, Link, NEVER, NONE};

/// No perfect matching exists; so many trees found no partner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Exposed(pub usize);

impl Forest {
    /// Makes an exposed top-level node the root of a tree.
    pub fn plant(&mut self, node: u32) {
        let tree = self.nodes[node as usize].first;
        self.tree_head[tree as usize] = NONE;
        self.relabel(node, Label::Plus);
        self.enlist(node, tree);
        self.n_trees += 1;
    }

    /// Runs the clock until every vertex is matched.
    pub fn run(&mut self) -> Result<(), Exposed> {
        for vertex in 0..self.n_vertices() as u32 {
            if self.group_of(vertex).label == Label::Plus {
                self.schedule(vertex);
            }
        }
        while self.n_trees > 0 {
            let Some((time, key)) = self.queue.pop() else { return Err(Exposed(self.n_trees)) };
            if self.due[key as usize] != time {
                continue;
            }
            self.now = time;
            self.due[key as usize] = NEVER;
            if self.is_blossom(key) {
                self.expand_in_tree(key);
            } else {
                self.visit(key);
            }
        }
        Ok(())
    }

    /// The earliest event at a vertex labelled plus: the time when an edge gets tight that leads on.
    #[inline]
    fn earliest(&self, vertex: u32) -> (i64, u32) {
        let place = self.places[vertex as usize];
        let group = self.groups[place.group as usize];
        let radius = place.offset + group.offset + self.now;
        let (mut best, mut head) = (NEVER, NONE);
        for arc in self.graph.arcs(vertex) {
            let other = self.places[arc.head as usize];
            if other.group == place.group {
                continue;
            }
            let other_group = self.groups[other.group as usize];
            let slack = arc.weight - radius - other.offset - other_group.offset;
            let wait = match other_group.label {
                Label::Free => slack,
                Label::Plus => (slack - self.now) >> 1,
                Label::Minus => continue,
            };
            if wait < best {
                (best, head) = (wait, arc.head);
            }
        }
        if head == NONE { (NEVER, NONE) } else { (self.now + best, head) }
    }

    /// Enters the next event of a vertex labelled plus.
    pub fn schedule(&mut self, vertex: u32) {
        let (time, _) = self.earliest(vertex);
        self.set_due(vertex, time);
    }

    #[inline]
    fn set_due(&mut self, key: u32, time: i64) {
        if self.due[key as usize] != time {
            self.due[key as usize] = time;
            if time != NEVER {
                self.queue.push(time, key);
            }
        }
    }

    /// Enters the time when the dual of a minus blossom reaches zero.
    pub fn schedule_expansion(&mut self, node: u32) {
        if self.is_blossom(node) {
            let time = self.now + self.dual(node);
            self.set_due(node, time);
        }
    }

    /// Handles every tight edge at a vertex labelled plus, then enters its next event.
    fn visit(&mut self, vertex: u32) {
        while self.group_of(vertex).label == Label::Plus {
            let (time, head) = self.earliest(vertex);
            if time > self.now {
                self.set_due(vertex, time);
                return;
            }
            let edge = Link { inner: vertex, outer: head };
            let (near, far) = (self.top(vertex), self.group_of(head));
            if far.label == Label::Free {
                self.grow(near, far.node, edge);
            } else if self.nodes[near as usize].tree == self.nodes[far.node as usize].tree {
                self.shrink(near, far.node, edge);
            } else {
                self.augment(near, far.node, edge);
            }
        }
    }

    /// Adds a free node and its mate to the tree of `near`.
    fn grow(&mut self, near: u32, far: u32, edge: Link) {
        let tree = self.nodes[near as usize].tree;
        let mate = self.top(self.nodes[far as usize].mate.outer);
        self.relabel(far, Label::Minus);
        self.nodes[far as usize].up = edge.reversed();
        self.enlist(far, tree);
        self.schedule_expansion(far);
        self.relabel(mate, Label::Plus);
        self.enlist(mate, tree);
        self.schedule_all(mate);
    }

    /// Enters the events of all vertices of a node that has just become plus.
    pub fn schedule_all(&mut self, node: u32) {
        let (mut vertex, last) = (self.nodes[node as usize].first, self.nodes[node as usize].last);
        loop {
            self.schedule(vertex);
            if vertex == last {
                return;
            }
            vertex = self.next_vertex[vertex as usize];
        }
    }

    /// Matches along a tight edge between two trees and dissolves both.
    fn augment(&mut self, near: u32, far: u32, edge: Link) {
        self.flip_to_root(near, edge);
        self.flip_to_root(far, edge.reversed());
        self.n_trees -= 2;
        let mut freed = std::mem::take(&mut self.scratch);
        for tree in [self.nodes[near as usize].tree, self.nodes[far as usize].tree] {
            self.dissolve(tree, &mut freed);
        }
        for &node in &freed {
            self.announce(node);
        }
        freed.clear();
        self.scratch = freed;
    }

    fn flip_to_root(&mut self, mut node: u32, mut edge: Link) {
        loop {
            let old = std::mem::replace(&mut self.nodes[node as usize].mate, edge);
            if old.is_absent() {
                return;
            }
            let minus = self.top(old.outer);
            let up = self.nodes[minus as usize].up;
            self.nodes[minus as usize].mate = up;
            node = self.top(up.outer);
            edge = up.reversed();
        }
    }

    /// Frees the nodes of a tree and appends them to `freed`; what was shrunk or expanded meanwhile only leaves the list.
    fn dissolve(&mut self, tree: u32, freed: &mut Vec<u32>) {
        let mut node = std::mem::replace(&mut self.tree_head[tree as usize], NONE);
        while node != NONE {
            let record = &mut self.nodes[node as usize];
            let next = std::mem::replace(&mut record.next_in_tree, NONE);
            if record.size == 0 {
                self.recycled.push(node);
            } else if record.parent == NONE {
                record.tree = NONE;
                self.due[node as usize] = NEVER;
                self.relabel(node, Label::Free);
                freed.push(node);
            }
            node = next;
        }
    }

    /// Tells the plus neighbours of a node that has become free; its own events end.
    pub fn announce(&mut self, node: u32) {
        let (mut vertex, last) = (self.nodes[node as usize].first, self.nodes[node as usize].last);
        loop {
            self.announce_vertex(vertex);
            if vertex == last {
                return;
            }
            vertex = self.next_vertex[vertex as usize];
        }
    }

    fn announce_vertex(&mut self, vertex: u32) {
        self.due[vertex as usize] = NEVER;
        let radius = self.radius(vertex);
        for k in 0..self.graph.arcs(vertex).len() {
            let arc = self.graph.arcs(vertex)[k];
            if self.group_of(arc.head).label == Label::Plus {
                let time = self.now + arc.weight - radius - self.radius(arc.head);
                if time < self.due[arc.head as usize] {
                    self.set_due(arc.head, time);
                }
            }
        }
    }
}
