//! Runs a known problem with any transcription, on a fixed mesh or refined.

use traj_opt::{Guess, Mesh, Options, Problem, RefineOptions, Status, Transcription, solve, solve_refined};

/// What a run gave.
pub struct Row {
    pub value: f64,
    pub status: Status,
    pub segments: usize,
    pub iterations: usize,
    pub error: f64,
}

type Run = Box<dyn Fn(Transcription, usize, Option<f64>) -> Row>;

/// A problem with its reference value.
pub struct Entry {
    pub name: &'static str,
    pub reference: f64,
    /// Relative tolerance to which the reference is trusted and reproduced.
    pub tolerance: f64,
    pub segments: usize,
    /// Transcription, segments, tolerance of refinement.
    pub run: Run,
}

pub fn entry<const NX: usize, const NU: usize, P: Problem<NX, NU> + 'static>(
    name: &'static str,
    problem: P,
    guess: Guess<NX, NU>,
    reference: f64,
    sign: f64,
    tolerance: f64,
    segments: usize,
) -> Entry {
    let run = move |transcription, segments, refine: Option<f64>| {
        let (mesh, options) = (Mesh::uniform(segments), Options::default().with_max_iterations(1000));
        let (s, iterations, error) = match refine {
            None => {
                let s = solve(&problem, &mesh, transcription, &guess, &options).expect("valid input");
                let iterations = s.iterations;
                (s, iterations, f64::NAN)
            }
            Some(tolerance) => {
                // the stiff one is dear: its reference is trusted to less
                let (tolerance, violation) =
                    if name == "alp_rider" { (1e-7, f64::INFINITY) } else { (tolerance, 1e-5) };
                let refine =
                    RefineOptions::default().with_tolerance(tolerance).with_violation_tolerance(violation);
                let r = solve_refined(&problem, &mesh, transcription, &guess, &options, &refine)
                    .expect("valid input");
                (r.solution, r.iterations, r.error)
            }
        };
        let segments = s.mesh().n_segments();
        Row { value: sign * s.objective, status: s.status, segments, iterations, error }
    };
    Entry { name, reference, tolerance, segments, run: Box::new(run) }
}
