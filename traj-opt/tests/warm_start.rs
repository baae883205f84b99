//! Starting from a neighbour's solution.
mod common;

use common::quadcopter::*;
use std::ops::ControlFlow;
use traj_opt::{
    Mesh, Options, Problem, Status, Transcription, Workspace, solve_from, solve_on_mesh, solve_with,
};

/// A tenth of the circle that all of a transition's end states lie on moves by less than this.
const SHIFT: f64 = 0.2;

#[test]
fn neighbours_are_solved_in_a_fraction_of_the_iterations() {
    let mut workspace = Workspace::new();
    let options = Options::default().with_tolerance(1e-6);
    let proceed = |_: &traj_opt::Iteration| ControlFlow::Continue(());
    let (mut cold_iterations, mut warm_iterations) = (0, 0);
    for r in references().iter().step_by(5) {
        let t = thrust_rate(&r.start, &r.end);
        let guess = naive_guess(&t, hover_thrust_rate());
        let mesh = Mesh::uniform(40);
        let mut solve = |t: &Transition<ThrustRate, 10>| {
            solve_with(&mut workspace, t, &mesh, Transcription::HermiteSimpson, &guess, &options, proceed)
                .expect("valid input")
        };
        let previous = solve(&t);
        let mut end = r.end;
        end[0] += SHIFT;
        end[2] -= SHIFT;
        let near = thrust_rate(&r.start, &end);
        let cold = solve(&near);
        let warm =
            solve_from(&mut workspace, &near, &previous, Transcription::HermiteSimpson, &options, proceed)
                .expect("valid input");
        assert!(previous.status.is_success() && cold.status.is_success());
        assert_eq!(warm.status, Status::Solved, "transition {}", r.id);
        // both are local minima; the neighbour's basin is kept, which the guess need not find
        assert!(warm.objective < cold.objective * 1.001, "{} against {}", warm.objective, cold.objective);
        let last = warm.states()[warm.states().len() - 1];
        assert!((last[0] - near.end[0]).abs() < 1e-4, "the end state is the new one");
        assert_eq!(near.bounds().terminal_lower[0], near.end[0]);
        cold_iterations += cold.iterations;
        warm_iterations += warm.iterations;
    }
    assert!(2 * warm_iterations < cold_iterations, "{warm_iterations} warm, {cold_iterations} cold");
}

#[test]
fn another_shape_falls_back_to_the_trajectory_as_a_guess() {
    let r = &references()[0];
    let t = thrust_rate(&r.start, &r.end);
    let proceed = |_: &traj_opt::Iteration| ControlFlow::Continue(());
    let mut workspace = Workspace::new();
    let guess = naive_guess(&t, hover_thrust_rate());
    let coarse = solve_with(
        &mut workspace,
        &t,
        &Mesh::uniform(10),
        Transcription::Trapezoidal,
        &guess,
        &Options::default(),
        proceed,
    )
    .expect("valid input");
    let mut free_end = thrust_rate(&r.start, &r.end);
    free_end.bounds.terminal_lower[2] = f64::NEG_INFINITY;
    free_end.bounds.terminal_upper[2] = f64::INFINITY;
    let solved = solve_from(
        &mut workspace,
        &free_end,
        &coarse,
        Transcription::Trapezoidal,
        &Options::default(),
        proceed,
    )
    .expect("valid input");
    assert!(solved.status.is_success());
    assert!(solved.objective <= coarse.objective * (1.0 + 1e-6));
}

/// More Runge-Kutta steps a segment change little: the multipliers of few steps are a good start.
#[test]
fn few_steps_are_a_start_for_many() {
    let options = Options::default().with_tolerance(1e-6);
    let proceed = |_: &traj_opt::Iteration| ControlFlow::Continue(());
    let mut workspace = Workspace::new();
    let (mut cold_iterations, mut warm_iterations) = (0, 0);
    for r in references().iter().step_by(10) {
        let t = thrust_rate(&r.start, &r.end);
        let guess = naive_guess(&t, hover_thrust_rate());
        let mesh = Mesh::uniform(40);
        let [few, many] = [1, 4].map(|substeps| Transcription::RungeKutta { substeps });
        let mut cold = |transcription| {
            solve_with(&mut workspace, &t, &mesh, transcription, &guess, &options, proceed)
                .expect("valid input")
        };
        let (previous, wanted) = (cold(few), cold(many));
        let warm = solve_from(&mut workspace, &t, &previous, many, &options, proceed).expect("valid input");
        assert_eq!((warm.status, warm.transcription()), (Status::Solved, many), "transition {}", r.id);
        assert!(warm.objective < wanted.objective * 1.001, "{} against {}", warm.objective, wanted.objective);
        cold_iterations += wanted.iterations;
        warm_iterations += warm.iterations;
    }
    assert!(2 * warm_iterations < cold_iterations, "{warm_iterations} warm, {cold_iterations} cold");
}

/// A solution on half of the segments is a start, whether it was solved to the end or stopped on the way.
#[test]
fn a_coarse_mesh_is_a_start_for_a_fine_one() {
    let options = Options::default().with_tolerance(1e-6);
    let (mut cold_iterations, mut warm_iterations) = (0, [0; 2]);
    for r in references().iter().step_by(5) {
        let t = thrust_rate(&r.start, &r.end);
        let guess = naive_guess(&t, hover_thrust_rate());
        let mut workspace = Workspace::new();
        let mut cold = |segments, enough_mu: f64| {
            let stop = |it: &traj_opt::Iteration| match it.mu < enough_mu && it.residuals.primal < 1e-3 {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            };
            let mesh = Mesh::uniform(segments);
            solve_with(&mut workspace, &t, &mesh, Transcription::HermiteSimpson, &guess, &options, stop)
                .expect("valid input")
        };
        let wanted = cold(40, 0.0);
        cold_iterations += wanted.iterations;
        for (spent, (status, enough_mu)) in
            warm_iterations.iter_mut().zip([(Status::Solved, 0.0), (Status::Stopped, 1e-3)])
        {
            let coarse = cold(20, enough_mu);
            assert_eq!(coarse.status, status);
            let proceed = |_: &traj_opt::Iteration| ControlFlow::Continue(());
            let (mesh, own) = (Mesh::uniform(40), Transcription::HermiteSimpson);
            let fine =
                solve_on_mesh(&mut Workspace::new(), &t, &coarse, &mesh, own, &options, proceed).unwrap();
            assert_eq!((fine.status, fine.mesh().n_segments()), (Status::Solved, 40), "transition {}", r.id);
            assert!(fine.objective < wanted.objective * 1.001, "{} {}", fine.objective, wanted.objective);
            *spent += fine.iterations;
        }
    }
    assert!(warm_iterations[0] < cold_iterations, "{warm_iterations:?} warm, {cold_iterations} cold");
    assert!(5 * warm_iterations[1] < 4 * cold_iterations, "{warm_iterations:?} warm, {cold_iterations} cold");
}

/// Multipliers of other constraints, or of other points of a segment, are of no use: the trajectory is.
#[test]
fn another_shape_on_another_mesh_falls_back_to_the_trajectory() {
    let r = &references()[0];
    let t = thrust_rate(&r.start, &r.end);
    let proceed = |_: &traj_opt::Iteration| ControlFlow::Continue(());
    let options = Options::default();
    let guess = naive_guess(&t, hover_thrust_rate());
    let (mesh, finer) = (Mesh::uniform(15), Mesh::graded(40, 0.5));
    let transcriptions = [
        Transcription::Trapezoidal,
        Transcription::HermiteSimpson,
        Transcription::RungeKutta { substeps: 1 },
        Transcription::LegendreGaussRadau { degree: 3 },
    ];
    let mut free_end = thrust_rate(&r.start, &r.end);
    free_end.bounds.terminal_lower[2] = f64::NEG_INFINITY;
    free_end.bounds.terminal_upper[2] = f64::INFINITY;
    for from in transcriptions {
        let coarse = solve_with(&mut Workspace::new(), &t, &mesh, from, &guess, &options, proceed)
            .expect("valid input");
        for to in transcriptions {
            let fine =
                solve_on_mesh(&mut Workspace::new(), &free_end, &coarse, &finer, to, &options, proceed)
                    .expect("valid input");
            assert!(fine.status.is_success(), "{from:?} to {to:?}: {}", fine.status);
            assert_eq!(fine.transcription(), to);
        }
    }
}
