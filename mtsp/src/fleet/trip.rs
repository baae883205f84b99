//! The order of a trip: nearest neighbours, then 2-opt and Or-opt with the start fixed.

use super::Space;
use crate::error::Error;
use christofides::{Ends, Matrix, Path, improve_path};

/// A short order through all places that starts at the first and ends anywhere.
pub(super) fn open_trip<S: Space>(space: &S, places: &[S::Place]) -> Result<Vec<usize>, Error> {
    let n = places.len();
    let mut order = vec![0];
    let mut left: Vec<usize> = (1..n).collect();
    while let Some(&here) = order.last() {
        let distance = |position: usize| space.distance(&places[here], &places[left[position]]);
        match (0..left.len()).min_by(|&a, &b| distance(a).total_cmp(&distance(b))) {
            Some(position) => order.push(left.remove(position)),
            None => break,
        }
    }
    if n < 4 {
        return Ok(order);
    }
    let distances = places.iter().flat_map(|a| places.iter().map(|b| space.distance(a, b))).collect();
    let matrix = Matrix::symmetric(n, distances)?;
    let path = improve_path(&matrix, Path::new(&matrix, order)?, Ends::Start(0))?;
    Ok(path.into_order())
}
