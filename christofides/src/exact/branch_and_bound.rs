//! Branch and bound on 1-trees (Held and Karp 1971; branching of Volgenant and Jonker 1982).

use crate::metric::Metric;
use crate::spanning_tree::Prim;

/// Ascent steps at the root and at every other node of the search tree.
const STEPS: [usize; 2] = [400, 40];

/// What is decided about an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Status {
    Open,
    Required,
    Forbidden,
}

/// The best tour found, and a lower bound on all.
pub(crate) struct Found {
    pub order: Vec<usize>,
    /// Infinite if the tour is a shortest one; else the least bound of what was left to search.
    pub bound: f64,
}

/// Search for a tour shorter than `order`; returns a shortest one, which is `order` if none is shorter, or the best found after
/// `most_work`: nodes of the search tree times the square of the number of vertices.
///
/// A node is cut off when its bound reaches the cost of the best tour less the rounding that either sum may carry.
/// The `required` edges are in every tour considered, `order` included.
pub(crate) fn search(
    metric: &impl Metric,
    order: Vec<usize>,
    required: &[(usize, usize)],
    most_work: usize,
) -> Found {
    let n = order.len();
    let cost = crate::tour::tour_edges(&order).map(|(u, v)| metric.distance(u, v)).sum();
    if n < 4 {
        return Found { order, bound: f64::INFINITY };
    }
    let distances: Vec<f64> = (0..n * n).map(|k| metric.distance(k / n, k % n)).collect();
    let mut search = Search::new(n, distances, order, cost);
    let mut root = Node { status: vec![Status::Open; n * n], pi: vec![0.0; n], bound: 0.0 };
    for &(u, v) in required {
        root.status[u * n + v] = Status::Required;
        root.status[v * n + u] = Status::Required;
    }
    let mut stack = Vec::new();
    if propagate(n, &mut root.status) {
        stack.push(root);
    }
    let mut nodes = 0;
    while let Some(mut node) = stack.pop() {
        if node.bound >= search.limit() {
            continue;
        }
        if nodes * n * n >= most_work {
            let bound = stack.iter().map(|open| open.bound).fold(node.bound, f64::min);
            return Found { order: search.order, bound: bound.max(0.0) };
        }
        search.ascend(&mut node, STEPS[nodes.min(1)]);
        nodes += 1;
        if node.bound < search.limit() {
            search.branch(&node, &mut stack);
        }
    }
    Found { order: search.order, bound: f64::INFINITY }
}

struct Node {
    status: Vec<Status>,
    pi: Vec<f64>,
    bound: f64,
}

struct Search {
    n: usize,
    distances: Vec<f64>,
    order: Vec<usize>,
    cost: f64,
    /// Subtracted from the cost of required edges: more than any tour can gain.
    reward: f64,
    prim: Prim,
    /// Edges of the last 1-tree.
    tree: Vec<(usize, usize)>,
    /// Edges of the 1-tree with the greatest value at this node.
    best_tree: Vec<(usize, usize)>,
    degree: Vec<i32>,
}

impl Search {
    fn new(n: usize, distances: Vec<f64>, order: Vec<usize>, cost: f64) -> Self {
        let greatest = distances.iter().copied().fold(0.0, f64::max);
        let (tree, best_tree) = (Vec::with_capacity(n), Vec::with_capacity(n));
        // Not so large that the digits of the distances would be lost.
        let reward = 64.0 * (greatest + cost);
        Search {
            n,
            distances,
            order,
            cost,
            reward,
            prim: Prim::default(),
            tree,
            best_tree,
            degree: vec![0; n],
        }
    }

    /// Bounds from here on allow no shorter tour.
    fn limit(&self) -> f64 {
        self.cost * (1.0 - 1e-11)
    }

    /// The least 1-tree under the decisions; its value less the rewards, or infinity if it cannot be a tour.
    fn one_tree(&mut self, node: &Node) -> f64 {
        let Search { n, distances, reward, prim, tree, degree, .. } = self;
        let (n, last) = (*n, *n - 1);
        let cost = |u: usize, v: usize| {
            let length = distances[u * n + v] + node.pi[u] + node.pi[v];
            match node.status[u * n + v] {
                Status::Open => length,
                Status::Required => length - *reward,
                Status::Forbidden => f64::INFINITY,
            }
        };
        tree.clear();
        prim.run(last, cost, |from, to, _| tree.push((from, to)));
        let mut two = [(f64::INFINITY, 0); 2];
        for v in 0..last {
            let candidate = (cost(last, v), v);
            if candidate.0 < two[0].0 {
                two = [candidate, two[0]];
            } else if candidate.0 < two[1].0 {
                two[1] = candidate;
            }
        }
        tree.extend(two.map(|(_, v)| (last, v)));
        degree.fill(0);
        let mut total = 0.0;
        for &(u, v) in &*tree {
            degree[u] += 1;
            degree[v] += 1;
            let length = distances[u * n + v] + node.pi[u] + node.pi[v];
            total += if node.status[u * n + v] == Status::Forbidden { f64::INFINITY } else { length };
        }
        total - 2.0 * node.pi.iter().sum::<f64>()
    }

    fn ascend(&mut self, node: &mut Node, steps: usize) {
        let mut previous = vec![0; self.n];
        let mut best_pi = node.pi.clone();
        let mut value_here = f64::NEG_INFINITY;
        let mut step = if node.bound > 0.0 { 0.3 } else { 1.0 } * self.cost / (2.0 * self.n as f64);
        let factor = 0.003_f64.powf(1.0 / steps as f64);
        for _ in 0..steps {
            let value = self.one_tree(node);
            if value > value_here {
                value_here = value;
                best_pi.copy_from_slice(&node.pi);
                self.best_tree.clone_from(&self.tree);
            }
            if value >= self.limit() {
                break;
            }
            if self.degree.iter().all(|&degree| degree == 2) {
                self.accept();
                break;
            }
            for v in 0..self.n {
                let excess = self.degree[v] - 2;
                node.pi[v] += step * (0.7 * f64::from(excess) + 0.3 * f64::from(previous[v]));
                previous[v] = excess;
            }
            step *= factor;
        }
        node.bound = node.bound.max(value_here);
        node.pi = best_pi;
    }

    /// The last 1-tree is a tour, and the shortest under the decisions made.
    fn accept(&mut self) {
        let mut adjacent = vec![Vec::with_capacity(2); self.n];
        for &(u, v) in &self.tree {
            adjacent[u].push(v);
            adjacent[v].push(u);
        }
        let mut order = vec![0];
        let (mut before, mut at) = (0, adjacent[0][0]);
        while at != 0 {
            order.push(at);
            let next = if adjacent[at][0] == before { adjacent[at][1] } else { adjacent[at][0] };
            (before, at) = (at, next);
        }
        let cost = crate::tour::tour_edges(&order).map(|(u, v)| self.distances[u * self.n + v]).sum();
        if order.len() == self.n && cost < self.cost {
            (self.order, self.cost) = (order, cost);
        }
    }

    /// Splits at a vertex with too many edges: the first forbidden; it required and the second forbidden; both
    /// required and all others forbidden.
    fn branch(&self, node: &Node, stack: &mut Vec<Node>) {
        let n = self.n;
        let mut incident = vec![Vec::new(); n];
        for &(u, v) in &self.best_tree {
            incident[u].push(v);
            incident[v].push(u);
        }
        let is_open = |v: usize, w: usize| node.status[v * n + w] == Status::Open;
        let n_open = |v: usize| incident[v].iter().filter(|&&w| is_open(v, w)).count();
        let busy = (0..n).filter(|&v| incident[v].len() > 2 && n_open(v) > 0);
        let Some(vertex) = busy.max_by_key(|&v| (incident[v].len() - n_open(v), incident[v].len())) else {
            return;
        };
        let mut open: Vec<usize> = incident[vertex].iter().copied().filter(|&w| is_open(vertex, w)).collect();
        open.sort_by(|&a, &b| self.distances[vertex * n + a].total_cmp(&self.distances[vertex * n + b]));
        let n_required = (0..n).filter(|&w| node.status[vertex * n + w] == Status::Required).count();
        let first = open[0];
        let child = |decisions: &[(usize, Status)]| {
            let mut status = node.status.clone();
            for &(w, decision) in decisions {
                status[vertex * n + w] = decision;
                status[w * n + vertex] = decision;
            }
            let mut child = Node { status, pi: node.pi.clone(), bound: node.bound };
            propagate(n, &mut child.status).then_some(child)
        };
        stack.extend(child(&[(first, Status::Forbidden)]));
        if n_required == 1 {
            stack.extend(child(&[(first, Status::Required)]));
        } else if n_required == 0 {
            // With no required edge all of the three or more edges are open.
            let second = open[1];
            stack.extend(child(&[(first, Status::Required), (second, Status::Forbidden)]));
            stack.extend(child(&[(first, Status::Required), (second, Status::Required)]));
        }
    }
}

/// Forbids what two required edges at a vertex exclude, requires what is left where only two edges are not forbidden;
/// `false` if the decisions allow no tour.
fn propagate(n: usize, status: &mut [Status]) -> bool {
    let mut changed = true;
    while changed {
        changed = false;
        for v in 0..n {
            let count =
                |status: &[Status], kind| (0..n).filter(|&w| w != v && status[v * n + w] == kind).count();
            let (required, open) = (count(status, Status::Required), count(status, Status::Open));
            if required > 2 || required + open < 2 {
                return false;
            }
            let decision = if required == 2 {
                Status::Forbidden
            } else if required + open == 2 {
                Status::Required
            } else {
                continue;
            };
            for w in (0..n).filter(|&w| w != v) {
                if status[v * n + w] == Status::Open {
                    status[v * n + w] = decision;
                    status[w * n + v] = decision;
                    changed = true;
                }
            }
        }
    }
    true
}
