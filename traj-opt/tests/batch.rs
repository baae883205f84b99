//! Many problems at once.
mod common;

use common::quadcopter::*;
use traj_opt::{Error, Guess, Mesh, Options, Transcription, solve, solve_batch};

#[test]
fn a_batch_equals_single_solves_to_the_bit_on_any_number_of_threads() {
    let mesh = Mesh::uniform(20);
    let options = Options::default().with_tolerance(1e-6);
    let scheme = Transcription::HermiteSimpson;
    let cases: Vec<_> = references()
        .iter()
        .step_by(5)
        .map(|r| {
            let t = thrust_rate(&r.start, &r.end);
            let guess = naive_guess(&t, hover_thrust_rate());
            (t, guess)
        })
        .collect();
    let single: Vec<_> = cases.iter().map(|(t, guess)| solve(t, &mesh, scheme, guess, &options)).collect();
    let run = || solve_batch(&cases, &mesh, scheme, &options);
    #[cfg(feature = "rayon")]
    let batches = [1, 2, 5].map(|n| {
        rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("a pool of threads").install(run)
    });
    #[cfg(not(feature = "rayon"))]
    let batches = [run()];
    for batch in batches {
        assert_eq!(batch.len(), single.len());
        for (one, alone) in batch.iter().zip(&single) {
            let (one, alone) = (one.as_ref().expect("valid input"), alone.as_ref().expect("valid input"));
            assert!(one.status.is_success());
            assert_eq!((one.states(), one.controls()), (alone.states(), alone.controls()));
            assert_eq!((one.iterations, &one.multipliers), (alone.iterations, &alone.multipliers));
        }
    }
}

#[test]
fn a_malformed_case_does_not_spoil_the_others_and_none_is_no_problem() {
    let r = &references()[0];
    let good = thrust_rate(&r.start, &r.end);
    let guess = naive_guess(&good, hover_thrust_rate());
    let nowhere: Guess<10, 4> =
        Guess::from_fn(f64::NAN, 4, |_| (r.start.fixed_rows::<10>(0).into(), hover_thrust_rate()));
    let cases = [(thrust_rate(&r.start, &r.end), nowhere), (good, guess)];
    let mesh = Mesh::uniform(20);
    let solved = solve_batch(&cases, &mesh, Transcription::Trapezoidal, &Options::default());
    assert!(matches!(solved[0], Err(Error::NonFiniteGuess { .. })));
    assert!(solved[1].as_ref().is_ok_and(|s| s.status.is_success()));
    assert!(solve_batch(&cases[..0], &mesh, Transcription::Trapezoidal, &Options::default()).is_empty());
}
