//! One hot kernel, so many times: `kernels NAME TIMES`, for counters of instructions (`benches/instructions.py`). Without arguments the names.
#![allow(missing_docs)]

#[path = "../../traj-opt/tests/common/mod.rs"]
mod common;

use benches::{SEED, depot_and_targets, uniform};
use christofides::matching::Solver;
use christofides::{Points, Workspace, christofides_with, held_karp};
use cluster::{KMeansOptions, kmeans};
use common::quadcopter::{Transition, cubic_guess, references, rigid_body, thrust_rate};
use mtsp::{Options as Search, Problem, solve};
use quad_dynamics::{Direction, Loiter, LoiterSpec, RigidBody, ThrustRate, Vehicle};
use std::hint::black_box;
use std::ops::ControlFlow;
use traj_opt::{Dynamics, Mesh, Options, Transcription, Workspace as Solving, solve_with};

type Error = Box<dyn std::error::Error>;
/// Sets up, then runs the kernel so many times.
type Kernel = fn(usize) -> Result<(), Error>;

const KERNELS: [(&str, Kernel); 9] = [
    ("christofides/whole/1000", whole),
    ("christofides/matching/1000", matching),
    ("christofides/held_karp/100x400", bound),
    ("cluster/kmeans/n10000-k64", clustering),
    ("mtsp/solve-10000/n100-m8", search),
    ("quad_dynamics/jacobian/both-x1000", jacobians),
    ("quad_dynamics/loiter/new", loiter),
    ("traj-opt/thrust-rate/cold", transition_by_rates),
    ("traj-opt/rigid-body/cold", transition_by_rotors),
];

fn whole(times: usize) -> Result<(), Error> {
    let points = uniform(SEED, 1000);
    let mut workspace = Workspace::default();
    for _ in 0..times {
        black_box(christofides_with(&mut workspace, &Points(black_box(&points)))?.cost());
    }
    Ok(())
}

fn matching(times: usize) -> Result<(), Error> {
    let points = uniform(SEED, 1000);
    let mut solver = Solver::default();
    for _ in 0..times {
        let _ = black_box(solver.complete(&Points(black_box(&points)))?);
    }
    Ok(())
}

fn bound(times: usize) -> Result<(), Error> {
    let points = uniform(SEED, 100);
    for _ in 0..times {
        let _ = black_box(held_karp(&Points(black_box(&points)), 400)?);
    }
    Ok(())
}

fn clustering(times: usize) -> Result<(), Error> {
    let points = uniform(SEED, 10_000);
    for _ in 0..times {
        black_box(kmeans(black_box(&points), 64, &KMeansOptions::default().with_n_init(1))?);
    }
    Ok(())
}

fn search(times: usize) -> Result<(), Error> {
    let nodes = depot_and_targets(100);
    let metric = Points(&nodes);
    let problem = Problem::new(&metric, 8)?;
    for _ in 0..times {
        black_box(solve(black_box(&problem), &Search::default().with_iterations(10_000))?);
    }
    Ok(())
}

fn jacobians(times: usize) -> Result<(), Error> {
    let vehicle = Vehicle::survey_450();
    let motion = Loiter::new(&vehicle, &LoiterSpec::new(3.0))?.state(0.7, Direction::Clockwise);
    let (rotors, rates) = (RigidBody::new(&vehicle), ThrustRate::new(&vehicle));
    for _ in 0..1000 * times {
        black_box(rotors.jacobian(black_box(&motion.rigid_body_state()), black_box(&motion.rotor_thrusts)));
        black_box(
            rates.jacobian(black_box(&motion.thrust_rate_state()), black_box(&motion.thrust_rate_control())),
        );
    }
    Ok(())
}

fn loiter(times: usize) -> Result<(), Error> {
    let vehicle = Vehicle::survey_450();
    for _ in 0..times {
        black_box(Loiter::new(black_box(&vehicle), &LoiterSpec::new(3.0))?);
    }
    Ok(())
}

/// The first reference transition on 40 Hermite-Simpson segments from the cubic guess.
fn transition<D: Dynamics<NX, 4>, const NX: usize>(
    transition: &Transition<D, NX>,
    times: usize,
) -> Result<(), Error> {
    let mut workspace = Solving::new();
    let (guess, mesh) = (cubic_guess(transition), Mesh::uniform(40));
    let options = Options::default().with_tolerance(3e-6).with_initial_mu(0.01);
    let proceed = |_: &_| ControlFlow::Continue(());
    for _ in 0..times {
        let scheme = Transcription::HermiteSimpson;
        black_box(solve_with(
            &mut workspace,
            black_box(transition),
            &mesh,
            scheme,
            &guess,
            &options,
            proceed,
        )?);
    }
    Ok(())
}

fn transition_by_rates(times: usize) -> Result<(), Error> {
    let reference = &references()[0];
    transition(&thrust_rate(&reference.start, &reference.end), times)
}

fn transition_by_rotors(times: usize) -> Result<(), Error> {
    let reference = &references()[0];
    transition(&rigid_body(&reference.start, &reference.end), times)
}

fn main() -> Result<(), Error> {
    let mut arguments = std::env::args().skip(1);
    let (Some(name), Some(times)) = (arguments.next(), arguments.next()) else {
        KERNELS.iter().for_each(|(name, _)| println!("{name}"));
        return Ok(());
    };
    let (_, kernel) = KERNELS.iter().find(|kernel| kernel.0 == name).ok_or("no such kernel")?;
    kernel(times.parse()?)
}
