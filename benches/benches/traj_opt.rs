//! One reference transition of either model from the cubic guess, its neighbour from its solution, and the cost by segments.
#![allow(missing_docs)]

#[path = "../../traj-opt/tests/common/mod.rs"]
mod common;

use common::quadcopter::{Transition, cubic_guess, references, rigid_body, thrust_rate};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::ops::ControlFlow;
use traj_opt::{
    Dynamics, Guess, Iteration, Mesh, Options, Solution, Transcription, Workspace, solve_from, solve_with,
};

/// How far the end of the neighbour lies from that of the transition (m).
const SHIFT: f64 = 0.2;
const SCHEME: Transcription = Transcription::HermiteSimpson;

fn proceed(_: &Iteration) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn options() -> Options {
    Options::default().with_tolerance(3e-6).with_initial_mu(0.01)
}

/// Solves on so many equal segments; no answer where the input is refused.
fn cold<D: Dynamics<NX, 4>, const NX: usize>(
    workspace: &mut Workspace<NX, 4>,
    transition: &Transition<D, NX>,
    guess: &Guess<NX, 4>,
    segments: usize,
) -> Option<Solution<NX, 4>> {
    solve_with(workspace, transition, &Mesh::uniform(segments), SCHEME, guess, &options(), proceed).ok()
}

fn model<D: Dynamics<NX, 4>, const NX: usize>(
    c: &mut Criterion,
    name: &str,
    [transition, neighbour]: [&Transition<D, NX>; 2],
) {
    let mut workspace = Workspace::new();
    let guess = cubic_guess(transition);
    let Some(solved) = cold(&mut workspace, transition, &guess, 40) else { return };
    c.bench_function(&format!("traj-opt/{name}/cold"), |b| {
        b.iter(|| cold(&mut workspace, black_box(transition), &guess, 40));
    });
    let options = Options::default().with_tolerance(1e-5);
    c.bench_function(&format!("traj-opt/{name}/neighbour"), |b| {
        b.iter(|| solve_from(&mut workspace, black_box(neighbour), &solved, SCHEME, &options, proceed));
    });
}

/// So many iterations on each mesh: what one of them costs is what grows.
const ITERATIONS: usize = 10;

fn by_segments<D: Dynamics<NX, 4>, const NX: usize>(c: &mut Criterion, transition: &Transition<D, NX>) {
    let mut workspace = Workspace::new();
    let guess = cubic_guess(transition);
    let options = options().with_max_iterations(ITERATIONS);
    let mut group = c.benchmark_group("traj-opt/segments");
    group.sample_size(10);
    for segments in [50, 100, 200, 500, 1000, 2000] {
        let mesh = Mesh::uniform(segments);
        group.throughput(Throughput::Elements(segments as u64));
        group.bench_with_input(BenchmarkId::from_parameter(segments), &mesh, |b, mesh| {
            b.iter(|| solve_with(&mut workspace, transition, mesh, SCHEME, &guess, &options, proceed));
        });
    }
    group.finish();
}

fn bench(c: &mut Criterion) {
    let references = references();
    let reference = &references[0];
    let mut moved = reference.end;
    moved[0] += SHIFT;
    let rates = thrust_rate(&reference.start, &reference.end);
    model(c, "thrust-rate", [&rates, &thrust_rate(&reference.start, &moved)]);
    let rotors = rigid_body(&reference.start, &reference.end);
    model(c, "rigid-body", [&rotors, &rigid_body(&reference.start, &moved)]);
    by_segments(c, &rates);
}

criterion_group!(benches, bench);
criterion_main!(benches);
