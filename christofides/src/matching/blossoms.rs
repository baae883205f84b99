//! The dual solution of a matching.

use super::forest::{Forest, NONE, Node};
use super::quantise::Scale;

/// An odd set of vertices with its dual variable.
///
/// The set consists of `vertices` and of the sets of all blossoms whose `parent` this one is, so that all blossoms together
/// take linear memory however deep they are nested.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Blossom {
    /// The dual variable, not negative.
    pub dual: f64,
    /// Index of the smallest blossom around this one; always larger than its own index.
    pub parent: Option<usize>,
    /// The vertices for which this is the smallest blossom.
    pub vertices: Vec<usize>,
}

impl Forest {
    /// The blossoms that stand, inner ones before those around them.
    pub(crate) fn export(&self, scale: Scale) -> Vec<Blossom> {
        let n = self.n_vertices();
        let alive = |&node: &u32| self.nodes[node as usize].size > 0;
        let mut nodes: Vec<u32> = (n as u32..self.nodes.len() as u32).filter(alive).collect();
        nodes.sort_unstable_by_key(|&node| (self.nodes[node as usize].size, node));
        let mut index = vec![NONE; self.nodes.len()];
        for (k, &node) in nodes.iter().enumerate() {
            index[node as usize] = k as u32;
        }
        let blossom = |&node: &u32| {
            let Node { dual, parent, .. } = &self.nodes[node as usize];
            let children = self.children(node);
            Blossom {
                dual: scale.real(*dual),
                parent: (*parent != NONE).then(|| index[*parent as usize] as usize),
                vertices: children.filter(|&child| !self.is_blossom(child)).map(|v| v as usize).collect(),
            }
        };
        nodes.iter().map(blossom).collect()
    }
}
