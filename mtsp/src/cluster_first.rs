//! Cluster first, route second: the targets of a cluster belong to one vehicle.

use crate::error::{Error, List};
use crate::lower_bound;
use crate::problem::{End, Problem, expect_length};
use crate::solution::Solution;
use christofides::{Geometry, Metric, christofides};
use cluster::{KMeansOptions, kmeans};

/// Routes from a clustering: Christofides' tour of each cluster, entered at the target closest to the depot.
///
/// Gao, Mandal, Bhattacharya (2020), Algorithm 2, with any clustering in the place of k-means. The tour runs over the targets of a
/// cluster only. Its vehicle flies from the depot to the target closest to it, once around the tour without the closing
/// edge, and home if routes are closed. Of the two directions the one with the shorter route is taken (the last leg
/// counts), the tour's own on ties. Ties for the closest target go to the lowest index.
///
/// # Arguments
/// * `labels`: for each of [`problem.targets()`](Problem::targets), in that order, the vehicle that serves it.
///
/// # Returns
/// The routes; a vehicle without label stays at home. Lower bounds are the quick ones ([`lower_bound::quick`]); call
/// [`lower_bound::both`] for better.
///
/// # Guarantee
/// None against the best solution: clustering first has no approximation factor, for neither objective. The certificate is
/// the gap to the lower bounds.
///
/// # Errors
/// [`Error::WrongLength`], [`Error::LabelOutOfRange`], [`Error::Tour`] if the metric is not symmetric, and those of
/// [`check`](crate::check()) if limits or forbidden pairs are not kept.
///
/// # Complexity
/// O(c^3) for a cluster of c targets at worst, far less in practice (the exact matching dominates).
///
/// # Examples
/// ```
/// use christofides::Points;
/// use mtsp::{Problem, assign};
///
/// let nodes = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 3.0]];
/// let metric = Points(&nodes);
/// let problem = Problem::new(&metric, 2)?;
/// let solution = assign(&problem, &[0, 0, 1])?;
/// assert_eq!(solution.routes, [vec![1, 2], vec![3]]);
/// assert_eq!(solution.lengths, [4.0, 6.0]);
/// # Ok::<(), mtsp::Error>(())
/// ```
pub fn assign<M: Metric>(problem: &Problem<'_, M>, labels: &[usize]) -> Result<Solution, Error> {
    let routes = cluster_routes(problem, labels)?;
    Solution::with_bounds(problem, routes, lower_bound::quick(problem))
}

/// The routes of [`assign`].
pub(crate) fn cluster_routes<M: Metric>(
    problem: &Problem<'_, M>,
    labels: &[usize],
) -> Result<Vec<Vec<usize>>, Error> {
    let (targets, vehicles) = (problem.targets(), problem.vehicles());
    expect_length(List::Labels, targets.len(), labels.len())?;
    let mut clusters = vec![Vec::new(); vehicles];
    for (&target, &label) in targets.iter().zip(labels) {
        let cluster = clusters.get_mut(label).ok_or(Error::LabelOutOfRange { target, label, vehicles })?;
        cluster.push(target);
    }
    clusters.iter().enumerate().map(|(vehicle, cluster)| route(problem, vehicle, cluster)).collect()
}

/// One vehicle's route through its cluster.
pub(crate) fn route<M: Metric>(
    problem: &Problem<'_, M>,
    vehicle: usize,
    cluster: &[usize],
) -> Result<Vec<usize>, Error> {
    if cluster.is_empty() {
        return Ok(vec![]);
    }
    let tour = christofides(&Subset { metric: problem.metric(), nodes: cluster })?;
    let mut route: Vec<usize> = tour.order().iter().map(|&i| cluster[i]).collect();
    let depot = problem.start(vehicle);
    for &target in &route {
        problem.leg(depot, target)?;
    }
    let distance = |i: usize| problem.metric().distance(depot, route[i]);
    let first = (0..route.len()).fold(0, |best, i| {
        let nearer = distance(i) < distance(best);
        let tie = distance(i) == distance(best) && route[i] < route[best];
        if nearer || tie { i } else { best }
    });
    route.rotate_left(first);
    let mut reversed = route.clone();
    reversed[1..].reverse();
    if differing_part(problem, vehicle, &reversed) < differing_part(problem, vehicle, &route) {
        return Ok(reversed);
    }
    Ok(route)
}

/// What distinguishes the two directions: the last leg less the tour edge that is not flown.
fn differing_part<M: Metric>(problem: &Problem<'_, M>, vehicle: usize, route: &[usize]) -> f64 {
    let (Some(&first), Some(&last)) = (route.first(), route.last()) else { return 0.0 };
    let home = match problem.end(vehicle) {
        End::At(node) => problem.metric().distance(last, node),
        End::Open => 0.0,
    };
    home - problem.metric().distance(last, first)
}

/// k-means labels of the targets, one cluster a vehicle, if the metric has coordinates.
pub(crate) fn k_means_labels<M: Metric>(
    problem: &Problem<'_, M>,
    seed: u64,
) -> Option<Result<Vec<usize>, Error>> {
    let options = KMeansOptions::default().with_seed(seed);
    let labels = match problem.metric().geometry() {
        Geometry::Planar(points) => labels(points, problem.targets(), problem.vehicles(), &options),
        Geometry::Spatial(points) => labels(points, problem.targets(), problem.vehicles(), &options),
        _ => return None,
    };
    Some(labels)
}

fn labels<const D: usize>(
    points: &[[f64; D]],
    targets: &[usize],
    vehicles: usize,
    options: &KMeansOptions,
) -> Result<Vec<usize>, Error> {
    let targets: Vec<[f64; D]> = targets.iter().map(|&t| points[t]).collect();
    Ok(kmeans(&targets, vehicles, options)?.labels)
}

/// Some nodes of a metric.
pub(crate) struct Subset<'a, M: Metric> {
    pub metric: &'a M,
    pub nodes: &'a [usize],
}

impl<M: Metric> Metric for Subset<'_, M> {
    fn len(&self) -> usize {
        self.nodes.len()
    }

    #[inline]
    fn distance(&self, i: usize, j: usize) -> f64 {
        self.metric.distance(self.nodes[i], self.nodes[j])
    }

    fn is_metric(&self) -> bool {
        self.metric.is_metric()
    }
}
