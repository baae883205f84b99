//! Hierarchies against a textbook implementation, and cuts against their definition.

mod common;

use cluster::{Dendrogram, Error, Linkage, clink, linkage, linkage_condensed, merge_within};
use common::{distance, points};
use proptest::prelude::*;

/// Points in general position: distances do not tie.
fn scattered(n: usize) -> impl Strategy<Value = Vec<[f64; 2]>> {
    prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64), 0..n)
        .prop_map(|v| v.into_iter().map(|(x, y)| [x, y]).collect())
}

/// Merges the two closest clusters again and again, measuring clusters from their members.
fn primitive(points: &[[f64; 2]], method: Linkage) -> Vec<f64> {
    let mut clusters: Vec<Vec<usize>> = (0..points.len()).map(|i| vec![i]).collect();
    let mut heights = vec![];
    while clusters.len() > 1 {
        let mut best = (f64::INFINITY, 0, 0);
        for i in 0..clusters.len() {
            for j in i + 1..clusters.len() {
                let d = between(points, &clusters[i], &clusters[j], method);
                if d < best.0 {
                    best = (d, i, j);
                }
            }
        }
        heights.push(best.0);
        let removed = clusters.remove(best.2);
        clusters[best.1].extend(removed);
    }
    heights
}

fn between(points: &[[f64; 2]], a: &[usize], b: &[usize], method: Linkage) -> f64 {
    let pairs = a.iter().flat_map(|&i| b.iter().map(move |&j| distance(&points[i], &points[j])));
    match method {
        Linkage::Single => pairs.fold(f64::INFINITY, f64::min),
        Linkage::Complete => pairs.fold(0.0, f64::max),
        Linkage::Average => pairs.sum::<f64>() / (a.len() * b.len()) as f64,
        _ => {
            let mean =
                |c: &[usize], axis: usize| c.iter().map(|&i| points[i][axis]).sum::<f64>() / c.len() as f64;
            let (p, q) = ([mean(a, 0), mean(a, 1)], [mean(b, 0), mean(b, 1)]);
            let sizes = (a.len() * b.len()) as f64 / (a.len() + b.len()) as f64;
            (2.0 * sizes).sqrt() * distance(&p, &q)
        }
    }
}

fn diameters_hold(points: &[[f64; 2]], labels: &[usize], diameter: f64) -> bool {
    (0..points.len()).all(|i| {
        (0..i).all(|j| labels[i] != labels[j] || distance(&points[i], &points[j]) <= diameter * (1.0 + 1e-15))
    })
}

/// SciPy's numbering: every cluster is used once, children exist before their parent, sizes add up, heights rise.
fn is_scipy_numbered(dendrogram: &Dendrogram) -> bool {
    let n = dendrogram.observations();
    let size = |c: usize| if c < n { 1 } else { dendrogram.steps()[c - n].size };
    let mut used = vec![false; 2 * n];
    dendrogram.steps().iter().enumerate().all(|(k, s)| {
        let fresh = !used[s.cluster1] && !used[s.cluster2] && s.cluster1 < s.cluster2 && s.cluster2 < n + k;
        used[s.cluster1] = true;
        used[s.cluster2] = true;
        let rises = k == 0 || dendrogram.steps()[k - 1].dissimilarity <= s.dissimilarity;
        fresh && rises && s.size == size(s.cluster1) + size(s.cluster2)
    }) && dendrogram.steps().len() == n.saturating_sub(1)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn heights_are_those_of_the_textbook(points in scattered(25)) {
        for method in [Linkage::Single, Linkage::Complete, Linkage::Average, Linkage::Ward] {
            let dendrogram = linkage(&points, method).unwrap();
            prop_assert!(is_scipy_numbered(&dendrogram));
            for (step, height) in dendrogram.steps().iter().zip(primitive(&points, method)) {
                prop_assert!((step.dissimilarity - height).abs() <= 1e-9 * height.max(1e-9), "{:?}", method);
            }
        }
    }

    #[test]
    fn steps_are_those_of_kodama(points in scattered(60)) {
        let mut condensed = vec![];
        for i in 0..points.len() {
            condensed.extend(points[i + 1..].iter().map(|q| distance(&points[i], q)));
        }
        for (method, same) in [
            (Linkage::Single, kodama::Method::Single),
            (Linkage::Complete, kodama::Method::Complete),
            (Linkage::Average, kodama::Method::Average),
            (Linkage::Ward, kodama::Method::Ward),
        ] {
            let ours = linkage_condensed(&mut condensed.clone(), points.len(), method).unwrap();
            let theirs = kodama::linkage(&mut condensed.clone(), points.len(), same);
            prop_assert_eq!(ours.steps().len(), theirs.steps().len());
            for (a, b) in ours.steps().iter().zip(theirs.steps()) {
                prop_assert_eq!((a.cluster1, a.cluster2, a.size), (b.cluster1, b.cluster2, b.size));
                prop_assert_eq!(a.dissimilarity, b.dissimilarity);
            }
        }
    }

    #[test]
    fn merging_within_is_the_complete_linkage_cut(points in scattered(120), diameter in 0.0..1.5f64) {
        let merged = merge_within(&points, diameter).unwrap();
        let full = linkage(&points, Linkage::Complete).unwrap();
        prop_assert_eq!(&merged.labels, &full.cut(diameter));
    }

    #[test]
    fn merged_clusters_are_narrow_and_cannot_be_merged_further(points in points(60), relative in 0.0..1.5f64) {
        let size = points.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let diameter = relative * size;
        let merged = merge_within(&points, diameter).unwrap();
        prop_assert!(diameters_hold(&points, &merged.labels, diameter));
        for (a, first) in merged.clusters.iter().enumerate() {
            prop_assert!(first.iter().all(|&i| merged.labels[i] == a));
            for second in &merged.clusters[..a] {
                prop_assert!(between(&points, first, second, Linkage::Complete) > diameter * (1.0 - 1e-15));
            }
        }
    }

    #[test]
    fn clink_heights_bound_diameters(points in points(60)) {
        let dendrogram = clink(&points).unwrap();
        prop_assert!(is_scipy_numbered(&dendrogram));
        for step in dendrogram.steps() {
            let labels = dendrogram.cut(step.dissimilarity);
            prop_assert!(diameters_hold(&points, &labels, step.dissimilarity));
        }
    }

    #[test]
    fn cutting_into_k_gives_k(points in points(40), k in 1usize..50) {
        let labels = linkage(&points, Linkage::Average).unwrap().cut_into(k);
        prop_assert_eq!(labels.iter().max().map_or(0, |m| m + 1), k.min(points.len()));
    }
}

#[test]
fn bad_input_is_refused() {
    assert!(matches!(linkage(&[[f64::INFINITY]], Linkage::Single), Err(Error::NonFiniteCoordinate { .. })));
    assert!(matches!(linkage_condensed(&mut [1.0], 3, Linkage::Ward), Err(Error::CondensedLength { .. })));
    assert!(matches!(
        linkage_condensed(&mut [-1.0], 2, Linkage::Ward),
        Err(Error::InvalidDissimilarity { .. })
    ));
    assert!(matches!(merge_within(&[[0.0]], f64::NAN), Err(Error::InvalidDiameter { .. })));
    assert_eq!(merge_within(&[[0.0], [1.0], [2.0]], f64::INFINITY).unwrap().clusters, [vec![0, 1, 2]]);
}
