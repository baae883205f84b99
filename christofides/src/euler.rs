//! Euler circuits of multigraphs.

use crate::error::Error;

/// A closed walk from vertex 0 that uses every edge exactly once, as its vertices without the last one (Hierholzer 1873).
///
/// # Errors
/// [`Error::VertexOutOfRange`]; [`Error::OddVertexCount`] with the number of vertices of odd degree, if there are any;
/// [`Error::Disconnected`] if a vertex cannot be reached from vertex 0.
///
/// # Complexity
/// `O(n + m)` time and memory.
pub fn euler_circuit(n: usize, edges: &[[usize; 2]]) -> Result<Vec<usize>, Error> {
    if let Some(&vertex) = edges.iter().flatten().find(|&&vertex| vertex >= n) {
        return Err(Error::VertexOutOfRange { vertex, n });
    }
    let mut start = vec![0; n + 2];
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
    let mut incident = vec![0; 2 * edges.len()];
    for (k, &vertex) in edges.iter().flatten().enumerate() {
        incident[start[vertex + 1]] = k / 2;
        start[vertex + 1] += 1;
    }
    let circuit = walk(n, edges, &start, &incident);
    check_connected(n, &circuit)?;
    Ok(circuit)
}

/// Hierholzer's walk with an explicit stack: a vertex is put out when no unused edge is left at it.
fn walk(n: usize, edges: &[[usize; 2]], start: &[usize], incident: &[usize]) -> Vec<usize> {
    let mut next = start.to_vec();
    let mut used = vec![false; edges.len()];
    let mut circuit = Vec::with_capacity(edges.len() + 1);
    let mut stack = Vec::with_capacity(edges.len() + 1);
    stack.extend((n > 0).then_some(0));
    while let Some(&vertex) = stack.last() {
        while next[vertex] < start[vertex + 1] && used[incident[next[vertex]]] {
            next[vertex] += 1;
        }
        if next[vertex] == start[vertex + 1] {
            stack.pop();
            circuit.push(vertex);
        } else {
            let edge = incident[next[vertex]];
            used[edge] = true;
            let [u, v] = edges[edge];
            stack.push(if u == vertex { v } else { u });
        }
    }
    if circuit.len() > 1 {
        circuit.pop();
    }
    circuit
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
