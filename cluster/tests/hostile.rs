//! Numbers at the edge of what `f64` holds: every public function answers or refuses, none panics.

use cluster::{
    Ball, Error, KMeansOptions, Linkage, Online, balanced_kmeans, clink, equal_shares, kmeans,
    kmeans_weighted, linkage, linkage_condensed, merge_within, smallest_enclosing_ball,
    smallest_enclosing_circle, smallest_enclosing_sphere,
};
use proptest::prelude::*;

const LINKAGES: [Linkage; 4] = [Linkage::Single, Linkage::Complete, Linkage::Average, Linkage::Ward];

fn extreme() -> impl Strategy<Value = f64> {
    let special = prop::sample::select(vec![
        0.0,
        -0.0,
        1.0,
        5e-324,
        -1e-310,
        1e-160,
        1e154,
        1e300,
        -1e300,
        f64::MAX,
        f64::MIN,
        f64::INFINITY,
        f64::NAN,
    ]);
    prop_oneof![3 => special, 1 => prop::num::f64::NORMAL, 6 => -1e3..1e3]
}

/// Finite coordinates of any magnitude.
fn finite() -> impl Strategy<Value = f64> {
    extreme().prop_map(|x| if x.is_finite() { x } else { 7.0 })
}

fn options() -> impl Strategy<Value = KMeansOptions> {
    (any::<u64>(), 0..4_usize, 0..20_usize, prop_oneof![4 => Just(1e-4), 1 => extreme()]).prop_map(
        |(seed, n_init, iterations, tolerance)| {
            let options = KMeansOptions::default().with_seed(seed).with_n_init(n_init);
            options.with_max_iterations(iterations).with_tolerance(tolerance)
        },
    )
}

fn all_finite<const D: usize>(points: &[[f64; D]]) -> bool {
    points.iter().flatten().all(|x| x.is_finite())
}

/// Every function of points; what comes back labels every point and has no clusters that are not numbers.
fn call_everything<const D: usize>(points: &[[f64; D]], k: usize, diameter: f64, options: &KMeansOptions) {
    let is_finite = all_finite(points);
    let weights: Vec<f64> = (0..points.len()).map(|i| [1.0, 5e-324, 1e300, 2.0][i % 4]).collect();
    for found in [kmeans(points, k, options), kmeans_weighted(points, &weights, k, options)] {
        assert!(is_finite || found.is_err());
        let Ok(found) = found else { continue };
        assert_eq!(found.labels.len(), points.len());
        assert!(all_finite(&found.centroids), "{points:?} {:?}", found.centroids);
        assert!(found.clusters().iter().all(|members| !members.is_empty()));
        online(points, &found.labels, &found.centroids);
    }
    if let Ok(found) = balanced_kmeans(points, &equal_shares(points.len(), k), options) {
        assert!(found.labels.len() == points.len() && found.clusters().len() == k);
        assert!(all_finite(&found.centroids), "{points:?} {:?}", found.centroids);
    }
    for hierarchy in LINKAGES.map(|kind| linkage(points, kind)).into_iter().chain([clink(points)]) {
        assert!(is_finite || hierarchy.is_err());
        let Ok(dendrogram) = hierarchy else { continue };
        assert_eq!(dendrogram.observations(), points.len());
        assert_eq!(dendrogram.steps().len(), points.len().saturating_sub(1));
        assert_eq!(dendrogram.cut(diameter).len(), points.len());
        assert_eq!(dendrogram.cut_into(k).iter().max().map_or(0, |m| m + 1), k.max(1).min(points.len()));
    }
    if let Ok(merged) = merge_within(points, diameter) {
        assert!(is_finite && merged.labels.len() == points.len());
        assert_eq!(merged.clusters.iter().map(Vec::len).sum::<usize>(), points.len());
    }
    let ball = smallest_enclosing_ball(points);
    assert!(is_finite || ball.is_err());
    if let Ok(Ball { centre, radius, .. }) = ball {
        assert!(centre.iter().all(|x| x.is_finite()) && radius >= 0.0, "{points:?} {centre:?} {radius}");
    }
}

/// Points come, move and go; the clustering stays one of numbers.
fn online<const D: usize>(points: &[[f64; D]], labels: &[usize], centroids: &[[f64; D]]) {
    let Ok(mut online) = Online::new(points, labels, centroids) else { return };
    for (i, point) in points.iter().enumerate() {
        let (id, label) = online.absorb(point.map(|x| -x)).unwrap();
        assert!(label < centroids.len() && online.label(id) == Some(label));
        online.shift(id, points[points.len() - 1 - i]).unwrap();
        if i % 3 == 0 {
            online.remove(i).unwrap();
            assert_eq!(online.remove(i), Err(Error::UnknownPoint { id: i }));
        }
    }
    assert!(all_finite(online.centroids()), "{points:?} {:?}", online.centroids());
    assert!(!online.drift().is_nan() && (0.0..=1.0).contains(&online.misplaced()));
    let _ = (online.is_stale(), online.members(0));
    assert!(D == 0 || online.absorb([f64::NAN; D]).is_err());
    assert_eq!(online.shift(usize::MAX, [0.0; D]), Err(Error::UnknownPoint { id: usize::MAX }));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn points_of_any_size(
        points in prop::collection::vec([extreme(), extreme()], 0..40), k in 0..9_usize, diameter in extreme(), options in options(),
    ) {
        call_everything(&points, k, diameter, &options);
        let _ = smallest_enclosing_circle(&points);
    }

    #[test]
    fn finite_points_of_any_size(
        points in prop::collection::vec([finite(), finite()], 0..40), k in 1..9_usize, diameter in extreme(), options in options(),
    ) {
        call_everything(&points, k, diameter, &options);
    }

    #[test]
    fn points_of_one_or_three_coordinates(
        points in prop::collection::vec([finite(), finite(), finite()], 0..30), k in 1..40_usize, options in options(),
    ) {
        call_everything(&points, k, 1.0, &options);
        let _ = smallest_enclosing_sphere(&points);
        let line: Vec<[f64; 1]> = points.iter().map(|p| [p[0]]).collect();
        call_everything(&line, k, 0.0, &options);
        let nowhere: Vec<[f64; 0]> = points.iter().map(|_| []).collect();
        call_everything(&nowhere, k, 0.0, &options);
    }

    #[test]
    fn matrices_of_any_entries(n in 0..9_usize, mut entries in prop::collection::vec(extreme(), 0..36)) {
        for kind in LINKAGES {
            if let Ok(dendrogram) = linkage_condensed(&mut entries.clone(), n, kind) {
                prop_assert_eq!(dendrogram.steps().len(), n.saturating_sub(1));
            }
            let length = n * n.saturating_sub(1) / 2;
            entries.resize(length, 1e300);
            entries.iter_mut().for_each(|x| *x = if x.is_finite() { x.abs() } else { 0.0 });
            prop_assert!(linkage_condensed(&mut entries.clone(), n, kind).is_ok());
        }
    }

    #[test]
    fn weights_and_capacities_of_any_size(
        points in prop::collection::vec([finite(), finite()], 0..12), weights in prop::collection::vec(extreme(), 0..12),
        capacities in prop::collection::vec(prop_oneof![0..5_usize, Just(usize::MAX)], 0..6),
    ) {
        let options = KMeansOptions::default().with_max_iterations(5);
        let _ = kmeans_weighted(&points, &weights, 3, &options);
        if let Ok(found) = balanced_kmeans(&points, &capacities, &options) {
            for (members, capacity) in found.clusters().iter().zip(&capacities) {
                prop_assert!(members.len() <= *capacity);
            }
        }
    }
}

/// A number alone takes neither memory nor time.
#[test]
fn enormous_numbers_are_answered() {
    let points = [[0.0, 0.0], [1.0, 0.0], [5.0, 5.0]];
    for k in [1 << 40, usize::MAX] {
        assert_eq!(kmeans(&points, k, &KMeansOptions::default()).unwrap().centroids.len(), 3);
        assert_eq!(clink(&points).unwrap().cut_into(k), [0, 1, 2]);
        assert_eq!(equal_shares(k, 2).len(), 2);
        for kind in LINKAGES {
            assert!(matches!(linkage_condensed(&mut [1.0], k, kind), Err(Error::CondensedLength { .. })));
        }
    }
    let endless = KMeansOptions::default().with_max_iterations(usize::MAX).with_tolerance(0.0);
    assert_eq!(kmeans(&points, 2, &endless).unwrap().inertia, 0.5);
    let many = vec![1; 100_000];
    let refused = balanced_kmeans(&points, &many, &KMeansOptions::default());
    assert_eq!(refused.unwrap_err(), Error::TooManyClusters { clusters: 100_000, limit: 4096 });
    let line: Vec<[f64; 1]> = (0..100_000).map(|i| [f64::from(i)]).collect();
    let refused = linkage(&line, Linkage::Ward);
    assert_eq!(refused.unwrap_err(), Error::TooManyPoints { points: 100_000, limit: 65_536 });
}
