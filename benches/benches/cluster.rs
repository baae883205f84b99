//! k-means, complete linkage and merging on uniform points.
#![allow(missing_docs)]

use benches::{SEED, uniform};
use cluster::{KMeansOptions, Linkage, kmeans, linkage, linkage_condensed, merge_within};
use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use std::hint::black_box;

fn bench(c: &mut Criterion) {
    let one_run = KMeansOptions::default().with_n_init(1);
    let small = uniform(SEED, 100);
    c.bench_function("cluster/kmeans/n100-k8", |b| b.iter(|| kmeans(black_box(&small), 8, &one_run)));
    let large = uniform(SEED, 100_000);
    let mut group = c.benchmark_group("cluster/large");
    group.sample_size(10);
    for k in [8, 64, 256] {
        group.bench_function(format!("kmeans/n100000-k{k}"), |b| {
            b.iter(|| kmeans(black_box(&large), k, &one_run));
        });
    }
    group.bench_function("merge_within/n100000", |b| b.iter(|| merge_within(black_box(&large), 0.001)));
    let middle = uniform(SEED, 2000);
    group.bench_function("linkage/complete/n2000", |b| {
        b.iter(|| linkage(black_box(&middle), Linkage::Complete))
    });
    let mut condensed = Vec::new();
    for i in 0..middle.len() {
        condensed.extend(middle[i + 1..].iter().map(|q| (middle[i][0] - q[0]).hypot(middle[i][1] - q[1])));
    }
    // Both overwrite the matrix, so both get a copy; the peer is the crate that the workspace builds on.
    group.bench_function("linkage_condensed/complete/n2000", |b| {
        b.iter_batched_ref(
            || condensed.clone(),
            |d| linkage_condensed(d, middle.len(), Linkage::Complete),
            BatchSize::LargeInput,
        );
    });
    group.bench_function("kodama/complete/n2000", |b| {
        b.iter_batched_ref(
            || condensed.clone(),
            |d| kodama::linkage(d, middle.len(), kodama::Method::Complete),
            BatchSize::LargeInput,
        );
    });
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
