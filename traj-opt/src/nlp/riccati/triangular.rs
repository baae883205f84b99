//! Small factorisations and triangular solves.

use super::NotConvex;
use crate::dense::{Arithmetic, LANES, Lanes};

/// Cholesky factorisation of `m` rows in pieces (`hessian`: for every piece `m` rows, upper triangle used, overwritten) into a
/// row-major lower factor and its inverse pivots.
#[inline(always)]
pub(super) fn factorise_pieces<A: Arithmetic>(
    hessian: &mut [Lanes],
    m: usize,
    lower: &mut [f64],
    inverse: &mut [f64],
) -> Result<(), NotConvex> {
    for k in 0..m {
        let first = k / LANES;
        let mut scale = 0.0;
        for (piece, rows) in hessian.chunks_exact_mut(m).enumerate().skip(first) {
            let (done, rest) = rows.split_at_mut(k);
            let mut row = A::subtract(rest[0], lower[k * m..k * m + k].iter().copied(), done);
            if piece == first {
                let (original, pivot) = (rest[0][k % LANES], row[k % LANES]);
                // a pivot that is rounding of the original entry says nothing about the sign
                if pivot.is_nan() || pivot <= 1e-15 * original.abs() {
                    return Err(NotConvex);
                }
                scale = 1.0 / pivot.sqrt();
                inverse[k] = scale;
            }
            row.iter_mut().for_each(|v| *v *= scale);
            rest[0] = row;
            for (lane, value) in row.iter().enumerate() {
                let i = piece * LANES + lane;
                if i >= k && i < m {
                    lower[i * m + k] = *value;
                }
            }
        }
    }
    Ok(())
}

/// Solves `L y = x` in place with the inverse pivots at hand.
#[inline(always)]
pub(super) fn forward_scaled<A: Arithmetic>(lower: &[f64], inverse: &[f64], x: &mut [f64]) {
    let m = x.len();
    for i in 0..m {
        let (done, rest) = x.split_at_mut(i);
        let mut sum = rest[0];
        for (l, y) in lower[i * m..i * m + i].iter().zip(done) {
            sum = A::madd(-l, *y, sum);
        }
        rest[0] = sum * inverse[i];
    }
}

/// Solves `L' x = y` in place with the inverse pivots at hand.
#[inline(always)]
pub(super) fn backward_scaled<A: Arithmetic>(lower: &[f64], inverse: &[f64], x: &mut [f64]) {
    let m = x.len();
    for i in (0..m).rev() {
        let (rest, done) = x.split_at_mut(i);
        let value = done[0] * inverse[i];
        done[0] = value;
        for (l, y) in lower[i * m..i * m + i].iter().zip(rest) {
            *y = A::madd(-l, value, *y);
        }
    }
}

/// In-place Cholesky factorisation of a row-major matrix's lower triangle.
pub(super) fn cholesky(a: &mut [f64], n: usize) -> Result<(), NotConvex> {
    for j in 0..n {
        let original = a[j * n + j];
        let mut pivot = original;
        for k in 0..j {
            pivot -= a[j * n + k] * a[j * n + k];
        }
        if pivot.is_nan() || pivot <= 1e-15 * original.abs() {
            return Err(NotConvex);
        }
        let root = pivot.sqrt();
        a[j * n + j] = root;
        eliminate(a, n, j, root);
    }
    Ok(())
}

/// Cholesky factorisation that replaces vanishing pivots (dependent end conditions) so that their multiplier does not move.
pub(super) fn cholesky_repaired(a: &mut [f64], n: usize) {
    for j in 0..n {
        let original = a[j * n + j];
        let mut pivot = original;
        for k in 0..j {
            pivot -= a[j * n + k] * a[j * n + k];
        }
        if pivot.is_nan() || pivot <= 1e-13 * original.abs() || pivot <= 0.0 {
            pivot = 1e100;
        }
        let root = pivot.sqrt();
        a[j * n + j] = root;
        eliminate(a, n, j, root);
    }
}

/// Column `j` of a Cholesky factor below its pivot.
fn eliminate(a: &mut [f64], n: usize, j: usize, root: f64) {
    for i in j + 1..n {
        let mut sum = a[i * n + j];
        for k in 0..j {
            sum -= a[i * n + k] * a[j * n + k];
        }
        a[i * n + j] = sum / root;
    }
}

/// Solves `L y = x` in place.
pub(super) fn forward(l: &[f64], n: usize, x: &mut [f64]) {
    for i in 0..n {
        let mut sum = x[i];
        for j in 0..i {
            sum -= l[i * n + j] * x[j];
        }
        x[i] = sum / l[i * n + i];
    }
}

/// Solves `L' y = x` in place.
pub(super) fn backward(l: &[f64], n: usize, x: &mut [f64]) {
    for i in (0..n).rev() {
        let mut sum = x[i];
        for j in i + 1..n {
            sum -= l[j * n + i] * x[j];
        }
        x[i] = sum / l[i * n + i];
    }
}
