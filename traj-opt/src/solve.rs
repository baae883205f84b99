//! The entry points of the solver.

use crate::dense::vector;
use crate::interpolate::Nodes;
use crate::nlp::interior_point::{Memory, Outcome};
use crate::nlp::program::Program;
use crate::nlp::{runge_kutta, setup};
use crate::violation::greatest_residual;
use crate::{
    Dynamics, Error, Guess, Iteration, Mesh, Multipliers, Options, Problem, Solution, Status, Transcription,
};
use nalgebra::SVector;
use std::ops::ControlFlow;

/// Memory of a solve, to be reused: no allocation after the first solve of a given shape, except for the solution itself.
#[derive(Clone, Debug, Default)]
pub struct Workspace<const NX: usize, const NU: usize> {
    memory: Memory<NX, NU>,
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
    mut monitor: impl FnMut(&Iteration) -> ControlFlow<()>,
) -> Result<Solution<NX, NU>, Error> {
    options.validate()?;
    let bounds = problem.bounds();
    setup::validate(problem, &bounds)?;
    guess.validate(bounds.initial_time)?;
    let transcription = transcription.valid();
    let possible = bounds.final_time_lower..=bounds.final_time_upper;
    let program = transcribe(problem, mesh, transcription, guess);
    let memory = &mut workspace.memory;
    // one type for all callers: the iterations are compiled once a problem
    let monitor: &mut dyn FnMut(&Iteration) -> ControlFlow<()> = &mut monitor;
    let restarts = if program.free_time { options.time_restarts } else { 0 };
    let mut spent = 0;
    for factor in restart_factors(restarts) {
        let initial_time = program.bounds.initial_time;
        let final_time = initial_time + (guess.final_time() - initial_time) * factor;
        if factor != 1.0 && !possible.contains(&final_time) {
            continue;
        }
        memory.start(&program, guess, final_time, options);
        let mut outcome = memory.run(&program, options, true, &mut *monitor);
        spent += outcome.iterations;
        if outcome.status != Status::Infeasible {
            outcome.iterations = spent;
            return Ok(extract(&program, memory, &outcome));
        }
    }
    // what is diagnosed is what the caller's own guess leads to
    memory.start(&program, guess, guess.final_time(), options);
    let mut outcome = memory.run(&program, options, false, &mut *monitor);
    outcome.iterations += spent;
    Ok(extract(&program, memory, &outcome))
}

/// Factors of the length of the guess that are tried one after the other while a solve is stuck far from feasibility: doublings,
/// because a guess is more often too short than too long, then leaps for guesses that are wrong by orders of magnitude.
fn restart_factors(doublings: usize) -> impl Iterator<Item = f64> {
    let last = f64::powi(2.0, doublings.min(60) as i32);
    let leaps = [1.0 / 16.0, 16.0 * last, 1.0 / 256.0, 256.0 * last].into_iter();
    let first = (0..=doublings.min(60) as i32).map(|k| f64::powi(2.0, k));
    first.chain(leaps).take(if doublings == 0 { 0 } else { usize::MAX })
}

/// Solves a problem that differs little from one that is solved (another end state, other limits, more Runge-Kutta steps), on the same mesh, starting from
/// that one's primal and dual variables with the barrier parameter [`Options::warm_mu`]: a few iterations where a solve from a
/// guess takes a few dozen (method: every variable and its multiplier are moved to where their product is mu; E. A. Yildirim,
/// S. J. Wright, *Warm-start strategies in interior-point methods for linear programming*, SIAM J. Optim. 12, 2002). If the shapes
/// differ or the start turns out badly, the solve begins anew with the previous trajectory as the guess.
///
/// # Errors
/// Those of [`solve`].
pub fn solve_from<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    workspace: &mut Workspace<NX, NU>,
    problem: &P,
    previous: &Solution<NX, NU>,
    transcription: Transcription,
    options: &Options,
    mut monitor: impl FnMut(&Iteration) -> ControlFlow<()>,
) -> Result<Solution<NX, NU>, Error> {
    options.validate()?;
    let bounds = problem.bounds();
    setup::validate(problem, &bounds)?;
    let guess = Guess::from_solution(previous, 1);
    let (mesh, transcription) = (previous.mesh(), transcription.valid());
    let program = transcribe(problem, mesh, transcription, &guess);
    let memory = &mut workspace.memory;
    let monitor: &mut dyn FnMut(&Iteration) -> ControlFlow<()> = &mut monitor;
    let is_warm = memory.start_at(&program, &previous.point, options);
    go_on(workspace, &program, is_warm, &guess, options, monitor)
}

/// Solves on another mesh what `coarser` solves on its own, starting from its primal and dual variables with the barrier parameter
/// [`Options::warm_mu`]: costates are interpolated, and multipliers of bounds by the share of the flight that they stand for. If the
/// transcription has other points in a segment or the start turns out badly, the solve begins anew with the trajectory as the guess.
///
/// A solution that a monitor stopped early is the better start, on with the barrier parameter with which it was stopped: twice as many
/// segments take a quarter fewer iterations than from a guess, from one that was solved to the end a tenth fewer (ten quadcopter
/// transitions, where controls switch between the knots of both meshes).
///
/// # Errors
/// Those of [`solve`].
pub fn solve_on_mesh<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    workspace: &mut Workspace<NX, NU>,
    problem: &P,
    coarser: &Solution<NX, NU>,
    mesh: &Mesh,
    transcription: Transcription,
    options: &Options,
    mut monitor: impl FnMut(&Iteration) -> ControlFlow<()>,
) -> Result<Solution<NX, NU>, Error> {
    options.validate()?;
    setup::validate(problem, &problem.bounds())?;
    let (guess, transcription) = (Guess::from_solution(coarser, SAMPLES), transcription.valid());
    let program = transcribe(problem, mesh, transcription, &guess);
    let memory = &mut workspace.memory;
    let monitor: &mut dyn FnMut(&Iteration) -> ControlFlow<()> = &mut monitor;
    let is_warm = memory.start_on_finer(&program, coarser, &guess, options);
    go_on(workspace, &program, is_warm, &guess, options, monitor)
}

/// Runs on from multipliers, and anew from the guess where there are none or they turn out badly.
fn go_on<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    workspace: &mut Workspace<NX, NU>,
    program: &Program<NX, NU, P>,
    is_warm: bool,
    guess: &Guess<NX, NU>,
    options: &Options,
    monitor: &mut dyn FnMut(&Iteration) -> ControlFlow<()>,
) -> Result<Solution<NX, NU>, Error> {
    let memory = &mut workspace.memory;
    let mut spent = 0;
    if is_warm {
        let outcome = memory.run(program, options, true, &mut *monitor);
        if outcome.status.is_success() || outcome.status == Status::Stopped {
            return Ok(extract(program, memory, &outcome));
        }
        spent = outcome.iterations;
    }
    let Program { problem, mesh, transcription, .. } = *program;
    let mut solution = solve_with(workspace, problem, mesh, transcription, guess, options, monitor)?;
    solution.iterations += spent;
    Ok(solution)
}

/// Samples a segment from which a solution is interpolated onto another mesh.
pub(crate) const SAMPLES: usize = 4;

fn transcribe<'a, const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    problem: &'a P,
    mesh: &'a Mesh,
    transcription: Transcription,
    guess: &Guess<NX, NU>,
) -> Program<'a, NX, NU, P> {
    let bounds = problem.bounds();
    let scales = problem.scales().unwrap_or_else(|| setup::default_scales(&bounds, guess));
    let free_time = bounds.final_time_lower != bounds.final_time_upper;
    Program { problem, mesh, transcription, bounds, scales, free_time }
}

/// Builds the solution from the last iterate.
pub(crate) fn extract<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    memory: &Memory<NX, NU>,
    outcome: &Outcome,
) -> Solution<NX, NU> {
    let layout = &memory.layout;
    let n = layout.n_segments;
    let w = &memory.w;
    let n_local = program.transcription.n_local();
    let tf = w[layout.time];
    Solution {
        status: outcome.status,
        objective: memory.values.objective,
        iterations: outcome.iterations,
        residuals: outcome.residuals,
        multipliers: multipliers(memory, n_local),
        log: memory.log.clone(),
        diagnosis: if outcome.status.is_success() { None } else { greatest_residual(program, memory) },
        transcription: program.transcription,
        mesh: program.mesh.clone(),
        times: program.mesh.fractions().iter().map(|&f| program.time_at(f, tf)).collect(),
        states: (0..=n).map(|k| program.state(layout, w, k)).collect(),
        controls: (0..n * n_local).map(|i| program.control(layout, w, i / n_local, i % n_local)).collect(),
        nodes: nodes(program, memory),
        point: memory.point(),
    }
}

fn multipliers<const NX: usize, const NU: usize>(
    memory: &Memory<NX, NU>,
    n_local: usize,
) -> Multipliers<NX, NU> {
    let (layout, n) = (&memory.layout, memory.layout.n_segments);
    let sides = [&memory.bounds.z_lower, &memory.bounds.z_upper];
    Multipliers {
        defects: memory.duals.defect.clone(),
        boundary: memory.duals.boundary.clone(),
        path: memory.duals.path.clone(),
        states: sides.map(|z| (0..=n).map(|k| vector(z, layout.state(k))).collect()),
        controls: sides
            .map(|z| (0..n * n_local).map(|i| vector(z, layout.control(i / n_local, i % n_local))).collect()),
        final_time: sides.map(|z| z[layout.time]),
        cones: vec![],
    }
}

/// States and slopes between which the state is interpolated.
fn nodes<const NX: usize, const NU: usize, P: Problem<NX, NU>>(
    program: &Program<NX, NU, P>,
    memory: &Memory<NX, NU>,
) -> Nodes<NX> {
    let (layout, w) = (&memory.layout, &memory.w);
    let tf = w[layout.time];
    let mut nodes = Nodes::default();
    let slope = |t, x: &SVector<f64, NX>, k, local| {
        program.problem.dynamics().derivative(t, x, &program.control(layout, w, k, local))
    };
    nodes.times.push(program.time_at(0.0, tf));
    nodes.states.push(program.state(layout, w, 0));
    for k in 0..layout.n_segments {
        let end = program.time_at(program.mesh.fractions()[k + 1], tf);
        let mut push = |t: f64, x: SVector<f64, NX>, locals: [usize; 2]| {
            let (t0, x0) = (nodes.times[nodes.times.len() - 1], nodes.states[nodes.states.len() - 1]);
            nodes.slopes.push([slope(t0, &x0, k, locals[0]), slope(t, &x, k, locals[1])]);
            nodes.times.push(t);
            nodes.states.push(x);
        };
        let next = program.state(layout, w, k + 1);
        match program.transcription {
            Transcription::RungeKutta { substeps } => {
                let mut count = 0;
                runge_kutta::step_states(program, layout, substeps, k, w, |t, x| {
                    count += 1;
                    let last = count == substeps;
                    push(if last { end } else { t }, if last { next } else { x }, [0, 0]);
                });
            }
            Transcription::Trapezoidal => push(end, next, [0, 1]),
            Transcription::HermiteSimpson | Transcription::CompressedHermiteSimpson => {
                let at = layout.middle(k);
                let middle = program.point_time(k, 0.5, tf).time;
                push(middle, SVector::from_column_slice(&w[at..at + NX]), [0, 1]);
                push(end, next, [1, 2]);
            }
            Transcription::LegendreGaussRadau { .. } => {
                nodes.group = layout.n_inner + 1;
                for i in 0..layout.n_inner {
                    let time = program.point_time(k, program.transcription.control_points()[i], tf).time;
                    nodes.times.push(time);
                    nodes.states.push(crate::dense::vector(w, layout.inner(k, i)));
                }
                nodes.times.push(end);
                nodes.states.push(next);
            }
        }
    }
    nodes
}
