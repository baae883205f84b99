//! The entry points of the solver.

use crate::interpolate::Nodes;
use crate::{
    Dynamics, Error, Guess, Iteration, Mesh, Multipliers, Options, Problem, Residuals, Solution, Status,
    Transcription,
};
use nalgebra::SVector;
use std::ops::ControlFlow;

/// Memory of a solve, to be reused: no allocation after the first solve of a given shape, except for the solution itself.
#[derive(Clone, Debug, Default)]
pub struct Workspace<const NX: usize, const NU: usize> {
    states: Vec<SVector<f64, NX>>,
    controls: Vec<SVector<f64, NU>>,
}

impl<const NX: usize, const NU: usize> Workspace<NX, NU> {
    /// An empty workspace.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }
}

/// Solves an optimal control problem on a mesh.
///
/// # Errors
/// Malformed input only: inconsistent bounds, a guess that is not finite, options out of range. A solve that does not reach
/// its tolerance is not an error: see [`Solution::status`].
pub fn solve<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &P,
    mesh: &Mesh,
    transcription: Transcription,
    guess: &Guess<NX, NU>,
    options: &Options,
) -> Result<Solution<NX, NU>, Error> {
    solve_with(&mut Workspace::new(), problem, mesh, transcription, guess, options, |_| {
        ControlFlow::Continue(())
    })
}

/// [`solve`] with a reusable workspace and a monitor that sees every iteration and may stop the solve by returning
/// `ControlFlow::Break(())`.
///
/// # Errors
/// Those of [`solve`].
pub fn solve_with<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    workspace: &mut Workspace<NX, NU>,
    problem: &P,
    mesh: &Mesh,
    transcription: Transcription,
    guess: &Guess<NX, NU>,
    options: &Options,
    mut _monitor: impl FnMut(&Iteration) -> ControlFlow<()>,
) -> Result<Solution<NX, NU>, Error> {
    options.validate()?;
    let bounds = problem.bounds();
    guess.validate(bounds.initial_time)?;
    let (t0, tf) = (bounds.initial_time, guess.final_time());
    let times: Vec<f64> = mesh.fractions().iter().map(|f| t0 + f * (tf - t0)).collect();
    workspace.states.clear();
    workspace.controls.clear();
    let fractions = mesh.fractions();
    let mut nodes = Nodes::default();
    for (k, &s) in fractions.iter().enumerate() {
        workspace.states.push(guess.sample(s).0);
        nodes.times.push(times[k]);
        nodes.states.push(guess.sample(s).0);
        if k + 1 < fractions.len() {
            for &c in transcription.control_points() {
                workspace.controls.push(guess.sample(s + c * (fractions[k + 1] - s)).1);
            }
            let slope = problem.dynamics().derivative(times[k], &guess.sample(s).0, &guess.sample(s).1);
            nodes.slopes.push([slope; 2]);
        }
    }
    Ok(Solution {
        status: Status::IterationLimit,
        objective: tf,
        iterations: 0,
        residuals: Residuals { primal: f64::INFINITY, dual: f64::INFINITY, complementarity: f64::INFINITY },
        multipliers: Multipliers::default(),
        log: vec![],
        transcription,
        mesh: mesh.clone(),
        times,
        states: workspace.states.clone(),
        controls: workspace.controls.clone(),
        nodes,
    })
}
