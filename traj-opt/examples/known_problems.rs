//! Solves classic optimal control problems and compares them with their known values.
//!
//! `cargo run --release -p traj-opt --example known_problems [NAME] [--json] [--scheme hs|compressed|radau|trap|rk] [--segments N]`
//!
//! With `--segments` the mesh is uniform and not refined.

#[path = "../tests/known_problems/catalogue.rs"]
mod catalogue;

use catalogue::definition::Mode;
use std::time::Instant;
use traj_opt::Transcription;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let json = args.iter().any(|a| a == "--json");
    let option = |key: &str| args.iter().position(|a| a == key).and_then(|i| args.get(i + 1)).cloned();
    let (scheme, segments) = (option("--scheme"), option("--segments"));
    let fixed: Option<usize> = segments.as_ref().and_then(|n| n.parse().ok());
    let values = [scheme.as_ref(), segments.as_ref()];
    let name = args.iter().find(|a| !a.starts_with("--") && !values.contains(&Some(a))).cloned();
    let transcription = match scheme.as_deref() {
        Some("rk") => Transcription::RungeKutta { substeps: 2 },
        Some("trap") => Transcription::Trapezoidal,
        Some("compressed") => Transcription::CompressedHermiteSimpson,
        Some("radau") => Transcription::LegendreGaussRadau { degree: 3 },
        _ => Transcription::HermiteSimpson,
    };
    let mut objects = vec![];
    if !json {
        println!(
            "{:26} {:>15} {:>15} {:>9} {:>8} {:>6} {:>9} {:>9}  status",
            "problem", "value", "reference", "error", "segments", "iter", "ms", "mesh"
        );
    }
    for e in catalogue::all().iter().filter(|e| name.as_ref().is_none_or(|n| n == e.name)) {
        let begin = Instant::now();
        let mode = fixed.map_or_else(|| e.mode(transcription), Mode::Fixed);
        let row = e.run(transcription, &mode);
        let ms = begin.elapsed().as_secs_f64() * 1e3;
        let error = e.relative_error(&row);
        if json {
            objects.push(format!(
                "{{\"name\":\"{}\",\"value\":{},\"reference\":{},\"relative_error\":{:e},\"segments\":{},\"iterations\":{},\"milliseconds\":{ms:.3}}}",
                e.name, row.value, e.reference, error, row.segments, row.iterations
            ));
        } else {
            println!(
                "{:26} {:15.8} {:15.8} {:9.1e} {:8} {:6} {:9.2} {:9.1e}  {}",
                e.name,
                row.value,
                e.reference,
                error,
                row.segments,
                row.iterations,
                ms,
                row.error,
                row.status
            );
        }
    }
    if json {
        println!("[{}]", objects.join(",\n "));
    }
}
