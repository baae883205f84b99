//! A tour of places on a road network, flown or driven along the roads.
//!
//! `cargo run --release -p christofides --features petgraph --example roads`

use christofides::{Matrix, Metric, Options, solve};
use petgraph::graph::{NodeIndex, UnGraph};
use std::error::Error;

/// Streets of a small town: a ring, two streets across it and a dead end; lengths in kilometres.
const STREETS: [(u32, u32, f64); 11] = [
    (0, 1, 1.2),
    (1, 2, 0.8),
    (2, 3, 1.1),
    (3, 4, 0.9),
    (4, 5, 1.3),
    (5, 0, 1.0),
    (0, 6, 0.7),
    (6, 3, 0.6),
    (1, 6, 0.9),
    (6, 5, 0.8),
    (4, 7, 1.5),
];

fn main() -> Result<(), Box<dyn Error>> {
    let roads = UnGraph::<(), f64>::from_edges(STREETS);
    // Shortest ways between all crossings: a metric, so that the tour has its guarantee.
    let closure = Matrix::closure(&roads, |kilometres| *kilometres)?;
    let tour = solve(&closure, &Options::default(), &mut || false)?;
    println!("{:.1} km, proven to be at least {:.1} km", tour.cost(), tour.lower_bound().unwrap_or(0.0));

    let stops = tour.order();
    for (k, &from) in stops.iter().enumerate() {
        let to = stops[(k + 1) % stops.len()];
        let (length, way) = petgraph::algo::astar(
            &roads,
            NodeIndex::new(from),
            |node| node.index() == to,
            |street| *street.weight(),
            |_| 0.0,
        )
        .ok_or("no way between two crossings")?;
        let way: Vec<String> = way.iter().map(|node| node.index().to_string()).collect();
        println!("{:.1} km  {}", length, way.join(" - "));
        debug_assert!((length - closure.distance(from, to)).abs() < 1e-9);
    }

    // A street that is closed cuts a crossing off: the error names the parts.
    let mut closed = roads.clone();
    closed.retain_edges(|graph, edge| graph[edge] < 1.4);
    if let Err(error) = Matrix::closure(&closed, |kilometres| *kilometres) {
        println!("without the dead end's street: {error}");
    }
    Ok(())
}
