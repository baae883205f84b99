//! What the solver returns.

use crate::interpolate::Nodes;
use crate::nlp::warm::Point;
use crate::{
    Dynamics, Error, IntegrateOptions, Iteration, Mesh, Residuals, Status, Trajectory, Transcription,
    Violation,
};
use nalgebra::SVector;

/// The trajectory that a solve ended with, how it ended, and how good it is.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Solution<const NX: usize, const NU: usize> {
    /// How the solve ended.
    pub status: Status,
    /// Cost.
    pub objective: f64,
    /// Number of iterations.
    pub iterations: usize,
    /// KKT residuals of the transcribed problem.
    pub residuals: Residuals,
    /// Multipliers.
    pub multipliers: Multipliers<NX, NU>,
    /// One entry an iteration.
    pub log: Vec<Iteration>,
    /// The constraint that is left most violated, relative to its scale, if the solve did not succeed; `None` if it did or no
    /// constraint is violated. A dynamically infeasible problem names the equation of motion where the iterate tears, or the end
    /// condition that it misses.
    pub diagnosis: Option<Violation>,
    pub(crate) transcription: Transcription,
    pub(crate) mesh: Mesh,
    pub(crate) times: Vec<f64>,
    pub(crate) states: Vec<SVector<f64, NX>>,
    pub(crate) controls: Vec<SVector<f64, NU>>,
    pub(crate) nodes: Nodes<NX>,
    pub(crate) point: Point<NX>,
}

/// Multipliers of the transcribed problem.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Multipliers<const NX: usize, const NU: usize> {
    /// Of the defects, one vector a segment: the costate at the segment's end.
    pub defects: Vec<SVector<f64, NX>>,
    /// Of the boundary constraints, then of the fixed components of the end state in ascending order.
    pub boundary: Vec<f64>,
    /// Of the path constraints, `n_path` a collocation point; positive where the upper bound holds it back.
    pub path: Vec<f64>,
    /// Of the lower and upper bounds on the states at the knots; not negative.
    pub states: [Vec<SVector<f64, NX>>; 2],
    /// Of the lower and upper bounds on the control vectors; not negative.
    pub controls: [Vec<SVector<f64, NU>>; 2],
    /// Of the lower and upper bound on the final time; not negative.
    pub final_time: [f64; 2],
    /// Of the second-order cones of `solve_conic`: for every collocation point and cone that of the radius, then those of the rows. They
    /// lie in the dual cone: the first is at least the norm of the others. Empty for the other solvers.
    pub cones: Vec<f64>,
}

impl<const NX: usize, const NU: usize> Solution<NX, NU> {
    /// Times of the knots, s; `n_segments + 1`.
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// States at the knots, `n_segments + 1`.
    #[must_use]
    pub fn states(&self) -> &[SVector<f64, NX>] {
        &self.states
    }

    /// Control vectors, `n_local` of them a segment (one for [`Transcription::RungeKutta`]), segment by segment.
    #[must_use]
    pub fn controls(&self) -> &[SVector<f64, NU>] {
        &self.controls
    }

    /// The transcription that was solved.
    #[must_use]
    pub fn transcription(&self) -> Transcription {
        self.transcription
    }

    /// The mesh that was solved on.
    #[must_use]
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Start time, s.
    #[must_use]
    pub fn initial_time(&self) -> f64 {
        self.times[0]
    }

    /// Final time, s.
    #[must_use]
    pub fn final_time(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// State at a time, interpolated consistently with the transcription; times outside are clamped to the ends.
    #[must_use]
    pub fn state_at(&self, time: f64) -> SVector<f64, NX> {
        self.nodes.state_at(time)
    }

    /// Control at a time: the polynomial of the segment through its control vectors. At a knot that of the segment that
    /// begins there; times outside are clamped to the ends.
    #[must_use]
    pub fn control_at(&self, time: f64) -> SVector<f64, NU> {
        let last = self.times.len() - 2;
        let segment = self.times.partition_point(|&t| t <= time).saturating_sub(1).min(last);
        self.control_in_segment(segment, time)
    }

    /// Control of a given segment at a time (clamped to the segment), so that both limits at a knot can be had.
    ///
    /// # Panics
    /// If there is no such segment.
    #[must_use]
    pub fn control_in_segment(&self, segment: usize, time: f64) -> SVector<f64, NU> {
        let n = self.transcription.n_local();
        let u = &self.controls[segment * n..(segment + 1) * n];
        let (t0, t1) = (self.times[segment], self.times[segment + 1]);
        let s = if t1 > t0 { ((time - t0) / (t1 - t0)).clamp(0.0, 1.0) } else { 0.0 };
        crate::interpolate::polynomial(self.transcription.control_points(), u, s)
    }

    /// Integrates the controls from the start state with the adaptive integrator, independently of the transcription.
    /// Knots are hit exactly. The last state minus [`states`](Self::states)' last is the *integrated miss*.
    ///
    /// # Errors
    /// [`Error::IntegrationFailed`] or [`Error::TooManySteps`].
    pub fn integrate(
        &self,
        dynamics: &impl Dynamics<NX, NU>,
        options: &IntegrateOptions,
    ) -> Result<Trajectory<NX>, Error> {
        let mut trajectory = Trajectory::starting_at(self.times[0], self.states[0]);
        for k in 0..self.times.len() - 1 {
            let rhs =
                |t: f64, x: &SVector<f64, NX>| dynamics.derivative(t, x, &self.control_in_segment(k, t));
            trajectory.extend(rhs, self.times[k + 1], options)?;
        }
        Ok(trajectory)
    }
}
