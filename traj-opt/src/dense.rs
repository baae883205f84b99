//! Products of small matrices whose sizes are known at compile time.
//!
//! Column by column, so that the inner loops have constant length and are unrolled and vectorised. nalgebra hands products
//! above 5 x 5 to a blocked routine for large matrices, whose packing costs more than the product itself at these sizes.

use nalgebra::{SMatrix, SVector};

/// Work to be compiled for several instruction sets.
pub(crate) trait Kernel {
    /// What the work results in.
    type Output;

    /// Does the work; `#[inline(always)]`, as must be everything inside that is to profit.
    fn run(self) -> Self::Output;
}

struct Dispatched<K>(K);

impl<K: Kernel> pulp::WithSimd for Dispatched<K> {
    type Output = K::Output;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> K::Output {
        self.0.run()
    }
}

/// Runs a kernel compiled for the widest vector instructions that the processor has. Products and sums stay separate
/// operations, so the results are the same to the bit whatever the instructions.
pub(crate) fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    pulp::Arch::new().dispatch(Dispatched(kernel))
}

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
        let mut column = [0.0; R];
        for k in 0..K {
            axpy(&mut column, b.data.0[j][k], &a.data.0[k]);
        }
        out.data.0[j] = column;
    }
    out
}

/// `a b` for an `a` of which some columns are zero: derivatives of a model by variables that it does not depend on.
#[inline(always)]
pub(crate) fn mul_thin<const R: usize, const K: usize, const C: usize>(
    a: &Matrix<R, K>,
    b: &Matrix<K, C>,
) -> Matrix<R, C> {
    let mut used = [0; K];
    let mut n_used = 0;
    for k in 0..K {
        if a.data.0[k].iter().any(|&v| v != 0.0) {
            used[n_used] = k;
            n_used += 1;
        }
    }
    let mut out = Matrix::<R, C>::zeros();
    for j in 0..C {
        let mut column = [0.0; R];
        for &k in &used[..n_used] {
            axpy(&mut column, b.data.0[j][k], &a.data.0[k]);
        }
        out.data.0[j] = column;
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
