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
    fn run<A: Arithmetic>(self) -> Self::Output;
}

/// Runs a kernel compiled for the widest vector instructions that the processor has, with fused multiply-add where the
/// processor has that; up to those of 256 bits, since those of 512 take 9 % longer on a processor that has them (rows here are as long as
/// a model has states, and rarely fill them). Results are the same to the bit on the same machine, and differ in rounding between machines.
#[cfg(target_arch = "x86_64")]
pub(crate) fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    struct Wide<K>(K);
    impl<K: Kernel> pulp::NullaryFnOnce for Wide<K> {
        type Output = K::Output;

        #[inline(always)]
        fn call(self) -> K::Output {
            self.0.run::<Fused>()
        }
    }
    match pulp::x86::V3::try_new() {
        Some(simd) => simd.vectorize(Wide(kernel)),
        None => kernel.run::<Separate>(),
    }
}

/// Runs a kernel; this processor always has fused multiply-add and no wider vectors to choose.
#[cfg(target_arch = "aarch64")]
pub(crate) fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Fused>()
}

/// Runs a kernel.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
pub(crate) fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    kernel.run::<Separate>()
}

/// Multiplication and addition in one instruction, which only kernels may use: elsewhere it is a slow function call.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
#[derive(Clone, Copy)]
pub(crate) struct Fused;

/// Multiplication, then addition.
#[derive(Clone, Copy)]
pub(crate) struct Separate;

#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
impl Arithmetic for Fused {
    const FUSED: bool = true;

    #[inline(always)]
    fn madd(a: f64, b: f64, c: f64) -> f64 {
        a.mul_add(b, c)
    }
}

impl Arithmetic for Separate {
    const FUSED: bool = false;

    #[inline(always)]
    fn madd(a: f64, b: f64, c: f64) -> f64 {
        a * b + c
    }
}

/// Whether [`dispatch`] runs kernels with [`Fused`] arithmetic on this processor.
pub(crate) fn is_fused() -> bool {
    struct IsFused;
    impl Kernel for IsFused {
        type Output = bool;

        #[inline(always)]
        fn run<A: Arithmetic>(self) -> bool {
            A::FUSED
        }
    }
    dispatch(IsFused)
}

/// Numbers that one instruction of the narrower kind takes.
pub(crate) const LANES: usize = 4;
/// A piece of a row whose length is known at run time only.
pub(crate) type Lanes = [f64; LANES];
/// Rows of equal length, side by side.
pub(crate) type Panel<const N: usize> = [Lanes; N];

/// Number of pieces of a row of `n` numbers.
pub(crate) fn pieces(n: usize) -> usize {
    n.div_ceil(LANES)
}

/// Rows of `W` numbers, one after another.
#[inline(always)]
pub(crate) fn rows<const W: usize>(numbers: &[f64]) -> &[[f64; W]] {
    numbers.as_chunks().0
}

/// Rows of `W` numbers, one after another.
#[inline(always)]
pub(crate) fn rows_mut<const W: usize>(numbers: &mut [f64]) -> &mut [[f64; W]] {
    numbers.as_chunks_mut().0
}

/// Panels of `N` rows of `W` numbers, one after another.
#[inline(always)]
pub(crate) fn panels<const W: usize, const N: usize>(numbers: &[f64]) -> &[[[f64; W]; N]] {
    rows(numbers).as_chunks().0
}

/// Panels of `N` rows of `W` numbers, one after another.
#[inline(always)]
pub(crate) fn panels_mut<const W: usize, const N: usize>(numbers: &mut [f64]) -> &mut [[[f64; W]; N]] {
    rows_mut(numbers).as_chunks_mut().0
}

/// A piece of a row, padded with zeros.
#[inline(always)]
pub(crate) fn piece_of(row: &[f64], piece: usize) -> Lanes {
    let (whole, rest) = row.as_chunks::<LANES>();
    match whole.get(piece) {
        Some(piece) => *piece,
        None => {
            let mut padded = [0.0; LANES];
            padded[..rest.len()].copy_from_slice(rest);
            padded
        }
    }
}

/// Lays columns side by side in panels.
#[inline(always)]
pub(crate) fn fill_panels<const N: usize>(columns: &[SVector<f64, N>], panels: &mut [Panel<N>]) {
    for (columns, panel) in columns.chunks(LANES).zip(panels) {
        if let [a, b, c, d] = columns {
            for i in 0..N {
                panel[i] = [a[i], b[i], c[i], d[i]];
            }
            continue;
        }
        for (lane, column) in columns.iter().enumerate() {
            for i in 0..N {
                panel[i][lane] = column[i];
            }
        }
    }
}

/// Which columns of a matrix are zero.
#[inline(always)]
pub(crate) fn zero_columns<const R: usize, const N: usize>(a: &Matrix<R, N>) -> [bool; N] {
    let mut zero = [false; N];
    for k in 0..N {
        zero[k] = is_zero(&a.data.0[k]);
    }
    zero
}

/// True if all numbers are zero; no early end, so that it is done with wide instructions.
#[inline(always)]
fn is_zero<const N: usize>(x: &[f64; N]) -> bool {
    let mut bits = 0;
    for v in x {
        bits |= v.to_bits() << 1;
    }
    bits == 0
}

/// True for column `j` of the identity: of a map that adds a variable to what it was and depends on it no further.
#[inline(always)]
pub(crate) fn is_unit<const N: usize>(x: &[f64; N], j: usize) -> bool {
    let mut rest = [0.0; N];
    for i in 0..N {
        // not one store to rest[j], on which the wide loads that follow would wait
        rest[i] = x[i] - if i == j { 1.0 } else { 0.0 };
    }
    is_zero(&rest)
}

/// Products of small matrices in one way of rounding.
pub(crate) trait Arithmetic {
    /// Multiplication and addition are one instruction, of vectors as wide as the processor has them.
    const FUSED: bool;

    /// `a b + c`.
    fn madd(a: f64, b: f64, c: f64) -> f64;

    /// `y += a x`.
    #[inline(always)]
    fn axpy<const N: usize>(y: &mut [f64; N], a: f64, x: &[f64; N]) {
        for i in 0..N {
            y[i] = Self::madd(a, x[i], y[i]);
        }
    }

    /// `x . y`, in four sums.
    #[inline(always)]
    fn dot<const N: usize>(x: &[f64; N], y: &[f64; N]) -> f64 {
        let mut sums = [0.0; LANES];
        for i in 0..N / LANES {
            for lane in 0..LANES {
                let at = i * LANES + lane;
                sums[lane] = Self::madd(x[at], y[at], sums[lane]);
            }
        }
        for at in N / LANES * LANES..N {
            sums[at % LANES] = Self::madd(x[at], y[at], sums[at % LANES]);
        }
        (sums[0] + sums[2]) + (sums[1] + sums[3])
    }

    /// `a b`.
    #[inline(always)]
    fn mul<const R: usize, const K: usize, const C: usize>(
        a: &Matrix<R, K>,
        b: &Matrix<K, C>,
    ) -> Matrix<R, C> {
        let mut out = Matrix::<R, C>::zeros();
        for j in 0..C {
            let mut column = [0.0; R];
            for k in 0..K {
                Self::axpy(&mut column, b.data.0[j][k], &a.data.0[k]);
            }
            out.data.0[j] = column;
        }
        out
    }

    /// `a x`.
    #[inline(always)]
    fn mul_vec<const R: usize, const K: usize>(a: &Matrix<R, K>, x: &SVector<f64, K>) -> SVector<f64, R> {
        let mut out = [0.0; R];
        for k in 0..K {
            Self::axpy(&mut out, x[k], &a.data.0[k]);
        }
        SVector::from(out)
    }

    /// `a' x`.
    #[inline(always)]
    fn tr_mul_vec<const R: usize, const K: usize>(a: &Matrix<K, R>, x: &SVector<f64, K>) -> SVector<f64, R> {
        // no closure: one handed to a function that is not inlined would be compiled without the wide instructions
        let mut out = [0.0; R];
        for i in 0..R {
            out[i] = Self::dot(&a.data.0[i], array(x));
        }
        SVector::from(out)
    }

    /// `start` plus the sum over k of `x[k] rows[k]`.
    #[inline(always)]
    fn combine<const N: usize, const W: usize>(
        start: [f64; W],
        x: &[f64; N],
        rows: &[[f64; W]; N],
    ) -> [f64; W] {
        let mut sum = start;
        for k in 0..N {
            Self::axpy(&mut sum, x[k], &rows[k]);
        }
        sum
    }

    /// `row += x' panels`, a row in pieces of which the last may be shorter.
    #[inline(always)]
    fn add_pieces<const N: usize>(row: &mut [f64], x: &[f64; N], panels: &[Panel<N>]) {
        let (whole, rest) = row.as_chunks_mut::<LANES>();
        for (piece, panel) in whole.iter_mut().zip(panels) {
            *piece = Self::combine(*piece, x, panel);
        }
        if let Some(panel) = panels.get(whole.len()) {
            let sums = Self::combine([0.0; LANES], x, panel);
            for (r, sum) in rest.iter_mut().zip(sums) {
                *r += sum;
            }
        }
    }

    /// Inverse by Gauss-Jordan elimination with pivots chosen in rows; `None` if a pivot is zero. Columns that are `idle` are
    /// those of the identity, as they then are in the inverse.
    #[inline(always)]
    fn inverse<const N: usize>(a: &Matrix<N, N>, idle: &[bool; N]) -> Option<Matrix<N, N>> {
        let mut c = a.data.0;
        let (mut order, mut exchanged) = ([0; N], false);
        for (i, place) in order.iter_mut().enumerate() {
            *place = i;
        }
        for k in 0..N {
            if idle[k] {
                continue;
            }
            let mut best = k;
            for j in k + 1..N {
                if c[j][k].abs() > c[best][k].abs() {
                    best = j;
                }
            }
            if c[best][k].is_nan() || c[best][k] == 0.0 {
                return None;
            }
            // an idle column has nothing in this row and is never exchanged
            if best != k {
                c.swap(k, best);
                order.swap(k, best);
                exchanged = true;
            }
            let pivot = 1.0 / c[k][k];
            let own = c[k];
            for j in 0..N {
                if j == k || idle[j] {
                    continue;
                }
                let share = c[j][k] * pivot;
                for i in 0..N {
                    let reduced = Self::madd(-share, own[i], c[j][i]);
                    c[j][i] = if i == k { share } else { reduced };
                }
            }
            for i in 0..N {
                c[k][i] = if i == k { pivot } else { -own[i] * pivot };
            }
        }
        if !exchanged {
            return Some(Matrix::from_data(nalgebra::ArrayStorage(c)));
        }
        // rows of the inverse belong to the columns as they were before the exchanges
        let mut out = Matrix::<N, N>::zeros();
        for j in 0..N {
            for i in 0..N {
                out.data.0[j][order[i]] = c[j][i];
            }
        }
        Some(out)
    }
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
    Separate::mul(a, b)
}

/// `a x`.
#[inline(always)]
pub(crate) fn mul_vec<const R: usize, const K: usize>(
    a: &Matrix<R, K>,
    x: &SVector<f64, K>,
) -> SVector<f64, R> {
    Separate::mul_vec(a, x)
}

/// `a' x`.
#[inline(always)]
pub(crate) fn tr_mul_vec<const R: usize, const K: usize>(
    a: &Matrix<K, R>,
    x: &SVector<f64, K>,
) -> SVector<f64, R> {
    let mut out = [0.0; R];
    for i in 0..R {
        out[i] = dot(&a.data.0[i], array(x));
    }
    SVector::from(out)
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
    // not from_column_slice, which goes number by number
    let mut out = [0.0; N];
    out.copy_from_slice(&values[offset..offset + N]);
    SVector::from(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Of matrices with columns of the identity, with and without zeros on the diagonal that force exchanges.
        #[test]
        fn inverse_times_matrix_is_the_identity(
            entries in prop::array::uniform5(prop::array::uniform5(-1.0..1.0f64)),
            idle in prop::array::uniform5(prop::bool::ANY),
            hollow in prop::bool::ANY,
        ) {
            let mut a = Matrix::<5, 5>::from_fn(|i, j| entries[j][i]);
            for j in 0..5 {
                if idle[j] {
                    a.set_column(j, &Matrix::<5, 5>::identity().column(j));
                } else if hollow {
                    a[(j, j)] = 0.0;
                }
            }
            prop_assume!(a.determinant().abs() > 1e-2);
            let inverse = Separate::inverse(&a, &idle).expect("not singular");
            prop_assert!((mul(&inverse, &a) - Matrix::identity()).amax() < 1e-9);
            for j in (0..5).filter(|j| idle[*j]) {
                prop_assert!(inverse.column(j) == Matrix::<5, 5>::identity().column(j));
            }
        }
    }

    #[test]
    fn a_singular_matrix_has_no_inverse() {
        let mut a = Matrix::<3, 3>::identity();
        a[(1, 1)] = 0.0;
        assert!(Separate::inverse(&a, &[true, false, true]).is_none());
    }

    #[test]
    fn rows_in_pieces_equal_products() {
        let columns: [SVector<f64, 3>; 6] =
            std::array::from_fn(|j| SVector::from_fn(|i, _| (7 * i + 3 * j) as f64 - 5.0));
        let mut panels = [[[0.0; LANES]; 3]; 2];
        fill_panels(&columns, &mut panels);
        let x = [1.0, -2.0, 0.5];
        let mut row = [1.0; 6];
        Separate::add_pieces(&mut row, &x, &panels);
        for j in 0..6 {
            assert_eq!(row[j], 1.0 + dot(&x, array(&columns[j])));
        }
        assert_eq!(piece_of(&row, 1), [row[4], row[5], 0.0, 0.0]);
    }
}
