//! An odd cycle of tight edges becomes a blossom.

use super::forest::{Forest, Label, Link, NONE, Node};

impl Forest {
    /// Shrinks the cycle that a tight edge between two plus nodes of one tree closes.
    pub fn shrink(&mut self, near: u32, far: u32, edge: Link) {
        let root = self.common_ancestor(near, far);
        let cycle = self.collect_cycle(near, far, edge, root);
        let blossom = self.allocate();
        let (tree, mate) = (self.nodes[root as usize].tree, self.nodes[root as usize].mate);
        self.form(blossom, &cycle);
        self.nodes[blossom as usize].mate = mate;
        self.enlist(blossom, tree);
        // Even positions of the cycle were plus: their events stand. The others have none yet.
        for &(child, _) in &cycle {
            if self.nodes[child as usize].stamp == NONE {
                self.nodes[child as usize].stamp = 0;
                self.schedule_all(child);
            }
        }
        self.cycle = cycle;
    }

    /// The plus node two levels nearer to the root.
    fn grandparent(&self, plus: u32) -> Option<u32> {
        let mate = self.nodes[plus as usize].mate;
        if mate.is_absent() {
            return None;
        }
        Some(self.top(self.nodes[self.top(mate.outer) as usize].up.outer))
    }

    /// Climbs from both nodes in turn until one path meets the other.
    fn common_ancestor(&mut self, near: u32, far: u32) -> u32 {
        self.stamp += 1;
        let (mut this, mut other) = (Some(near), Some(far));
        loop {
            if let Some(node) = this {
                if self.nodes[node as usize].stamp == self.stamp {
                    return node;
                }
                self.nodes[node as usize].stamp = self.stamp;
                this = self.grandparent(node);
            }
            std::mem::swap(&mut this, &mut other);
        }
    }

    /// The cycle from the common ancestor down to `near`, over `edge` to `far`, and up again.
    fn collect_cycle(&mut self, near: u32, far: u32, edge: Link, root: u32) -> Vec<(u32, Link)> {
        let mut cycle = std::mem::take(&mut self.cycle);
        cycle.clear();
        let mut node = near;
        let mut onward = edge;
        while node != root {
            let mate = self.nodes[node as usize].mate;
            let minus = self.top(mate.outer);
            let up = self.nodes[minus as usize].up;
            cycle.push((node, onward));
            cycle.push((minus, mate.reversed()));
            onward = up.reversed();
            node = self.top(up.outer);
        }
        cycle.push((root, onward));
        cycle.reverse();
        node = far;
        while node != root {
            let mate = self.nodes[node as usize].mate;
            let minus = self.top(mate.outer);
            let up = self.nodes[minus as usize].up;
            cycle.push((node, mate));
            cycle.push((minus, up));
            node = self.top(up.outer);
        }
        cycle
    }

    fn allocate(&mut self) -> u32 {
        if let Some(node) = self.recycled.pop() {
            return node;
        }
        self.nodes.push(Node::new(NONE, 0));
        self.due.push(super::forest::NEVER);
        (self.nodes.len() - 1) as u32
    }

    /// Freezes the children and joins their vertices into one group, that of the largest child.
    ///
    /// Only the vertices of the smaller children are touched, so that a blossom that grows bit by bit costs `O(n log n)`.
    /// Children that were minus are marked by the stamp `NONE`.
    fn form(&mut self, blossom: u32, cycle: &[(u32, Link)]) {
        let mut largest = cycle[0].0;
        for &(child, _) in cycle {
            if self.nodes[child as usize].size > self.nodes[largest as usize].size {
                largest = child;
            }
            if self.label(child) == Label::Minus {
                self.nodes[child as usize].stamp = NONE;
                self.due[child as usize] = super::forest::NEVER;
            }
            // Freezes the dual; the label of the group is that of the new blossom from now on.
            self.relabel(child, Label::Plus);
        }
        let group = self.nodes[largest as usize].group;
        let mut size = 0;
        let mut last = NONE;
        for (k, &(child, onward)) in cycle.iter().enumerate() {
            if child != largest {
                self.regroup(child, group);
            }
            let next_child = cycle.get(k + 1).map_or(NONE, |&(next, _)| next);
            let record = &mut self.nodes[child as usize];
            (record.parent, record.next_child, record.onward) = (blossom, next_child, onward);
            size += record.size;
            if last != NONE {
                self.next_vertex[last as usize] = record.first;
            }
            last = record.last;
        }
        let first_child = cycle[0].0;
        let first = self.nodes[first_child as usize].first;
        self.groups[group as usize].node = blossom;
        self.nodes[blossom as usize] =
            Node { last, group, first_child, since: self.now, ..Node::new(first, size) };
    }
}
