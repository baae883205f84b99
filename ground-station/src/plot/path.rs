//! Fewer points for the same line.

/// The points of a polyline that are needed to stay within `tolerance` of it (Douglas and Peucker, 1973); both ends stay.
///
/// Worst case O(n^2), O(n log n) for flown paths.
#[must_use]
pub fn simplified(points: &[[f64; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut kept = vec![false; points.len()];
    kept[0] = true;
    kept[points.len() - 1] = true;
    let mut open = vec![(0, points.len() - 1)];
    while let Some((first, last)) = open.pop() {
        let distance = |&index: &usize| distance_to_segment(points[index], points[first], points[last]);
        let farthest = (first + 1..last).max_by(|a, b| distance(a).total_cmp(&distance(b)));
        if let Some(farthest) = farthest.filter(|index| distance(index) > tolerance) {
            kept[farthest] = true;
            open.push((first, farthest));
            open.push((farthest, last));
        }
    }
    points.iter().zip(kept).filter(|(_, kept)| *kept).map(|(point, _)| *point).collect()
}

fn distance_to_segment(point: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let along = [to[0] - from[0], to[1] - from[1]];
    let off = [point[0] - from[0], point[1] - from[1]];
    let squared = along[0] * along[0] + along[1] * along[1];
    let share =
        if squared > 0.0 { ((off[0] * along[0] + off[1] * along[1]) / squared).clamp(0.0, 1.0) } else { 0.0 };
    (off[0] - share * along[0]).hypot(off[1] - share * along[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_point_stays_near_and_the_ends_stay(
            points in prop::collection::vec([-50.0..50.0f64, -50.0..50.0f64], 1..60), tolerance in 0.01..5.0f64,
        ) {
            let short = simplified(&points, tolerance);
            prop_assert_eq!(short.first(), points.first());
            prop_assert_eq!(short.last(), points.last());
            for &point in &points {
                let near = short.windows(2).map(|pair| distance_to_segment(point, pair[0], pair[1]));
                let least = near.fold(f64::INFINITY, f64::min);
                prop_assert!(short.len() < 2 || least <= tolerance + 1e-9, "{:?} {}", point, least);
            }
        }
    }

    #[test]
    fn a_straight_line_needs_its_ends_only() {
        let points: Vec<[f64; 2]> = (0..100).map(|i| [f64::from(i), 2.0 * f64::from(i)]).collect();
        assert_eq!(simplified(&points, 0.01).len(), 2);
    }
}
