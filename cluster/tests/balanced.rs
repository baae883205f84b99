//! Balanced clusters against every assignment, and online clusters against their definition.

mod common;

use cluster::{Error, KMeansOptions, Online, balanced_kmeans, equal_shares};
use common::{distance, points};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn sizes_are_equal_shares(points in points(50), k in 1usize..8) {
        let found = balanced_kmeans(&points, &equal_shares(points.len(), k), &KMeansOptions::default()).unwrap();
        let mut sizes: Vec<usize> = found.clusters().iter().map(Vec::len).collect();
        sizes.sort_unstable_by(|a, b| b.cmp(a));
        prop_assert_eq!(sizes, equal_shares(points.len(), k));
    }

    #[test]
    fn the_assignment_is_optimal_for_its_centroids(
        raw in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 1..8), k in 1usize..4, spare in 0usize..3,
    ) {
        let points: Vec<[f64; 2]> = raw.into_iter().map(|(x, y)| [x, y]).collect();
        let n = points.len();
        let mut capacities = equal_shares(n, k);
        capacities[0] += spare;
        let found = balanced_kmeans(&points, &capacities, &KMeansOptions::default()).unwrap();
        // At rest, no other assignment that keeps the capacities is cheaper to the same centroids.
        let cost = |i: usize, j: usize| distance(&points[i], &found.centroids[j]).powi(2);
        let mut best = f64::INFINITY;
        for code in 0..k.pow(n as u32) {
            let label = |i: usize| code / k.pow(i as u32) % k;
            if (0..k).all(|j| (0..n).filter(|&i| label(i) == j).count() <= capacities[j]) {
                best = best.min((0..n).map(|i| cost(i, label(i))).sum());
            }
        }
        prop_assert!((found.inertia - best).abs() <= 1e-9);
    }

    #[test]
    fn online_centroids_are_means(events in prop::collection::vec((0usize..4, -1.0..1.0f64, -1.0..1.0f64), 1..80)) {
        let mut online = Online::new(&[[0.0, 0.0], [1.0, 1.0]], &[0, 1], &[[0.0, 0.0], [1.0, 1.0]]).unwrap();
        let mut there = vec![(0, [0.0, 0.0]), (1, [1.0, 1.0])];
        for (kind, x, y) in events {
            let chosen = ((x + 1.0) * 0.5 * there.len() as f64) as usize;
            match kind {
                0 | 1 => {
                    let (id, label) = online.absorb([x, y]).unwrap();
                    prop_assert_eq!(online.label(id), Some(label));
                    there.push((id, [x, y]));
                }
                2 if chosen < there.len() => {
                    online.shift(there[chosen].0, [y, x]).unwrap();
                    there[chosen].1 = [y, x];
                }
                _ if chosen < there.len() => {
                    let (id, _) = there.swap_remove(chosen);
                    online.remove(id).unwrap();
                    prop_assert_eq!(online.remove(id), Err(Error::UnknownPoint { id }));
                }
                _ => {}
            }
            for label in 0..2 {
                let members: Vec<[f64; 2]> =
                    there.iter().filter(|(id, _)| online.label(*id) == Some(label)).map(|e| e.1).collect();
                prop_assert_eq!(members.len(), online.members(label).len());
                for axis in 0..2 {
                    let mean = members.iter().map(|p| p[axis]).sum::<f64>() / members.len() as f64;
                    prop_assert!(members.is_empty() || (mean - online.centroids()[label][axis]).abs() < 1e-9);
                }
            }
        }
    }
}

#[test]
fn drift_is_reported() {
    let mut online = Online::new(&[[0.0], [1.0], [10.0], [11.0]], &[0, 0, 1, 1], &[[0.5], [10.5]]).unwrap();
    assert!(!online.is_stale());
    for i in 0..10 {
        online.absorb([5.0 + 0.1 * i as f64]).unwrap();
    }
    assert!(online.is_stale());
    assert!(online.drift() > 1.0);
}

#[test]
fn bad_input_is_refused() {
    let options = KMeansOptions::default();
    let small = balanced_kmeans(&[[0.0], [1.0], [2.0]], &[1, 1], &options);
    assert_eq!(small, Err(Error::CapacityTooSmall { capacity: 2, points: 3 }));
    assert!(Online::new(&[[0.0]], &[3], &[[0.0]]).is_err());
    assert!(Online::<1>::new(&[], &[], &[]).is_err());
}
