//! Small instances solved to proof.

mod branch_and_bound;
pub(crate) mod subsets;

use crate::algorithm::{from_tree_and_matching, start_path};
use crate::error::Error;
use crate::improve::{Pinned, chained_improve, chained_improve_path};
use crate::metric::Metric;
use crate::tour::{Ends, Path, Tour};
use crate::validate::validate_finite;
use branch_and_bound::Found;

/// Up to this number of vertices the subsets are searched.
const SUBSETS_UP_TO: usize = 10;

/// Most vertices that are taken: the search for a proof takes exponential time in the worst case.
const LIMIT: usize = 100;

/// Nodes of the search tree, times the square of the number of vertices, after which the search gives up.
const MOST_WORK: usize = 50_000_000;

/// Kicks that find the tour to be proven.
const KICKS: usize = 200;

/// The shortest tour: dynamic programming over subsets (Bellman 1962; Held and Karp 1962) for a few vertices, then branch
/// and bound on 1-trees (Held and Karp 1971).
///
/// # Guarantee
/// No tour is shorter by more than a relative 1e-11; `lower_bound()` says so. A search that has grown too long gives up (distances
/// of very unequal magnitude can bring it to that): then `lower_bound()` is below the cost, and tells how far the proof has come.
///
/// # Errors
/// [`Error::TooManyVertices`] above 100 vertices, and distances that are not finite, symmetric and non-negative.
///
/// # Complexity
/// Exponential in the worst case; 40 points in the plane typically take some hundredths of a second.
///
/// # Examples
/// ```
/// use christofides::{Points, exact_tour};
///
/// let square = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
/// let tour = exact_tour(&Points(&square))?;
/// assert_eq!((tour.cost(), tour.gap()), (4.0, Some(0.0)));
/// # Ok::<(), christofides::Error>(())
/// ```
pub fn exact_tour(metric: &impl Metric) -> Result<Tour, Error> {
    validate_finite(metric)?;
    check_size(metric.len())?;
    let is_small = metric.len() <= SUBSETS_UP_TO;
    let Found { order, bound } = if is_small { proven(subsets::tour(metric)) } else { search_tour(metric)? };
    let tour = Tour::measured(metric, order);
    let bound = bound.min(tour.cost());
    Ok(tour.with_lower_bound(bound))
}

/// The shortest path with the given ends; see [`exact_tour`].
///
/// # Errors
/// As [`exact_tour`]; [`Error::VertexOutOfRange`] and [`Error::EqualEnds`].
pub fn exact_path(metric: &impl Metric, ends: Ends) -> Result<Path, Error> {
    let n = metric.len();
    validate_finite(metric)?;
    ends.validate(n)?;
    check_size(n)?;
    let is_small = n <= SUBSETS_UP_TO;
    let Found { order, bound } =
        if is_small { proven(subsets::path(metric, ends)) } else { search_path(metric, ends)? };
    let path = Path::measured(metric, order);
    let bound = bound.min(path.cost());
    Ok(path.with_lower_bound(bound))
}

/// An order that needs no further proof.
fn proven(order: Vec<usize>) -> Found {
    Found { order, bound: f64::INFINITY }
}

fn search_tour(metric: &impl Metric) -> Result<Found, Error> {
    let start = chained_improve(metric, from_tree_and_matching(metric)?, KICKS, 1, &mut || false)?;
    Ok(branch_and_bound::search(metric, start.into_order(), &[], MOST_WORK))
}

/// The edges between the joint and the fixed ends are required, so that they need no bond.
fn search_path(metric: &impl Metric, ends: Ends) -> Result<Found, Error> {
    let n = metric.len();
    let start = chained_improve_path(metric, start_path(metric, ends)?, ends, KICKS, 1, &mut || false)?;
    let pinned = Pinned::new(metric, ends, 0.0);
    let required = match ends {
        Ends::Free => Vec::new(),
        Ends::Start(start) => vec![(start, n)],
        Ends::Both(start, end) => vec![(start, n), (end, n)],
    };
    let found = branch_and_bound::search(&pinned, pinned.close(start.into_order()), &required, MOST_WORK);
    Ok(Found { order: pinned.open(found.order), ..found })
}

fn check_size(n: usize) -> Result<(), Error> {
    if n > LIMIT { Err(Error::TooManyVertices { n, limit: LIMIT }) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::points::Points;
    use proptest::prelude::*;

    fn points() -> impl Strategy<Value = Vec<[f64; 2]>> {
        let real = prop::collection::vec([-1e3..1e3, -1e3..1e3], 8..12);
        let grid = prop::collection::vec([0..4i32, 0..4i32].prop_map(|p| p.map(f64::from)), 8..12);
        prop_oneof![real, grid]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(100))]

        #[test]
        fn branch_and_bound_agrees_with_subsets(points in points()) {
            let metric = Points(&points);
            let identity = || (0..points.len()).collect();
            let best = Tour::measured(&metric, subsets::tour(&metric)).cost();
            // From a bad start, so that the proof has something to find.
            let found = Tour::measured(&metric, branch_and_bound::search(&metric, identity(), &[], MOST_WORK).order).cost();
            prop_assert!((found - best).abs() <= 1e-9 * best);
            for ends in [Ends::Free, Ends::Start(2), Ends::Both(4, 1)] {
                let best = Path::measured(&metric, subsets::path(&metric, ends)).cost();
                let found = Path::measured(&metric, search_path(&metric, ends).unwrap().order);
                prop_assert!((found.cost() - best).abs() <= 1e-9 * best);
                prop_assert!(super::super::improve::check_ends(found.order(), ends).is_ok());
            }
        }

        #[test]
        fn a_search_that_gives_up_still_bounds(points in points(), nodes in 0..6_usize) {
            let metric = Points(&points);
            let n = points.len();
            let best = Tour::measured(&metric, subsets::tour(&metric)).cost();
            let found = branch_and_bound::search(&metric, (0..n).collect(), &[], nodes * n * n);
            let cost = Tour::measured(&metric, found.order).cost();
            prop_assert!(found.bound >= 0.0 && (found.bound.is_infinite() || found.bound <= best * (1.0 + 1e-9)));
            prop_assert!(cost >= best * (1.0 - 1e-9));
            // Without an end to the search nothing is proven; with it, the tour is a shortest one.
            prop_assert!(nodes > 0 || found.bound == 0.0);
            prop_assert!(found.bound.is_finite() || cost <= best * (1.0 + 1e-9));
        }
    }
}
