//! Minimum-weight perfect matching of the complete graph on the points of a file, by the crate `integer-blossom`.
//! Prints seconds and weight; distances are rounded to a billionth of the greatest coordinate.

use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("usage: blossom-peer FILE.csv")?;
    let text = std::fs::read_to_string(file)?;
    let points: Vec<[f64; 2]> = text
        .lines()
        .filter_map(|line| line.split_once(','))
        .filter_map(|(x, y)| Some([x.trim().parse().ok()?, y.trim().parse().ok()?]))
        .collect();
    let n = points.len();
    let distance = |i: usize, j: usize| (points[i][0] - points[j][0]).hypot(points[i][1] - points[j][1]);
    let greatest = points.iter().flatten().fold(1.0_f64, |greatest, x| greatest.max(x.abs()));

    let start = Instant::now();
    let cost: Vec<i64> = (0..n * n).map(|k| (distance(k / n, k % n) * 1e9 / greatest) as i64).collect();
    let mates = integer_blossom::min_weight_perfect_matching(&cost, n);
    let seconds = start.elapsed().as_secs_f64();
    let weight: f64 = mates.iter().enumerate().filter(|&(i, &j)| i < j).map(|(i, &j)| distance(i, j)).sum();
    println!("{seconds} {weight}");
    Ok(())
}
