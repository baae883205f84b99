//! Classic problems against their known values.

#[allow(dead_code)]
mod harness;
mod problems;

use traj_opt::Transcription;

#[test]
fn known_problems_are_reproduced_after_refinement() {
    let mut failures = vec![];
    for e in problems::all() {
        let row = (e.run)(Transcription::HermiteSimpson, e.segments, Some(1e-7));
        let error = (row.value - e.reference).abs() / e.reference.abs();
        if !(error <= e.tolerance && row.status.is_success()) {
            failures.push(format!("{}: {} for {}, {}", e.name, row.value, e.reference, row.status));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
