//! Successive convexification against the interior-point method, exact values and certified bounds.
#![cfg(feature = "clarabel")]
#![allow(dead_code)]

mod common;

use common::quadcopter::*;
use nalgebra::{RealField, SVector};
use std::ops::ControlFlow;
use traj_opt::{
    Affine, BoundOptions, Bounds, Cone, Conic, ConicOptions, ConstraintKind, Dynamics, Error, Guess,
    IntegrateOptions, Mesh, Options, PointMass, Problem, Solution, Status, Transcription, least_time_bound,
    solve, solve_conic, solve_conic_with,
};

const SCHEMES: [Transcription; 5] = [
    Transcription::HermiteSimpson,
    Transcription::CompressedHermiteSimpson,
    Transcription::Trapezoidal,
    Transcription::LegendreGaussRadau { degree: 3 },
    Transcription::RungeKutta { substeps: 1 },
];

fn real<T: RealField + Copy>(v: f64) -> T {
    nalgebra::convert(v)
}

/// A point mass in a plane with drag, `|u| <= 4`, to rest in least time; `smooth` states its limits as path constraints,
/// for the interior-point method. `slope`: it stays inside the cone `|x| <= slope z`.
struct Flight {
    start: [f64; 2],
    /// Horizontal velocity at the start.
    velocity: f64,
    end: [f64; 2],
    drag: f64,
    slope: Option<f64>,
    smooth: bool,
}

impl Dynamics<4, 2> for Flight {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 4>, u: &SVector<T, 2>) -> SVector<T, 4> {
        let speed = (x[2] * x[2] + x[3] * x[3] + real(1e-6)).sqrt();
        let drag = speed * real(self.drag);
        SVector::from([x[2], x[3], u[0] - drag * x[2], u[1] - drag * x[3]])
    }
}

/// A rise inside the cone of positions.
const RISE: Flight =
    Flight { start: [0.0, 0.5], velocity: 0.0, end: [3.0, 5.5], drag: 0.2, slope: Some(0.6), smooth: false };

impl Problem<4, 2> for Flight {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<4, 2> {
        let at = |p: [f64; 2]| SVector::from([p[0], p[1], 0.0, 0.0]);
        Bounds::free()
            .with_control([-4.0; 2].into(), [4.0; 2].into())
            .with_initial_state(at(self.start) + SVector::from([0.0, 0.0, self.velocity, 0.0]))
            .with_terminal_state(at(self.end))
            .with_final_time(0.1, 50.0)
    }

    fn mayer<T: RealField + Copy>(&self, _: &SVector<T, 4>, _: &SVector<T, 4>, time: T) -> T {
        time
    }

    fn n_path(&self) -> usize {
        if self.smooth { 1 + 2 * usize::from(self.slope.is_some()) } else { 0 }
    }

    fn path<T: RealField + Copy>(&self, _: T, x: &SVector<T, 4>, u: &SVector<T, 2>, out: &mut [T]) {
        let slope = self.slope.unwrap_or(0.0);
        let values = [
            real::<T>(16.0) - u[0] * u[0] - u[1] * u[1],
            real::<T>(slope) * x[1] - x[0],
            real::<T>(slope) * x[1] + x[0],
        ];
        out.iter_mut().zip(values).for_each(|(o, v)| *o = v);
    }
}

impl Conic<4, 2> for Flight {
    fn cones(&self) -> Vec<Cone<4, 2>> {
        let thrust =
            Cone { rows: vec![Affine::control(0), Affine::control(1)], radius: Affine::constant(4.0) };
        let inside =
            |slope| Cone { rows: vec![Affine::state(0)], radius: Affine::constant(0.0).with_state(1, slope) };
        std::iter::once(thrust).chain(self.slope.map(inside)).collect()
    }
}

fn line(f: &Flight) -> Guess<4, 2> {
    let at = |p: [f64; 2]| SVector::from([p[0], p[1], 0.0, 0.0]);
    Guess::line(at(f.start), at(f.end), [0.0, 0.0].into(), 3.0)
}

/// Value of the interior-point method and the solution of the conic path.
fn both(mut flight: Flight, scheme: Transcription, n: usize) -> (f64, Solution<4, 2>) {
    let guess = line(&flight);
    let conic = solve_conic(&flight, &Mesh::uniform(n), scheme, &guess, &ConicOptions::default()).unwrap();
    flight.smooth = true;
    let smooth = solve(&flight, &Mesh::uniform(n), scheme, &guess, &Options::default()).unwrap();
    println!(
        "{scheme:?}: conic {} {} {} {:?}, interior point {} {}",
        conic.objective, conic.status, conic.iterations, conic.residuals, smooth.objective, smooth.status
    );
    assert!(smooth.status.is_success(), "{}", smooth.status);
    (smooth.objective, conic)
}

#[test]
fn it_reaches_the_value_of_the_interior_point_method_with_every_transcription() {
    for scheme in SCHEMES {
        agrees(RISE, scheme);
    }
}

/// The value, after checking that both methods find it.
fn agrees(flight: Flight, scheme: Transcription) -> f64 {
    let (value, conic) = both(flight, scheme, 16);
    assert!(conic.status.is_success(), "{scheme:?} {}: {:?}", conic.status, conic.diagnosis);
    assert!((conic.objective / value - 1.0).abs() < 1e-5, "{scheme:?}: {} for {value}", conic.objective);
    value
}

/// A start that moves outwards: the glide slope bends the way.
#[test]
fn a_binding_cone_of_positions_costs_what_it_costs_the_interior_point_method() {
    let [free, bound] = [None, Some(0.6)].map(|slope| {
        let flight =
            Flight { start: [0.3, 1.0], velocity: 1.5, end: [1.0, 3.0], drag: 0.2, slope, smooth: false };
        agrees(flight, Transcription::HermiteSimpson)
    });
    assert!(bound > free + 1e-4, "the slope does not bind: {bound} {free}");
}

impl Conic<10, 4> for Transition<ThrustRate, 10> {
    fn cones(&self) -> Vec<Cone<10, 4>> {
        vec![]
    }
}

/// A minimum-time transition of a quadcopter. The conic path is at its limit of iterations here, feasible and 0.15 % faster than the
/// interior-point method: the test asks that it be no slower, and checks the flight by integration.
#[test]
fn it_flies_a_quadcopter_no_slower_than_the_interior_point_method() {
    let (mesh, scheme) = (Mesh::uniform(16), Transcription::RungeKutta { substeps: 2 });
    for r in references().iter().take(1) {
        let t = thrust_rate(&r.start, &r.end);
        let guess = naive_guess(&t, hover_thrust_rate());
        let conic = solve_conic(&t, &mesh, scheme, &guess, &ConicOptions::default()).unwrap();
        let smooth = solve(&t, &mesh, scheme, &guess, &Options::default()).unwrap();
        println!(
            "transition {}: conic {} {} {} {:?}, interior point {} {}",
            r.id,
            conic.objective,
            conic.status,
            conic.iterations,
            conic.residuals,
            smooth.objective,
            smooth.status
        );
        assert!(
            conic.status.is_success() && smooth.status.is_success(),
            "{} {}",
            conic.status,
            smooth.status
        );
        assert!(conic.objective < smooth.objective * (1.0 + 1e-4));
        let flown = conic.integrate(t.dynamics(), &IntegrateOptions::default()).unwrap();
        assert!((flown.end_state() - conic.states()[16]).amax() < 1e-2, "{}", flown.end_state());
    }
}

#[test]
fn no_value_is_below_the_certified_bound_and_the_controls_fly() {
    let flight =
        Flight { start: [0.0, 0.5], velocity: 0.0, end: [3.0, 4.5], drag: 0.0, slope: None, smooth: false };
    let s = solve_conic(
        &flight,
        &Mesh::uniform(20),
        Transcription::HermiteSimpson,
        &line(&flight),
        &ConicOptions::default(),
    )
    .unwrap();
    assert_eq!(s.status, Status::Solved);
    let mass = PointMass {
        start: [0.0, 0.5, 0.0],
        start_velocity: [0.0; 3],
        end: [3.0, 4.5, 0.0],
        end_velocity: [0.0; 3],
        acceleration: 4.0,
        bias: [0.0; 3],
        speed: 20.0,
    };
    let bound = least_time_bound(&mass, &BoundOptions::default()).unwrap();
    // 5 m at 4 m/s^2 from rest to rest
    let exact = 2.0 * f64::sqrt(5.0 / 4.0);
    assert!(
        s.objective >= bound && (s.objective / exact - 1.0).abs() < 1e-4,
        "{bound} {} {exact}",
        s.objective
    );
    let flown = s.integrate(&flight, &IntegrateOptions::default()).unwrap();
    assert!((flown.end_state() - s.states()[20]).amax() < 1e-6);
    for u in s.controls() {
        assert!(u.norm() <= 4.0 + 1e-6);
    }
    // multipliers of cones lie in the dual cone and are complementary
    for (z, u) in s.multipliers.cones.chunks_exact(3).zip(s.controls()) {
        assert!(z[0] >= f64::hypot(z[1], z[2]) - 1e-6);
        assert!((4.0 * z[0] + z[1] * u[0] + z[2] * u[1]).abs() < 1e-4);
    }
}

/// Soft landing with most mass left, thrust `u[0..2]` of norm at most `u[2]`, which burns the fuel: the lossless form of a thrust with
/// limits on its norm (B. Acikmese, S. R. Ploen, J. Guidance 30, 2007). Straight down it is Meditch's problem.
struct Landing;

impl Dynamics<5, 3> for Landing {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 5>, u: &SVector<T, 3>) -> SVector<T, 5> {
        SVector::from([x[2], x[3], u[0] / x[4], u[1] / x[4] - T::one(), -u[2] / real(2.349)])
    }
}

impl Problem<5, 3> for Landing {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<5, 3> {
        let inf = f64::INFINITY;
        let mut bounds = Bounds::free()
            .with_control([-inf, -inf, 0.0].into(), [inf, inf, 1.227].into())
            .with_state([-inf, -inf, -inf, -inf, 0.1].into(), [inf; 5].into())
            .with_initial_state([0.0, 1.0, 0.0, -0.783, 1.0].into())
            .with_final_time(0.1, 20.0);
        for i in 0..4 {
            bounds = bounds.with_terminal_component(i, 0.0);
        }
        bounds
    }

    fn mayer<T: RealField + Copy>(&self, _: &SVector<T, 5>, end: &SVector<T, 5>, _: T) -> T {
        -end[4]
    }
}

impl Conic<5, 3> for Landing {
    fn cones(&self) -> Vec<Cone<5, 3>> {
        vec![Cone { rows: vec![Affine::control(0), Affine::control(1)], radius: Affine::control(2) }]
    }
}

#[test]
fn a_soft_landing_has_its_exact_value_and_the_relaxed_thrust_is_lossless() {
    let guess = Guess::line(
        [0.0, 1.0, 0.0, -0.783, 1.0].into(),
        [0.0, 0.0, 0.0, 0.0, 0.5].into(),
        [0.0, 0.5, 0.6].into(),
        1.5,
    );
    // the switch, by root finding at 0.239259109 of 1.396808089, is a knot
    let (switch, last) = (0.239_259_109 / 1.396_808_089, 24);
    let knots = (0..=last).map(|k| {
        if k <= 4 {
            switch * k as f64 / 4.0
        } else {
            switch + (1.0 - switch) * (k - 4) as f64 / (last - 4) as f64
        }
    });
    let mesh = Mesh::from_fractions(knots.collect()).unwrap();
    let s = solve_conic(&Landing, &mesh, Transcription::HermiteSimpson, &guess, &ConicOptions::default())
        .unwrap();
    println!("{} {} {} {:?}", s.objective, s.status, s.iterations, s.residuals);
    assert!(s.status.is_success(), "{}", s.status);
    assert!((-s.objective / 0.395_354_364 - 1.0).abs() < 1e-5, "{}", s.objective);
    for u in s.controls() {
        assert!((f64::hypot(u[0], u[1]) - u[2]).abs() < 1e-3, "{u:?}");
    }
    let flown = s.integrate(&Landing, &IntegrateOptions::default()).unwrap();
    assert!((flown.end_state() - s.states()[last]).amax() < 1e-3);
}

#[test]
fn it_can_be_stopped_refuses_bad_options_and_names_what_is_infeasible() {
    let (mesh, scheme, guess) = (Mesh::uniform(8), Transcription::Trapezoidal, line(&RISE));
    let options = ConicOptions::default();
    let stop = |entry: &traj_opt::Iteration| match entry.iteration {
        2 => ControlFlow::Break(()),
        _ => ControlFlow::Continue(()),
    };
    let s = solve_conic_with(&RISE, &mesh, scheme, &guess, &options, stop).unwrap();
    assert_eq!((s.status, s.iterations), (Status::Stopped, 2));
    let bad = options.clone().with_trust_radius(0.0);
    assert!(matches!(solve_conic(&RISE, &mesh, scheme, &guess, &bad), Err(Error::InvalidOption { .. })));
    let shapeless = Flight { slope: Some(f64::NAN), ..RISE };
    let refused = solve_conic(&shapeless, &mesh, scheme, &guess, &options);
    assert_eq!(refused.unwrap_err(), Error::NonFiniteCone { cone: 1 });
    // an end outside the cone of positions
    let outside = Flight { end: [5.0, 5.5], ..RISE };
    let s = solve_conic(&outside, &mesh, scheme, &line(&outside), &options).unwrap();
    assert_eq!(s.status, Status::Infeasible, "{:?}", s.residuals);
    let found = s.diagnosis.unwrap();
    println!("{found}");
    assert!(matches!(found.kind, ConstraintKind::Cone | ConstraintKind::TerminalState));
    assert!((found.time - s.final_time()).abs() < 1e-9 && found.amount > 0.1);
}
