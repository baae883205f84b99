//! What a model of the vehicle must tell before a transition with it can be planned.

use crate::bound::Agility;
use crate::mission::Model;
use nalgebra::{RealField, SVector};
use quad_dynamics::Motion;
use traj_opt::Dynamics;

/// A model with the limits that a transition keeps.
pub(crate) trait Flight<const NX: usize, const NU: usize>: Dynamics<NX, NU> + Clone + Sync {
    /// Its name in the plan.
    const MODEL: Model;

    /// How many bounds and limits are active in a segment of a fast flight, as seen: on average, and at most. Each makes the time of a
    /// barrier problem longer by about its barrier parameter.
    const ACTIVE_BOUNDS: [f64; 2] = [1.4, 1.8];

    /// The model's state in a motion.
    fn state(&self, motion: &Motion) -> SVector<f64, NX>;

    /// The control that holds a hover.
    fn hover_control(&self) -> SVector<f64, NU>;

    /// Least and greatest control, component by component.
    fn control_bounds(&self) -> (SVector<f64, NU>, SVector<f64, NU>);

    /// Least and greatest value of each state on the way; infinite where there is none. Heights are not its business.
    fn state_bounds(&self) -> (SVector<f64, NX>, SVector<f64, NX>) {
        (SVector::repeat(f64::NEG_INFINITY), SVector::repeat(f64::INFINITY))
    }

    /// Number of further limits.
    fn n_limits(&self) -> usize {
        0
    }

    /// The limits as functions that must not exceed 1.
    fn limits<T: RealField + Copy>(
        &self,
        _state: &SVector<T, NX>,
        _control: &SVector<T, NU>,
        _values: &mut [T],
    ) {
    }

    /// What a lower bound on times may count on; `None` if the model moves by other rules than thrust and drag.
    fn agility(&self) -> Option<Agility>;

    /// Where the attitude stands in the state (w first), if it does.
    const ATTITUDE: Option<usize>;

    /// Everything about one moment.
    fn motion(&self, state: &SVector<f64, NX>, control: &SVector<f64, NU>) -> Motion;
}

/// A number as the scalar of an automatic differentiation.
pub(crate) fn real<T: RealField>(value: f64) -> T {
    nalgebra::convert(value)
}

/// Vector part of `goal^-1 q`: zero if and only if the unit quaternion `q` is `goal` or `-goal`, the same attitude.
pub(crate) fn attitude_error<T: RealField + Copy>(goal: &[T; 4], q: &[T; 4]) -> [T; 3] {
    let [gw, gx, gy, gz] = *goal;
    let [w, x, y, z] = *q;
    [gw * x - gx * w - gy * z + gz * y, gw * y + gx * z - gy * w - gz * x, gw * z - gx * y + gy * x - gz * w]
}
