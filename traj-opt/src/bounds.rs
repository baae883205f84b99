//! Component-wise bounds on states, controls, end states and time.

use nalgebra::SVector;

/// Component-wise bounds of a [`Problem`](crate::Problem). Infinite entries mean "no bound"; equal lower and upper
/// entries of `initial` and `terminal` fix that component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<const NX: usize, const NU: usize> {
    /// Least state along the way.
    pub state_lower: SVector<f64, NX>,
    /// Greatest state along the way.
    pub state_upper: SVector<f64, NX>,
    /// Least control.
    pub control_lower: SVector<f64, NU>,
    /// Greatest control.
    pub control_upper: SVector<f64, NU>,
    /// Least start state.
    pub initial_lower: SVector<f64, NX>,
    /// Greatest start state.
    pub initial_upper: SVector<f64, NX>,
    /// Least end state.
    pub terminal_lower: SVector<f64, NX>,
    /// Greatest end state.
    pub terminal_upper: SVector<f64, NX>,
    /// Start time, s.
    pub initial_time: f64,
    /// Least final time, s; must not be before `initial_time`.
    pub final_time_lower: f64,
    /// Greatest final time, s; equal to the least for a fixed final time.
    pub final_time_upper: f64,
}

impl<const NX: usize, const NU: usize> Bounds<NX, NU> {
    /// No bounds at all, start time 0, final time free and positive.
    #[must_use]
    pub fn free() -> Self {
        let low = f64::NEG_INFINITY;
        let high = f64::INFINITY;
        Self {
            state_lower: SVector::repeat(low),
            state_upper: SVector::repeat(high),
            control_lower: SVector::repeat(low),
            control_upper: SVector::repeat(high),
            initial_lower: SVector::repeat(low),
            initial_upper: SVector::repeat(high),
            terminal_lower: SVector::repeat(low),
            terminal_upper: SVector::repeat(high),
            initial_time: 0.0,
            final_time_lower: 0.0,
            final_time_upper: high,
        }
    }

    /// Sets the bounds on the states along the way.
    #[must_use]
    pub fn with_state(mut self, lower: SVector<f64, NX>, upper: SVector<f64, NX>) -> Self {
        (self.state_lower, self.state_upper) = (lower, upper);
        self
    }

    /// Sets the bounds on the controls.
    #[must_use]
    pub fn with_control(mut self, lower: SVector<f64, NU>, upper: SVector<f64, NU>) -> Self {
        (self.control_lower, self.control_upper) = (lower, upper);
        self
    }

    /// Fixes the start state.
    #[must_use]
    pub fn with_initial_state(mut self, state: SVector<f64, NX>) -> Self {
        (self.initial_lower, self.initial_upper) = (state, state);
        self
    }

    /// Fixes the end state.
    #[must_use]
    pub fn with_terminal_state(mut self, state: SVector<f64, NX>) -> Self {
        (self.terminal_lower, self.terminal_upper) = (state, state);
        self
    }

    /// Fixes one component of the start state.
    ///
    /// # Panics
    /// If `index >= NX`.
    #[must_use]
    pub fn with_initial_component(mut self, index: usize, value: f64) -> Self {
        (self.initial_lower[index], self.initial_upper[index]) = (value, value);
        self
    }

    /// Fixes one component of the end state.
    ///
    /// # Panics
    /// If `index >= NX`.
    #[must_use]
    pub fn with_terminal_component(mut self, index: usize, value: f64) -> Self {
        (self.terminal_lower[index], self.terminal_upper[index]) = (value, value);
        self
    }

    /// Sets the range of the final time, s; equal values fix it.
    #[must_use]
    pub fn with_final_time(mut self, lower: f64, upper: f64) -> Self {
        (self.final_time_lower, self.final_time_upper) = (lower, upper);
        self
    }
}
