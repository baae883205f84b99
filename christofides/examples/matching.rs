//! Minimum-weight perfect matching of the points of a file, with its certificate.
//!
//! `cargo run --release -p christofides --example matching -- FILE.csv [--json]`, where each line of the file is `x,y`.

use christofides::Points;
use christofides::matching::{certificate, min_weight_perfect_matching};
use std::error::Error;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let json = arguments.iter().any(|argument| argument == "--json");
    arguments.retain(|argument| argument != "--json");
    let [file] = &arguments[..] else { return Err("usage: matching FILE.csv [--json]".into()) };
    let points = read_points(&std::fs::read_to_string(file)?)?;
    let metric = Points(&points);

    let start = Instant::now();
    let matching = min_weight_perfect_matching(&metric)?;
    let seconds = start.elapsed().as_secs_f64();
    let proof = certificate(&metric, &matching);
    let (weight, error_bound) = (matching.weight(), matching.error_bound());
    // What summing the duals in floating point may lose comes on top of the quantisation.
    let certified = proof.is_optimal_within(error_bound + 1e-9 * weight);
    let peak_bytes = peak_bytes().unwrap_or(0);
    if json {
        let n = points.len();
        println!(
            r#"{{"n": {n}, "weight": {weight}, "error_bound": {error_bound}, "certified": {certified}, "seconds": {seconds}, "peak_bytes": {peak_bytes}}}"#
        );
    } else {
        println!("points       {}", points.len());
        println!("weight       {weight} (at most {error_bound:.3e} above the optimum)");
        println!(
            "certificate  {}: every matching weighs at least {}",
            if certified { "holds" } else { "FAILS" },
            proof.lower_bound
        );
        println!("time         {seconds:.6} s");
        println!("peak memory  {:.1} MiB", peak_bytes as f64 / (1 << 20) as f64);
    }
    Ok(())
}

fn read_points(text: &str) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
    let is_data = |line: &&str| !line.trim().is_empty() && line.trim() != "x,y";
    let point = |line: &str| {
        let (x, y) = line.split_once(',').ok_or_else(|| format!("no comma in line {line:?}"))?;
        Ok([x.trim().parse()?, y.trim().parse()?])
    };
    text.lines().filter(is_data).map(point).collect()
}

/// The peak of the resident memory, where the operating system tells it as Linux does.
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kibibytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kibibytes * 1024)
}
