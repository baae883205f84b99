//! What can be wrong with the input.

/// Malformed input, found before any work is done (or, for integration, a failure of the integration itself).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The knots do not increase strictly from 0 to 1.
    #[error("mesh fractions must increase strictly from 0 to 1 (violated at knot {knot})")]
    InvalidMesh {
        /// First knot that is out of order.
        knot: usize,
    },
    /// A lower bound exceeds its upper bound, or a bound is NaN.
    #[error("{what} {index}: lower bound {lower} and upper bound {upper} are inconsistent")]
    InconsistentBounds {
        /// Which bounds.
        what: BoundKind,
        /// Component.
        index: usize,
        /// Lower bound.
        lower: f64,
        /// Upper bound.
        upper: f64,
    },
    /// The guess has no samples, or samples of unequal number.
    #[error(
        "the guess needs equally many fractions, states and controls, at least one: {fractions}, {states}, {controls}"
    )]
    InvalidGuess {
        /// Number of fractions.
        fractions: usize,
        /// Number of states.
        states: usize,
        /// Number of controls.
        controls: usize,
    },
    /// A number of the guess is not finite, or its final time is not after the initial time.
    #[error("the guess is not finite, or its final time {final_time} is not after the initial time")]
    NonFiniteGuess {
        /// Final time of the guess, s.
        final_time: f64,
    },
    /// A factor or constant of a second-order cone is not finite.
    #[error("a factor or constant of cone {cone} is not finite")]
    NonFiniteCone {
        /// Place of the cone in the list.
        cone: usize,
    },
    /// An option is out of range.
    #[error("option {option} is out of range: {value}")]
    InvalidOption {
        /// Name of the option.
        option: &'static str,
        /// Its value.
        value: f64,
    },
    /// The integrator could not go on: the step became too small or a derivative is not finite.
    #[error(
        "integration stopped at time {time}: step size {step} is too small or the derivative is not finite"
    )]
    IntegrationFailed {
        /// Time reached, s.
        time: f64,
        /// Step size that was refused, s.
        step: f64,
    },
    /// The integrator used up its steps.
    #[error("integration used its {max_steps} steps and reached time {time}")]
    TooManySteps {
        /// Number of steps allowed.
        max_steps: usize,
        /// Time reached, s.
        time: f64,
    },
}

/// Which bounds an error is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BoundKind {
    /// A state along the way.
    State,
    /// A control.
    Control,
    /// A component of the start state.
    InitialState,
    /// A component of the end state.
    TerminalState,
    /// The final time.
    FinalTime,
    /// A path constraint.
    Path,
    /// A boundary constraint.
    Boundary,
}

impl std::fmt::Display for BoundKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::State => "state",
            Self::Control => "control",
            Self::InitialState => "initial state",
            Self::TerminalState => "terminal state",
            Self::FinalTime => "final time",
            Self::Path => "path constraint",
            Self::Boundary => "boundary constraint",
        })
    }
}
