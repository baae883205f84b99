//! The routes as linked lists with lengths, and a log with which a change is undone.

use super::arcs::Arcs;

/// No route: the target has been taken out.
pub(crate) const NOWHERE: u32 = u32::MAX;

/// Routes under change. Vertex `n + v` closes the list of vehicle `v` to a ring.
#[derive(Clone)]
pub(crate) struct State {
    /// Number of targets.
    pub n: usize,
    pub next: Vec<u32>,
    pub prev: Vec<u32>,
    /// The vehicle of each vertex.
    pub route: Vec<u32>,
    /// Length of each route.
    pub length: Vec<f64>,
    /// Number of targets of each route.
    pub count: Vec<u32>,
    log: Vec<Change>,
}

#[derive(Clone, Copy)]
struct Change {
    vertex: u32,
    /// The vertex before it, where it was taken out or put in.
    after: u32,
    /// The length of the route before the change.
    length: f64,
    inserted: bool,
}

impl State {
    /// Routes as lists of targets by position in `problem.targets()`.
    pub fn new(n: usize, routes: &[Vec<u32>], arcs: &impl Arcs) -> Self {
        let m = routes.len();
        let ends: Vec<u32> = (0..(n + m) as u32).collect();
        let mut route = vec![NOWHERE; n];
        route.extend(0..m as u32);
        let mut state = Self {
            n,
            next: ends.clone(),
            prev: ends,
            route,
            length: vec![0.0; m],
            count: vec![0; m],
            log: Vec::new(),
        };
        for (vehicle, list) in routes.iter().enumerate() {
            for &target in list {
                let last = state.prev[n + vehicle] as usize;
                state.insert(target as usize, last, arcs);
            }
        }
        state.commit();
        state.measure(arcs);
        state
    }

    /// Puts a target that is nowhere behind the vertex `after`.
    #[inline]
    pub fn insert(&mut self, target: usize, after: usize, arcs: &impl Arcs) {
        let before = self.next[after] as usize;
        let vehicle = self.route[after] as usize;
        self.log.push(Change {
            vertex: target as u32,
            after: after as u32,
            length: self.length[vehicle],
            inserted: true,
        });
        self.length[vehicle] += arcs.arc(after, target) + arcs.arc(target, before) - arcs.arc(after, before);
        self.link(target, after, before, vehicle);
    }

    /// Takes a target out of its route.
    #[inline]
    pub fn remove(&mut self, target: usize, arcs: &impl Arcs) {
        let (after, before) = (self.prev[target] as usize, self.next[target] as usize);
        let vehicle = self.route[target] as usize;
        self.log.push(Change {
            vertex: target as u32,
            after: after as u32,
            length: self.length[vehicle],
            inserted: false,
        });
        self.length[vehicle] += arcs.arc(after, before) - arcs.arc(after, target) - arcs.arc(target, before);
        self.unlink(target, after, before, vehicle);
    }

    #[inline]
    fn link(&mut self, target: usize, after: usize, before: usize, vehicle: usize) {
        self.next[after] = target as u32;
        self.prev[target] = after as u32;
        self.next[target] = before as u32;
        self.prev[before] = target as u32;
        self.route[target] = vehicle as u32;
        self.count[vehicle] += 1;
    }

    #[inline]
    fn unlink(&mut self, target: usize, after: usize, before: usize, vehicle: usize) {
        self.next[after] = before as u32;
        self.prev[before] = after as u32;
        self.route[target] = NOWHERE;
        self.count[vehicle] -= 1;
    }

    /// Undoes everything since the last commit; lengths come back to the bit.
    pub fn undo(&mut self) {
        while let Some(change) = self.log.pop() {
            let (target, after) = (change.vertex as usize, change.after as usize);
            let vehicle = self.route[after] as usize;
            if change.inserted {
                self.unlink(target, after, self.next[target] as usize, vehicle);
            } else {
                self.link(target, after, self.next[after] as usize, vehicle);
            }
            self.length[vehicle] = change.length;
        }
    }

    /// Accepts everything so far.
    pub fn commit(&mut self) {
        self.log.clear();
    }

    /// Recomputes all lengths, which removes the rounding collected in them.
    pub fn measure(&mut self, arcs: &impl Arcs) {
        for vehicle in 0..self.length.len() {
            let end = self.n + vehicle;
            let (mut here, mut length) = (end, 0.0);
            loop {
                let next = self.next[here] as usize;
                length += arcs.arc(here, next);
                here = next;
                if here == end {
                    break;
                }
            }
            self.length[vehicle] = length;
        }
    }

    pub fn makespan(&self) -> f64 {
        self.length.iter().copied().fold(0.0, f64::max)
    }

    pub fn total(&self) -> f64 {
        self.length.iter().sum()
    }

    /// The routes as lists.
    pub fn lists(&self) -> Vec<Vec<u32>> {
        (0..self.length.len())
            .map(|vehicle| {
                let end = (self.n + vehicle) as u32;
                let mut list = Vec::with_capacity(self.count[vehicle] as usize);
                let mut here = self.next[end as usize];
                while here != end {
                    list.push(here);
                    here = self.next[here as usize];
                }
                list
            })
            .collect()
    }
}
