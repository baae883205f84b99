//! Clustering of points in the plane, in space, in any fixed dimension: k-means, hierarchies, merging within a diameter.
//!
//! Points are slices of arrays, `&[[f64; D]]`; clusters are labels `0..k`. k-means looks for the labels `l` and centroids
//! `c` that minimise the inertia
//!
//! ```text
//! sum over i of w_i |x_i - c_l(i)|^2
//! ```
//!
//! and hierarchical clustering merges the two closest clusters again and again.
//!
//! | wanted | function |
//! |---|---|
//! | `k` compact clusters | [`kmeans`], [`kmeans_weighted`] |
//! | `k` clusters of limited or equal size | [`balanced_kmeans`], [`equal_shares`] |
//! | a clustering kept current while points come and go | [`Online`] |
//! | a hierarchy (single, complete, average, Ward) | [`linkage()`], [`linkage_condensed`], [`Dendrogram::cut`] |
//! | a hierarchy in linear memory | [`clink`] |
//! | close points merged, no cluster wider than a diameter | [`merge_within`] |
//! | the circle or sphere around a cluster | [`smallest_enclosing_circle`], [`smallest_enclosing_sphere`] |
//!
//! # Example
//! ```
//! use cluster::{KMeansOptions, kmeans, merge_within, smallest_enclosing_circle};
//!
//! let targets = [[0.0, 0.0], [1.0, 0.0], [8.0, 8.0], [9.0, 8.0], [9.0, 9.0]];
//! let groups = kmeans(&targets, 2, &KMeansOptions::default().with_seed(7))?;
//! assert_eq!(groups.clusters().iter().map(Vec::len).sum::<usize>(), 5);
//!
//! let merged = merge_within(&targets, 1.0)?;
//! let members: Vec<[f64; 2]> = merged.clusters[0].iter().map(|&i| targets[i]).collect();
//! assert_eq!(smallest_enclosing_circle(&members)?.radius, 0.5);
//! # Ok::<(), cluster::Error>(())
//! ```
//!
//! # Guarantees
//! * Equal input and seed give equal bits.
//! * k-means labels are exact nearest centroids, and no cluster is empty; its inertia is a local minimum, not the least.
//! * [`merge_within`] is the complete-linkage cut, not an approximation of it; where distances tie, one of the possible cuts.
//! * No input makes a function panic: coordinates that are not finite are errors. Coordinates of any magnitude work.
//!
//! # Features
//! `serde`: serialisation of the results.
//!
//! # References
//! Lloyd 1982; Hartigan 1975; Arthur and Vassilvitskii 2007; Pelleg and Moore 1999; Kanungo et al. 2002; Müllner 2011; Defays 1977;
//! Welzl 1991; Gärtner 1999. Each function names its own.

#![forbid(unsafe_code)]
#![deny(missing_docs)]

mod balanced;
mod enclosing;
mod error;
mod geometry;
mod kmeans;
mod labels;
mod linkage;
mod online;
mod tree;

pub use balanced::{Balanced, balanced_kmeans, equal_shares};
pub use enclosing::{Ball, smallest_enclosing_ball, smallest_enclosing_circle, smallest_enclosing_sphere};
pub use error::{Error, OptionName};
pub use kmeans::{KMeans, KMeansOptions, KMeansStatus, kmeans, kmeans_weighted};
pub use linkage::{Dendrogram, Linkage, Partition, Step, clink, linkage, linkage_condensed, merge_within};
pub use online::Online;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
