//! Numbers at the edge of what `f64` holds: every public function answers or refuses, none panics.

use nalgebra::{RealField, SVector};
use proptest::prelude::*;
use std::ops::ControlFlow;
use traj_opt::{
    Bounds, Continuous, Dynamics, Error, FreeInitialTime, Guess, IntegrateOptions, LinearAlgebra, Linked,
    Mesh, Options, Problem, RefineOptions, Scales, Solution, Transcription, Workspace, check_derivatives,
    check_path_derivatives, integrate, refined_mesh, segment_errors, solve, solve_batch, solve_from,
    solve_refined, solve_with,
};

fn extreme() -> impl Strategy<Value = f64> {
    let special = prop::sample::select(vec![
        0.0,
        -0.0,
        1.0,
        5e-324,
        -1e-310,
        1e-160,
        1e154,
        1e300,
        -1e300,
        f64::MAX,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
    ]);
    prop_oneof![2 => special, 1 => prop::num::f64::NORMAL, 9 => -3.0..3.0_f64]
}

fn numbers(n: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(extreme(), n)
}

fn transcription() -> impl Strategy<Value = Transcription> {
    prop_oneof![
        prop::sample::select(vec![0, 1, 3]).prop_map(|substeps| Transcription::RungeKutta { substeps }),
        Just(Transcription::Trapezoidal),
        Just(Transcription::HermiteSimpson),
        Just(Transcription::CompressedHermiteSimpson),
        prop::sample::select(vec![0, 1, 3, usize::MAX])
            .prop_map(|degree| Transcription::LegendreGaussRadau { degree }),
    ]
}

fn real<T: RealField + Copy>(v: f64) -> T {
    nalgebra::convert(v)
}

/// `x1' = x2`, `x2' = a x1 x2 + b u + c` under whatever bounds; all numbers are data.
#[derive(Debug, Clone)]
struct Any {
    factors: [f64; 3],
    bounds: Bounds<2, 1>,
    path: (f64, f64),
    scales: Option<Scales<2, 1>>,
    is_timed: bool,
}

impl Dynamics<2, 1> for Any {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
        let [a, b, c] = self.factors.map(real::<T>);
        SVector::from([x[1], a * x[0] * x[1] + b * u[0] + c])
    }
}

impl Problem<2, 1> for Any {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<2, 1> {
        self.bounds
    }

    fn mayer<T: RealField + Copy>(&self, _: &SVector<T, 2>, end: &SVector<T, 2>, time: T) -> T {
        if self.is_timed { time } else { real::<T>(self.factors[0]) * end[0] }
    }

    fn lagrange<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> Option<T> {
        (!self.is_timed).then(|| u[0] * u[0] + (real::<T>(self.factors[1]) * x[1]).sqrt())
    }

    fn n_path(&self) -> usize {
        1
    }

    fn path<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>, values: &mut [T]) {
        values[0] = x[0] / u[0];
    }

    fn path_bounds(&self, _: usize) -> (f64, f64) {
        self.path
    }

    fn scales(&self) -> Option<Scales<2, 1>> {
        self.scales
    }
}

fn any_problem() -> impl Strategy<Value = Any> {
    let kinds = (any::<[bool; 5]>(), prop::array::uniform3(prop_oneof![1 => extreme(), 3 => -2.0..2.0]));
    (kinds, numbers(16)).prop_map(|((switches, factors), n)| {
        let [wild, bounded, pinned, is_timed, is_path] = switches;
        let mut bounds =
            Bounds::free().with_initial_state([0.0, 0.0].into()).with_terminal_state([1.0, 0.0].into());
        if bounded {
            bounds = bounds.with_control([-1.0].into(), [1.0].into()).with_final_time(0.1, 9.0);
        }
        if wild {
            bounds = bounds
                .with_state([n[0], n[1]].into(), [n[2], n[3]].into())
                .with_control([n[4]].into(), [n[5]].into());
            bounds = bounds
                .with_final_time(n[6], n[7])
                .with_initial_component(0, n[8])
                .with_terminal_component(1, n[9]);
        }
        if pinned {
            bounds.initial_time = n[10];
            bounds = bounds.with_initial_state([n[11], 0.5].into());
        }
        let path = if is_path { (n[12], n[13]) } else { (f64::NEG_INFINITY, f64::INFINITY) };
        Any { factors, bounds, path, scales: None, is_timed }
    })
}

fn any_guess() -> impl Strategy<Value = Guess<2, 1>> {
    prop_oneof![
        2 => Just(Guess::line([0.0; 2].into(), [1.0, 0.0].into(), [0.1].into(), 1.0)),
        1 => numbers(6).prop_map(|n| Guess::line([n[0], n[1]].into(), [n[2], n[3]].into(), [n[4]].into(), n[5])),
        1 => numbers(7).prop_map(|n| {
            let fractions = vec![n[0], n[1], n[2]];
            let guess = Guess::from_samples(n[6], fractions, vec![[n[3], n[4]].into(); 3], vec![[n[5]].into(); 3]);
            guess.expect("as many states and controls as fractions")
        }),
    ]
}

fn options() -> impl Strategy<Value = Options> {
    (0..25_usize, 0..3_usize, any::<bool>(), numbers(4)).prop_map(|(iterations, restarts, is_wild, n)| {
        let options = Options::default().with_max_iterations(iterations).with_time_restarts(restarts);
        if is_wild {
            options
                .with_tolerance(n[0])
                .with_initial_mu(n[1])
                .with_warm_mu(n[2])
                .with_acceptable_tolerance(n[3])
        } else {
            options
        }
    })
}

/// Everything that a solution is asked for.
fn ask(problem: &Any, solution: &Solution<2, 1>, number: f64) {
    let success = solution.status.is_success();
    assert!(
        !success || solution.states().iter().flatten().all(|x| x.is_finite()),
        "{problem:?} {:?}",
        solution.states()
    );
    assert!(!success || solution.objective.is_finite() && solution.final_time() >= solution.initial_time());
    for time in [number, solution.final_time(), f64::NAN] {
        let _ = (solution.state_at(time), solution.control_at(time), solution.control_in_segment(0, time));
    }
    let flying = IntegrateOptions::default().with_tolerance(1e-6).with_max_steps(200);
    let _ = (solution.integrate(problem, &flying), solution.greatest_violation(problem, 3));
    let _ = (Guess::from_solution(solution, 0).sample(number), solution.diagnosis.map(|d| d.to_string()));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn problems_of_any_numbers(
        problem in any_problem(), guess in any_guess(), options in options(), scheme in transcription(), number in extreme(), n in 1..6_usize,
    ) {
        let mesh = Mesh::graded(n, number);
        let mut workspace = Workspace::new();
        let stop = |iteration: &traj_opt::Iteration| {
            if iteration.residuals.primal > 1e200 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let found = solve_with(&mut workspace, &problem, &mesh, scheme, &guess, &options, stop);
        // What a hostile problem leaves in the workspace is as good as new.
        let again = solve(&problem, &mesh, scheme, &guess, &options);
        prop_assert_eq!(found.is_ok(), again.is_ok());
        if let (Ok(found), Ok(_)) = (&found, again) {
            ask(&problem, found, number);
            let _ = solve_from(&mut workspace, &problem, found, scheme, &options, stop);
        }
        let _ = solve_batch(&[(problem, guess)], &mesh, scheme, &options);
    }

    #[test]
    fn other_forms_of_any_numbers(problem in any_problem(), guess in any_guess(), n in numbers(8), scheme in transcription()) {
        let options = Options::default().with_max_iterations(8).with_time_restarts(0);
        let mesh = Mesh::uniform(3);
        let free = FreeInitialTime::<_, 2> { problem: problem.clone(), initial_time: (n[0], n[1]), duration: (n[2], n[3]) };
        let longer = Guess::line([n[4], 0.0, 0.0].into(), [1.0, n[5], 0.0].into(), [n[6]].into(), 1.0);
        let _ = solve::<3, 1, _>(&free, &mesh, scheme, &longer, &options);
        let linked: Linked<_, _, _, 2, 2, 1, 1> = Linked { first: problem.clone(), second: problem.clone(), linkage: Continuous };
        let both: Guess<6, 2> = linked.guess(&guess, &guess.clone().with_final_time(n[7]));
        let _ = solve::<6, 2, _>(&linked, &mesh, scheme, &both, &options);
        let mut scaled = problem.clone();
        scaled.scales = Some(Scales { state: [n[0], n[1]].into(), control: [n[2]].into(), time: n[3] });
        let _ = solve(&scaled, &mesh, scheme, &guess, &options);
        let mut refine = RefineOptions::default().with_tolerance(n[4]).with_violation_tolerance(n[5]).with_cost_tolerance(n[6]);
        if n[0] > 0.0 {
            refine = RefineOptions::default();
        }
        refine = refine.with_max_rounds(2).with_max_segments(12);
        let _ = solve_refined(&problem, &mesh, scheme, &guess, &options, &refine);
        #[cfg(feature = "faer")]
        {
            let options = options.with_linear_algebra(LinearAlgebra::Sparse);
            let _ = solve(&problem, &mesh, scheme, &guess, &options);
        }
        let _ = LinearAlgebra::default();
        let (state, control) = ([n[1], n[2]].into(), [n[3]].into());
        let _ = (check_derivatives(&problem, n[0], &state, &control), check_path_derivatives(&problem, &state, &control));
    }

    #[test]
    fn integrations_of_any_numbers(n in numbers(8), breaks in numbers(3), steps in 0..200_usize) {
        let mut options = IntegrateOptions::default().with_max_steps(steps);
        if n[7] > 0.0 {
            options = options.with_tolerance(n[6]);
        }
        let rhs = |t: f64, x: &SVector<f64, 2>| SVector::from([n[0] * x[1] + t, n[1] * x[0] * x[0]]);
        if let Ok(flown) = integrate(rhs, n[2], [n[3], n[4]].into(), n[5], &breaks, &options) {
            prop_assert!(flown.end_time() == n[5] || n[5].is_nan());
            let _ = (flown.state_at(n[6]), flown.end_state(), flown.initial_time(), flown.step_times().len());
        }
    }

    #[test]
    fn meshes_of_any_numbers(fractions in numbers(5), errors in numbers(5), tolerance in extreme(), order in prop_oneof![0..9_usize, Just(usize::MAX)]) {
        let _ = Mesh::from_fractions(fractions.clone());
        let mesh = refined_mesh(&Mesh::graded(4, tolerance), &errors, tolerance, order);
        prop_assert!(mesh.n_segments() <= 16 && Mesh::from_fractions(mesh.fractions().to_vec()).is_ok());
        let states = vec![[0.0, 0.0].into(); fractions.len()];
        prop_assert!(Guess::<2, 1>::from_samples(1.0, fractions, states, vec![]).is_err());
    }

    #[cfg(feature = "clarabel")]
    #[test]
    fn bounds_of_any_numbers(n in numbers(16), intervals in 1..4_usize) {
        let mass = traj_opt::PointMass {
            start: [n[0], n[1], n[2]], start_velocity: [n[3], n[4], 0.0], end: [n[5], n[6], n[7]], end_velocity: [n[8], 0.0, n[9]],
            acceleration: n[10], bias: [n[11], n[12], n[13]], speed: n[14],
        };
        let mut options = traj_opt::BoundOptions::default().with_n_intervals(intervals).with_resolution(0.5);
        options.max_enclosures = 6;
        if n[15] > 1.0 {
            options = options.with_resolution(n[15]);
        }
        if let Ok(bound) = traj_opt::least_time_bound(&mass, &options) {
            prop_assert!(bound >= 0.0, "{}", bound);
        }
    }
}

/// A number alone takes neither memory nor time.
#[test]
fn enormous_numbers_are_cut() {
    for n in [1 << 40, usize::MAX] {
        assert_eq!(Mesh::uniform(n).n_segments(), 1 << 20);
        assert_eq!(Mesh::graded(n, 0.5).n_segments(), 1 << 20);
        let guess = Guess::<1, 1>::from_fn(1.0, n, |s| ([s].into(), [0.0].into()));
        assert_eq!(guess.sample(0.25).0[0], 0.25);
    }
    let bounds = Bounds::free().with_initial_state([0.0, 0.0].into()).with_terminal_state([1.0, 0.0].into());
    let bounds = bounds.with_control([-1.0].into(), [1.0].into());
    let path = (f64::NEG_INFINITY, f64::INFINITY);
    let problem = Any { factors: [0.0, 1.0, 0.0], bounds, path, scales: None, is_timed: true };
    let guess = Guess::line([0.0; 2].into(), [1.0, 0.0].into(), [0.1].into(), 1.0);
    let endless = Options::default().with_max_iterations(usize::MAX).with_time_restarts(usize::MAX);
    let scheme = Transcription::RungeKutta { substeps: usize::MAX };
    let solution = solve(&problem, &Mesh::uniform(4), scheme, &guess, &endless).unwrap();
    assert!(solution.status.is_success(), "{}", solution.status);
    assert_eq!(solution.transcription(), Transcription::RungeKutta { substeps: 100 });
    assert_eq!(Guess::from_solution(&solution, usize::MAX).sample(1.0).0[0], solution.states()[4][0]);
    assert!(segment_errors(&solution, &problem).is_ok_and(|errors| errors.len() == 4));
    #[cfg(feature = "clarabel")]
    {
        let mass = traj_opt::PointMass {
            start: [0.0; 3],
            start_velocity: [0.0; 3],
            end: [1.0; 3],
            end_velocity: [0.0; 3],
            acceleration: 1.0,
            bias: [0.0; 3],
            speed: 1.0,
        };
        let options = traj_opt::BoundOptions::default().with_n_intervals(usize::MAX);
        assert!(matches!(
            traj_opt::least_time_bound(&mass, &options),
            Err(Error::InvalidOption { option: "n_intervals", .. })
        ));
    }
    assert!(matches!(
        solve(&problem, &Mesh::uniform(4), scheme, &guess, &Options::default().with_tolerance(0.0)),
        Err(Error::InvalidOption { .. })
    ));
}

/// A mesh in a file is checked as one that is made by hand.
#[cfg(feature = "serde")]
#[test]
fn forged_meshes_are_refused() {
    for text in ["[]", "[0.0]", "[0.0,0.5]", "[0.0,0.0,1.0]", "[1.0,0.0]"] {
        assert!(serde_json::from_str::<Mesh>(&format!("{{\"fractions\":{text}}}")).is_err(), "{text}");
    }
    let mesh = Mesh::graded(5, 0.3);
    assert_eq!(serde_json::from_str::<Mesh>(&serde_json::to_string(&mesh).unwrap()).unwrap(), mesh);
}
