//! A k-d tree over the points, with the moments of each node, built once for all runs.

/// Points a leaf: few enough that a leaf seldom straddles clusters, enough that visiting a node costs less than its
/// points (16 and 64 measured slower at n = 100 000, k = 8..256).
const LEAF: usize = 32;

/// Below this number of points one leaf, that is plain Lloyd, is fastest.
const WORTH_A_TREE: usize = 256;

/// A node covers `start..end` of the permuted points; children of an inner node are `node + 1` and `right`.
pub(crate) struct Node<const D: usize> {
    pub low: [f64; D],
    pub high: [f64; D],
    pub start: usize,
    pub end: usize,
    /// Index of the right child, 0 for a leaf.
    pub right: usize,
    /// Index of the first node after this subtree.
    pub skip: usize,
    /// Sum of weight times point.
    pub sum: [f64; D],
    pub weight: f64,
}

pub(crate) struct Tree<const D: usize> {
    /// The points in the order of the leaves.
    pub points: Vec<[f64; D]>,
    /// Their weights, empty when all are one.
    pub weights: Vec<f64>,
    /// Original index of each permuted point.
    order: Vec<u32>,
    /// Nodes in preorder.
    pub nodes: Vec<Node<D>>,
    /// Mean over the axes of the weighted variance of the coordinates.
    pub mean_variance: f64,
}

impl<const D: usize> Tree<D> {
    /// Builds the tree in O(n log n) by splitting the longest side of the bounding box at the median.
    pub fn new(points: &[[f64; D]], weights: Option<&[f64]>) -> Self {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let leaf = if points.len() < WORTH_A_TREE { WORTH_A_TREE } else { LEAF };
        let mut nodes = Vec::with_capacity(4 * points.len() / leaf + 1);
        build(points, &mut order, 0, leaf, &mut nodes);
        let permuted: Vec<[f64; D]> = order.iter().map(|&i| points[i as usize]).collect();
        let weights = weights.map_or(vec![], |w| order.iter().map(|&i| w[i as usize]).collect());
        let mut tree = Tree { points: permuted, weights, order, nodes, mean_variance: 0.0 };
        tree.add_moments();
        tree.mean_variance = tree.variance();
        tree
    }

    /// Weight of a permuted point.
    #[inline(always)]
    pub fn weight(&self, i: usize) -> f64 {
        if self.weights.is_empty() { 1.0 } else { self.weights[i] }
    }

    /// The leaves, left to right.
    pub fn leaves(&self) -> impl Iterator<Item = &Node<D>> {
        self.nodes.iter().filter(|n| n.right == 0)
    }

    /// Values given in permuted order, in the order of the caller's points.
    pub fn in_original_order(&self, labels: &[u32]) -> Vec<usize> {
        let mut out = vec![0; labels.len()];
        for (&original, &label) in self.order.iter().zip(labels) {
            out[original as usize] = label as usize;
        }
        out
    }

    /// Children come after their parent in preorder, so a backward sweep sees them first.
    fn add_moments(&mut self) {
        for index in (0..self.nodes.len()).rev() {
            let (mut sum, mut weight) = ([0.0; D], 0.0);
            let node = &self.nodes[index];
            if node.right == 0 {
                for i in node.start..node.end {
                    let w = self.weight(i);
                    weight += w;
                    for axis in 0..D {
                        sum[axis] += w * self.points[i][axis];
                    }
                }
            } else {
                let (left, right) = (&self.nodes[index + 1], &self.nodes[node.right]);
                weight = left.weight + right.weight;
                for axis in 0..D {
                    sum[axis] = left.sum[axis] + right.sum[axis];
                }
            }
            self.nodes[index].sum = sum;
            self.nodes[index].weight = weight;
        }
    }

    fn variance(&self) -> f64 {
        let root = &self.nodes[0];
        let mean = root.sum.map(|x| x / root.weight);
        let scatter: f64 = (0..self.points.len())
            .map(|i| self.weight(i) * crate::geometry::squared_distance(&self.points[i], &mean))
            .sum();
        scatter / root.weight / D.max(1) as f64
    }
}

fn build<const D: usize>(
    points: &[[f64; D]],
    order: &mut [u32],
    start: usize,
    leaf: usize,
    nodes: &mut Vec<Node<D>>,
) {
    let (low, high) = bounding_box(points, order);
    let index = nodes.len();
    nodes.push(Node {
        low,
        high,
        start,
        end: start + order.len(),
        right: 0,
        skip: index + 1,
        sum: [0.0; D],
        weight: 0.0,
    });
    let side = |axis: usize| high[axis] - low[axis];
    let longest = (0..D).fold(0, |best, axis| if side(axis) > side(best) { axis } else { best });
    if order.len() <= leaf || low == high {
        return;
    }
    let middle = order.len() / 2;
    order.select_nth_unstable_by(middle, |&a, &b| {
        points[a as usize][longest].total_cmp(&points[b as usize][longest]).then(a.cmp(&b))
    });
    let (left, right) = order.split_at_mut(middle);
    build(points, left, start, leaf, nodes);
    nodes[index].right = nodes.len();
    build(points, right, start + middle, leaf, nodes);
    nodes[index].skip = nodes.len();
}

fn bounding_box<const D: usize>(points: &[[f64; D]], order: &[u32]) -> ([f64; D], [f64; D]) {
    let mut low = [f64::INFINITY; D];
    let mut high = [f64::NEG_INFINITY; D];
    for &i in order {
        for axis in 0..D {
            low[axis] = low[axis].min(points[i as usize][axis]);
            high[axis] = high[axis].max(points[i as usize][axis]);
        }
    }
    (low, high)
}

impl<const D: usize> Tree<D> {
    /// Calls `visit(i, distance)` with the caller's index of every point within `radius` of `centre`, in leaf order.
    pub fn within(&self, centre: &[f64; D], radius: f64, visit: &mut impl FnMut(usize, f64)) {
        let mut index = 0;
        while index < self.nodes.len() {
            let node = &self.nodes[index];
            if (0..D)
                .any(|axis| node.low[axis] - centre[axis] > radius || centre[axis] - node.high[axis] > radius)
            {
                index = node.skip;
                continue;
            }
            if node.right == 0 {
                for i in node.start..node.end {
                    let distance = crate::geometry::distance(&self.points[i], centre);
                    if distance <= radius {
                        visit(self.order[i] as usize, distance);
                    }
                }
            }
            index += 1;
        }
    }
}
