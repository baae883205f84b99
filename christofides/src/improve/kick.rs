//! Kicks: double bridges between edges that are near each other.

use super::lin_kernighan::Search;
use crate::metric::Metric;
use rand::Rng;
use rand::rngs::Xoshiro256PlusPlus;

/// Walks to find four different vertices.
const WALKS: usize = 20;

/// Most vertices that a kick along a walk moves; more would cost more than the repair.
const REACH: usize = 1000;

/// Longest of the three pieces that a kick along the tour permutes, in vertices.
const PIECE: usize = 50;

/// A number below `bound`, by a multiplication of high words; the bias of `bound / 2^64` does not matter here.
pub(crate) fn below(rng: &mut Xoshiro256PlusPlus, bound: usize) -> usize {
    ((u128::from(rng.next_u64()) * bound as u128) >> 64) as usize
}

/// The four vertices after which the tour is cut, in its order.
type Cuts = [u32; 4];

/// Kicks near `origin`; returns the gain, usually negative, with the ends of the changed edges in `touched`.
///
/// The edges start where random walks of `steps` steps over the neighbours end (Applegate, Cook, Rohe 2003); if these are too
/// far apart on the tour, at random in a short piece of it.
pub(crate) fn kick<M: Metric>(
    search: &mut Search<'_, M>,
    rng: &mut Xoshiro256PlusPlus,
    origin: u32,
    steps: usize,
) -> f64 {
    let cuts =
        cuts_by_walks(search, rng, origin, steps).unwrap_or_else(|| cuts_in_piece(search, rng, origin));
    double_bridge(search, cuts)
}

fn cuts_by_walks<M: Metric>(
    search: &Search<'_, M>,
    rng: &mut Xoshiro256PlusPlus,
    origin: u32,
    steps: usize,
) -> Option<Cuts> {
    let mut cuts = [origin; 4];
    let mut found = 1;
    for _ in 0..WALKS {
        let mut v = origin;
        for _ in 0..steps {
            let near = search.neighbours.of(v);
            // The joint of a path has no neighbours.
            v = near.get(below(rng, near.len())).map_or(v, |&(_, next)| next);
        }
        if !cuts[..found].contains(&v) {
            cuts[found] = v;
            found += 1;
        }
        if found == cuts.len() {
            return in_short_piece(search, cuts);
        }
    }
    None
}

/// Sorts the cuts along the tour, the longest of the four pieces between them last, if the others are short.
fn in_short_piece<M: Metric>(search: &Search<'_, M>, mut cuts: Cuts) -> Option<Cuts> {
    let n = search.tour.len();
    cuts.sort_unstable_by_key(|&v| search.tour.offset(v));
    let offsets = cuts.map(|v| search.tour.offset(v));
    let mut longest = (0, 0);
    for k in 0..4 {
        let len = if k == 3 { offsets[0] + n - offsets[3] } else { offsets[k + 1] - offsets[k] };
        longest = longest.max((len, k));
    }
    cuts.rotate_left((longest.1 + 1) % 4);
    (n - longest.0 <= REACH).then_some(cuts)
}

fn cuts_in_piece<M: Metric>(search: &Search<'_, M>, rng: &mut Xoshiro256PlusPlus, origin: u32) -> Cuts {
    let piece = PIECE.min((search.tour.len() - 2) / 3);
    let mut cuts = [origin; 4];
    for k in 1..4 {
        cuts[k] = search.tour.ahead(cuts[k - 1], 1 + below(rng, piece));
    }
    cuts
}

/// Puts the three pieces between the cuts into the opposite order, each in its direction.
fn double_bridge<M: Metric>(search: &mut Search<'_, M>, cuts: Cuts) -> f64 {
    let after = cuts.map(|v| search.tour.next(v));
    let [b, c, d] = [0, 1, 2].map(|k| (after[k], cuts[k + 1]));
    let removed = [0, 1, 2, 3].map(|k| (cuts[k], after[k]));
    let added = [(cuts[0], d.0), (d.1, c.0), (c.1, b.0), (b.1, after[3])];
    search.reverse(b.0, d.1);
    search.reverse(d.1, d.0);
    search.reverse(c.1, c.0);
    search.reverse(b.1, b.0);
    search.touched.clear();
    search.touched.extend(removed.iter().flat_map(|&(u, v)| [u, v]));
    let sum = |edges: [(u32, u32); 4]| edges.iter().map(|&(u, v)| search.distance(u, v)).sum::<f64>();
    sum(removed) - sum(added)
}
