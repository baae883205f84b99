//! A blossom whose dual has reached zero is replaced by its children.

use super::forest::{Forest, Group, Label, Link, NONE};

impl Forest {
    /// The children of a blossom, each with the edge to the next, in storage that is to be given back.
    fn take_cycle(&mut self, blossom: u32) -> Vec<(u32, Link)> {
        let mut cycle = std::mem::take(&mut self.cycle);
        cycle.clear();
        cycle.extend(self.children(blossom).map(|child| (child, self.nodes[child as usize].onward)));
        cycle
    }

    /// Makes the children top-level nodes, all free, in the groups they had; returns the cycle.
    fn open(&mut self, blossom: u32) -> Vec<(u32, Link)> {
        let cycle = self.take_cycle(blossom);
        let shared = self.nodes[blossom as usize].group;
        self.relabel(blossom, Label::Free);
        for &(child, _) in &cycle {
            self.nodes[child as usize].parent = NONE;
            self.nodes[child as usize].since = self.now;
            self.nodes[child as usize].tree = NONE;
            let group = self.nodes[child as usize].group;
            if group == shared {
                self.groups[group as usize].node = child;
            } else {
                // The radii of the vertices are still read through the shared group.
                self.groups[group as usize] = Group { offset: 0, node: child, label: Label::Free };
                self.regroup(child, group);
            }
        }
        self.nodes[blossom as usize].size = 0;
        cycle
    }

    fn pair(&mut self, from: u32, to: u32, edge: Link) {
        self.nodes[from as usize].mate = edge;
        self.nodes[to as usize].mate = edge.reversed();
    }

    /// Expands a minus blossom; the path from its tree parent to its mate stays in the tree, the other children are freed.
    pub fn expand_in_tree(&mut self, blossom: u32) {
        let record = &self.nodes[blossom as usize];
        let (tree, mate, up) = (record.tree, record.mate, record.up);
        let base = self.child_around(blossom, mate.inner);
        let entry = self.child_around(blossom, up.inner);
        // The list of the tree still holds the blossom: it is recycled when the tree dissolves.
        let cycle = self.open(blossom);
        let position = |node: u32| cycle.iter().position(|&(child, _)| child == node).unwrap_or(0);
        let (from, to, len) = (position(entry), position(base), cycle.len());
        let forward = (to + len - from) % len;
        let is_forward = forward % 2 == 0;
        let steps = if is_forward { forward } else { len - forward };
        let step = |at: usize| if is_forward { (at + 1) % len } else { (at + len - 1) % len };
        // The edge from position `at` to the next one in the chosen direction.
        let edge =
            |at: usize| if is_forward { cycle[at].1 } else { cycle[(at + len - 1) % len].1.reversed() };
        let mut at = from;
        let mut incoming = up;
        for k in 0..=steps {
            let node = cycle[at].0;
            if k % 2 == 0 {
                self.nodes[node as usize].up = incoming;
                self.relabel(node, Label::Minus);
                if k < steps {
                    self.pair(node, cycle[step(at)].0, edge(at));
                } else {
                    self.nodes[node as usize].mate = mate;
                }
            } else {
                self.relabel(node, Label::Plus);
            }
            self.enlist(node, tree);
            incoming = edge(at).reversed();
            at = step(at);
        }
        for _ in 0..(len - 1 - steps) / 2 {
            self.pair(cycle[at].0, cycle[step(at)].0, edge(at));
            at = step(step(at));
        }
        for &(child, _) in &cycle {
            match self.label(child) {
                Label::Minus => self.schedule_expansion(child),
                Label::Free => self.announce(child),
                Label::Plus => self.schedule_all(child),
            }
        }
        self.cycle = cycle;
    }

    /// Expands a blossom outside any tree; the children are matched in pairs except the one around `base`, which takes
    /// over the blossom's mate and is returned.
    pub fn expand_free(&mut self, blossom: u32, base: u32) -> u32 {
        let mate = self.nodes[blossom as usize].mate;
        let child = self.child_around(blossom, base);
        let cycle = self.open(blossom);
        self.pair_around(&cycle, child);
        self.nodes[child as usize].mate = mate;
        self.cycle = cycle;
        self.recycled.push(blossom);
        child
    }

    /// Matches the children of a cycle in pairs, all but `base`.
    fn pair_around(&mut self, cycle: &[(u32, Link)], base: u32) {
        let len = cycle.len();
        let start = cycle.iter().position(|&(child, _)| child == base).unwrap_or(0);
        for k in (1..len).step_by(2) {
            let at = (start + k) % len;
            self.pair(cycle[at].0, cycle[(at + 1) % len].0, cycle[at].1);
        }
    }

    /// Matches inside every blossom according to the matched edge at its top; afterwards vertices know their mates.
    ///
    /// Blossoms stay in place, so that their duals can be read.
    pub fn match_inside(&mut self) {
        let mut stack = std::mem::take(&mut self.scratch);
        for node in self.n_vertices() as u32..self.nodes.len() as u32 {
            let record = &self.nodes[node as usize];
            if record.size > 0 && record.parent == NONE {
                stack.push(node);
            }
        }
        while let Some(blossom) = stack.pop() {
            let mate = self.nodes[blossom as usize].mate;
            let base = self.child_around(blossom, mate.inner);
            let cycle = self.take_cycle(blossom);
            self.pair_around(&cycle, base);
            self.nodes[base as usize].mate = mate;
            stack.extend(cycle.iter().map(|&(child, _)| child).filter(|&child| self.is_blossom(child)));
            self.cycle = cycle;
        }
        self.scratch = stack;
    }
}
