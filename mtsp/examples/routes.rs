//! Routes for the nodes of a file, with a certificate.
//!
//! `routes FILE.tsp|FILE.csv --vehicles M [--objective min-max|min-sum] [--open] [--seconds S | --iterations N] [--seed K] [--json]
//! [--bound-seconds S]`
//!
//! `--bound-seconds` takes that long at most for a tighter lower bound of the longest closed route (feature `columns`).
//! The first node is the depot; distances are Euclidean, not rounded.

use christofides::Points;
use mtsp::{Objective, Options, Problem, Solution, solve_with};
use std::time::Instant;

/// Iterations that fit a second on a common machine, up to a few thousand nodes (distances stored) and beyond: the annealing is planned
/// for them, the clock has the last word.
const ITERATIONS_A_SECOND: f64 = 500_000.0;
const STORED: usize = 3000;
const ITERATIONS_A_SECOND_BEYOND: f64 = 130_000.0;

#[cfg(feature = "columns")]
const MAX_CUTS: usize = 150;

struct Arguments {
    file: String,
    vehicles: usize,
    objective: Objective,
    open: bool,
    seconds: f64,
    iterations: Option<u64>,
    seed: u64,
    json: bool,
    bound_seconds: f64,
}

fn arguments() -> Result<Arguments, String> {
    let mut given = std::env::args().skip(1);
    let mut a = Arguments {
        file: given.next().ok_or("which file?")?,
        vehicles: 0,
        objective: Objective::Makespan,
        open: false,
        seconds: 1.0,
        iterations: None,
        seed: 0,
        json: false,
        bound_seconds: 0.0,
    };
    while let Some(key) = given.next() {
        let mut value = || given.next().ok_or(format!("{key} needs a value"));
        match key.as_str() {
            "--open" => a.open = true,
            "--json" => a.json = true,
            "--vehicles" => a.vehicles = number(&value()?)?,
            "--seconds" => a.seconds = number(&value()?)?,
            "--iterations" => a.iterations = Some(number(&value()?)?),
            "--bound-seconds" => a.bound_seconds = number(&value()?)?,
            "--seed" => a.seed = number(&value()?)?,
            "--objective" => {
                a.objective = match value()?.as_str() {
                    "min-max" => Objective::Makespan,
                    "min-sum" => Objective::Total,
                    other => return Err(format!("unknown objective {other}")),
                }
            }
            _ => return Err(format!("unknown option {key}")),
        }
    }
    Ok(a)
}

fn number<T: std::str::FromStr>(text: &str) -> Result<T, String> {
    text.parse().map_err(|_| format!("not a number: {text}"))
}

/// The last two numbers of each line that holds nothing but numbers: coordinates in a CSV as in a TSPLIB file.
fn read_nodes(file: &str) -> Result<Vec<[f64; 2]>, String> {
    let text = std::fs::read_to_string(file).map_err(|e| format!("{file}: {e}"))?;
    let numbers = |line: &str| -> Option<Vec<f64>> {
        let words = line.split([',', ' ', '\t', '\r']).filter(|w| !w.is_empty());
        words.map(|w| w.parse().ok()).collect()
    };
    let rows = text.lines().filter_map(numbers).filter(|row| row.len() >= 2);
    Ok(rows.map(|row| [row[row.len() - 2], row[row.len() - 1]]).collect())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let a = arguments()?;
    let nodes = read_nodes(&a.file)?;
    let metric = Points(&nodes);
    let begin = Instant::now();
    let mut problem = Problem::new(&metric, a.vehicles)?;
    if a.open {
        problem = problem.with_open_routes();
    }
    let mut options = Options::default().with_objective(a.objective).with_seed(a.seed);
    options = match a.iterations {
        Some(iterations) => options.with_iterations(iterations),
        None => {
            let rate = if nodes.len() < STORED { ITERATIONS_A_SECOND } else { ITERATIONS_A_SECOND_BEYOND };
            let horizon = (a.seconds * rate) as u64;
            options.with_horizon(horizon.max(1000)).with_iterations(u64::MAX)
        }
    };
    let mut best = f64::INFINITY;
    let mut trace = Vec::new();
    let mut solution = solve_with(&problem, &options, &mut |progress| {
        let value = if a.objective == Objective::Total { progress.total_cost } else { progress.makespan };
        if value < best {
            best = value;
            trace.push((begin.elapsed().as_secs_f64(), value));
        }
        a.iterations.is_some() || begin.elapsed().as_secs_f64() < a.seconds
    })?;
    let seconds = begin.elapsed().as_secs_f64();
    if a.bound_seconds > 0.0 {
        tighten(&problem, &mut solution, a.bound_seconds)?;
    }
    if a.json {
        print_json(&a, nodes.len(), &solution, seconds)
    } else {
        print(&a, &solution, seconds, &trace)
    }
    Ok(())
}

#[cfg(feature = "columns")]
fn tighten(
    problem: &Problem<'_, Points<'_, 2>>,
    solution: &mut Solution,
    seconds: f64,
) -> Result<(), mtsp::Error> {
    let begin = Instant::now();
    let proceed = &mut || begin.elapsed().as_secs_f64() < seconds;
    solution.lower_bounds.makespan =
        mtsp::lower_bound::columns(problem, &solution.routes, MAX_CUTS, proceed)?;
    Ok(())
}

#[cfg(not(feature = "columns"))]
fn tighten(_: &Problem<'_, Points<'_, 2>>, _: &mut Solution, _: f64) -> Result<(), String> {
    Err("--bound-seconds needs the feature columns".into())
}

fn print_json(a: &Arguments, n: usize, solution: &Solution, seconds: f64) {
    let objective = if a.objective == Objective::Total { "min-sum" } else { "min-max" };
    let report = serde_json::json!({
        "n": n,
        "vehicles": a.vehicles,
        "objective": objective,
        "value": solution.value(a.objective),
        "total": solution.total_cost,
        "makespan": solution.makespan,
        "lower_bound": solution.lower_bound(a.objective),
        "gap": solution.gap(a.objective),
        "seconds": seconds,
        "routes": solution.routes,
    });
    println!("{report}");
}

fn print(a: &Arguments, solution: &Solution, seconds: f64, trace: &[(f64, f64)]) {
    for (time, value) in trace {
        println!("{time:8.3} s  {value:.3}");
    }
    for (vehicle, (route, length)) in solution.routes.iter().zip(&solution.lengths).enumerate() {
        println!("vehicle {}: length {length:.3}, targets {route:?}", vehicle + 1);
    }
    println!("makespan {:.3}, total {:.3}, after {seconds:.3} s", solution.makespan, solution.total_cost);
    let (bound, gap) = (solution.lower_bound(a.objective), solution.gap(a.objective));
    println!("value {:.3}, lower bound {bound:.3}, gap {:.2} %", solution.value(a.objective), 100.0 * gap);
}
