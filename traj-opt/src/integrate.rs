//! The adaptive integrator with which trajectories are checked.
//!
//! Dormand and Prince's embedded Runge-Kutta pair of orders 5 and 4 with its continuous extension of order 4 (J. R. Dormand,
//! P. J. Prince, *A family of embedded Runge-Kutta formulae*, J. Comp. Appl. Math. 6, 1980; continuous extension and step
//! control after E. Hairer, S. P. Norsett, G. Wanner, *Solving Ordinary Differential Equations I*, sections II.4 to II.6).

use crate::Error;
use nalgebra::SVector;

/// Settings of the integrator.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct IntegrateOptions {
    /// Relative error allowed in a step. Default 1e-10.
    pub relative_tolerance: f64,
    /// Absolute error allowed in a step, in the units of each state. Default 1e-10.
    pub absolute_tolerance: f64,
    /// Limit of steps between two break points. Default 100 000.
    pub max_steps: usize,
}

impl Default for IntegrateOptions {
    fn default() -> Self {
        Self { relative_tolerance: 1e-10, absolute_tolerance: 1e-10, max_steps: 100_000 }
    }
}

impl IntegrateOptions {
    /// Sets both tolerances.
    #[must_use]
    pub fn with_tolerance(mut self, tolerance: f64) -> Self {
        (self.relative_tolerance, self.absolute_tolerance) = (tolerance, tolerance);
        self
    }

    /// Sets [`max_steps`](Self::max_steps).
    #[must_use]
    pub fn with_max_steps(mut self, n: usize) -> Self {
        self.max_steps = n;
        self
    }
}

/// A continuous trajectory as the integrator left it: between its steps a polynomial of order 4.
#[derive(Clone, Debug)]
pub struct Trajectory<const N: usize> {
    times: Vec<f64>,
    states: Vec<SVector<f64, N>>,
    /// Coefficients 2 to 5 of the continuous extension of each step (Hairer, Norsett, Wanner, eq. II.6.12 as coded in DOPRI5).
    dense: Vec<[SVector<f64, N>; 4]>,
}

impl<const N: usize> Trajectory<N> {
    /// A trajectory that consists of one state only.
    #[must_use]
    pub fn starting_at(time: f64, state: SVector<f64, N>) -> Self {
        Self { times: vec![time], states: vec![state], dense: vec![] }
    }

    /// Integrates on from the last state to `end`. Break points (jumps of the right-hand side) are hit by calling this once
    /// for each smooth piece.
    ///
    /// # Errors
    /// [`Error::IntegrationFailed`] or [`Error::TooManySteps`].
    pub fn extend(
        &mut self,
        mut rhs: impl FnMut(f64, &SVector<f64, N>) -> SVector<f64, N>,
        end: f64,
        options: &IntegrateOptions,
    ) -> Result<(), Error> {
        let (mut t, mut x) = (self.end_time(), *self.end_state());
        let span = end - t;
        if span == 0.0 {
            return Ok(());
        }
        let direction = span.signum();
        let mut h = span.abs() * 0.1;
        let mut k1 = rhs(t, &x);
        for _ in 0..options.max_steps {
            let remaining = (end - t).abs();
            // avoids a last step that is nothing but rounding
            let last = h * 1.000_001 >= remaining;
            let step = if last { end - t } else { direction * h };
            let (next, k7, error, dense) = dormand_prince(&mut rhs, t, &x, step, &k1, options);
            if error <= 1.0 {
                t = if last { end } else { t + step };
                (x, k1) = (next, k7);
                self.times.push(t);
                self.states.push(x);
                self.dense.push(dense);
                if last {
                    return Ok(());
                }
            }
            let factor = if error.is_finite() { 0.9 * error.max(1e-10).powf(-0.2) } else { 0.1 };
            h = step.abs() * factor.clamp(0.2, 5.0);
            if h.is_nan() || h <= 1e-14 * (1.0 + t.abs()) {
                return Err(Error::IntegrationFailed { time: t, step: h });
            }
        }
        Err(Error::TooManySteps { max_steps: options.max_steps, time: t })
    }

    /// State at a time, from the continuous extension; times outside are clamped to the ends.
    #[must_use]
    pub fn state_at(&self, time: f64) -> SVector<f64, N> {
        if self.dense.is_empty() {
            return self.states[0];
        }
        let forward = self.times[self.times.len() - 1] >= self.times[0];
        let before = |t: &f64| if forward { *t <= time } else { *t >= time };
        let k = self.times.partition_point(before).saturating_sub(1).min(self.dense.len() - 1);
        let s = ((time - self.times[k]) / (self.times[k + 1] - self.times[k])).clamp(0.0, 1.0);
        let [r2, r3, r4, r5] = &self.dense[k];
        let s1 = 1.0 - s;
        self.states[k] + (r2 + (r3 + (r4 + r5 * s1) * s) * s1) * s
    }

    /// Time of the first state, s.
    #[must_use]
    pub fn initial_time(&self) -> f64 {
        self.times[0]
    }

    /// Time of the last state, s.
    #[must_use]
    pub fn end_time(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// The last state.
    #[must_use]
    pub fn end_state(&self) -> &SVector<f64, N> {
        &self.states[self.states.len() - 1]
    }

    /// Times of the integrator's own steps.
    #[must_use]
    pub fn step_times(&self) -> &[f64] {
        &self.times
    }
}

/// Integrates `dx/dt = rhs(t, x)` from `(start, state)` to `end`, hitting the increasing `breaks` between them exactly.
///
/// # Arguments
/// `breaks`: times at which the right-hand side may jump; those outside the interval are ignored.
///
/// # Errors
/// [`Error::IntegrationFailed`] if the step size collapses or a derivative is not finite, [`Error::TooManySteps`].
///
/// # Examples
/// ```
/// use traj_opt::{IntegrateOptions, integrate};
/// use traj_opt::nalgebra::SVector;
///
/// let circle = integrate(|_, x| SVector::from([-x[1], x[0]]), 0.0, SVector::from([1.0, 0.0]), 6.0, &[], &IntegrateOptions::default())?;
/// assert!((circle.state_at(1.5)[0] - 1.5_f64.cos()).abs() < 1e-7);
/// assert!((circle.end_state()[1] - 6.0_f64.sin()).abs() < 1e-8);
/// # Ok::<(), traj_opt::Error>(())
/// ```
pub fn integrate<const N: usize>(
    mut rhs: impl FnMut(f64, &SVector<f64, N>) -> SVector<f64, N>,
    start: f64,
    state: SVector<f64, N>,
    end: f64,
    breaks: &[f64],
    options: &IntegrateOptions,
) -> Result<Trajectory<N>, Error> {
    let mut trajectory = Trajectory::starting_at(start, state);
    for &b in breaks.iter().filter(|&&b| b > start && b < end) {
        trajectory.extend(&mut rhs, b, options)?;
    }
    trajectory.extend(&mut rhs, end, options)?;
    Ok(trajectory)
}

type Step<const N: usize> = (SVector<f64, N>, SVector<f64, N>, f64, [SVector<f64, N>; 4]);

/// One step: new state, its derivative, scaled error, dense output.
fn dormand_prince<const N: usize>(
    rhs: &mut impl FnMut(f64, &SVector<f64, N>) -> SVector<f64, N>,
    t: f64,
    x: &SVector<f64, N>,
    h: f64,
    k1: &SVector<f64, N>,
    options: &IntegrateOptions,
) -> Step<N> {
    let k2 = rhs(t + 0.2 * h, &(x + k1 * (0.2 * h)));
    let k3 = rhs(t + 0.3 * h, &(x + (k1 * (3.0 / 40.0) + k2 * (9.0 / 40.0)) * h));
    let k4 = rhs(t + 0.8 * h, &(x + (k1 * (44.0 / 45.0) - k2 * (56.0 / 15.0) + k3 * (32.0 / 9.0)) * h));
    let x5 =
        k1 * (19372.0 / 6561.0) - k2 * (25360.0 / 2187.0) + k3 * (64448.0 / 6561.0) - k4 * (212.0 / 729.0);
    let k5 = rhs(t + h * (8.0 / 9.0), &(x + x5 * h));
    let x6 = k1 * (9017.0 / 3168.0) - k2 * (355.0 / 33.0) + k3 * (46732.0 / 5247.0) + k4 * (49.0 / 176.0)
        - k5 * (5103.0 / 18656.0);
    let k6 = rhs(t + h, &(x + x6 * h));
    let increment = k1 * (35.0 / 384.0) + k3 * (500.0 / 1113.0) + k4 * (125.0 / 192.0)
        - k5 * (2187.0 / 6784.0)
        + k6 * (11.0 / 84.0);
    let next = x + increment * h;
    let k7 = rhs(t + h, &next);
    let error = k1 * (71.0 / 57600.0) - k3 * (71.0 / 16695.0) + k4 * (71.0 / 1920.0)
        - k5 * (17253.0 / 339_200.0)
        + k6 * (22.0 / 525.0)
        - k7 * (1.0 / 40.0);
    let mut sum = 0.0;
    for i in 0..N {
        let scale = options.absolute_tolerance + options.relative_tolerance * x[i].abs().max(next[i].abs());
        sum += (error[i] * h / scale).powi(2);
    }
    let r2 = next - x;
    let r3 = k1 * h - r2;
    let r4 = r2 - k7 * h - r3;
    let r5 = (k1 * (-12_715_105_075.0 / 11_282_082_432.0) + k3 * (87_487_479_700.0 / 32_700_410_799.0)
        - k4 * (10_690_763_975.0 / 1_880_347_072.0)
        + k5 * (701_980_252_875.0 / 199_316_789_632.0)
        - k6 * (1_453_857_185.0 / 822_651_844.0)
        + k7 * (69_997_945.0 / 29_380_423.0))
        * h;
    (next, k7, (sum / N.max(1) as f64).sqrt(), [r2, r3, r4, r5])
}
