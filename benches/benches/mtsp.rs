//! The paper's pipeline, lower bounds, search and replanning on 100 targets with 8 vehicles.
#![allow(missing_docs)]

use benches::depot_and_targets;
use christofides::Points;
use cluster::{KMeansOptions, kmeans};
use criterion::{Criterion, criterion_group, criterion_main};
use mtsp::{Absorb, Fleet, Options, Problem, Revisit, assign, lower_bound, solve};
use std::hint::black_box;

fn bench(c: &mut Criterion) {
    let nodes = depot_and_targets(100);
    let metric = Points(&nodes);
    let Ok(problem) = Problem::new(&metric, 8) else { return };
    let Ok(clusters) = kmeans(&nodes[1..], 8, &KMeansOptions::default()) else { return };
    c.bench_function("mtsp/assign/n100-m8", |b| b.iter(|| assign(black_box(&problem), &clusters.labels)));
    c.bench_function("mtsp/lower_bound/n100-m8", |b| b.iter(|| lower_bound::both(black_box(&problem))));
    let mut group = c.benchmark_group("mtsp/search");
    group.sample_size(10);
    let options = Options::default().with_iterations(50_000);
    group.bench_function("solve-50000/n100-m8", |b| b.iter(|| solve(black_box(&problem), &options)));
    let fewer = Points(&nodes[..41]);
    let Ok(small) = Problem::new(&fewer, 5) else { return };
    let Ok(solution) = solve(&small, &options) else { return };
    group.bench_function("columns/n40-m5", |b| {
        b.iter(|| lower_bound::columns(black_box(&small), &solution.routes, 0, &mut || true));
    });
    group.finish();
    let mut fleet = Fleet::new(Revisit::All, Absorb::NearestCluster);
    for _ in 0..8 {
        let _ = fleet.join([0.0, 0.0]);
    }
    for &target in &nodes[1..] {
        let _ = fleet.appear(target);
    }
    c.bench_function("mtsp/replan-one-of-100", |b| {
        b.iter_batched_ref(
            || fleet.clone(),
            |fleet| {
                let _ = fleet.appear(black_box([123.0, -456.0]));
                let owner = fleet.vehicles().max_by_key(|v| fleet.cluster(*v).map_or(0, <[_]>::len));
                owner.map(|v| fleet.retour(v))
            },
            criterion::BatchSize::SmallInput,
        );
    });
}

criterion_group!(benches, bench);
criterion_main!(benches);
