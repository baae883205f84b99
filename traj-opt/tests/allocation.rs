//! Iterations allocate nothing.
mod common;

use common::quadcopter::*;
use nalgebra::SVector;
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;
use std::ops::ControlFlow;
use traj_opt::{Mesh, Options, Transcription, Workspace, solve_with};

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// The only test of this file, because the counters belong to the process.
#[test]
fn nothing_is_allocated_between_iterations() {
    let r = &references()[0];
    let t = thrust_rate(&r.start, &r.end);
    let guess = naive_guess(&t, hover_thrust_rate());
    let mesh = Mesh::uniform(20);
    for transcription in [
        Transcription::HermiteSimpson,
        Transcription::CompressedHermiteSimpson,
        Transcription::Trapezoidal,
        Transcription::RungeKutta { substeps: 2 },
        Transcription::LegendreGaussRadau { degree: 3 },
    ] {
        let mut workspace = Workspace::new();
        let options = Options::default().with_max_iterations(60);
        let mut seen = [0; 400];
        let mut n = 0;
        // the first solve of a shape may size scratch in its first iteration; the second may not even do that
        for _ in 0..2 {
            n = 0;
            let watch = |_: &traj_opt::Iteration| {
                if n < seen.len() {
                    let stats = ALLOCATOR.stats();
                    seen[n] = stats.allocations + stats.reallocations;
                }
                n += 1;
                ControlFlow::Continue(())
            };
            solve_with(&mut workspace, &t, &mesh, transcription, &guess, &options, watch)
                .expect("valid input");
        }
        assert!(n > 5, "{transcription:?}: {n} iterations seen");
        let used = &seen[..n.min(seen.len())];
        assert!(used.iter().all(|count| *count == used[0]), "{transcription:?}: {used:?}");
    }
    // and the counter does count
    let before = ALLOCATOR.stats().allocations;
    let kept = vec![SVector::<f64, 3>::zeros(); 10];
    assert!(ALLOCATOR.stats().allocations > before && kept.len() == 10);
}
