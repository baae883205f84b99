//! Sparse graphs with integer weights, stored by rows.

/// One direction of an edge.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Arc {
    /// Four times the scaled weight, so that half of a slack between two growing trees is an integer.
    pub weight: i64,
    /// The vertex at the other end.
    pub head: u32,
}

/// An undirected graph in compressed rows.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    start: Vec<u32>,
    arcs: Vec<Arc>,
}

impl Graph {
    /// Replaces the graph by one on `n` vertices with the given edges (each once; loops are not allowed).
    pub fn rebuild(&mut self, n: usize, edges: &[(u32, u32, i64)]) {
        self.start.clear();
        self.start.resize(n + 2, 0);
        for &(u, v, _) in edges {
            self.start[u as usize + 2] += 1;
            self.start[v as usize + 2] += 1;
        }
        for i in 2..n + 2 {
            self.start[i] += self.start[i - 1];
        }
        self.arcs.clear();
        self.arcs.resize(2 * edges.len(), Arc::default());
        for &(u, v, weight) in edges {
            for (tail, head) in [(u, v), (v, u)] {
                let slot = &mut self.start[tail as usize + 1];
                self.arcs[*slot as usize] = Arc { weight, head };
                *slot += 1;
            }
        }
    }

    /// The number of vertices.
    pub fn len(&self) -> usize {
        self.start.len().saturating_sub(2)
    }

    /// The edges at a vertex.
    #[inline]
    pub fn arcs(&self, vertex: u32) -> &[Arc] {
        let row = vertex as usize;
        &self.arcs[self.start[row] as usize..self.start[row + 1] as usize]
    }
}
