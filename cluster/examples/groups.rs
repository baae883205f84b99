//! Groups a grid of points three ways and prints what came out.

use cluster::{KMeansOptions, Linkage, kmeans, linkage, merge_within, smallest_enclosing_circle};

fn main() -> Result<(), cluster::Error> {
    let points: Vec<[f64; 2]> =
        (0..60).map(|i| [(i * 37 % 60) as f64 + (i % 7) as f64, (i * 23 % 60) as f64]).collect();

    let groups = kmeans(&points, 4, &KMeansOptions::default().with_seed(1))?;
    println!("k-means: inertia {:.1} after {} iterations", groups.inertia, groups.iterations);
    for (centroid, members) in groups.centroids.iter().zip(groups.clusters()) {
        let members: Vec<[f64; 2]> = members.iter().map(|&i| points[i]).collect();
        let circle = smallest_enclosing_circle(&members)?;
        println!("  {:2} points around {:5.1?}, all within {:.1}", members.len(), centroid, circle.radius);
    }

    let tree = linkage(&points, Linkage::Average)?;
    println!(
        "average linkage: the last merge is at {:.1}",
        tree.steps()[tree.steps().len() - 1].dissimilarity
    );
    println!("merged within 8: {} clusters", merge_within(&points, 8.0)?.clusters.len());
    Ok(())
}
