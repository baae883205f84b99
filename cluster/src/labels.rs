//! From labels to lists of members.

/// The members of clusters `0..k`, each in ascending order.
pub(crate) fn clusters(labels: &[usize], k: usize) -> Vec<Vec<usize>> {
    let mut clusters = vec![Vec::new(); k];
    for (point, &label) in labels.iter().enumerate() {
        clusters[label].push(point);
    }
    clusters
}

/// Renumbers arbitrary cluster ids so that clusters count up in the order of their first members; returns labels and count.
pub(crate) fn by_first_member(ids: &[usize]) -> (Vec<usize>, usize) {
    let mut new = vec![usize::MAX; ids.iter().max().map_or(0, |m| m + 1)];
    let mut count = 0;
    let labels = ids
        .iter()
        .map(|&id| {
            if new[id] == usize::MAX {
                new[id] = count;
                count += 1;
            }
            new[id]
        })
        .collect();
    (labels, count)
}
