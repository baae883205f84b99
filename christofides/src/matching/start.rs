//! Feasible duals to start from: greedy ones at first, those of the last round when edges are added.

use super::forest::{Forest, Label, Link};

impl Forest {
    /// Halves of the lightest edges as duals, then one sweep that raises each to its first tight edge and matches it.
    pub fn start_greedily(&mut self) {
        let n = self.graph.len();
        self.reset(n);
        for v in 0..n as u32 {
            let lightest = self.graph.arcs(v).iter().map(|arc| arc.weight).min().unwrap_or(0);
            self.groups[v as usize].offset = lightest >> 1;
        }
        for v in 0..n as u32 {
            if self.nodes[v as usize].mate.is_absent() {
                self.raise_and_match(v);
            }
        }
        for v in 0..n as u32 {
            self.nodes[v as usize].dual = self.groups[v as usize].offset;
            if self.nodes[v as usize].mate.is_absent() {
                self.plant(v);
            }
        }
    }

    fn raise_and_match(&mut self, v: u32) {
        let offset = self.groups[v as usize].offset;
        let slack = |weight: i64, head: u32| weight - offset - self.groups[head as usize].offset;
        let arcs = self.graph.arcs(v);
        let Some(least) = arcs.iter().map(|arc| slack(arc.weight, arc.head)).min() else { return };
        let is_exposed = |head: u32| self.nodes[head as usize].mate.is_absent();
        let tight = arcs.iter().find(|arc| slack(arc.weight, arc.head) == least && is_exposed(arc.head));
        let partner = tight.map(|arc| arc.head);
        self.groups[v as usize].offset += least;
        if let Some(head) = partner {
            self.nodes[v as usize].mate = Link { inner: v, outer: head };
            self.nodes[head as usize].mate = Link { inner: head, outer: v };
        }
    }

    /// Makes the duals feasible for edges that have been added, by lowering duals at their ends, and plants what is
    /// exposed by that. The graph must already contain the edges; no tree may be alive.
    pub fn restart(&mut self, added: &[(u32, u32, i64)]) {
        self.queue.clear();
        let mut exposed = std::mem::take(&mut self.scratch);
        for &(u, v, weight) in added {
            while self.top(u) == self.top(v) {
                self.lower(u, self.dual(self.top(u)), &mut exposed);
                let blossom = self.top(u);
                if self.is_blossom(blossom) {
                    self.expand_free(blossom, u);
                }
            }
            let slack = weight - self.radius(u) - self.radius(v);
            if slack < 0 {
                let end = if self.is_blossom(self.top(u)) { v } else { u };
                self.lower(end, -slack, &mut exposed);
            }
        }
        let mut k = 0;
        while k < exposed.len() {
            // Slacks between trees must be even: exposed radii are, and tight edges carry the parity on.
            let v = exposed[k];
            if self.radius(v) & 1 != 0 && self.nodes[self.top(v) as usize].mate.is_absent() {
                self.lower(v, 1, &mut exposed);
            }
            k += 1;
        }
        for &v in &exposed {
            let node = self.top(v);
            if self.label(node) == Label::Free && self.nodes[node as usize].mate.is_absent() {
                self.plant(node);
            }
        }
        exposed.clear();
        self.scratch = exposed;
    }

    /// Lowers the radius of a vertex, taking blossoms around it apart as their duals are used up; it ends up exposed.
    fn lower(&mut self, vertex: u32, mut amount: i64, exposed: &mut Vec<u32>) {
        let mut node = self.top(vertex);
        self.unmatch(node, exposed);
        exposed.push(vertex);
        loop {
            if !self.is_blossom(node) {
                return self.lower_dual(node, amount);
            }
            let step = amount.min(self.dual(node));
            self.lower_dual(node, step);
            amount -= step;
            if amount == 0 {
                return;
            }
            node = self.expand_free(node, vertex);
        }
    }

    fn unmatch(&mut self, node: u32, exposed: &mut Vec<u32>) {
        let mate = std::mem::replace(&mut self.nodes[node as usize].mate, Link::ABSENT);
        if !mate.is_absent() {
            let other = self.top(mate.outer);
            self.nodes[other as usize].mate = Link::ABSENT;
            exposed.push(mate.outer);
        }
    }
}
