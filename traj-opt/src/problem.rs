//! The optimal control problem: cost, bounds, path constraints, boundary conditions.

use crate::{Bounds, ConstraintKind, Dynamics, Hessian, Location};
use nalgebra::{RealField, SVector};

/// A single-phase optimal control problem in Bolza form:
///
/// ```text
/// minimise    mayer(x(t0), x(tf), tf) + integral of lagrange(t, x, u) over [t0, tf]
/// subject to  dx/dt = f(t, x, u)
///             bounds on x, u, x(t0), x(tf), tf                                    (component-wise)
///             path_bounds.0     <= path(t, x, u)             <= path_bounds.1     (at every collocation point)
///             boundary_bounds.0 <= boundary(x(t0), x(tf), tf) <= boundary_bounds.1
/// ```
///
/// Every function is generic over the scalar, so that first and second derivatives come from automatic differentiation.
/// Methods with a default may be left out. The trait is open.
pub trait Problem<const NX: usize, const NU: usize> {
    /// The equation of motion.
    type Dynamics: Dynamics<NX, NU>;

    /// The equation of motion.
    fn dynamics(&self) -> &Self::Dynamics;

    /// Bounds on states, controls, start, end and final time.
    fn bounds(&self) -> Bounds<NX, NU>;

    /// Cost of the end points. Default: zero. Minimum time: return `final_time`.
    fn mayer<T: RealField + Copy>(
        &self,
        _initial: &SVector<T, NX>,
        _terminal: &SVector<T, NX>,
        _final_time: T,
    ) -> T {
        T::zero()
    }

    /// Running cost; `None` (the default) if there is none, which saves its derivatives.
    fn lagrange<T: RealField + Copy>(
        &self,
        _time: T,
        _state: &SVector<T, NX>,
        _control: &SVector<T, NU>,
    ) -> Option<T> {
        None
    }

    /// Number of path constraints.
    fn n_path(&self) -> usize {
        0
    }

    /// Writes the `n_path` path functions `g(t, x, u)`.
    fn path<T: RealField + Copy>(
        &self,
        _time: T,
        _state: &SVector<T, NX>,
        _control: &SVector<T, NU>,
        _values: &mut [T],
    ) {
    }

    /// Writes the gradient of every path function by state and by control (not by time), and returns true; a problem that
    /// returns false, the default, is differentiated automatically. Only asked of [autonomous](Self::is_autonomous) problems.
    fn path_gradients(
        &self,
        _state: &SVector<f64, NX>,
        _control: &SVector<f64, NU>,
        _by_state: &mut [SVector<f64, NX>],
        _by_control: &mut [SVector<f64, NU>],
    ) -> bool {
        false
    }

    /// Adds the second derivatives of the `weights`-weighted sum of the path functions to `sum`, and returns true; must do so
    /// if and only if [`path_gradients`](Self::path_gradients) does.
    fn path_hessian(
        &self,
        _state: &SVector<f64, NX>,
        _control: &SVector<f64, NU>,
        _weights: &[f64],
        _sum: &mut Hessian<NX, NU>,
    ) -> bool {
        false
    }

    /// Lower and upper bound of path function `index`; infinite where there is none.
    fn path_bounds(&self, _index: usize) -> (f64, f64) {
        (0.0, f64::INFINITY)
    }

    /// Number of boundary constraints (beside the component-wise bounds on the end states).
    fn n_boundary(&self) -> usize {
        0
    }

    /// Writes the `n_boundary` boundary functions of the end points.
    fn boundary<T: RealField + Copy>(
        &self,
        _initial: &SVector<T, NX>,
        _terminal: &SVector<T, NX>,
        _final_time: T,
        _values: &mut [T],
    ) {
    }

    /// Lower and upper bound of boundary function `index`; equal for an equality. Default: `(0, 0)`.
    fn boundary_bounds(&self, _index: usize) -> (f64, f64) {
        (0.0, 0.0)
    }

    /// True if running cost and path functions do not depend on time; saves derivatives. Default: false (always safe).
    fn is_autonomous(&self) -> bool {
        false
    }

    /// Number of phases: 1 unless the problem is made of several, as [`Linked`](crate::Linked) is.
    fn n_phases(&self) -> usize {
        1
    }

    /// The clock of the problem when the solver's time is `time`. Default: the same.
    fn clock<T: RealField + Copy>(&self, time: T, _state: &SVector<T, NX>) -> T {
        time
    }

    /// Phase and clock of a constraint, for diagnoses. Default: phase 0, the same time.
    fn locate(&self, kind: ConstraintKind, index: usize, time: f64, _state: &SVector<f64, NX>) -> Location {
        Location { kind, index, phase: 0, time }
    }

    /// Typical magnitudes of the variables; default: taken from the bounds and the guess.
    fn scales(&self) -> Option<Scales<NX, NU>> {
        None
    }
}

/// Typical magnitudes of states, controls and final time (all positive). They enter the norms in which convergence is
/// judged and the size of regularisations, nothing else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales<const NX: usize, const NU: usize> {
    /// Magnitude of each state.
    pub state: SVector<f64, NX>,
    /// Magnitude of each control.
    pub control: SVector<f64, NU>,
    /// Magnitude of the final time, s.
    pub time: f64,
}
