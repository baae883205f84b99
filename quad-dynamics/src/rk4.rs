//! Fixed-step integration.

use nalgebra::{RealField, SVector};

/// One step of the classical fourth-order Runge-Kutta method for `x' = f(x)`, autonomous (control held).
///
/// Source: W. Kutta (1901), the 3/6-weights form. Local error O(step^5). Does not allocate; generic, so that
/// derivatives flow through.
///
/// ```
/// use quad_dynamics::{nalgebra::SVector, rk4_step};
/// let x = rk4_step(|x: &SVector<f64, 1>| -x, &SVector::from([1.0]), 0.1);
/// assert!((x[0] - (-0.1_f64).exp()).abs() < 1e-7);
/// ```
#[must_use]
pub fn rk4_step<T, F, const N: usize>(f: F, x: &SVector<T, N>, step: T) -> SVector<T, N>
where
    T: RealField + Copy,
    F: Fn(&SVector<T, N>) -> SVector<T, N>,
{
    let half = step * nalgebra::convert(0.5);
    let sixth = step * nalgebra::convert(1.0 / 6.0);
    let two: T = nalgebra::convert(2.0);
    let k1 = f(x);
    let k2 = f(&(x + k1 * half));
    let k3 = f(&(x + k2 * half));
    let k4 = f(&(x + k3 * step));
    x + (k1 + (k2 + k3) * two + k4) * sixth
}

/// `n_steps` equal Runge-Kutta steps over `duration`; zero steps return `x`.
#[must_use]
pub fn rk4<T, F, const N: usize>(f: F, x: &SVector<T, N>, duration: T, n_steps: usize) -> SVector<T, N>
where
    T: RealField + Copy,
    F: Fn(&SVector<T, N>) -> SVector<T, N>,
{
    let count: T = nalgebra::convert(n_steps.max(1) as f64);
    let step = duration / count;
    (0..n_steps).fold(*x, |x, _| rk4_step(&f, &x, step))
}

/// [`rk4_step`] for a state that holds a quaternion `(w, x, y, z)` from entry `quaternion` on, whose norm is 1 after the
/// step: the result is projected back, which costs nothing of the order (the norm drifts by O(step^5) in a step).
///
/// # Panics
/// If `quaternion + 4 > N`, as for a slice.
#[must_use]
pub fn rk4_step_unit<T, F, const N: usize>(
    f: F,
    x: &SVector<T, N>,
    step: T,
    quaternion: usize,
) -> SVector<T, N>
where
    T: RealField + Copy,
    F: Fn(&SVector<T, N>) -> SVector<T, N>,
{
    let mut next = rk4_step(f, x, step);
    let norm = next.fixed_rows::<4>(quaternion).norm();
    for i in quaternion..quaternion + 4 {
        next[i] /= norm;
    }
    next
}
