//! A short tour with a proven bound, for TSPLIB and CSV files.
//!
//! `cargo run --release -p christofides --example tour -- FILE [--seconds S] [--seed K] [--ascent ITERATIONS] [--no-bound]
//! [--tsplib-rounding] [--json]`
//!
//! The bound takes time of its own, `--ascent` times a minimum spanning tree (default 600, more do not raise it by 1e-4); at 100 000
//! vertices a few tens of iterations are a cheap bound, and `--no-bound` leaves it out.

use christofides::tsplib::Instance;
use christofides::{Tour, chained_improve, christofides, held_karp};
use std::error::Error;
use std::time::{Duration, Instant};

/// Iterations of the ascent: more do not raise the bound by 1e-4.
const ASCENT: usize = 600;

struct Arguments {
    file: String,
    seconds: f64,
    seed: u64,
    /// Iterations of the bound's ascent, if there is to be one.
    ascent: Option<usize>,
    rounding: bool,
    json: bool,
}

struct Report {
    christofides: f64,
    tour: Tour,
    lower_bound: Option<f64>,
    seconds: [f64; 3],
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = parse(std::env::args().skip(1))?;
    let text = std::fs::read_to_string(&arguments.file)?;
    let instance =
        if Instance::is_one(&text) { Instance::read(&text)? } else { Instance::planar(points(&text)?) };
    let report = run(&instance, &arguments)?;
    let length = report.tour.cost();
    let gap_to = |bound: f64| if length <= bound { 0.0 } else { length / bound - 1.0 };
    if arguments.json {
        let seconds: f64 = report.seconds.iter().sum();
        let (n, christofides) = (instance.len(), report.christofides);
        let number = |x: Option<f64>| x.map_or("null".to_owned(), |x| x.to_string());
        let (bound, gap) = (number(report.lower_bound), number(report.lower_bound.map(gap_to)));
        println!(
            r#"{{"n": {n}, "christofides": {christofides}, "length": {length}, "lower_bound": {bound}, "gap": {gap}, "seconds": {seconds}, "tour": {:?}}}"#,
            report.tour.order()
        );
    } else {
        let [first, second, third] = report.seconds;
        println!("vertices      {}", instance.len());
        println!("christofides  {:<16} in {first:.6} s", report.christofides);
        println!("improved      {length:<16} in {second:.6} s");
        if let Some(bound) = report.lower_bound {
            println!("lower bound   {bound:<16.6} in {third:.6} s");
            println!("gap           {:.4} %", 100.0 * gap_to(bound));
        }
    }
    Ok(())
}

/// The points of lines `x,y`.
fn points(text: &str) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
    let is_data = |line: &&str| !line.trim().is_empty() && line.trim() != "x,y";
    let point = |line: &str| -> Result<[f64; 2], Box<dyn Error>> {
        let (x, y) = line.split_once(',').ok_or_else(|| format!("no comma in line {line:?}"))?;
        Ok([x.trim().parse()?, y.trim().parse()?])
    };
    text.lines().filter(is_data).map(point).collect()
}

fn run(instance: &Instance, arguments: &Arguments) -> Result<Report, Box<dyn Error>> {
    let exact = instance.metric(false);
    let metric = instance.metric(arguments.rounding);
    let start = Instant::now();
    let first = christofides(&exact)?;
    let first_seconds = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let deadline = Duration::from_secs_f64(arguments.seconds);
    let first = Tour::new(&metric, first.into_order())?;
    let christofides = first.cost();
    let tour =
        chained_improve(&metric, first, usize::MAX, arguments.seed, &mut || start.elapsed() >= deadline)?;
    let second_seconds = start.elapsed().as_secs_f64();

    let start = Instant::now();
    let bound = arguments.ascent.map(|iterations| held_karp(&metric, iterations)).transpose()?;
    let whole = |bound: f64| if metric.are_whole() { (bound - 1e-6).ceil() } else { bound };
    let lower_bound = bound.map(|bound| whole(bound.value()));
    let seconds = [first_seconds, second_seconds, start.elapsed().as_secs_f64()];
    Ok(Report { christofides, tour, lower_bound, seconds })
}

fn parse(mut words: impl Iterator<Item = String>) -> Result<Arguments, Box<dyn Error>> {
    let mut arguments = Arguments {
        file: String::new(),
        seconds: 1.0,
        seed: 1,
        ascent: Some(ASCENT),
        rounding: false,
        json: false,
    };
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or_else(|| format!("{word} needs a value"));
        match word.as_str() {
            "--seconds" => arguments.seconds = value()?.parse()?,
            "--seed" => arguments.seed = value()?.parse()?,
            "--ascent" => arguments.ascent = Some(value()?.parse()?),
            "--no-bound" => arguments.ascent = None,
            "--tsplib-rounding" => arguments.rounding = true,
            "--json" => arguments.json = true,
            _ => arguments.file = word,
        }
    }
    let is_usable = !arguments.file.is_empty() && Duration::try_from_secs_f64(arguments.seconds).is_ok();
    let usage = "usage: tour FILE [--seconds S] [--seed K] [--ascent ITERATIONS] [--no-bound] [--tsplib-rounding] [--json]";
    if is_usable { Ok(arguments) } else { Err(usage.into()) }
}
