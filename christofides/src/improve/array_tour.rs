//! A tour as an array of vertices with their positions.

/// A cyclic order that is changed by reversals, each of at most half of the vertices.
///
/// Instead of a path, its complement may be reversed; the direction in which the array is read is then turned.
#[derive(Debug, Clone, Default)]
pub(crate) struct ArrayTour {
    order: Vec<u32>,
    position: Vec<u32>,
    is_backward: bool,
}

impl ArrayTour {
    /// Takes over an order of all vertices.
    pub fn load(&mut self, order: impl Iterator<Item = u32>) {
        self.order.clear();
        self.order.extend(order);
        self.position.resize(self.order.len(), 0);
        for (k, &v) in self.order.iter().enumerate() {
            self.position[v as usize] = k as u32;
        }
        self.is_backward = false;
    }

    pub fn len(&self) -> usize {
        self.order.len()
    }

    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// The place of a vertex in reading direction.
    #[inline]
    pub fn offset(&self, v: u32) -> usize {
        let k = self.position[v as usize] as usize;
        if self.is_backward { self.order.len() - 1 - k } else { k }
    }

    #[inline]
    fn after(&self, v: u32) -> u32 {
        let k = self.position[v as usize] as usize + 1;
        self.order[if k == self.order.len() { 0 } else { k }]
    }

    #[inline]
    fn before(&self, v: u32) -> u32 {
        let k = self.position[v as usize] as usize;
        self.order[if k == 0 { self.order.len() } else { k } - 1]
    }

    #[inline]
    pub fn next(&self, v: u32) -> u32 {
        if self.is_backward { self.before(v) } else { self.after(v) }
    }

    #[inline]
    pub fn previous(&self, v: u32) -> u32 {
        if self.is_backward { self.after(v) } else { self.before(v) }
    }

    /// Reads the tour in the other direction.
    pub fn turn(&mut self) {
        self.is_backward = !self.is_backward;
    }

    /// Whether the way from `a` onwards meets `b` no later than `c`.
    #[inline]
    pub fn between(&self, a: u32, b: u32, c: u32) -> bool {
        let position = |v: u32| self.position[v as usize];
        let (mut from, middle, mut to) = (position(a), position(b), position(c));
        if self.is_backward {
            std::mem::swap(&mut from, &mut to);
        }
        if from <= to { from <= middle && middle <= to } else { middle >= from || middle <= to }
    }

    /// Reverses the path from `a` onwards to `b`; `reverse(b, a)` undoes it.
    pub fn reverse(&mut self, a: u32, b: u32) {
        let n = self.order.len();
        let (mut from, mut to) = (self.position[a as usize] as usize, self.position[b as usize] as usize);
        if self.is_backward {
            std::mem::swap(&mut from, &mut to);
        }
        let mut len = if to >= from { to - from + 1 } else { to + n - from + 1 };
        if 2 * len > n {
            (from, to) = (if to + 1 == n { 0 } else { to + 1 }, if from == 0 { n - 1 } else { from - 1 });
            len = n - len;
            self.turn();
        }
        for _ in 0..len / 2 {
            let (u, v) = (self.order[from], self.order[to]);
            self.order[from] = v;
            self.position[v as usize] = from as u32;
            self.order[to] = u;
            self.position[u as usize] = to as u32;
            from = if from + 1 == n { 0 } else { from + 1 };
            to = if to == 0 { n - 1 } else { to - 1 };
        }
    }

    /// The vertex `steps` after the one at the head of the array position `start`, in reading direction.
    pub fn ahead(&self, v: u32, steps: usize) -> u32 {
        let (n, k) = (self.order.len(), self.position[v as usize] as usize);
        self.order[if self.is_backward { (k + n - steps) % n } else { (k + steps) % n }]
    }
}
