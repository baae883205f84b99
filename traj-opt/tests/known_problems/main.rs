//! Classic problems against their known values, with every transcription.

#[path = "catalogue.rs"]
mod catalogue;

use catalogue::definition::{Known, Mode};
use traj_opt::{Status, Transcription};

const TRANSCRIPTIONS: [Transcription; 5] = [
    Transcription::HermiteSimpson,
    Transcription::CompressedHermiteSimpson,
    Transcription::LegendreGaussRadau { degree: 3 },
    Transcription::Trapezoidal,
    Transcription::RungeKutta { substeps: 2 },
];

/// Runs of seconds, which only the ignored test makes: `cargo test --release -- --ignored`.
fn is_slow(name: &str, transcription: Transcription) -> bool {
    let low = matches!(transcription, Transcription::Trapezoidal | Transcription::RungeKutta { .. });
    match name {
        "alp_rider" => transcription != Transcription::HermiteSimpson,
        "hang_glider" | "hang_glider_betts" | "cartpole_optimtraj_time" | "free_flying_robot" => {
            low || transcription == Transcription::CompressedHermiteSimpson
        }
        _ => false,
    }
}

fn reproduces(known: &Known, slow: bool) {
    let mut failures = vec![];
    for transcription in TRANSCRIPTIONS {
        if is_slow(known.name, transcription) != slow {
            continue;
        }
        let row = known.run(transcription, &known.mode(transcription));
        let tolerance = known.tolerance_of(transcription);
        if tolerance == f64::INFINITY {
            continue;
        }
        let error = known.relative_error(&row);
        if !(error <= tolerance && row.status.is_success()) {
            failures.push(format!("{transcription:?}: {} (error {error:.1e}), {}", row.value, row.status));
        }
    }
    assert!(failures.is_empty(), "{} is {}: {failures:#?}", known.name, known.reference);
}

macro_rules! reproduced {
    ($($name:ident),*) => {$(
        #[test]
        fn $name() {
            reproduces(&catalogue::$name::known(), false);
        }
    )*};
}

reproduced!(
    double_integrator,
    triple_integrator,
    s_curve,
    block_move,
    brachistochrone,
    bryson_denham,
    planar_two_axis,
    moon_landing,
    dubins_lsl,
    linear_tangent,
    vanderpol,
    cartpole_kelly,
    cartpole_optimtraj_force,
    cartpole_optimtraj_time,
    goddard_cops,
    catmix,
    hang_glider,
    hang_glider_betts,
    free_flying_robot,
    robot_arm,
    alp_rider,
    quad2d_x3,
    quad2d_x6,
    quad2d_x12,
    quad2d_z3
);

#[test]
#[ignore = "a minute of computation"]
fn the_slow_ones_too() {
    for known in catalogue::all() {
        reproduces(&known, true);
    }
}

/// Outside its tube the rider moves along spheres on which the running cost is constant: the reduced Hessian is as good as singular and
/// often indefinite, and steps are short unless the regularisation answers them.
#[test]
fn the_rider_is_solved_on_every_mesh() {
    for n in [100, 150, 200] {
        let row = catalogue::alp_rider::known().run(Transcription::HermiteSimpson, &Mode::Fixed(n));
        assert_eq!(row.status, Status::Solved, "{n} segments, {} iterations", row.iterations);
    }
}

/// Solves from a trajectory alone take 111 iterations, most of them on meshes whose solution the one before nearly is.
const FEWER_THAN_FROM_THE_TRAJECTORY: usize = 80;

#[test]
fn refinement_carries_multipliers_from_mesh_to_mesh() {
    let known = catalogue::quad2d_x12::known();
    let row = known.run(Transcription::HermiteSimpson, &known.mode(Transcription::HermiteSimpson));
    assert!(row.iterations < FEWER_THAN_FROM_THE_TRAJECTORY, "{}", row.iterations);
}

#[test]
fn the_list_is_complete() {
    assert_eq!(catalogue::all().len(), 25);
}

#[test]
fn the_false_optimum_of_the_coarse_hang_glider_is_caught() {
    let known = catalogue::hang_glider::known();
    let coarse = known.run(Transcription::HermiteSimpson, &Mode::Fixed(50));
    assert!(coarse.status.is_success() && coarse.value > 1400.0, "{}", coarse.value);
    let mode = known.mode(Transcription::HermiteSimpson);
    let refined = known.run(Transcription::HermiteSimpson, &mode);
    assert!(known.relative_error(&refined) < known.tolerance && refined.error < 1e-7);
}
