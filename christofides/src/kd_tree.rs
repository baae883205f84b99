//! A k-d tree with bounding boxes, for points of any small dimension.

/// Most points in a leaf.
const LEAF: usize = 8;

/// A box around consecutive points of the tree's order.
#[derive(Debug, Clone, Copy)]
pub(crate) struct KdNode<const D: usize> {
    pub low: [f64; D],
    pub high: [f64; D],
    pub begin: u32,
    pub end: u32,
    /// Index of the left child, the right one follows; 0 for leaves.
    pub left: u32,
}

impl<const D: usize> KdNode<D> {
    /// The squared distance from a point to the box.
    #[inline]
    pub fn squared_distance(&self, point: &[f64; D]) -> f64 {
        let mut sum = 0.0;
        for k in 0..D {
            let outside = (self.low[k] - point[k]).max(point[k] - self.high[k]).max(0.0);
            sum += outside * outside;
        }
        sum
    }

    pub fn range(&self) -> std::ops::Range<usize> {
        self.begin as usize..self.end as usize
    }
}

/// Points sorted into nested boxes; parents come before their children.
#[derive(Debug, Clone, Default)]
pub(crate) struct KdTree<const D: usize> {
    /// The points in the order of the tree.
    pub points: Vec<[f64; D]>,
    /// Index of each of them in the input.
    pub order: Vec<u32>,
    pub nodes: Vec<KdNode<D>>,
}

#[inline]
pub(crate) fn squared_distance<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    let mut sum = 0.0;
    for k in 0..D {
        sum += (a[k] - b[k]) * (a[k] - b[k]);
    }
    sum
}

impl<const D: usize> KdTree<D> {
    /// Sorts finite points; `O(n log n)`.
    pub fn new(points: &[[f64; D]]) -> Self {
        let mut entries: Vec<([f64; D], u32)> = points.iter().copied().zip(0..).collect();
        let mut tree = KdTree { points: Vec::new(), order: Vec::new(), nodes: Vec::new() };
        tree.push_node(&entries, 0);
        let mut next = 0;
        while next < tree.nodes.len() {
            let KdNode { low, high, begin, end, .. } = tree.nodes[next];
            let len = (end - begin) as usize;
            if len > LEAF {
                let mut axis = 0;
                for k in 1..D {
                    if high[k] - low[k] > high[axis] - low[axis] {
                        axis = k;
                    }
                }
                let (begin, middle) = (begin as usize, len / 2);
                let slice = &mut entries[begin..end as usize];
                slice.select_nth_unstable_by(middle, |a, b| {
                    a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1))
                });
                tree.nodes[next].left = tree.nodes.len() as u32;
                tree.push_node(&slice[..middle], begin);
                tree.push_node(&slice[middle..], begin + middle);
            }
            next += 1;
        }
        (tree.points, tree.order) = entries.into_iter().unzip();
        tree
    }

    fn push_node(&mut self, entries: &[([f64; D], u32)], begin: usize) {
        let (mut low, mut high) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
        for (point, _) in entries {
            for k in 0..D {
                low[k] = low[k].min(point[k]);
                high[k] = high[k].max(point[k]);
            }
        }
        let (begin, end) = (begin as u32, (begin + entries.len()) as u32);
        self.nodes.push(KdNode { low, high, begin, end, left: 0 });
    }

    /// The `k` nearest points of the one at `position`, nearest first, by position; equal distances by position.
    pub fn nearest(
        &self,
        position: usize,
        k: usize,
        found: &mut Vec<(f64, u32)>,
        stack: &mut Vec<(f64, u32)>,
    ) {
        found.clear();
        stack.clear();
        stack.push((0.0, 0));
        let point = self.points[position];
        let mut worst = f64::INFINITY;
        while let Some((distance, index)) = stack.pop() {
            if distance >= worst {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.left != 0 {
                let [left, right] = [node.left, node.left + 1];
                let to_left = self.nodes[left as usize].squared_distance(&point);
                let to_right = self.nodes[right as usize].squared_distance(&point);
                if to_left <= to_right {
                    stack.extend([(to_right, right), (to_left, left)]);
                } else {
                    stack.extend([(to_left, left), (to_right, right)]);
                }
                continue;
            }
            for other in node.range() {
                let distance = squared_distance(&point, &self.points[other]);
                if distance < worst && other != position {
                    insert(found, k, (distance, other as u32));
                    if found.len() == k {
                        worst = found[k - 1].0;
                    }
                }
            }
        }
    }
}

/// Inserts into a sorted list of at most `k` entries.
fn insert(found: &mut Vec<(f64, u32)>, k: usize, entry: (f64, u32)) {
    if found.len() < k {
        found.push(entry);
    }
    let mut at = found.len() - 1;
    while at > 0 && found[at - 1].0 > entry.0 {
        found[at] = found[at - 1];
        at -= 1;
    }
    if let Some(slot) = found.get_mut(at) {
        *slot = entry;
    }
}
