//! Cuts: of all routes that visit two or more of three targets, a solution has at most one.
//!
//! In fractions there may be one and a half: three routes through two of the targets each, taken half. The subset-row inequalities of Jepsen, Petersen,
//! Spoorendonk and Pisinger (2008, doi:10.1287/opre.1070.0449) for triples forbid it; a route counts once for every two visits. They hold for solutions
//! that visit each target once, and by the triangle inequality there are no shorter ones.

/// Three targets, ascending.
pub(super) type Triple = [usize; 3];

/// Cuts at most: parities are a bit set.
pub(super) const CUTS: usize = 192;

/// Excess over one that makes a cut worth adding, how many are added at a time, and how many of these may share a target.
const VIOLATION: f64 = 0.03;
const AT_ONCE: usize = 25;
const SHARED: usize = 6;

/// Shares of routes below this are rounding.
const SHARE: f64 = 1e-6;

/// How often a route counts in a cut.
pub(super) fn count(triple: &Triple, route: &[usize]) -> usize {
    route.iter().filter(|target| triple.contains(target)).count() / 2
}

/// Triples whose cuts are violated most by routes taken in shares.
pub(super) fn violated(nodes: usize, routes: &[&[usize]], shares: &[f64]) -> Vec<Triple> {
    let mut taken = vec![0.0; nodes * nodes * nodes];
    for (route, &share) in routes.iter().zip(shares).filter(|(_, share)| **share > SHARE) {
        let mut visited = vec![false; nodes];
        route.iter().for_each(|&i| visited[i] = true);
        let members: Vec<usize> = (1..nodes).filter(|&i| visited[i]).collect();
        for (position, &i) in members.iter().enumerate() {
            for &j in &members[position + 1..] {
                // A third member is counted from the pair of the two least.
                for k in (1..nodes).filter(|&k| !visited[k] || k > j) {
                    let mut triple = [i, j, k];
                    triple.sort_unstable();
                    taken[(triple[0] * nodes + triple[1]) * nodes + triple[2]] += share;
                }
            }
        }
    }
    let mut found: Vec<usize> = (0..taken.len()).filter(|&t| taken[t] > 1.0 + VIOLATION).collect();
    found.sort_by(|&a, &b| taken[b].total_cmp(&taken[a]).then(a.cmp(&b)));
    let mut uses = vec![0; nodes];
    let mut triples = vec![];
    for triple in found.into_iter().map(|t| [t / (nodes * nodes), t / nodes % nodes, t % nodes]) {
        if triples.len() < AT_ONCE && triple.iter().all(|&i| uses[i] < SHARED) {
            triple.iter().for_each(|&i| uses[i] += 1);
            triples.push(triple);
        }
    }
    triples
}

/// For each cut whether a walk has visited its targets an odd number of times.
#[derive(Clone, Copy, Default)]
pub(super) struct Parities([u64; CUTS / 64]);

impl Parities {
    /// Visits a target of a cut; whether this makes a pair.
    #[inline]
    pub fn flip(&mut self, cut: usize) -> bool {
        let (word, bit) = (&mut self.0[cut / 64], 1 << (cut % 64));
        *word ^= bit;
        *word & bit == 0
    }

    /// The sum of charges of the cuts that are odd in both.
    #[inline]
    pub fn charge_of_both(&self, other: &Self, charges: &[f64]) -> f64 {
        Self::charge(charges, |word| self.0[word] & other.0[word])
    }

    /// The sum of charges of the cuts that are odd here and even there.
    #[inline]
    pub fn charge_beyond(&self, other: &Self, charges: &[f64]) -> f64 {
        Self::charge(charges, |word| self.0[word] & !other.0[word])
    }

    #[inline]
    fn charge(charges: &[f64], words: impl Fn(usize) -> u64) -> f64 {
        let mut sum = 0.0;
        for word in 0..charges.len().div_ceil(64) {
            let mut bits = words(word);
            while bits != 0 {
                sum += charges[64 * word + bits.trailing_zeros() as usize];
                bits &= bits - 1;
            }
        }
        sum
    }
}
