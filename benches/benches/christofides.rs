//! Christofides' algorithm and its parts. Quality is printed beside time.

use benches::{SEED, uniform};
use christofides::matching::Solver;
use christofides::{Points, chained_improve, christofides, exact_tour, held_karp};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use std::hint::black_box;

fn matching(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("christofides/matching");
    group.sample_size(20);
    for n in [100, 1000, 3000, 10_000] {
        let points = uniform(SEED, n);
        let mut solver = Solver::default();
        group.bench_function(BenchmarkId::from_parameter(n), |bencher| {
            bencher.iter(|| solver.complete(&Points(black_box(&points))));
        });
    }
}

fn whole(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("christofides/whole");
    group.sample_size(10);
    for n in [12, 100, 1000, 10_000, 100_000] {
        let points = uniform(SEED, n);
        group.bench_function(BenchmarkId::from_parameter(n), |bencher| {
            bencher.iter(|| christofides(&Points(black_box(&points))));
        });
    }
}

fn chained(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("christofides/chained");
    group.sample_size(10);
    for (n, kicks) in [(100, 1000), (1000, 1000)] {
        let points = uniform(SEED, n);
        let metric = Points(&points);
        let Ok(start) = christofides(&metric) else { return };
        let improve = || chained_improve(&metric, start.clone(), kicks, 1, &mut || false);
        if let (Ok(tour), Ok(bound)) = (improve(), held_karp(&metric, 1000)) {
            let gap = 100.0 * (tour.cost() / bound.value() - 1.0);
            println!("chained/{n}: {kicks} kicks end {gap:.3} % above the Held-Karp bound");
        }
        group.bench_function(BenchmarkId::from_parameter(n), |bencher| bencher.iter(|| black_box(improve())));
    }
}

fn bound(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("christofides/held_karp");
    group.sample_size(10);
    for n in [100, 1000] {
        let points = uniform(SEED, n);
        group.bench_function(BenchmarkId::from_parameter(n), |bencher| {
            bencher.iter(|| held_karp(&Points(black_box(&points)), 400));
        });
    }
}

fn exact(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("christofides/exact");
    group.sample_size(10);
    for n in [8, 12, 40] {
        let points = uniform(SEED, n);
        group.bench_function(BenchmarkId::from_parameter(n), |bencher| {
            bencher.iter(|| exact_tour(&Points(black_box(&points))));
        });
    }
}

criterion_group!(benches, matching, whole, chained, bound, exact);
criterion_main!(benches);
