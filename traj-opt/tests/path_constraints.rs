//! Path constraints: a point mass flies round a keep-out cylinder with a limited norm of its acceleration.

use nalgebra::{RealField, SVector};
use traj_opt::{
    Bounds, ConstraintKind, Dynamics, Guess, IntegrateOptions, Mesh, Options, Problem, RefineOptions,
    Solution, Transcription, solve, solve_refined,
};

const SCHEMES: [Transcription; 3] =
    [Transcription::RungeKutta { substeps: 1 }, Transcription::Trapezoidal, Transcription::HermiteSimpson];

/// From (-3, 0.2) at rest to (3, 0) at rest around the unit disc; the norm of the acceleration is at most 1.
struct Detour {
    radius: f64,
}

fn real<T: RealField + Copy>(v: f64) -> T {
    nalgebra::convert(v)
}

impl Dynamics<4, 2> for Detour {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 4>, u: &SVector<T, 2>) -> SVector<T, 4> {
        SVector::from([x[2], x[3], u[0], u[1]])
    }
}

impl Problem<4, 2> for Detour {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<4, 2> {
        Bounds::free()
            .with_initial_state([-3.0, 0.2, 0.0, 0.0].into())
            .with_terminal_state([3.0, 0.0, 0.0, 0.0].into())
            .with_final_time(0.1, 50.0)
    }

    fn mayer<T: RealField + Copy>(&self, _: &SVector<T, 4>, _: &SVector<T, 4>, final_time: T) -> T {
        final_time
    }

    fn n_path(&self) -> usize {
        2
    }

    fn path<T: RealField + Copy>(&self, _: T, x: &SVector<T, 4>, u: &SVector<T, 2>, out: &mut [T]) {
        out[0] = x[0] * x[0] + x[1] * x[1] - real::<T>(self.radius * self.radius);
        out[1] = real::<T>(1.0) - u[0] * u[0] - u[1] * u[1];
    }
}

fn detour(transcription: Transcription, segments: usize) -> Solution<4, 2> {
    let guess =
        Guess::line([-3.0, 1.5, 0.0, 0.0].into(), [3.0, 1.5, 0.0, 0.0].into(), [0.1, 0.1].into(), 6.0);
    let problem = Detour { radius: 1.0 };
    let solution =
        solve(&problem, &Mesh::uniform(segments), transcription, &guess, &Options::default()).unwrap();
    assert!(solution.status.is_success(), "{transcription:?}: {}", solution.status);
    solution
}

#[test]
fn path_constraints_hold_at_the_knots_and_bind() {
    for scheme in SCHEMES {
        let solution = detour(scheme, 40);
        let nearest = solution.states().iter().map(|x| x[0].hypot(x[1])).fold(f64::INFINITY, f64::min);
        assert!((1.0 - 1e-5..1.05).contains(&nearest), "{scheme:?}: {nearest}");
        let strongest = solution.controls().iter().map(|u| u.norm()).fold(0.0, f64::max);
        assert!((0.99..=1.0 + 1e-5).contains(&strongest), "{scheme:?}: {strongest}");
        // without the cylinder: bang-bang along the straight line
        assert!(solution.final_time() > 2.0 * 6.0_f64.sqrt(), "{scheme:?}: {}", solution.final_time());
    }
}

#[test]
fn flown_controls_stay_near_the_constraints_between_the_knots() {
    let solution = detour(Transcription::HermiteSimpson, 40);
    let flown = solution.integrate(&Detour { radius: 1.0 }, &IntegrateOptions::default()).unwrap();
    assert!((flown.end_state() - solution.states()[40]).amax() < 1e-6);
    let tf = solution.final_time();
    for i in 0..=2000 {
        let x = flown.state_at(tf * f64::from(i) / 2000.0);
        assert!(x[0].hypot(x[1]) > 1.0 - 1e-2, "{x}");
    }
}

#[test]
fn greatest_violation_names_constraint_amount_and_time() {
    let solution = detour(Transcription::HermiteSimpson, 40);
    // a wider cylinder than was solved for: the nearest point violates it by radius^2 - distance^2
    let wide = Detour { radius: 2.0 };
    let worst = solution.greatest_violation(&wide, 16).unwrap();
    assert_eq!((worst.kind, worst.index), (ConstraintKind::Path, 0));
    let x = solution.state_at(worst.time);
    assert!((worst.amount - (4.0 - x[0] * x[0] - x[1] * x[1])).abs() < 1e-12);
    for i in 0..=640 {
        let x = solution.state_at(solution.final_time() * f64::from(i) / 640.0);
        assert!(4.0 - x[0] * x[0] - x[1] * x[1] <= worst.amount + 1e-9);
    }
    // finer samples that contain the coarse ones can only find more; the knots alone see less than the whole
    let own =
        |samples| solution.greatest_violation(&Detour { radius: 1.0 }, samples).map_or(0.0, |v| v.amount);
    println!("knots {:e}, 16 samples {:e}", own(1), own(16));
    assert!(own(1) < own(16) && own(16) < 0.5);
}

/// Least time over 4 m with limits on velocity, acceleration and jerk: exactly `d/v + v/a + a/j = 2.6`.
struct SCurve;

impl Dynamics<3, 1> for SCurve {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 3>, u: &SVector<T, 1>) -> SVector<T, 3> {
        SVector::from([x[1], x[2], u[0]])
    }
}

impl Problem<3, 1> for SCurve {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<3, 1> {
        Bounds::free()
            .with_control([-40.0].into(), [40.0].into())
            .with_state([0.0, -2.0, -4.0].into(), [4.0, 2.0, 4.0].into())
            .with_initial_state([0.0; 3].into())
            .with_terminal_state([4.0, 0.0, 0.0].into())
            .with_final_time(0.01, 100.0)
    }

    fn mayer<T: RealField + Copy>(&self, _: &SVector<T, 3>, _: &SVector<T, 3>, final_time: T) -> T {
        final_time
    }
}

#[test]
fn refinement_brings_the_violation_between_the_knots_under_its_tolerance() {
    let guess = Guess::line([0.0; 3].into(), [4.0, 0.0, 0.0].into(), [0.0].into(), 2.0);
    let run = |refine: RefineOptions| {
        let scheme = Transcription::HermiteSimpson;
        solve_refined(&SCurve, &Mesh::uniform(50), scheme, &guess, &Options::default(), &refine).unwrap()
    };
    let states = |r: &traj_opt::Refined<3, 1>| {
        // independent of the refinement: a fine sample of the interpolated states
        (0..=20_000)
            .map(|i| r.solution.state_at(r.solution.final_time() * f64::from(i) / 2e4))
            .map(|x| (x[1].abs() - 2.0).max(x[2].abs() - 4.0).max(-x[0]).max(x[0] - 4.0))
            .fold(0.0, f64::max)
    };
    let loose = run(RefineOptions::default().with_tolerance(1e-3).with_violation_tolerance(f64::INFINITY));
    assert!(states(&loose) > 1e-5, "nothing to refine: {}", states(&loose));
    let tight = run(RefineOptions::default().with_violation_tolerance(1e-6));
    println!("{} -> {} in {} rounds", states(&loose), states(&tight), tight.rounds);
    assert!(tight.converged && tight.violation <= 1e-6);
    assert!(states(&tight) < 1e-5, "{}", states(&tight));
    assert!((tight.solution.final_time() - 2.6).abs() < 2.6e-6, "{}", tight.solution.final_time());
}
