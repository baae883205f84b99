//! How a solve ended, and what is reported on the way.

/// How a solve ended. The [`Solution`](crate::Solution) always holds the last iterate and its residuals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Status {
    /// The KKT residuals are below the tolerance.
    Solved,
    /// The KKT residuals are below the acceptable tolerance and nothing better was found.
    Acceptable,
    /// The iterate is a local minimum of the constraint violation.
    Infeasible,
    /// The limit of iterations was reached.
    IterationLimit,
    /// The caller's monitor asked to stop.
    Stopped,
    /// No acceptable step was found (numerical difficulties).
    Stalled,
}

impl Status {
    /// True for `Solved` and `Acceptable`.
    #[must_use]
    pub fn is_success(self) -> bool {
        matches!(self, Self::Solved | Self::Acceptable)
    }
}

impl std::fmt::Display for Status {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Solved => "solved",
            Self::Acceptable => "acceptable",
            Self::Infeasible => "infeasible",
            Self::IterationLimit => "iteration limit",
            Self::Stopped => "stopped",
            Self::Stalled => "stalled",
        })
    }
}

/// Scaled KKT residuals (greatest absolute value of each kind).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Residuals {
    /// Defects and constraint violations, each divided by the scale of its variable.
    pub primal: f64,
    /// Gradient of the Lagrangian, each entry times the scale of its variable.
    pub dual: f64,
    /// Products of bound multipliers and distances to the bound.
    pub complementarity: f64,
}

/// One line of the iteration log, as the monitor sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Iteration {
    /// Number of the iteration, from 0.
    pub iteration: usize,
    /// Cost.
    pub objective: f64,
    /// Lagrangian: the cost plus multipliers times residuals. Near a solution it tells the cost there, of the present barrier parameter,
    /// before the iterates are feasible: it is off by the square of what is left to correct.
    pub lagrangian: f64,
    /// Residuals at the iterate.
    pub residuals: Residuals,
    /// Barrier parameter mu.
    pub mu: f64,
    /// Regularisation that was added to the Hessian in the step that led here (0: none).
    pub regularisation: f64,
    /// Primal step length that led here.
    pub step_length: f64,
    /// Radius of the trust region, in scaled variables; 0 for the interior-point method, which has none.
    pub trust_radius: f64,
}
