//! Small factorisations and triangular solves.

use super::NotConvex;
use crate::dense::Arithmetic;

/// Cholesky factorisation `U' U` in place of `m` rows in pieces of `C` (for every piece `m` rows, upper triangle), with inverse pivots.
#[inline(always)]
pub(super) fn factorise_pieces<A: Arithmetic, const C: usize>(
    upper: &mut [[f64; C]],
    inverse: &mut [f64],
) -> Result<(), NotConvex> {
    let m = inverse.len();
    for k in 0..m {
        let first = k / C;
        for piece in first..upper.len() / m {
            let (done, rest) = upper.split_at_mut(piece * m + k);
            let mut row = rest[0];
            for l in 0..k {
                let weight = done[first * m + l][k % C];
                A::axpy(&mut row, -weight, &done[piece * m + l]);
            }
            if piece == first {
                let (original, pivot) = (rest[0][k % C], row[k % C]);
                // a pivot that is rounding of the original entry says nothing about the sign
                if pivot.is_nan() || pivot <= 1e-15 * original.abs() {
                    return Err(NotConvex);
                }
                inverse[k] = 1.0 / pivot.sqrt();
            }
            row.iter_mut().for_each(|v| *v *= inverse[k]);
            rest[0] = row;
        }
    }
    Ok(())
}

/// Solves `U' y = x` in place with the inverse pivots at hand.
#[inline(always)]
pub(super) fn forward_scaled<A: Arithmetic, const C: usize>(
    upper: &[[f64; C]],
    inverse: &[f64],
    x: &mut [f64],
) {
    let m = x.len();
    for i in 0..m {
        let (done, rest) = x.split_at_mut(i);
        let mut sum = rest[0];
        for (row, y) in upper[i / C * m..].iter().zip(done) {
            sum = A::madd(-row[i % C], *y, sum);
        }
        rest[0] = sum * inverse[i];
    }
}

/// Solves `U x = y` in place with the inverse pivots at hand.
#[inline(always)]
pub(super) fn backward_scaled<A: Arithmetic, const C: usize>(
    upper: &[[f64; C]],
    inverse: &[f64],
    x: &mut [f64],
) {
    let m = x.len();
    for i in (0..m).rev() {
        let (rest, done) = x.split_at_mut(i);
        let value = done[0] * inverse[i];
        done[0] = value;
        for (row, y) in upper[i / C * m..].iter().zip(rest) {
            *y = A::madd(-row[i % C], value, *y);
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
