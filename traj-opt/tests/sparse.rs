//! The general sparse factorisation against the Riccati recursion.
#![cfg(feature = "faer")]
#![allow(dead_code)]

#[path = "known_problems/catalogue.rs"]
mod catalogue;

use catalogue::definition::Mode;
use traj_opt::{LinearAlgebra, Transcription};

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
