//! k-means: invariants on hard input, and errors.

mod common;

use cluster::{Error, KMeansOptions, KMeansStatus, kmeans, kmeans_weighted};
use common::{distance, points};
use proptest::prelude::*;

/// Rounding of a distance and of the scaling around it.
const ROUNDING: f64 = 1e-12;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn labels_are_nearest_and_no_cluster_is_empty(points in points(60), k in 1usize..12, seed in 0u64..50) {
        let options = KMeansOptions::default().with_seed(seed).with_n_init(3);
        let found = kmeans(&points, k, &options).unwrap();
        prop_assert_eq!(found.labels.len(), points.len());
        prop_assert!(found.clusters().iter().all(|c| !c.is_empty()));
        let mut inertia = 0.0;
        for (point, &label) in points.iter().zip(&found.labels) {
            let own = distance(point, &found.centroids[label]);
            inertia += own * own;
            for other in &found.centroids {
                prop_assert!(own <= distance(point, other) * (1.0 + ROUNDING) + f64::MIN_POSITIVE);
            }
        }
        if inertia.is_normal() {
            prop_assert!((inertia - found.inertia).abs() <= 1e-9 * inertia);
        }
        prop_assert_eq!(kmeans(&points, k, &options).unwrap(), found);
    }

    #[test]
    fn as_many_clusters_as_distinct_points_and_no_more(points in points(40), k in 1usize..45) {
        let found = kmeans(&points, k, &KMeansOptions::default().with_n_init(1)).unwrap();
        let mut distinct: Vec<[u64; 2]> = points.iter().map(|p| p.map(|x| (x + 0.0).to_bits())).collect();
        distinct.sort_unstable();
        distinct.dedup();
        prop_assert_eq!(found.centroids.len(), k.min(distinct.len()));
        prop_assert_eq!(found.status == KMeansStatus::FewerDistinctPoints, distinct.len() < k && !points.is_empty());
    }

    #[test]
    fn converged_centroids_are_means(points in points(60), k in 1usize..8) {
        let found = kmeans(&points, k, &KMeansOptions::default().with_tolerance(0.0)).unwrap();
        prop_assume!(found.status == KMeansStatus::Converged);
        let size = points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (centroid, members) in found.centroids.iter().zip(found.clusters()) {
            for axis in 0..2 {
                let mean = members.iter().map(|&i| points[i][axis] / members.len() as f64).sum::<f64>();
                prop_assert!((mean - centroid[axis]).abs() <= ROUNDING * size);
            }
        }
    }

    #[test]
    fn an_integer_weight_is_that_many_copies(points in points(30), k in 1usize..5) {
        let weights: Vec<f64> = (0..points.len()).map(|i| 1.0 + (i % 3) as f64).collect();
        let weighted = kmeans_weighted(&points, &weights, k, &KMeansOptions::default()).unwrap();
        let inertia: f64 = points.iter().zip(&weights).zip(&weighted.labels)
            .map(|((p, w), &l)| w * distance(p, &weighted.centroids[l]).powi(2)).sum();
        if inertia.is_normal() {
            prop_assert!((inertia - weighted.inertia).abs() <= 1e-9 * inertia);
        }
        // Local minimum of the weighted problem: each centroid is the weighted mean of its members.
        let exact = kmeans_weighted(&points, &weights, k, &KMeansOptions::default().with_tolerance(0.0)).unwrap();
        prop_assume!(exact.status == KMeansStatus::Converged);
        let size = points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        for (centroid, members) in exact.centroids.iter().zip(exact.clusters()) {
            let total: f64 = members.iter().map(|&i| weights[i]).sum();
            let mean: f64 = members.iter().map(|&i| weights[i] / total * points[i][0]).sum();
            prop_assert!((mean - centroid[0]).abs() <= ROUNDING * size);
        }
    }
}

#[test]
fn finds_the_optimum_of_separated_groups() {
    let points: Vec<[f64; 3]> =
        (0..90).map(|i| [100.0 * (i % 9) as f64, (i / 9) as f64 * 0.1, ((i * 7) % 5) as f64 * 0.1]).collect();
    let found = kmeans(&points, 9, &KMeansOptions::default()).unwrap();
    for i in 0..90 {
        assert_eq!(found.labels[i], found.labels[i % 9]);
    }
}

#[test]
fn bad_input_is_refused() {
    let options = KMeansOptions::default();
    assert_eq!(
        kmeans(&[[0.0, 1.0], [f64::NAN, 0.0]], 1, &options),
        Err(Error::NonFiniteCoordinate { point: 1, axis: 0 })
    );
    assert_eq!(kmeans(&[[0.0]], 0, &options), Err(Error::NoClusters));
    assert!(kmeans(&[[0.0]], 1, &options.clone().with_n_init(0)).is_err());
    assert!(kmeans(&[[0.0]], 1, &options.clone().with_tolerance(f64::NAN)).is_err());
    assert!(kmeans_weighted(&[[0.0]], &[0.0], 1, &options).is_err());
    assert!(kmeans_weighted(&[[0.0]], &[], 1, &options).is_err());
    assert!(kmeans::<2>(&[], 3, &options).unwrap().centroids.is_empty());
}
