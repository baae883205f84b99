//! The general sparse factorisation against the Riccati recursion.
#![cfg(feature = "faer")]
#![allow(dead_code)]

#[path = "known_problems/catalogue.rs"]
mod catalogue;
mod common;

use catalogue::definition::Mode;
use common::quadcopter::*;
use traj_opt::{Guess, LinearAlgebra, Mesh, Options, Problem, Transcription, solve};

/// Problems of a single minimum that take few iterations.
const SMOOTH: [&str; 8] = [
    "double_integrator",
    "triple_integrator",
    "block_move",
    "brachistochrone",
    "bryson_denham",
    "linear_tangent",
    "vanderpol",
    "cartpole_kelly",
];

#[test]
fn known_problems_have_the_same_solutions() {
    let mut failures = vec![];
    for known in catalogue::all() {
        if !SMOOTH.contains(&known.name) {
            continue;
        }
        for transcription in [
            Transcription::HermiteSimpson,
            Transcription::Trapezoidal,
            Transcription::LegendreGaussRadau { degree: 3 },
            Transcription::RungeKutta { substeps: 2 },
        ] {
            let mode = Mode::Fixed(known.segments.min(20));
            let [one, other] = [LinearAlgebra::Riccati, LinearAlgebra::Sparse]
                .map(|algebra| known.run_with(transcription, &mode, algebra));
            println!(
                "{} {transcription:?}: {} and {} iterations",
                known.name, one.iterations, other.iterations
            );
            let difference = (one.value - other.value).abs() / one.value.abs();
            if !(one.status.is_success() == other.status.is_success() && difference < 1e-5) {
                failures.push(format!(
                    "{} {transcription:?}: {} {} {}, sparse {} {} {}",
                    known.name,
                    one.value,
                    one.status,
                    one.iterations,
                    other.value,
                    other.status,
                    other.iterations
                ));
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

/// Final time and iterations of a transition with either factorisation.
fn both<P: Problem<NX, 4>, const NX: usize>(
    problem: &P,
    transcription: Transcription,
    guess: &Guess<NX, 4>,
) -> [(f64, usize); 2] {
    [LinearAlgebra::Riccati, LinearAlgebra::Sparse].map(|algebra| {
        let options = Options::default().with_linear_algebra(algebra);
        let s = solve(problem, &Mesh::uniform(20), transcription, guess, &options).expect("valid input");
        assert!(s.status.is_success(), "{transcription:?} {algebra:?}: {}", s.status);
        (s.objective, s.iterations)
    })
}

/// Four and twelve controls a segment and ten or thirteen border columns: what the recursion is compiled for.
#[test]
fn transitions_have_the_same_solutions() {
    for r in references().iter().take(2) {
        for transcription in [Transcription::HermiteSimpson, Transcription::RungeKutta { substeps: 2 }] {
            let t = thrust_rate(&r.start, &r.end);
            let one = both(&t, transcription, &naive_guess(&t, hover_thrust_rate()));
            let t = rigid_body(&r.start, &r.end);
            let other = both(&t, transcription, &naive_guess(&t, hover_rigid_body()));
            for [riccati, sparse] in [one, other] {
                println!("transition {} {transcription:?}: {riccati:?} {sparse:?}", r.id);
                assert!((riccati.0 - sparse.0).abs() < 1e-5 * sparse.0, "{riccati:?} {sparse:?}");
            }
        }
    }
}
