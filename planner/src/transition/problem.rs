//! The minimum-time problem of one transition.

use super::flight::{Flight, attitude_error, real};
use crate::circles::Orbit;
use nalgebra::{RealField, SVector, Vector3};
use quad_dynamics::frames::to_wxyz;
use quad_dynamics::{Direction, Motion};
use traj_opt::{Bounds, Hessian, Problem};

/// A vertical cylinder to stay out of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct KeepOut {
    pub centre: [f64; 2],
    pub radius: f64,
}

/// Where a transition may end.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Goal<'a> {
    /// In one motion.
    Motion(Motion),
    /// Hovering at the place of this motion, with any yaw.
    Hover(Motion),
    /// Anywhere on a circle, in this direction.
    Circle(&'a Orbit, Direction),
}

/// `min t_f` from a start to a goal, around the keep-outs, between two heights, within the model's limits.
pub(crate) struct MinimumTime<'a, F> {
    pub flight: &'a F,
    pub start: Motion,
    pub goal: Goal<'a>,
    pub keep_outs: &'a [KeepOut],
    pub heights: [f64; 2],
}

/// Limits are divided by this, so that a loiter flown at the very limit leaves the solver an interior.
const LIMIT_SLACK: f64 = 1.0 + 1e-6;

/// What separates a state from the loiter on `orbit` at the angle where the state lies: radius, velocity, and attitude
/// or acceleration if the model has one. Zero at every entry in this direction.
fn circle_error<T: RealField + Copy, const NX: usize>(
    orbit: &Orbit,
    direction: Direction,
    attitude: Option<usize>,
    state: &SVector<T, NX>,
    values: &mut [T],
) {
    let [x, y] = orbit.circle.centre;
    let radius: T = real(orbit.circle.radius);
    let (dx, dy) = (state[0] - real(x), state[1] - real(y));
    let (cos, sin) = (dx / radius, dy / radius);
    let at_zero = orbit.loiter.state(0.0, direction);
    let turned = |v: &Vector3<f64>| {
        let (x, y): (T, T) = (real(v.x), real(v.y));
        [cos * x - sin * y, sin * x + cos * y, real(v.z)]
    };
    values[0] = (cos * cos + sin * sin - T::one()) * radius;
    let velocity = turned(&at_zero.velocity);
    for axis in 0..3 {
        values[1 + axis] = state[3 + axis] - velocity[axis];
    }
    if let Some(first) = attitude {
        let (s, c) = (dy.atan2(dx) * real(0.5)).sin_cos();
        let [w, x, y, z]: [T; 4] = to_wxyz(&at_zero.attitude).map(real).into();
        let goal = [c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w];
        let q = [state[first], state[first + 1], state[first + 2], state[first + 3]];
        values[4..7].copy_from_slice(&attitude_error(&goal, &q));
    } else if NX >= 9 {
        let acceleration = turned(&at_zero.acceleration);
        for axis in 0..3 {
            values[4 + axis] = state[6 + axis] - acceleration[axis];
        }
    }
}

impl<const NX: usize, const NU: usize, F: Flight<NX, NU>> Problem<NX, NU> for MinimumTime<'_, F> {
    type Dynamics = F;

    fn dynamics(&self) -> &F {
        self.flight
    }

    fn is_autonomous(&self) -> bool {
        true
    }

    fn bounds(&self) -> Bounds<NX, NU> {
        let (least, greatest) = self.flight.control_bounds();
        let (mut lower, mut upper) = self.flight.state_bounds();
        (lower[2], upper[2]) = (self.heights[0], self.heights[1]);
        let mut bounds = Bounds::free()
            .with_state(lower, upper)
            .with_control(least, greatest)
            .with_initial_state(self.flight.state(&self.start))
            .with_final_time(1e-3, f64::INFINITY);
        let mut fix = |index: usize, value: f64| bounds = bounds.with_terminal_component(index, value);
        // The attitude is never fixed here: a quaternion and its negative are the same, and four components too many.
        let free = F::ATTITUDE.map_or(NX..NX, |first| first..first + 4);
        match self.goal {
            Goal::Motion(goal) | Goal::Hover(goal) => {
                let state = self.flight.state(&goal);
                (0..NX).filter(|i| !free.contains(i)).for_each(|i| fix(i, state[i]));
                if let (Goal::Hover(_), Some(first)) = (self.goal, F::ATTITUDE)
                    && goal.tilt() == 0.0
                {
                    // Level: the body's z axis is vertical exactly when the quaternion's x and y vanish.
                    fix(first + 1, 0.0);
                    fix(first + 2, 0.0);
                }
            }
            Goal::Circle(orbit, direction) => {
                fix(2, orbit.circle.height);
                let state = self.flight.state(&orbit.loiter.state(0.0, direction));
                (free.end..NX).for_each(|i| fix(i, state[i]));
            }
        }
        bounds
    }

    fn mayer<T: RealField + Copy>(&self, _: &SVector<T, NX>, _: &SVector<T, NX>, final_time: T) -> T {
        final_time
    }

    fn n_path(&self) -> usize {
        self.keep_outs.len() + self.flight.n_limits()
    }

    fn path<T: RealField + Copy>(
        &self,
        _: T,
        state: &SVector<T, NX>,
        control: &SVector<T, NU>,
        values: &mut [T],
    ) {
        let (cylinders, limits) = values.split_at_mut(self.keep_outs.len());
        for (value, keep_out) in cylinders.iter_mut().zip(self.keep_outs) {
            let (dx, dy) = (state[0] - real(keep_out.centre[0]), state[1] - real(keep_out.centre[1]));
            *value = (dx * dx + dy * dy) / real(keep_out.radius * keep_out.radius);
        }
        self.flight.limits(state, control, limits);
    }

    fn path_gradients(
        &self,
        state: &SVector<f64, NX>,
        _: &SVector<f64, NU>,
        by_state: &mut [SVector<f64, NX>],
        by_control: &mut [SVector<f64, NU>],
    ) -> bool {
        if self.flight.n_limits() > 0 {
            return false;
        }
        by_control.fill(SVector::zeros());
        for (gradient, keep_out) in by_state.iter_mut().zip(self.keep_outs) {
            let scale = 2.0 / (keep_out.radius * keep_out.radius);
            *gradient = SVector::zeros();
            for axis in 0..2 {
                gradient[axis] = scale * (state[axis] - keep_out.centre[axis]);
            }
        }
        true
    }

    fn path_hessian(
        &self,
        _: &SVector<f64, NX>,
        _: &SVector<f64, NU>,
        weights: &[f64],
        sum: &mut Hessian<NX, NU>,
    ) -> bool {
        if self.flight.n_limits() > 0 {
            return false;
        }
        for (weight, keep_out) in weights.iter().zip(self.keep_outs) {
            let curvature = 2.0 * weight / (keep_out.radius * keep_out.radius);
            sum.state_state[(0, 0)] += curvature;
            sum.state_state[(1, 1)] += curvature;
        }
        true
    }

    fn path_bounds(&self, index: usize) -> (f64, f64) {
        if index < self.keep_outs.len() { (1.0, f64::INFINITY) } else { (f64::NEG_INFINITY, LIMIT_SLACK) }
    }

    fn n_boundary(&self) -> usize {
        match self.goal {
            Goal::Motion(_) if F::ATTITUDE.is_some() => 3,
            // In wind a hover leans; what is left to the yaw is a turn about the thrust.
            Goal::Hover(goal) if F::ATTITUDE.is_some() && goal.tilt() > 0.0 => 2,
            Goal::Motion(_) | Goal::Hover(_) => 0,
            Goal::Circle(..) if F::ATTITUDE.is_some() || NX >= 9 => 7,
            Goal::Circle(..) => 4,
        }
    }

    fn boundary<T: RealField + Copy>(
        &self,
        _: &SVector<T, NX>,
        end: &SVector<T, NX>,
        _: T,
        values: &mut [T],
    ) {
        match (self.goal, F::ATTITUDE) {
            (Goal::Circle(orbit, direction), attitude) => {
                circle_error(orbit, direction, attitude, end, values)
            }
            (Goal::Motion(goal) | Goal::Hover(goal), Some(first)) => {
                let q = [end[first], end[first + 1], end[first + 2], end[first + 3]];
                let error = attitude_error(&to_wxyz(&goal.attitude).map(real).into(), &q);
                values.copy_from_slice(&error[..values.len()]);
            }
            _ => {}
        }
    }
}
