//! Where the solver starts.

use crate::interpolate::bracket;
use crate::mesh::MOST;
use crate::{Error, Solution};
use nalgebra::SVector;

/// A first trajectory: samples over the flight, interpolated linearly onto the mesh, and a final time.
#[derive(Clone, Debug, PartialEq)]
pub struct Guess<const NX: usize, const NU: usize> {
    final_time: f64,
    fractions: Vec<f64>,
    states: Vec<SVector<f64, NX>>,
    controls: Vec<SVector<f64, NU>>,
}

impl<const NX: usize, const NU: usize> Guess<NX, NU> {
    /// A straight line from `initial` to `terminal` with a constant control; `final_time` in s.
    #[must_use]
    pub fn line(
        initial: SVector<f64, NX>,
        terminal: SVector<f64, NX>,
        control: SVector<f64, NU>,
        final_time: f64,
    ) -> Self {
        Self {
            final_time,
            fractions: vec![0.0, 1.0],
            states: vec![initial, terminal],
            controls: vec![control; 2],
        }
    }

    /// Samples `(fraction, state, control)` of a function of the fraction of the flight at `n + 1` equidistant points, `n` from 1
    /// to 2^20.
    #[must_use]
    pub fn from_fn(
        final_time: f64,
        n: usize,
        sample: impl Fn(f64) -> (SVector<f64, NX>, SVector<f64, NU>),
    ) -> Self {
        let n = n.clamp(1, MOST);
        let fractions: Vec<f64> = (0..=n).map(|k| k as f64 / n as f64).collect();
        let (states, controls) = fractions.iter().map(|&s| sample(s)).unzip();
        Self { final_time, fractions, states, controls }
    }

    /// A guess with samples at the given increasing fractions of the flight.
    ///
    /// # Errors
    /// [`Error::InvalidGuess`] if the lists differ in length or are empty.
    pub fn from_samples(
        final_time: f64,
        fractions: Vec<f64>,
        states: Vec<SVector<f64, NX>>,
        controls: Vec<SVector<f64, NU>>,
    ) -> Result<Self, Error> {
        let n = fractions.len();
        if n == 0 || states.len() != n || controls.len() != n {
            return Err(Error::InvalidGuess { fractions: n, states: states.len(), controls: controls.len() });
        }
        Ok(Self { final_time, fractions, states, controls })
    }

    /// The trajectory of a solution, resampled at its knots and at `per_segment - 1` points between them,
    /// 2^20 points at most.
    #[must_use]
    pub fn from_solution(solution: &Solution<NX, NU>, per_segment: usize) -> Self {
        let (t0, tf) = (solution.initial_time(), solution.final_time());
        let times = solution.times();
        let per = per_segment.clamp(1, MOST / (times.len() - 1).clamp(1, MOST));
        let mut guess = Self { final_time: tf, fractions: vec![], states: vec![], controls: vec![] };
        for k in 0..times.len() - 1 {
            for j in 0..per {
                let t = times[k] + (times[k + 1] - times[k]) * j as f64 / per as f64;
                guess.push((t - t0) / (tf - t0), solution.state_at(t), solution.control_at(t));
            }
        }
        guess.push(1.0, solution.state_at(tf), solution.control_at(tf));
        guess
    }

    fn push(&mut self, fraction: f64, state: SVector<f64, NX>, control: SVector<f64, NU>) {
        self.fractions.push(fraction);
        self.states.push(state);
        self.controls.push(control);
    }

    /// Final time, s.
    #[must_use]
    pub fn final_time(&self) -> f64 {
        self.final_time
    }

    /// The same trajectory with another final time, s.
    #[must_use]
    pub fn with_final_time(mut self, final_time: f64) -> Self {
        self.final_time = final_time;
        self
    }

    /// State and control at a fraction of the flight.
    #[must_use]
    pub fn sample(&self, fraction: f64) -> (SVector<f64, NX>, SVector<f64, NU>) {
        let (left, right, w) = bracket(&self.fractions, fraction);
        (
            self.states[left] * (1.0 - w) + self.states[right] * w,
            self.controls[left] * (1.0 - w) + self.controls[right] * w,
        )
    }

    pub(crate) fn validate(&self, initial_time: f64) -> Result<(), Error> {
        let finite = self.states.iter().all(|x| x.iter().all(|v| v.is_finite()))
            && self.controls.iter().all(|u| u.iter().all(|v| v.is_finite()))
            && self.fractions.iter().all(|v| v.is_finite());
        if finite && self.final_time.is_finite() && self.final_time > initial_time {
            Ok(())
        } else {
            Err(Error::NonFiniteGuess { final_time: self.final_time })
        }
    }
}
