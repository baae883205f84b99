//! Products of small matrices whose sizes are known at compile time.
//!
//! Column by column, so that the inner loops have constant length and are unrolled and vectorised. nalgebra hands products
//! above 5 x 5 to a blocked routine for large matrices, whose packing costs more than the product itself at these sizes.

use nalgebra::{SMatrix, SVector};

type Matrix<const R: usize, const C: usize> = SMatrix<f64, R, C>;

/// `y += a x`.
#[inline(always)]
pub(crate) fn axpy<const N: usize>(y: &mut [f64; N], a: f64, x: &[f64; N]) {
    for i in 0..N {
        y[i] += a * x[i];
    }
}

#[inline(always)]
pub(crate) fn dot<const N: usize>(x: &[f64; N], y: &[f64; N]) -> f64 {
    let mut sum = 0.0;
    for i in 0..N {
        sum += x[i] * y[i];
    }
    sum
}

/// The numbers of a vector as an array.
#[inline(always)]
pub(crate) fn array<const N: usize>(x: &SVector<f64, N>) -> &[f64; N] {
    &x.data.0[0]
}

/// The numbers of a vector as an array.
#[inline(always)]
pub(crate) fn array_mut<const N: usize>(x: &mut SVector<f64, N>) -> &mut [f64; N] {
    &mut x.data.0[0]
}

/// `a b`.
#[inline(always)]
pub(crate) fn mul<const R: usize, const K: usize, const C: usize>(
    a: &Matrix<R, K>,
    b: &Matrix<K, C>,
) -> Matrix<R, C> {
    let mut out = Matrix::<R, C>::zeros();
    for j in 0..C {
        let column = &mut out.data.0[j];
        for k in 0..K {
            axpy(column, b.data.0[j][k], &a.data.0[k]);
        }
    }
    out
}

/// `a x`.
#[inline(always)]
pub(crate) fn mul_vec<const R: usize, const K: usize>(
    a: &Matrix<R, K>,
    x: &SVector<f64, K>,
) -> SVector<f64, R> {
    let mut out = SVector::zeros();
    for k in 0..K {
        axpy(array_mut(&mut out), x[k], &a.data.0[k]);
    }
    out
}

/// `a' x`.
#[inline(always)]
pub(crate) fn tr_mul_vec<const R: usize, const K: usize>(
    a: &Matrix<K, R>,
    x: &SVector<f64, K>,
) -> SVector<f64, R> {
    SVector::from_fn(|i, _| dot(&a.data.0[i], array(x)))
}

/// `a' b`.
#[inline(always)]
pub(crate) fn tr_mul<const R: usize, const K: usize, const C: usize>(
    a: &Matrix<K, R>,
    b: &Matrix<K, C>,
) -> Matrix<R, C> {
    mul(&a.transpose(), b)
}

/// `m += a x x'`.
#[inline(always)]
pub(crate) fn rank_one<const N: usize>(m: &mut Matrix<N, N>, a: f64, x: &SVector<f64, N>) {
    for j in 0..N {
        axpy(&mut m.data.0[j], a * x[j], array(x));
    }
}

/// A vector from consecutive numbers.
#[inline(always)]
pub(crate) fn vector<const N: usize>(values: &[f64], offset: usize) -> SVector<f64, N> {
    SVector::from_column_slice(&values[offset..offset + N])
}
