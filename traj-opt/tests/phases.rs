//! Static parameters, a free start time, several phases.

use nalgebra::{RealField, SVector};
use traj_opt::{
    Bounds, ConstraintKind, Continuous, Dynamics, FreeInitialTime, Guess, Linked, Mesh, Options, Problem,
    Transcription, check_derivatives, solve,
};

const SCHEMES: [Transcription; 5] = [
    Transcription::RungeKutta { substeps: 1 },
    Transcription::Trapezoidal,
    Transcription::HermiteSimpson,
    Transcription::CompressedHermiteSimpson,
    Transcription::LegendreGaussRadau { degree: 3 },
];

fn real<T: RealField + Copy>(v: f64) -> T {
    nalgebra::convert(v)
}

/// Options with every factorisation that is compiled in: the recursion, and the sparse one that knows no stages.
fn factorisations() -> Vec<Options> {
    vec![
        Options::default(),
        #[cfg(feature = "faer")]
        Options::default().with_linear_algebra(traj_opt::LinearAlgebra::Sparse),
    ]
}

/// A mass on a line that accelerates within limits, from and to given states or free ones, in least time.
#[derive(Clone, Copy)]
struct Leg {
    from: Option<[f64; 2]>,
    to: Option<[f64; 2]>,
    /// Range of the acceleration.
    least: f64,
    limit: f64,
}

impl Dynamics<2, 1> for Leg {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
        SVector::from([x[1], u[0]])
    }
}

impl Problem<2, 1> for Leg {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<2, 1> {
        let mut bounds = Bounds::free().with_control([self.least].into(), [self.limit].into());
        if let Some(from) = self.from {
            bounds = bounds.with_initial_state(from.into());
        }
        if let Some(to) = self.to {
            bounds = bounds.with_terminal_state(to.into());
        }
        bounds.with_final_time(0.01, 100.0)
    }

    fn mayer<T: RealField + Copy>(&self, _: &SVector<T, 2>, _: &SVector<T, 2>, time: T) -> T {
        time
    }
}

/// The second leg of a flight: its clock starts where the first ends, so only its own final clock is the cost.
#[derive(Clone, Copy)]
struct Free(Leg);

impl Dynamics<2, 1> for Free {
    fn derivative<T: RealField + Copy>(&self, t: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
        self.0.derivative(t, x, u)
    }
}

impl Problem<2, 1> for Free {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<2, 1> {
        self.0.bounds()
    }
}

/// A mass on a line moved with least weighted effort in half a second.
struct Effort {
    from: Option<[f64; 2]>,
    to: Option<[f64; 2]>,
    weight: f64,
}

impl Dynamics<2, 1> for Effort {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
        SVector::from([x[1], u[0]])
    }
}

impl Problem<2, 1> for Effort {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<2, 1> {
        let mut bounds = Bounds::free().with_final_time(0.5, 0.5);
        if let Some(from) = self.from {
            bounds = bounds.with_initial_state(from.into());
        }
        if let Some(to) = self.to {
            bounds = bounds.with_terminal_state(to.into());
        }
        bounds
    }

    fn lagrange<T: RealField + Copy>(&self, _: T, _: &SVector<T, 2>, u: &SVector<T, 1>) -> Option<T> {
        Some(real::<T>(self.weight) * u[0] * u[0])
    }
}

#[test]
fn two_phases_with_different_costs_meet_at_the_best_state() {
    // 1 m from rest to rest in 1 s; effort costs four times as much in the second half. u = (a + b t) / w by the maximum principle,
    // and with I_k the integral of t^k / w the end conditions give the cost 1 / (I_2 - I_1^2 / I_0)
    let (i0, i1, i2): (f64, f64, f64) = (0.5 + 0.125, 0.125 + 0.375 / 4.0, (1.0 + 7.0 / 4.0) / 24.0);
    let exact = 1.0 / (i2 - i1 * i1 / i0);
    let problem = Linked::<_, _, _, 2, 2, 1, 1> {
        first: Effort { from: Some([0.0, 0.0]), to: None, weight: 1.0 },
        second: Effort { from: None, to: Some([1.0, 0.0]), weight: 4.0 },
        linkage: Continuous,
    };
    let leg = |from: [f64; 2], to: [f64; 2]| Guess::line(from.into(), to.into(), [0.0].into(), 0.5);
    let guess: Guess<6, 2> = problem.guess(&leg([0.0, 0.0], [0.5, 0.5]), &leg([0.5, 0.5], [1.0, 0.0]));
    for (scheme, options) in
        SCHEMES.into_iter().flat_map(|s| factorisations().into_iter().map(move |o| (s, o)))
    {
        let s = solve(&problem, &Mesh::uniform(20), scheme, &guess, &options).unwrap();
        let by = options.linear_algebra;
        assert!(s.status.is_success(), "{scheme:?} {by:?}: {}, {:?}", s.status, s.diagnosis);
        println!("{scheme:?} {by:?}: {} iterations", s.iterations);
        let tolerance = if scheme.order() == 2 || scheme == SCHEMES[0] { 2e-3 } else { 1e-7 };
        assert!((s.objective / exact - 1.0).abs() < tolerance, "{scheme:?}: {} for {exact}", s.objective);
        let (start, end) = (s.states()[0], s.states()[20]);
        assert!((0..2).all(|i| (end[i] - start[2 + i]).abs() < 1e-7), "linked");
    }
    assert_eq!(problem.phase_of_state(3), Some((1, 1)));
    assert_eq!(problem.phase_of_state(5), None);
}

#[test]
fn three_phases_nest() {
    // two legs of 0.5 m from rest to rest, 2 sqrt(0.5) each, then 0.25 m back
    let pair = Linked::<_, _, _, 2, 2, 1, 1> {
        first: Free(Leg { from: Some([0.0, 0.0]), to: Some([0.5, 0.0]), least: -1.0, limit: 1.0 }),
        second: Free(Leg { from: Some([0.5, 0.0]), to: Some([1.0, 0.0]), least: -1.0, limit: 1.0 }),
        linkage: Continuous,
    };
    struct Ends;
    impl traj_opt::Linkage<6, 2> for Ends {
        fn len(&self) -> usize {
            2
        }
        fn residual<T: RealField + Copy>(&self, end: &SVector<T, 6>, start: &SVector<T, 2>, out: &mut [T]) {
            for i in 0..2 {
                out[i] = start[i] - end[2 + i];
            }
        }
    }
    let problem = Linked::<_, _, _, 6, 2, 2, 1> {
        first: pair,
        // one clock: the end of the third leg is the time of all three
        second: Leg { from: None, to: Some([0.75, 0.0]), least: -1.0, limit: 1.0 },
        linkage: Ends,
    };
    let leg = |from: f64, to: f64| Guess::line([from, 0.0].into(), [to, 0.0].into(), [0.0].into(), 1.0);
    let guess: Guess<10, 3> = problem.guess(&pair.guess(&leg(0.0, 0.5), &leg(0.5, 1.0)), &leg(1.0, 0.75));
    let exact = 4.0 * f64::sqrt(0.5) + 2.0 * f64::sqrt(0.25);
    for options in factorisations() {
        let s = solve(&problem, &Mesh::uniform(10), Transcription::HermiteSimpson, &guess, &options).unwrap();
        let right = s.status.is_success() && (s.objective - exact).abs() < 1e-5;
        assert!(right, "{:?} {}: {} for {exact}", options.linear_algebra, s.status, s.objective);
    }
}

/// Catches a target that moves as `1 + (t - 3)^2 / 4`, in least effort with a free departure: the duration is fixed.
struct Window;

impl Dynamics<2, 1> for Window {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
        SVector::from([x[1], u[0]])
    }
}

impl Problem<2, 1> for Window {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<2, 1> {
        Bounds::free().with_initial_state([0.0, 0.0].into()).with_terminal_component(1, 0.0)
    }

    fn lagrange<T: RealField + Copy>(&self, _: T, _: &SVector<T, 2>, u: &SVector<T, 1>) -> Option<T> {
        Some(u[0] * u[0])
    }

    fn n_boundary(&self) -> usize {
        1
    }

    fn boundary<T: RealField + Copy>(&self, _: &SVector<T, 2>, end: &SVector<T, 2>, time: T, out: &mut [T]) {
        let late = time - real::<T>(3.0);
        out[0] = end[0] - T::one() - late * late * real::<T>(0.25);
    }
}

#[test]
fn a_free_start_time_waits_for_the_best_window() {
    // the nearest the target comes is 1, at clock 3: with a duration of 1 the departure is at 2 and the cost that of a block move
    let problem = FreeInitialTime { problem: Window, initial_time: (0.0, 10.0), duration: (1.0, 1.0) };
    let guess = Guess::line([0.0, 0.0, 0.5].into(), [1.0, 0.0, 0.5].into(), [0.0].into(), 1.0);
    for scheme in SCHEMES {
        let s = solve(&problem, &Mesh::uniform(40), scheme, &guess, &Options::default()).unwrap();
        assert!(s.status.is_success(), "{scheme:?}: {}", s.status);
        assert!((s.states()[0][2] - 2.0).abs() < 1e-3, "{scheme:?}: departs at {}", s.states()[0][2]);
        assert!((s.objective / 12.0 - 1.0).abs() < 2e-3, "{scheme:?}: {}", s.objective);
    }
}

/// The stiffest spring within bounds is not the best one: design the static parameter k of x'' = -k x so that x(1) = 0 from rest
/// at 1 with least effort: exactly k = (pi/2)^2 without any control.
struct Spring;

impl Dynamics<3, 1> for Spring {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 3>, u: &SVector<T, 1>) -> SVector<T, 3> {
        SVector::from([x[1], -x[2] * x[0] + u[0], T::zero()])
    }
}

impl Problem<3, 1> for Spring {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<3, 1> {
        let inf = f64::INFINITY;
        Bounds::free()
            .with_state([-inf, -inf, 0.1].into(), [inf, inf, 5.0].into())
            .with_initial_component(0, 1.0)
            .with_initial_component(1, 0.0)
            .with_terminal_component(0, 0.0)
            .with_final_time(1.0, 1.0)
    }

    fn lagrange<T: RealField + Copy>(&self, _: T, _: &SVector<T, 3>, u: &SVector<T, 1>) -> Option<T> {
        Some(u[0] * u[0])
    }
}

#[test]
fn a_static_parameter_is_a_state_that_does_not_change() {
    let guess = Guess::line([1.0, 0.0, 1.0].into(), [0.0, -1.0, 1.0].into(), [0.0].into(), 1.0);
    for scheme in [Transcription::HermiteSimpson, Transcription::LegendreGaussRadau { degree: 3 }] {
        let s = solve(&Spring, &Mesh::uniform(20), scheme, &guess, &Options::default()).unwrap();
        let exact = std::f64::consts::FRAC_PI_2.powi(2);
        assert!(
            s.status.is_success() && s.objective.abs() < 1e-6,
            "{scheme:?}: {} {}",
            s.status,
            s.objective
        );
        assert!((s.states()[0][2] - exact).abs() < 1e-3, "{scheme:?}: {}", s.states()[0][2]);
    }
}

#[test]
fn derivatives_of_linked_phases_agree_with_central_differences() {
    let problem = Linked::<_, _, _, 2, 2, 1, 1> {
        first: Leg { from: None, to: None, least: -2.0, limit: 2.0 },
        second: Leg { from: None, to: None, least: -1.0, limit: 1.0 },
        linkage: Continuous,
    };
    let x = SVector::<f64, 6>::from([0.3, -0.2, 1.0, 0.7, 1.4, 0.6]);
    let u = SVector::<f64, 2>::from([0.5, -0.8]);
    assert!(check_derivatives(&problem, 0.4, &x, &u) < 1e-12);
    let jacobian = problem.jacobian(0.4, &x, &u);
    for i in 0..6 {
        let mut step = SVector::<f64, 6>::zeros();
        step[i] = 1e-6;
        let f = |x: SVector<f64, 6>| problem.derivative(0.4, &x, &u);
        let slope = (f(x + step) - f(x - step)) / 2e-6;
        assert!((slope - jacobian.state.column(i)).amax() < 1e-8);
    }
}

#[test]
fn an_infeasible_phase_is_named_with_its_clock() {
    // the first leg has all the time it wants, the second must move 1 m in 0.5 s with 1 m/s^2
    let leg = |from, to| Leg { from, to, least: -1.0, limit: 1.0 };
    let problem = Linked::<_, _, _, 2, 2, 1, 1> {
        first: leg(Some([0.0, 0.0]), Some([1.0, 0.0])),
        second: Hurried(leg(None, Some([2.0, 0.0]))),
        linkage: Continuous,
    };
    let guess = problem.guess::<6, 2>(
        &Guess::line([0.0, 0.0].into(), [1.0, 0.0].into(), [0.0].into(), 2.0),
        &Guess::line([1.0, 0.0].into(), [2.0, 0.0].into(), [0.0].into(), 0.4),
    );
    let mut found = 0;
    for scheme in SCHEMES {
        let s = solve(&problem, &Mesh::uniform(20), scheme, &guess, &Options::default()).unwrap();
        assert_eq!(s.status, traj_opt::Status::Infeasible, "{scheme:?}");
        let d = s.diagnosis.unwrap();
        println!("{scheme:?}: {d}");
        let first = s.states()[0][4];
        // the clock is that of the phase named, also where a solver spreads the violation into the first
        let from = if d.phase == 1 { first } else { 0.0 };
        let to = if d.phase == 1 { first + 0.5 } else { first };
        assert!(d.amount > 1e-3 && d.index < 2 && d.phase < 2, "{scheme:?}: {d}");
        assert!(d.time >= from - 1e-6 && d.time <= to + 1e-6, "{scheme:?}: {d}, seam {first}");
        found += d.phase;
    }
    assert!(found > 0, "the second phase is the one that cannot be flown");
    // every kind is told in the words of its phase, at half of the second
    let x: SVector<f64, 6> = [0.0, 0.0, 0.0, 0.0, 2.0, 0.5].into();
    let told = |kind, index| Problem::<6, 2>::locate(&problem, kind, index, 0.5, &x);
    for (kind, index, phase, own) in [
        (ConstraintKind::State, 3, 1, 1),
        (ConstraintKind::State, 1, 0, 1),
        (ConstraintKind::Control, 1, 1, 0),
        (ConstraintKind::Dynamics, 2, 1, 0),
    ] {
        let location = told(kind, index);
        assert_eq!((location.kind, location.phase, location.index), (kind, phase, own));
        assert_eq!(location.time, if phase == 1 { 2.25 } else { 1.0 });
    }
    let seam = told(ConstraintKind::Boundary, 1);
    assert_eq!((seam.kind, seam.phase, seam.index, seam.time), (ConstraintKind::Linkage, 1, 1, 2.0));
    assert_eq!(told(ConstraintKind::State, 5).kind, ConstraintKind::Duration);
}

/// A leg with at most half a second.
#[derive(Clone, Copy)]
struct Hurried(Leg);

impl Dynamics<2, 1> for Hurried {
    fn derivative<T: RealField + Copy>(&self, t: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
        self.0.derivative(t, x, u)
    }
}

impl Problem<2, 1> for Hurried {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<2, 1> {
        self.0.bounds().with_final_time(0.01, 0.5)
    }
}
