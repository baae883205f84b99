//! The dual solution of a matching.

use super::forest::{Forest, NONE};
use super::quantise::Scale;

/// An odd set of vertices with its dual variable.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Blossom {
    /// The dual variable, not negative.
    pub dual: f64,
    /// Index of the smallest blossom around this one; always larger than its own index.
    pub parent: Option<usize>,
    /// The vertices, inner blossoms included.
    pub vertices: Vec<usize>,
}

impl Forest {
    /// The blossoms that stand, inner ones before those around them, and the innermost one around every vertex.
    pub(crate) fn export(&self, scale: Scale) -> (Vec<Blossom>, Vec<Option<usize>>) {
        let n = self.n_vertices();
        let alive = |&node: &u32| self.nodes[node as usize].size > 0;
        let mut nodes: Vec<u32> = (n as u32..self.nodes.len() as u32).filter(alive).collect();
        nodes.sort_by_key(|&node| (self.nodes[node as usize].size, node));
        let mut index = vec![None; self.nodes.len()];
        for (k, &node) in nodes.iter().enumerate() {
            index[node as usize] = Some(k);
        }
        let parent = |node: u32| match self.nodes[node as usize].parent {
            NONE => None,
            parent => index[parent as usize],
        };
        let blossom = |&node: &u32| Blossom {
            dual: scale.real(self.nodes[node as usize].dual),
            parent: parent(node),
            vertices: self.vertices(node).map(|v| v as usize).collect(),
        };
        (nodes.iter().map(blossom).collect(), (0..n as u32).map(parent).collect())
    }
}
