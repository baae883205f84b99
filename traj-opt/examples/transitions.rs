//! Solves the fifty reference transitions and prints a row each.
//!
//! `cargo run --release -p traj-opt --example transitions -- [A|B] [rk|trap|hs] [SEGMENTS] [ID]`

#[path = "../tests/common/mod.rs"]
mod common;

use common::quadcopter::*;
use nalgebra::SVector;
use std::ops::ControlFlow;
use traj_opt::{Dynamics, IntegrateOptions, Mesh, Options, Transcription, Workspace, solve_with};

/// Time (ns) that this thread has spent on a processor.
fn cpu_ns() -> u64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as u64 * 1_000_000_000 + time.tv_nsec as u64
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let get = |i: usize, default: &str| args.get(i).cloned().unwrap_or_else(|| default.to_string());
    let (model, scheme) = (get(0, "A"), get(1, "rk"));
    let segments: usize = get(2, "40").parse().unwrap_or(40);
    let only: Option<usize> = args.get(3).and_then(|v| v.parse().ok());
    let transcription = match scheme.as_str() {
        "trap" => Transcription::Trapezoidal,
        "hs" => Transcription::HermiteSimpson,
        "rk1" => Transcription::RungeKutta { substeps: 1 },
        "rk4" => Transcription::RungeKutta { substeps: 4 },
        _ => Transcription::RungeKutta { substeps: 2 },
    };
    let mut rows = vec![];
    let mut workspace_a = Workspace::new();
    let mut workspace_b = Workspace::new();
    for r in references().iter().filter(|r| only.is_none_or(|id| id == r.id)) {
        let row = if model == "A" {
            let mut t = thrust_rate(&r.start, &r.end);
            run(
                &mut workspace_a,
                &mut t,
                hover_thrust_rate(),
                r,
                r.time_thrust_rate,
                segments,
                transcription,
                only.is_some(),
            )
        } else {
            let mut t = rigid_body(&r.start, &r.end);
            run(
                &mut workspace_b,
                &mut t,
                hover_rigid_body(),
                r,
                r.time_rigid_body,
                segments,
                transcription,
                only.is_some(),
            )
        };
        rows.push(row);
    }
    let mut times: Vec<f64> = rows.iter().map(|r| r.1).collect();
    times.sort_by(f64::total_cmp);
    let solved = rows.iter().filter(|r| r.0).count();
    let mut iterations: Vec<usize> = rows.iter().map(|r| r.2).collect();
    iterations.sort_unstable();
    println!(
        "solved {solved} of {}; mean {:.2} ms, median {:.2} ms, 95th {:.2} ms, median iterations {}, mean {}",
        rows.len(),
        times.iter().sum::<f64>() / times.len() as f64,
        times[times.len() / 2],
        times[times.len() * 95 / 100],
        iterations[iterations.len() / 2],
        iterations.iter().sum::<usize>() as f64 / iterations.len() as f64
    );
}

#[allow(clippy::too_many_arguments)]
fn run<D: Dynamics<NX, 4>, const NX: usize>(
    workspace: &mut Workspace<NX, 4>,
    t: &mut Transition<D, NX>,
    hover: SVector<f64, 4>,
    r: &Reference,
    reference: f64,
    segments: usize,
    transcription: Transcription,
    verbose: bool,
) -> (bool, f64, usize) {
    let begin = cpu_ns();
    let guess = if std::env::var("OWN").is_ok() { cubic_guess(t) } else { naive_guess(t, hover) };
    let mesh = Mesh::uniform(segments);
    let tolerance = std::env::var("TOL").ok().and_then(|v| v.parse().ok()).unwrap_or(1e-8);
    let mu = std::env::var("MU").ok().and_then(|v| v.parse().ok()).unwrap_or(0.1);
    let options = Options::default().with_tolerance(tolerance).with_initial_mu(mu);
    let monitor = |i: &traj_opt::Iteration| {
        if verbose {
            println!(
                "{:4} f {:.6} primal {:.2e} dual {:.2e} compl {:.2e} mu {:.1e} reg {:.1e} alpha {:.2e}",
                i.iteration,
                i.objective,
                i.residuals.primal,
                i.residuals.dual,
                i.residuals.complementarity,
                i.mu,
                i.regularisation,
                i.step_length
            );
        }
        ControlFlow::Continue(())
    };
    let s = solve_with(workspace, &*t, &mesh, transcription, &guess, &options, monitor).expect("valid input");
    let ms = (cpu_ns() - begin) as f64 * 1e-6;
    if std::env::var("WARM").is_ok() {
        let turn = 5f64.to_radians();
        let z = nalgebra::Rotation3::from_axis_angle(&nalgebra::Vector3::z_axis(), turn);
        let c = SVector::<f64, 3>::new(r.centre[0], r.centre[1], r.centre[2]);
        let p = z * (t.end.fixed_rows::<3>(0) - c) + c;
        let v = z * t.end.fixed_rows::<3>(3);
        let q = nalgebra::UnitQuaternion::from_rotation_matrix(&z)
            * nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(
                t.end[6], t.end[7], t.end[8], t.end[9],
            ));
        t.end.fixed_rows_mut::<3>(0).copy_from(&p);
        t.end.fixed_rows_mut::<3>(3).copy_from(&v);
        t.end.fixed_rows_mut::<4>(6).copy_from(&SVector::<f64, 4>::new(q.w, q.i, q.j, q.k));
        for i in (0..NX).filter(|i| !(6..10).contains(i)) {
            t.bounds = t.bounds.with_terminal_component(i, t.end[i]);
        }
        let begin = cpu_ns();
        let wmu = std::env::var("WMU").ok().and_then(|v| v.parse().ok()).unwrap_or(1e-5);
        let s2 =
            traj_opt::solve_from(workspace, &*t, &s, &options.clone().with_warm_mu(wmu), monitor).unwrap();
        let ms = (cpu_ns() - begin) as f64 * 1e-6;
        let cold =
            solve_with(workspace, &*t, &mesh, transcription, &guess, &options, |_| ControlFlow::Continue(()))
                .unwrap();
        println!(
            "{:2} warm {} tf {:.5} ({:+.4} from {:.5}; cold {:.5}) iter {} {:.2} ms",
            r.id,
            s2.status,
            s2.objective,
            s2.objective - s.objective,
            s.objective,
            cold.objective,
            s2.iterations,
            ms
        );
        return (s2.status.is_success(), ms, s2.iterations);
    }
    let end = s.integrate(t.dynamics(), &IntegrateOptions::default()).map(|x| *x.end_state());
    let [p, v, a] = end.map_or([f64::NAN; 3], |x| miss(&x, &t.end));
    println!(
        "{:2} {:10} tf {:.5} ({:+.3} %) iter {:3} {:7.2} ms  miss {:.4} m {:.4} m/s {:.3} deg  kkt {:.1e} {:.1e} {:.1e}",
        r.id,
        s.status.to_string(),
        s.objective,
        100.0 * (s.objective / reference - 1.0),
        s.iterations,
        ms,
        p,
        v,
        a.to_degrees(),
        s.residuals.primal,
        s.residuals.dual,
        s.residuals.complementarity
    );
    (s.status.is_success(), ms, s.iterations)
}
use traj_opt::Problem;
