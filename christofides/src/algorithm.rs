//! Christofides' algorithm, and the whole way from a metric to an improved, bounded tour.

use crate::error::Error;
use crate::exact::{exact_path, exact_tour};
use crate::improve::{Effort, Pinned, chained_improve_path};
use crate::lower_bound::bound;
use crate::metric::Metric;
use crate::tour::{Ends, Path, Tour};
use crate::validate::{validate_finite, validate_promised};
use crate::workspace::Workspace;

/// Up to this number of vertices the ascent of the lower bound is not cut short: it takes a fraction of a second.
const PATIENT_UP_TO: usize = 1000;

/// How much work [`solve`] and [`solve_path`] put into a tour.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Options {
    /// Seed of the generator that chooses kicks. Default 1.
    pub seed: u64,
    /// Kicks of the chained local search. Default 1000.
    pub kicks: usize,
    /// Iterations of the lower bound's ascent; 0 for no bound. Default 400.
    pub ascent_iterations: usize,
    /// Up to this number of vertices the instance is solved to proof. Default 10.
    pub exact_up_to: usize,
}

impl Default for Options {
    fn default() -> Self {
        Options { seed: 1, kicks: 1000, ascent_iterations: 400, exact_up_to: 10 }
    }
}

impl Options {
    /// Sets the seed.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Sets the number of kicks.
    #[must_use]
    pub fn with_kicks(self, kicks: usize) -> Self {
        Self { kicks, ..self }
    }

    /// Sets the iterations of the ascent.
    #[must_use]
    pub fn with_ascent_iterations(self, ascent_iterations: usize) -> Self {
        Self { ascent_iterations, ..self }
    }

    /// Sets the largest number of vertices that is solved to proof.
    #[must_use]
    pub fn with_exact_up_to(self, exact_up_to: usize) -> Self {
        Self { exact_up_to, ..self }
    }
}

/// Christofides' algorithm (Christofides 1976): a tour of at most 3/2 times the least cost.
///
/// # Errors
/// Distances that are not finite, symmetric and non-negative; [`Error::TriangleInequality`] if the metric does not
/// promise the triangle inequality and breaks it.
///
/// # Complexity
/// `O(n log n)` typically for points, `O(n^2)` and the matching for other metrics. What does not promise the triangle
/// inequality costs [`validate`](crate::validate)'s `O(n^3)` on top; a [`Metric`] that keeps it should say so.
pub fn christofides(metric: &impl Metric) -> Result<Tour, Error> {
    validate_promised(metric)?;
    from_tree_and_matching(metric)
}

/// [`christofides`] in reused storage, where the tour stays until the next call.
///
/// # Errors
/// As [`christofides`].
///
/// # Examples
/// See [`Workspace`].
pub fn christofides_with<'a>(workspace: &'a mut Workspace, metric: &impl Metric) -> Result<&'a Tour, Error> {
    validate_promised(metric)?;
    workspace.run(metric)?;
    Ok(&workspace.tour)
}

/// The algorithm without a check of the distances.
pub(crate) fn from_tree_and_matching(metric: &impl Metric) -> Result<Tour, Error> {
    let mut workspace = Workspace::default();
    workspace.run(metric)?;
    Ok(workspace.tour)
}

/// A short tour with a lower bound: exact if small, else Christofides' tour improved within the budget of `options`.
///
/// Distances that break the triangle inequality are taken too if the metric says so; the tour then has no guarantee but
/// its own bound. `should_stop` is asked now and then and ends the improvement early; the check of the distances (`O(n^2)`
/// without coordinates), Christofides' tour and, up to 1000 vertices, the bound are not interrupted.
///
/// # Errors
/// Distances that are not finite, symmetric and non-negative.
pub fn solve(
    metric: &impl Metric,
    options: &Options,
    should_stop: &mut dyn FnMut() -> bool,
) -> Result<Tour, Error> {
    let mut workspace = Workspace::default();
    solve_with(&mut workspace, metric, options, should_stop)?;
    Ok(workspace.tour)
}

/// [`solve`] in reused storage, where the tour stays until the next call.
///
/// # Errors
/// As [`solve`].
pub fn solve_with<'a>(
    workspace: &'a mut Workspace,
    metric: &impl Metric,
    options: &Options,
    should_stop: &mut dyn FnMut() -> bool,
) -> Result<&'a Tour, Error> {
    validate_finite(metric)?;
    let n = metric.len();
    if n <= options.exact_up_to {
        workspace.tour = exact_tour(metric)?;
        return Ok(&workspace.tour);
    }
    workspace.run(metric)?;
    workspace.improve(metric, Effort { kicks: options.kicks, seed: options.seed, should_stop });
    if options.ascent_iterations > 0 {
        let stop = &mut || n > PATIENT_UP_TO && should_stop();
        let bound = bound(metric, options.ascent_iterations, stop).value;
        workspace.tour = std::mem::take(&mut workspace.tour).with_lower_bound(bound.max(0.0));
    }
    Ok(&workspace.tour)
}

/// A short path with the given ends: exact if small, else improved within the budget of `options`.
///
/// # Errors
/// As [`solve`]; [`Error::VertexOutOfRange`] and [`Error::EqualEnds`].
pub fn solve_path(
    metric: &impl Metric,
    ends: Ends,
    options: &Options,
    should_stop: &mut dyn FnMut() -> bool,
) -> Result<Path, Error> {
    ends.validate(metric.len())?;
    validate_finite(metric)?;
    let n = metric.len();
    if n <= options.exact_up_to {
        return exact_path(metric, ends);
    }
    let path = start_path(metric, ends)?;
    let path = chained_improve_path(metric, path, ends, options.kicks, options.seed, should_stop)?;
    if options.ascent_iterations == 0 {
        return Ok(path);
    }
    let pinned = Pinned::new(metric, ends, path.cost());
    let mut stop = || n > PATIENT_UP_TO && should_stop();
    let bound = bound(&pinned, options.ascent_iterations, &mut stop).value - pinned.offset();
    Ok(path.with_lower_bound(bound.max(0.0)))
}

/// Christofides' tour, opened at the start (or at its longest edge if that is free), with a named end moved to the end.
pub(crate) fn start_path(metric: &impl Metric, ends: Ends) -> Result<Path, Error> {
    let mut order = from_tree_and_matching(metric)?.into_order();
    let n = order.len();
    let first = match ends {
        Ends::Start(start) | Ends::Both(start, _) => order.iter().position(|&v| v == start).unwrap_or(0),
        Ends::Free => {
            let length = |k: usize| metric.distance(order[(k + n - 1) % n], order[k]);
            (1..n).fold(0, |longest, k| if length(k) > length(longest) { k } else { longest })
        }
    };
    order.rotate_left(first.min(n));
    if let Ends::Both(_, end) = ends {
        order.retain(|&v| v != end);
        order.push(end);
    }
    Ok(Path::measured(metric, order))
}
