//! Points to try the other examples with: uniform ones, and those that are hostile to matching.
//!
//! `cargo run --release -p christofides --example points -- KIND N [SEED] > FILE.csv`, where the kind is `uniform`, `clusters`,
//! `triples`, `duplicates` or `nested` (triples of triples of triples, each level a quarter of the one around it).

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use std::error::Error;
use std::f64::consts::TAU;
use std::io::{BufWriter, Write};

/// Side of the square.
const SIDE: f64 = 1e6;

/// Points of a cluster, their distance from its centre, and that of a triple's corners from theirs.
const CLUSTER: usize = 100;
const CLUSTER_SPREAD: f64 = 3000.0;
const TRIPLE_SPREAD: f64 = 100.0;

/// Points that share a place.
const COPIES: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let usage = "usage: points uniform|clusters|triples|duplicates|nested N [SEED]";
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (kind, n, seed) = match &arguments[..] {
        [kind, n] => (kind, n.parse()?, 1),
        [kind, n, seed] => (kind, n.parse()?, seed.parse()?),
        _ => return Err(usage.into()),
    };
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let points = match kind.as_str() {
        "uniform" => (0..n).map(|_| anywhere(&mut rng)).collect(),
        "clusters" => around(&mut rng, n, CLUSTER, CLUSTER_SPREAD),
        "triples" => around(&mut rng, n, 3, TRIPLE_SPREAD),
        "duplicates" => around(&mut rng, n, COPIES, 0.0),
        "nested" => nested(&mut rng, n),
        _ => return Err(usage.into()),
    };
    let mut out = BufWriter::new(std::io::stdout().lock());
    for [x, y] in points {
        writeln!(out, "{x},{y}")?;
    }
    Ok(out.flush()?)
}

fn anywhere(rng: &mut Xoshiro256PlusPlus) -> [f64; 2] {
    [rng.random_range(0.0..SIDE), rng.random_range(0.0..SIDE)]
}

/// A point at a random angle and, mostly, a distance about `spread`.
fn near(rng: &mut Xoshiro256PlusPlus, [x, y]: [f64; 2], spread: f64) -> [f64; 2] {
    let (angle, distance) =
        (rng.random_range(0.0..TAU), spread * (-2.0 * rng.random_range(f64::EPSILON..1.0).ln()).sqrt());
    [x + distance * angle.cos(), y + distance * angle.sin()]
}

/// Groups of `size` points about random centres.
fn around(rng: &mut Xoshiro256PlusPlus, n: usize, size: usize, spread: f64) -> Vec<[f64; 2]> {
    let centres: Vec<[f64; 2]> = (0..n.div_ceil(size)).map(|_| anywhere(rng)).collect();
    (0..n).map(|k| near(rng, centres[k / size], spread)).collect()
}

/// Corners of triangles at whose corners stand smaller triangles, each turned at random, down to single points.
fn nested(rng: &mut Xoshiro256PlusPlus, n: usize) -> Vec<[f64; 2]> {
    let mut centres = vec![[0.0; 2]];
    let mut radius = SIDE;
    while centres.len() < n {
        let mut corners = Vec::with_capacity(3 * centres.len());
        for [x, y] in centres {
            let turn = rng.random_range(0.0..TAU);
            corners.extend((0..3).map(|k| {
                let (sin, cos) = (turn + f64::from(k) * TAU / 3.0).sin_cos();
                [x + radius * cos, y + radius * sin]
            }));
        }
        (centres, radius) = (corners, radius / 4.0);
    }
    centres.truncate(n);
    centres
}
