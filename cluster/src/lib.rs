//! Clustering of points: k-means and its balanced form, hierarchical clustering, online absorption
