//! Time and result of a clustering of the points of a file, for comparison with other programs.
//!
//! `measure FILE.csv kmeans K RESTARTS SEED RUNS` prints the inertia and the least seconds of some runs, which differ in nothing;
//! `measure FILE.csv complete RUNS` the sum of all merge heights and the least seconds. Two numbers a line, nothing else in the file.

use cluster::{KMeansOptions, Linkage, kmeans, linkage};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize| -> Result<usize, Box<dyn std::error::Error>> {
        Ok(given.get(i).ok_or("an argument is missing")?.parse()?)
    };
    let mut points = Vec::new();
    for line in std::fs::read_to_string(given.first().ok_or("which file?")?)?.lines() {
        let (x, y) = line.split_once(',').ok_or("a line without a comma")?;
        points.push([x.parse()?, y.parse()?]);
    }
    match given.get(1).map(String::as_str) {
        Some("kmeans") => {
            let options = KMeansOptions::default().with_n_init(number(3)?).with_seed(number(4)? as u64);
            let k = number(2)?;
            report(number(5)?, || Ok(kmeans(&points, k, &options)?.inertia))
        }
        Some("complete") => report(number(2)?, || {
            Ok(linkage(&points, Linkage::Complete)?.steps().iter().map(|step| step.dissimilarity).sum())
        }),
        _ => Err("kmeans or complete?".into()),
    }
}

/// Prints what `run` returns and its least time.
fn report(
    runs: usize,
    run: impl Fn() -> Result<f64, cluster::Error>,
) -> Result<(), Box<dyn std::error::Error>> {
    let (mut seconds, mut value) = (f64::INFINITY, 0.0);
    for _ in 0..runs.max(1) {
        let begin = Instant::now();
        value = run()?;
        seconds = begin.elapsed().as_secs_f64().min(seconds);
    }
    println!("{value} {seconds}");
    Ok(())
}
