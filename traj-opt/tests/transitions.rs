//! The fifty reference transitions from the naive guess, and long legs.
mod common;

use common::quadcopter::*;
use nalgebra::SVector;
use traj_opt::{
    Dynamics, Guess, IntegrateOptions, Mesh, Options, Problem, Solution, Transcription, Workspace, solve_with,
};

const FLOWN: Transcription = Transcription::RungeKutta { substeps: 2 };

fn solve<D: Dynamics<NX, 4>, const NX: usize>(
    workspace: &mut Workspace<NX, 4>,
    t: &Transition<D, NX>,
    mesh: &Mesh,
    transcription: Transcription,
    guess: &Guess<NX, 4>,
) -> Solution<NX, 4> {
    let proceed = |_: &traj_opt::Iteration| std::ops::ControlFlow::Continue(());
    solve_with(workspace, t, mesh, transcription, guess, &Options::default(), proceed).expect("valid input")
}

/// Position, velocity (SI) and attitude (degrees) by which the integrated controls miss the target.
fn integrated_miss<D: Dynamics<NX, 4>, const NX: usize>(
    t: &Transition<D, NX>,
    s: &Solution<NX, 4>,
) -> [f64; 3] {
    let flown = s.integrate(t.dynamics(), &IntegrateOptions::default()).expect("integrable");
    let [p, v, a] = miss(flown.end_state(), &t.end);
    [p, v, a.to_degrees()]
}

fn assert_flyable<D: Dynamics<NX, 4>, const NX: usize>(
    id: usize,
    t: &Transition<D, NX>,
    s: &Solution<NX, 4>,
) {
    assert!(s.status.is_success(), "transition {id}: {}", s.status);
    let [p, v, a] = integrated_miss(t, s);
    assert!(p < 0.05 && v < 0.05 && a < 1.0, "transition {id} misses by {p} m, {v} m/s, {a} degrees");
}

#[test]
fn thrust_rate_transitions_are_solved_and_can_be_flown() {
    let mut workspace = Workspace::new();
    for r in references() {
        let t = thrust_rate(&r.start, &r.end);
        let s = solve(&mut workspace, &t, &Mesh::uniform(40), FLOWN, &naive_guess(&t, hover_thrust_rate()));
        assert_flyable(r.id, &t, &s);
        assert!(s.objective > r.time_thrust_rate * 0.9995, "transition {}: {}", r.id, s.objective);
        assert!(s.objective < r.time_thrust_rate * 1.015, "transition {}: {}", r.id, s.objective);
    }
}

#[test]
fn rigid_body_transitions_are_solved_and_can_be_flown() {
    let mut workspace = Workspace::new();
    for r in references() {
        let t = rigid_body(&r.start, &r.end);
        let s = solve(&mut workspace, &t, &Mesh::uniform(40), FLOWN, &naive_guess(&t, hover_rigid_body()));
        assert_flyable(r.id, &t, &s);
        // several local minima: one start need not find the best
        assert!(s.objective > r.time_rigid_body * 0.998, "transition {}: {}", r.id, s.objective);
        assert!(s.objective < r.time_rigid_body * 1.5, "transition {}: {}", r.id, s.objective);
    }
}

#[test]
fn collocation_solves_the_same_transitions() {
    let (mut a, mut b) = (Workspace::new(), Workspace::new());
    for r in references().iter().step_by(3) {
        for transcription in [Transcription::Trapezoidal, Transcription::HermiteSimpson] {
            let t = thrust_rate(&r.start, &r.end);
            let s =
                solve(&mut a, &t, &Mesh::uniform(40), transcription, &naive_guess(&t, hover_thrust_rate()));
            assert!(s.status.is_success(), "transition {}: {}", r.id, s.status);
            assert!(
                (s.objective / r.time_thrust_rate - 1.0).abs() < 0.02,
                "transition {}: {}",
                r.id,
                s.objective
            );
            let t = rigid_body(&r.start, &r.end);
            let s =
                solve(&mut b, &t, &Mesh::uniform(40), transcription, &naive_guess(&t, hover_rigid_body()));
            assert!(s.status.is_success(), "transition {}: {}", r.id, s.status);
        }
    }
}

#[test]
fn long_legs_are_solved_and_can_be_flown() {
    let mut workspace = Workspace::new();
    for (id, distance) in [(0, 100.0), (1, 500.0), (2, 2000.0)] {
        let r = &references()[id];
        let shift = SVector::<f64, 3>::new(distance, 0.3 * distance, 0.0);
        let mut end = r.end;
        for i in 0..3 {
            end[i] += shift[i];
        }
        let t = thrust_rate(&r.start, &end);
        let mesh = Mesh::graded(80, 0.9);
        let s = solve(
            &mut workspace,
            &t,
            &mesh,
            Transcription::RungeKutta { substeps: 8 },
            &naive_guess(&t, hover_thrust_rate()),
        );
        assert_flyable(id, &t, &s);
    }
}
