//! How solves end: diagnosis of what cannot be met, guesses of the wrong size, limits.

use nalgebra::{RealField, SVector};
use proptest::prelude::*;
use traj_opt::{
    Bounds, ConstraintKind, Dynamics, Guess, Mesh, Options, Problem, Solution, Status, Transcription, solve,
};

/// Double integrator from rest at 0 to rest at `distance` in least time, `|u| <= limit`, below an optional ceiling for
/// `x + ramp t` from a path constraint.
struct Sled {
    distance: f64,
    limit: f64,
    latest: f64,
    ceiling: Option<f64>,
}

fn real<T: RealField + Copy>(v: f64) -> T {
    nalgebra::convert(v)
}

impl Dynamics<2, 1> for Sled {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
        SVector::from([x[1], u[0]])
    }
}

impl Problem<2, 1> for Sled {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<2, 1> {
        Bounds::free()
            .with_control([-self.limit].into(), [self.limit].into())
            .with_initial_state([0.0, 0.0].into())
            .with_terminal_state([self.distance, 0.0].into())
            .with_final_time(0.0, self.latest)
    }

    fn mayer<T: RealField + Copy>(&self, _: &SVector<T, 2>, _: &SVector<T, 2>, final_time: T) -> T {
        final_time
    }

    fn n_path(&self) -> usize {
        usize::from(self.ceiling.is_some())
    }

    fn path<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, _: &SVector<T, 1>, out: &mut [T]) {
        if let (Some(first), Some(ceiling)) = (out.first_mut(), self.ceiling) {
            *first = real::<T>(ceiling) - x[0];
        }
    }
}

fn run(problem: &Sled, scheme: Transcription, time: f64) -> Solution<2, 1> {
    let guess = Guess::line([0.0; 2].into(), [problem.distance, 0.0].into(), [0.0].into(), time);
    solve(problem, &Mesh::uniform(20), scheme, &guess, &Options::default()).unwrap()
}

#[test]
fn a_path_constraint_that_cannot_be_met_is_named() {
    let problem = Sled { distance: 2.0, limit: 1.0, latest: 100.0, ceiling: Some(1.0) };
    for scheme in [Transcription::Trapezoidal, Transcription::HermiteSimpson] {
        let s = run(&problem, scheme, 3.0);
        assert_eq!(s.status, Status::Infeasible, "{scheme:?}");
        let d = s.diagnosis.unwrap();
        println!("{scheme:?}: {d}");
        // ceiling and target contradict each other by 1: the violation sits at one of the two, or in the dynamics before the end
        assert!(d.amount > 1e-2, "{d}");
        assert!(matches!(
            d.kind,
            ConstraintKind::Path | ConstraintKind::TerminalState | ConstraintKind::Dynamics
        ));
        assert!(d.time > 0.5 * s.final_time(), "{d}");
    }
}

#[test]
fn a_solved_problem_has_no_diagnosis() {
    let s = run(
        &Sled { distance: 1.0, limit: 1.0, latest: 100.0, ceiling: None },
        Transcription::HermiteSimpson,
        1.0,
    );
    assert_eq!((s.status, s.diagnosis), (Status::Solved, None));
}

#[test]
fn a_limit_of_iterations_is_said_with_what_is_missing() {
    let problem = Sled { distance: 1.0, limit: 1.0, latest: 100.0, ceiling: None };
    let guess = Guess::line([0.0; 2].into(), [1.0, 0.0].into(), [0.0].into(), 1.0);
    let options = Options::default().with_max_iterations(2);
    let s = solve(&problem, &Mesh::uniform(20), Transcription::HermiteSimpson, &guess, &options).unwrap();
    assert_eq!(s.status, Status::IterationLimit);
    assert!(s.log.len() == 3 && s.iterations == 2);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn guesses_of_the_wrong_size_do_not_make_a_feasible_problem_infeasible(
        distance in 0.1..1000.0, limit in 0.05..20.0, decades in -4.0..4.0,
    ) {
        let problem = Sled { distance, limit, latest: f64::INFINITY, ceiling: None };
        let exact = 2.0 * f64::sqrt(distance / limit);
        for scheme in [Transcription::RungeKutta { substeps: 1 }, Transcription::HermiteSimpson] {
            let s = run(&problem, scheme, exact * f64::powf(10.0, decades));
            prop_assert!(s.status.is_success(), "{:?}: {} after {}", scheme, s.status, s.iterations);
            prop_assert!((s.final_time() / exact - 1.0).abs() < 1e-2, "{:?}: {} for {}", scheme, s.final_time(), exact);
        }
    }

    #[test]
    fn deadlines_that_cannot_be_met_are_called_infeasible_and_diagnosed(
        distance in 0.1..100.0, limit in 0.2..5.0, share in 0.1..0.9,
    ) {
        let mut problem = Sled { distance, limit, latest: f64::INFINITY, ceiling: None };
        problem.latest = share * 2.0 * f64::sqrt(distance / limit);
        for scheme in [Transcription::RungeKutta { substeps: 1 }, Transcription::HermiteSimpson] {
            let s = run(&problem, scheme, 0.7 * problem.latest);
            prop_assert_eq!(s.status, Status::Infeasible);
            let d = s.diagnosis.expect("a diagnosis");
            prop_assert!(d.amount > 0.0 && d.time <= problem.latest * (1.0 + 1e-6));
        }
    }
}
