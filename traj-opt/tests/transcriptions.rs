//! Every transcription: observed order of convergence, agreement with the others, interpolation, path constraints.

use nalgebra::{RealField, SVector};
use traj_opt::{Bounds, Dynamics, Guess, Mesh, Options, Problem, Solution, Status, Transcription, solve};

const ALL: [Transcription; 9] = [
    Transcription::RungeKutta { substeps: 1 },
    Transcription::RungeKutta { substeps: 3 },
    Transcription::Trapezoidal,
    Transcription::HermiteSimpson,
    Transcription::CompressedHermiteSimpson,
    Transcription::LegendreGaussRadau { degree: 1 },
    Transcription::LegendreGaussRadau { degree: 2 },
    Transcription::LegendreGaussRadau { degree: 3 },
    Transcription::LegendreGaussRadau { degree: 5 },
];

fn real<T: RealField + Copy>(v: f64) -> T {
    nalgebra::convert(v)
}

/// A pendulum with a time-dependent load, free final time, running cost and, if asked for, a limit on energy-like values.
struct Pendulum {
    limit: f64,
}

impl Dynamics<2, 1> for Pendulum {
    fn derivative<T: RealField + Copy>(&self, t: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
        SVector::from([x[1], -x[0].sin() + u[0] + real::<T>(0.2) * t.sin()])
    }
}

impl Problem<2, 1> for Pendulum {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<2, 1> {
        Bounds::free()
            .with_initial_state([0.0, 0.0].into())
            .with_terminal_state([1.5, 0.0].into())
            .with_final_time(0.5, 10.0)
    }

    fn mayer<T: RealField + Copy>(&self, _: &SVector<T, 2>, _: &SVector<T, 2>, final_time: T) -> T {
        final_time
    }

    fn lagrange<T: RealField + Copy>(&self, t: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> Option<T> {
        Some(u[0] * u[0] * (T::one() + real::<T>(0.1) * t) + real::<T>(0.1) * x[0] * x[0])
    }

    fn n_path(&self) -> usize {
        usize::from(self.limit.is_finite())
    }

    fn path<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>, out: &mut [T]) {
        if let Some(first) = out.first_mut() {
            *first = real::<T>(self.limit) - u[0] * u[0] - x[1] * x[1];
        }
    }
}

fn solved(scheme: Transcription, n: usize, limit: f64) -> Solution<2, 1> {
    let guess = Guess::line([0.0, 0.0].into(), [1.5, 0.0].into(), [0.5].into(), 3.0);
    let s = solve(&Pendulum { limit }, &Mesh::uniform(n), scheme, &guess, &Options::default()).unwrap();
    assert_eq!(s.status, Status::Solved, "{scheme:?} with {n} segments");
    s
}

#[test]
fn costs_converge_with_the_order_of_the_transcription() {
    let fine = solved(Transcription::LegendreGaussRadau { degree: 5 }, 40, f64::INFINITY);
    let exact = fine.objective;
    for (scheme, order, n) in [
        // a control that is constant over a segment limits the cost to order 2
        (Transcription::RungeKutta { substeps: 1 }, 2.0, 16),
        (Transcription::Trapezoidal, 2.0, 16),
        (Transcription::HermiteSimpson, 4.0, 8),
        (Transcription::CompressedHermiteSimpson, 4.0, 8),
        (Transcription::LegendreGaussRadau { degree: 1 }, 1.0, 64),
        (Transcription::LegendreGaussRadau { degree: 2 }, 3.0, 16),
        (Transcription::LegendreGaussRadau { degree: 3 }, 5.0, 6),
    ] {
        let error = |n| (solved(scheme, n, f64::INFINITY).objective - exact).abs();
        let (coarse, fine) = (error(n), error(2 * n));
        let observed = (coarse / fine).log2();
        println!("{scheme:?}: {coarse:e} {fine:e}, order {observed}");
        assert!((observed - order).abs() < 0.4, "{scheme:?}: observed order {observed}");
    }
}

#[test]
fn all_transcriptions_agree_with_an_active_path_constraint() {
    let reference = solved(Transcription::HermiteSimpson, 100, 0.9).objective;
    assert!(reference > solved(Transcription::HermiteSimpson, 100, f64::INFINITY).objective + 1e-4);
    for scheme in ALL {
        let s = solved(scheme, 60, 0.9);
        let tolerance = if scheme.order() == 1 { 5e-2 } else { 2e-3 };
        assert!(
            (s.objective / reference - 1.0).abs() < tolerance,
            "{scheme:?}: {} for {reference}",
            s.objective
        );
    }
}

#[test]
fn compressed_and_separated_forms_have_the_same_solution() {
    let [a, b] = [Transcription::HermiteSimpson, Transcription::CompressedHermiteSimpson]
        .map(|scheme| solved(scheme, 12, f64::INFINITY));
    assert!((a.objective - b.objective).abs() < 1e-9);
    for (x, y) in a.states().iter().zip(b.states()) {
        assert!((x - y).amax() < 1e-6);
    }
}

#[test]
fn the_interpolant_of_radau_collocation_obeys_the_dynamics_at_its_points() {
    let degree = 4;
    let scheme = Transcription::LegendreGaussRadau { degree };
    let s = solved(scheme, 5, f64::INFINITY);
    let problem = Pendulum { limit: f64::INFINITY };
    for k in 0..5 {
        let (t0, t1) = (s.times()[k], s.times()[k + 1]);
        for (i, c) in scheme.control_points().iter().enumerate().take(degree - 1) {
            let t = t0 + c * (t1 - t0);
            let e = 1e-5;
            let slope = (s.state_at(t + e) - s.state_at(t - e)) / (2.0 * e);
            let u = s.controls()[k * degree + i];
            let f = problem.derivative(t, &s.state_at(t), &u);
            assert!((slope - f).amax() < 1e-7, "segment {k}, point {i}: {}", (slope - f).amax());
        }
    }
}
