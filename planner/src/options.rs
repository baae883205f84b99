//! How planning is watched and stopped.

use std::sync::atomic::{AtomicUsize, Ordering};

/// What a caller may add to [`plan`](crate::plan()).
///
/// There is no clock: budgets are iterations, so that equal options give equal plans, and a caller with a clock stops by it.
#[derive(Clone, Copy, Default)]
#[non_exhaustive]
pub struct Options<'a> {
    /// Called from any thread whenever candidates have been settled. Default: nobody listens.
    pub progress: Option<&'a (dyn Fn(Progress) + Sync)>,
    /// Asked between solves and while routes are sought; once it returns true, planning ends with [`Error::Stopped`](crate::Error::Stopped).
    /// Default: never stop.
    pub should_stop: Option<&'a (dyn Fn() -> bool + Sync)>,
    /// Whether every candidate entry is solved, even one that a bound proves worse: to compare, not to plan with. Default:
    /// false.
    pub exhaustive: bool,
    /// Iterations of the search for routes, each about a microsecond; `None` for 1000 for each circle. More of them give better routes
    /// and never worse ones; the paper's pipeline does not search.
    pub search_iterations: Option<u64>,
    /// The clustering of [`Pipeline::Paper`](crate::Pipeline::Paper), `None` for k-means: from the circles' centres (m: east, north) and
    /// the number of clusters (at most as many as circles, at most one for each vehicle) to a cluster for every circle.
    pub clustering: Option<Clustering<'a>>,
    /// Iterations after which the solve of one transition is given up and counts as failed; `None` for the solver's own limit. Most
    /// transitions take 15 to 60.
    pub solver_iterations: Option<usize>,
}

/// From points and a number of clusters to the cluster, from 0, of every point.
pub type Clustering<'a> = &'a (dyn Fn(&[[f64; 2]], usize) -> Vec<usize> + Sync);

/// How far planning has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Candidate entries solved or discarded so far.
    pub done: usize,
    /// Candidate entries of all legs.
    pub total: usize,
}

impl<'a> Options<'a> {
    /// Sets the function that hears of progress.
    #[must_use]
    pub fn with_progress(mut self, progress: &'a (dyn Fn(Progress) + Sync)) -> Self {
        self.progress = Some(progress);
        self
    }

    /// Sets whether every candidate entry is solved.
    #[must_use]
    pub fn with_exhaustive(mut self, exhaustive: bool) -> Self {
        self.exhaustive = exhaustive;
        self
    }

    /// Sets the budget of the search for routes.
    #[must_use]
    pub fn with_search_iterations(mut self, iterations: u64) -> Self {
        self.search_iterations = Some(iterations);
        self
    }

    /// Sets the clustering of the paper's pipeline.
    #[must_use]
    pub fn with_clustering(mut self, clustering: Clustering<'a>) -> Self {
        self.clustering = Some(clustering);
        self
    }

    /// Sets the budget of the solve of one transition.
    #[must_use]
    pub fn with_solver_iterations(mut self, iterations: usize) -> Self {
        self.solver_iterations = Some(iterations);
        self
    }

    /// Sets the function that may stop the planning.
    #[must_use]
    pub fn with_should_stop(mut self, should_stop: &'a (dyn Fn() -> bool + Sync)) -> Self {
        self.should_stop = Some(should_stop);
        self
    }
}

/// The options while planning, with the count so far.
pub(crate) struct Watch<'a> {
    options: Options<'a>,
    done: AtomicUsize,
    total: usize,
}

impl<'a> Watch<'a> {
    pub(crate) fn new(options: Options<'a>, total: usize) -> Self {
        Self { options, done: AtomicUsize::new(0), total }
    }

    pub(crate) fn advance(&self, candidates: usize) {
        let done = self.done.fetch_add(candidates, Ordering::Relaxed) + candidates;
        if let Some(progress) = self.options.progress {
            progress(Progress { done, total: self.total });
        }
    }

    pub(crate) fn exhaustive(&self) -> bool {
        self.options.exhaustive
    }

    pub(crate) fn should_stop(&self) -> bool {
        self.options.should_stop.is_some_and(|should_stop| should_stop())
    }
}
