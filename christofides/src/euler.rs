//! Euler circuits of multigraphs.

use crate::error::Error;
use crate::validate::check_count;

/// A closed walk from vertex 0 that uses every edge exactly once, as its vertices without the last one (Hierholzer 1873).
///
/// # Errors
/// [`Error::VertexOutOfRange`]; [`Error::OddVertexCount`] with the number of vertices of odd degree, if there are any;
/// [`Error::Disconnected`] if a vertex cannot be reached from vertex 0; [`Error::TooManyVertices`] above 2^30.
///
/// # Complexity
/// `O(n + m)` time and memory.
pub fn euler_circuit(n: usize, edges: &[[usize; 2]]) -> Result<Vec<usize>, Error> {
    check_count(n)?;
    let mut walk = Walk::default();
    walk.find(n, edges, 0)?;
    Ok(walk.circuit)
}

/// A closed walk and the storage of its search.
#[derive(Debug, Default)]
pub(crate) struct Walk {
    start: Vec<usize>,
    incident: Vec<usize>,
    next: Vec<usize>,
    is_used: Vec<bool>,
    stack: Vec<usize>,
    circuit: Vec<usize>,
}

impl Walk {
    /// See [`euler_circuit`]; edge `first` and those after it are taken first at every vertex.
    pub fn find(&mut self, n: usize, edges: &[[usize; 2]], first: usize) -> Result<(), Error> {
        if let Some(&vertex) = edges.iter().flatten().find(|&&vertex| vertex >= n) {
            return Err(Error::VertexOutOfRange { vertex, n });
        }
        self.list_incident(n, edges, first)?;
        self.walk(n, edges);
        if self.circuit.len() == edges.len() && (0..n).all(|v| self.start[v] < self.start[v + 1]) {
            return Ok(()); // every edge used, and one at every vertex
        }
        check_connected(n, &self.circuit)
    }

    /// The walk without its last vertex.
    pub fn circuit(&self) -> &[usize] {
        &self.circuit
    }

    fn list_incident(&mut self, n: usize, edges: &[[usize; 2]], first: usize) -> Result<(), Error> {
        let start = &mut self.start;
        start.clear();
        start.resize(n + 2, 0);
        for &vertex in edges.iter().flatten() {
            start[vertex + 2] += 1;
        }
        let n_odd = start.iter().filter(|&&degree| degree % 2 == 1).count();
        if n_odd > 0 {
            return Err(Error::OddVertexCount { n: n_odd });
        }
        for v in 2..n + 2 {
            start[v] += start[v - 1];
        }
        self.incident.resize(2 * edges.len(), 0);
        for edge in (first..edges.len()).chain(0..first) {
            for vertex in edges[edge] {
                self.incident[start[vertex + 1]] = edge;
                start[vertex + 1] += 1;
            }
        }
        Ok(())
    }

    /// Hierholzer's walk with an explicit stack: a vertex is put out when no unused edge is left at it.
    fn walk(&mut self, n: usize, edges: &[[usize; 2]]) {
        let Walk { start, incident, next, is_used, stack, circuit } = self;
        next.clone_from(start);
        is_used.clear();
        is_used.resize(edges.len(), false);
        circuit.clear();
        stack.clear();
        stack.extend((n > 0).then_some(0));
        while let Some(&vertex) = stack.last() {
            while next[vertex] < start[vertex + 1] && is_used[incident[next[vertex]]] {
                next[vertex] += 1;
            }
            if next[vertex] == start[vertex + 1] {
                stack.pop();
                circuit.push(vertex);
            } else {
                let edge = incident[next[vertex]];
                is_used[edge] = true;
                let [u, v] = edges[edge];
                stack.push(if u == vertex { v } else { u });
            }
        }
        if circuit.len() > 1 {
            circuit.pop();
        }
    }
}

fn check_connected(n: usize, circuit: &[usize]) -> Result<(), Error> {
    let mut components = vec![1; n];
    for &vertex in circuit {
        components[vertex] = 0;
    }
    match components.iter().position(|&component| component == 1) {
        Some(second) => Err(Error::Disconnected { n_components: 2, first: 0, second, components }),
        None => Ok(()),
    }
}
