//! Properties on generated problems: analytic switch times, Riccati solutions, infeasibility, convergence, repeatability.
mod common;

use common::quadcopter::*;
use nalgebra::{Matrix2, RealField, SVector, Vector2};
use proptest::prelude::*;
use traj_opt::{
    Bounds, Dynamics, Error, Guess, IntegrateOptions, Mesh, Options, Problem, Status, Transcription,
    Workspace, integrate, segment_errors, solve, solve_with,
};

const SCHEMES: [Transcription; 3] =
    [Transcription::RungeKutta { substeps: 1 }, Transcription::Trapezoidal, Transcription::HermiteSimpson];

fn real<T: RealField + Copy>(v: f64) -> T {
    nalgebra::convert(v)
}

/// Double integrator with an acceleration limit; minimum time, or with a least time that cannot be met.
struct Slide {
    start: [f64; 2],
    acceleration: f64,
    latest: f64,
}

impl Dynamics<2, 1> for Slide {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
        SVector::from([x[1], u[0]])
    }
}

impl Problem<2, 1> for Slide {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<2, 1> {
        Bounds::free()
            .with_control(SVector::from([-self.acceleration]), SVector::from([self.acceleration]))
            .with_initial_state(self.start.into())
            .with_terminal_state(SVector::zeros())
            .with_final_time(1e-3, self.latest)
    }

    fn mayer<T: RealField + Copy>(&self, _: &SVector<T, 2>, _: &SVector<T, 2>, final_time: T) -> T {
        final_time
    }
}

impl Slide {
    /// Minimum time to the origin (A. E. Bryson, Y.-C. Ho, *Applied Optimal Control*, section 3.9).
    fn least_time(&self) -> f64 {
        let (p, v, a) = (self.start[0], self.start[1], self.acceleration);
        let side = if p + v * v.abs() / (2.0 * a) >= 0.0 { 1.0 } else { -1.0 };
        let (p, v) = (side * p, side * v);
        (v + 2.0 * (0.5 * v * v + a * p).max(0.0).sqrt()) / a
    }

    fn guess(&self) -> Guess<2, 1> {
        let time = self.start[1].abs() / self.acceleration + (self.start[0].abs() / self.acceleration).sqrt();
        Guess::line(self.start.into(), SVector::zeros(), SVector::zeros(), time.max(0.1))
    }
}

/// Linear dynamics and quadratic cost over a fixed time.
struct Regulator {
    a: Matrix2<f64>,
    weight: f64,
    start: Vector2<f64>,
}

impl Dynamics<2, 1> for Regulator {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
        let a = self.a.map(real::<T>);
        a * x + SVector::from([T::zero(), u[0]])
    }
}

impl Problem<2, 1> for Regulator {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<2, 1> {
        Bounds::free().with_initial_state(self.start).with_final_time(2.0, 2.0)
    }

    fn lagrange<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> Option<T> {
        Some(x.norm_squared() + real::<T>(self.weight) * u[0] * u[0])
    }
}

impl Regulator {
    /// Least cost from the differential Riccati equation, integrated backwards from zero.
    fn least_cost(&self) -> f64 {
        let rhs = |_: f64, p: &SVector<f64, 4>| {
            let p = Matrix2::from_column_slice(p.as_slice());
            let b = Vector2::new(0.0, 1.0);
            let pb = p * b;
            let slope =
                self.a.transpose() * p + p * self.a + Matrix2::identity() - pb * pb.transpose() / self.weight;
            SVector::<f64, 4>::from_column_slice(slope.as_slice())
        };
        let end = integrate(rhs, 0.0, SVector::zeros(), 2.0, &[], &IntegrateOptions::default())
            .expect("integrable");
        let p = Matrix2::from_column_slice(end.end_state().as_slice());
        self.start.dot(&(p * self.start))
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn minimum_time_double_integrators_meet_the_analytic_time(p in -50.0..50.0, v in -5.0..5.0, a in 0.2..10.0) {
        let problem = Slide { start: [p, v], acceleration: a, latest: 1e4 };
        let exact = problem.least_time();
        prop_assume!(exact > 0.05);
        for scheme in SCHEMES {
            let s = solve(&problem, &Mesh::uniform(50), scheme, &problem.guess(), &Options::default()).expect("valid input");
            prop_assert!(s.status.is_success(), "{:?}: {}", scheme, s.status);
// the polynomial control of collocation may pass its bounds between the points: only shooting cannot beat the truth
            let leak = if scheme == SCHEMES[0] { 1e-6 } else { 1e-3 };
            prop_assert!(s.objective > exact * (1.0 - leak), "{:?}: {} beats {}", scheme, s.objective, exact);
            prop_assert!(s.objective < exact * (1.0 + 1e-2), "{:?}: {} for {}", scheme, s.objective, exact);
        }
    }

    #[test]
    fn impossible_deadlines_are_called_infeasible(p in 1.0..50.0, v in -5.0..5.0, share in 0.2..0.9) {
        let mut problem = Slide { start: [p, v], acceleration: 1.0, latest: 1e4 };
        problem.latest = share * problem.least_time();
        let s = solve(&problem, &Mesh::uniform(20), SCHEMES[0], &problem.guess().with_final_time(0.5 * problem.latest), &Options::default()).expect("valid input");
        prop_assert_eq!(s.status, Status::Infeasible);
        prop_assert!(s.residuals.primal > 1e-6);
    }

    #[test]
    fn linear_quadratic_problems_meet_the_riccati_cost(
        entries in prop::array::uniform4(-1.5..1.5), weight in 0.05..5.0, x in -3.0..3.0, y in -3.0..3.0,
    ) {
        let problem = Regulator { a: Matrix2::from_column_slice(&entries), weight, start: Vector2::new(x, y) };
        let exact = problem.least_cost();
        let guess = Guess::line(problem.start, SVector::zeros(), SVector::zeros(), 2.0);
        let s = solve(&problem, &Mesh::uniform(40), Transcription::HermiteSimpson, &guess, &Options::default()).expect("valid input");
        prop_assert_eq!(s.status, Status::Solved);
        // one Newton step: the recursion is exact for linear-quadratic problems
        prop_assert!(s.iterations <= 3, "{} iterations", s.iterations);
        prop_assert!((s.objective - exact).abs() < 1e-5 * (1.0 + exact), "{} for {}", s.objective, exact);
    }
}

#[test]
fn costs_converge_with_the_order_of_the_transcription() {
    let problem =
        Regulator { a: Matrix2::new(0.3, 1.0, -1.0, 0.2), weight: 0.5, start: Vector2::new(1.0, -2.0) };
    let exact = problem.least_cost();
    let guess = Guess::line(problem.start, SVector::zeros(), SVector::zeros(), 2.0);
    // a control that is constant over a segment limits the cost to order 2
    for (scheme, order) in [(SCHEMES[0], 2.0), (SCHEMES[1], 2.0), (SCHEMES[2], 4.0)] {
        let error = |n| {
            let s =
                solve(&problem, &Mesh::uniform(n), scheme, &guess, &Options::default()).expect("valid input");
            (s.objective - exact).abs()
        };
        let observed = (error(8) / error(16)).log2();
        assert!((observed - order).abs() < 0.35, "{scheme:?}: observed order {observed}");
    }
}

#[test]
fn solves_repeat_to_the_bit_and_do_not_depend_on_what_a_workspace_did_before() {
    let data = references();
    let problems: Vec<_> = data.iter().take(3).map(|r| thrust_rate(&r.start, &r.end)).collect();
    let mut workspace = Workspace::new();
    let proceed = |_: &traj_opt::Iteration| std::ops::ControlFlow::Continue(());
    for (i, p) in problems.iter().enumerate() {
        let guess = naive_guess(p, hover_thrust_rate());
        let (mesh, scheme) = (Mesh::uniform(12 + i), SCHEMES[i]);
        let fresh = solve(p, &mesh, scheme, &guess, &Options::default()).expect("valid input");
        let reused = solve_with(&mut workspace, p, &mesh, scheme, &guess, &Options::default(), proceed)
            .expect("valid input");
        assert_eq!(fresh.states(), reused.states());
        assert_eq!(fresh.controls(), reused.controls());
        assert_eq!(fresh.objective.to_bits(), reused.objective.to_bits());
    }
}

#[test]
fn a_monitor_can_stop_a_solve() {
    let problem = Slide { start: [1.0, 0.0], acceleration: 1.0, latest: 100.0 };
    let monitor = |i: &traj_opt::Iteration| {
        if i.iteration >= 2 { std::ops::ControlFlow::Break(()) } else { std::ops::ControlFlow::Continue(()) }
    };
    let s = solve_with(
        &mut Workspace::new(),
        &problem,
        &Mesh::uniform(10),
        SCHEMES[0],
        &problem.guess(),
        &Options::default(),
        monitor,
    )
    .expect("valid input");
    assert_eq!((s.status, s.iterations), (Status::Stopped, 2));
}

#[test]
fn residuals_hold_outside_the_solver() {
    for r in references().iter().take(5) {
        let t = thrust_rate(&r.start, &r.end);
        let guess = naive_guess(&t, hover_thrust_rate());
        let s = solve(&t, &Mesh::uniform(40), Transcription::HermiteSimpson, &guess, &Options::default())
            .expect("valid input");
        let b = t.bounds();
        for u in s.controls() {
            for i in 0..4 {
                assert!(u[i] >= b.control_lower[i] - 1e-6 && u[i] <= b.control_upper[i] + 1e-6);
            }
        }
        let x = s.states()[s.states().len() - 1];
        let mut attitude = [0.0; 3];
        t.boundary(&s.states()[0], &x, s.final_time(), &mut attitude);
        assert!(attitude.iter().all(|v| v.abs() < 1e-7));
        for k in 0..40 {
            // Simpson's rule on the states and controls that the solution reports
            let (t0, t1) = (s.times()[k], s.times()[k + 1]);
            let u = &s.controls()[3 * k..3 * k + 3];
            let (x0, xm, x1) = (s.states()[k], s.state_at(0.5 * (t0 + t1)), s.states()[k + 1]);
            let f = |x: &SVector<f64, 10>, u: &SVector<f64, 4>| t.dynamics().derivative(0.0, x, u);
            let (f0, fm, f1) = (f(&x0, &u[0]), f(&xm, &u[1]), f(&x1, &u[2]));
            let defect = x0 + (f0 + fm * 4.0 + f1) * ((t1 - t0) / 6.0) - x1;
            let middle = (x0 + x1) * 0.5 + (f0 - f1) * ((t1 - t0) / 8.0) - xm;
            assert!(
                defect.amax() < 1e-6 && middle.amax() < 1e-6,
                "segment {k}: {} {}",
                defect.amax(),
                middle.amax()
            );
        }
    }
}

#[test]
fn segment_errors_see_what_collocation_residuals_do_not() {
    let r = &references()[0];
    let t = thrust_rate(&r.start, &r.end);
    let guess = naive_guess(&t, hover_thrust_rate());
    let error = |scheme| {
        let s = solve(&t, &Mesh::uniform(40), scheme, &guess, &Options::default()).expect("valid input");
        segment_errors(&s, t.dynamics()).expect("integrable").into_iter().fold(0.0, f64::max)
    };
    assert!(error(Transcription::RungeKutta { substeps: 2 }) < 1e-5);
    assert!(error(Transcription::Trapezoidal) > 1e-4);
}

#[test]
fn malformed_input_is_refused() {
    let problem = Slide { start: [1.0, 0.0], acceleration: -1.0, latest: 100.0 };
    let run = |p: &Slide, g: &Guess<2, 1>, o: &Options| {
        solve(p, &Mesh::uniform(4), SCHEMES[0], g, o).map(|s| s.status)
    };
    assert!(matches!(
        run(&problem, &problem.guess(), &Options::default()),
        Err(Error::InconsistentBounds { .. })
    ));
    let problem = Slide { start: [f64::NAN, 0.0], acceleration: 1.0, latest: 100.0 };
    assert!(run(&problem, &problem.guess(), &Options::default()).is_err());
    let problem = Slide { start: [1.0, 0.0], acceleration: 1.0, latest: 100.0 };
    let late = problem.guess().with_final_time(-1.0);
    assert!(matches!(run(&problem, &late, &Options::default()), Err(Error::NonFiniteGuess { .. })));
    let options = Options::default().with_tolerance(f64::NAN);
    assert!(matches!(run(&problem, &problem.guess(), &options), Err(Error::InvalidOption { .. })));
}
