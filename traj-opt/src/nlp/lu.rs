//! LU factors of the small systems that couple the stages of a segment, on storage of the caller.

use nalgebra::SVector;

/// Factorises the row-major `n x n` matrix in place with row exchanges; `pivot[i]` is the row that was exchanged with row i.
/// A pivot of zero is replaced by the rounding unit: the step is then wrong and the line search refuses it.
pub(crate) fn factorise(a: &mut [f64], pivot: &mut [usize]) {
    let n = pivot.len();
    for k in 0..n {
        let mut best = k;
        for i in k + 1..n {
            if a[i * n + k].abs() > a[best * n + k].abs() {
                best = i;
            }
        }
        pivot[k] = best;
        if best != k {
            for j in 0..n {
                a.swap(k * n + j, best * n + j);
            }
        }
        if a[k * n + k] == 0.0 {
            a[k * n + k] = f64::EPSILON;
        }
        let (above, below) = a.split_at_mut((k + 1) * n);
        let row = &above[k * n..];
        for other in below.chunks_exact_mut(n) {
            let factor = other[k] / row[k];
            other[k] = factor;
            for j in k + 1..n {
                other[j] -= factor * row[j];
            }
        }
    }
}

#[inline]
fn get<const N: usize>(x: &[SVector<f64, N>], i: usize) -> f64 {
    x[i / N][i % N]
}

/// Solves `A y = x` in place; `x` is the concatenation of its vectors.
pub(crate) fn solve<const N: usize>(a: &[f64], pivot: &[usize], x: &mut [SVector<f64, N>]) {
    let n = pivot.len();
    for k in 0..n {
        swap(x, k, pivot[k]);
    }
    for k in 0..n {
        let value = get(x, k);
        for i in k + 1..n {
            x[i / N][i % N] -= a[i * n + k] * value;
        }
    }
    for k in (0..n).rev() {
        let mut value = get(x, k);
        for j in k + 1..n {
            value -= a[k * n + j] * get(x, j);
        }
        x[k / N][k % N] = value / a[k * n + k];
    }
}

/// Solves `A' y = x` in place.
pub(crate) fn solve_transposed<const N: usize>(a: &[f64], pivot: &[usize], x: &mut [SVector<f64, N>]) {
    let n = pivot.len();
    for k in 0..n {
        let mut value = get(x, k);
        for j in 0..k {
            value -= a[j * n + k] * get(x, j);
        }
        x[k / N][k % N] = value / a[k * n + k];
    }
    for k in (0..n).rev() {
        let mut value = get(x, k);
        for i in k + 1..n {
            value -= a[i * n + k] * get(x, i);
        }
        x[k / N][k % N] = value;
    }
    for k in (0..n).rev() {
        swap(x, k, pivot[k]);
    }
}

fn swap<const N: usize>(x: &mut [SVector<f64, N>], i: usize, j: usize) {
    let (a, b) = (get(x, i), get(x, j));
    x[i / N][i % N] = b;
    x[j / N][j % N] = a;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_solves_invert_the_product() {
        let a = [0.0, 2.0, 1.0, 3.0, 4.0, -1.0, 2.0, 0.5, 5.0, 0.1, -2.0, 1.0, 7.0, 1.0, 0.0, 3.0];
        let (mut lu, mut pivot) = (a, [0; 4]);
        factorise(&mut lu, &mut pivot);
        let y = [1.0, -2.0, 0.5, 3.0];
        for transposed in [false, true] {
            let product = |i: usize| {
                (0..4).map(|j| a[if transposed { j * 4 + i } else { i * 4 + j }] * y[j]).sum::<f64>()
            };
            let mut x = [SVector::from([product(0), product(1)]), SVector::from([product(2), product(3)])];
            if transposed {
                solve_transposed(&lu, &pivot, &mut x);
            } else {
                solve(&lu, &pivot, &mut x);
            }
            for i in 0..4 {
                assert!((get(&x, i) - y[i]).abs() < 1e-12, "{x:?}");
            }
        }
    }
}
