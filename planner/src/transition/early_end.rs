//! When a solve ends before it is solved to the end: it loses against another, or its time is known well enough to be compared.

use std::ops::ControlFlow;
use traj_opt::Iteration;

/// Dual residual of an iterate whose Lagrangian tells the time of the solution of its barrier problem, and how far (share of it) the
/// Lagrangian then is from the cost at most; with ten times as much one of fifty legs took a slower entry.
const NEARLY_STATIONARY: f64 = 3e-4;
const NEARLY_EQUAL: f64 = 1e-4;
/// The same of an iterate that may lose, and how far the Lagrangian then is from that time at most (share of it), in dual residuals. From
/// earlier iterates twelve of a thousand legs took a slower entry.
const ROUGHLY_STATIONARY: f64 = 1e-3;
const UNCERTAINTY: f64 = 10.0;
/// Greatest barrier parameters of sketches and drafts that are good enough, and greatest primal residual, in barrier parameters.
pub(super) const SKETCH_MU: f64 = 1e-3;
pub(super) const DRAFT_MU: f64 = 1e-5;
const ENOUGH_PRIMAL: f64 = 20.0;
/// Greatest regularisation with which they are: with more, directions are left along which the time still falls.
const ENOUGH_REGULARISATION: f64 = 1e-4;

/// What a solve is compared with, and how far it need go.
pub(super) struct EarlyEnd {
    /// Time of the fastest other (s).
    pub to_beat: f64,
    /// Greatest barrier parameter with which it may end as good enough; `None` for never.
    pub enough_mu: Option<f64>,
    /// Most bounds that are active in all segments together.
    pub active_bounds: f64,
}

impl EarlyEnd {
    /// Ends a solve that loses: the time of its barrier problem, as far as it is known, less what so many active bounds cost, is more
    /// than what is to be beaten. Ends one that is good enough to be compared once that time is known. An estimate, and no proof,
    /// because the problem is not convex.
    pub fn watch(&self, iteration: &Iteration) -> ControlFlow<()> {
        let Iteration { objective, lagrangian, mu, residuals, regularisation, .. } = *iteration;
        let least = lagrangian - mu * self.active_bounds;
        let loses = residuals.dual < ROUGHLY_STATIONARY
            && least > self.to_beat * (1.0 + UNCERTAINTY * residuals.dual);
        let is_known =
            residuals.dual < NEARLY_STATIONARY && (lagrangian - objective).abs() < NEARLY_EQUAL * objective;
        let is_enough = self.enough_mu.is_some_and(|enough| {
            mu < enough && residuals.primal < ENOUGH_PRIMAL * enough && regularisation < ENOUGH_REGULARISATION
        });
        if loses || is_known && is_enough { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
