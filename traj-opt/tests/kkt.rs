//! The conditions of optimality, written out by hand from what a solution reports.

use nalgebra::{RealField, SVector};
use proptest::prelude::*;
use traj_opt::{Bounds, Dynamics, Guess, Mesh, Options, Problem, Solution, Status, Transcription, solve};

/// A damped cart with a speed limit: a compromise of time and effort, `|u| <= 1`, from rest to rest.
struct Cart {
    distance: f64,
    drag: f64,
    effort: f64,
    speed: f64,
}

fn real<T: RealField + Copy>(v: f64) -> T {
    nalgebra::convert(v)
}

impl Dynamics<2, 1> for Cart {
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
        SVector::from([x[1], u[0] - real::<T>(self.drag) * x[1] * x[1]])
    }
}

impl Problem<2, 1> for Cart {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<2, 1> {
        Bounds::free()
            .with_control([-1.0].into(), [1.0].into())
            .with_state([f64::NEG_INFINITY, -self.speed].into(), [f64::INFINITY, self.speed].into())
            .with_initial_state([0.0, 0.0].into())
            .with_terminal_state([self.distance, 0.0].into())
            .with_final_time(0.1, 1000.0)
    }

    fn mayer<T: RealField + Copy>(&self, _: &SVector<T, 2>, _: &SVector<T, 2>, time: T) -> T {
        time
    }

    fn lagrange<T: RealField + Copy>(&self, _: T, _: &SVector<T, 2>, u: &SVector<T, 1>) -> Option<T> {
        Some(real::<T>(self.effort) * u[0] * u[0])
    }
}

/// Greatest entry of the Lagrangian's gradient of the trapezoidal transcription, of its defects, of products of multipliers and
/// distances, and of negative multipliers.
fn residuals(cart: &Cart, s: &Solution<2, 1>) -> [f64; 4] {
    let n = s.times().len() - 1;
    let m = &s.multipliers;
    let (mut dual, mut primal, mut product, mut negative): (f64, f64, f64, f64) = (0.0, 0.0, 0.0, 0.0);
    let half = 0.5 * s.final_time() / n as f64;
    let mut by_state = vec![SVector::<f64, 2>::zeros(); n + 1];
    let mut by_time = 1.0 - m.final_time[0] + m.final_time[1];
    for k in 0..n {
        let lambda = m.defects[k];
        let mut slope = SVector::<f64, 2>::zeros();
        by_state[k] += lambda;
        by_state[k + 1] -= lambda;
        for end in 0..2 {
            let (x, u, at) = (s.states()[k + end], s.controls()[2 * k + end][0], 2 * k + end);
            let f = SVector::from([x[1], u - cart.drag * x[1] * x[1]]);
            slope += f * half;
            by_state[k + end][1] += half * (lambda[0] - 2.0 * cart.drag * x[1] * lambda[1]);
            by_time += (f.dot(&lambda) + cart.effort * u * u) * 0.5 / n as f64;
            let (low, high) = (m.controls[0][at][0], m.controls[1][at][0]);
            dual = dual.max((half * (lambda[1] + 2.0 * cart.effort * u) - low + high).abs());
            product = product.max((low * (u + 1.0)).abs()).max((high * (1.0 - u)).abs());
            negative = negative.max(-low).max(-high);
            primal = primal.max(u.abs() - 1.0);
        }
        primal = primal.max((s.states()[k] + slope - s.states()[k + 1]).amax());
    }
    for k in 1..=n {
        let (low, high) = (m.states[0][k], m.states[1][k]);
        let mut g = by_state[k] - low + high;
        if k == n {
            // both components of the end state are fixed
            g += SVector::from([m.boundary[0], m.boundary[1]]);
        }
        let v = s.states()[k][1];
        dual = dual.max(g.amax());
        product = product.max((low[1] * (v + cart.speed)).abs()).max((high[1] * (cart.speed - v)).abs());
        negative = negative.max(-low.min()).max(-high.min());
        primal = primal.max(v.abs() - cart.speed);
    }
    [dual.max(by_time.abs()), primal, product, negative]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn solutions_meet_the_conditions_of_optimality(
        distance in 0.5..20.0, drag in 0.0..0.5, effort in 0.01..2.0, speed in 0.3..5.0,
    ) {
        let cart = Cart { distance, drag, effort, speed };
        let guess = Guess::line([0.0; 2].into(), [distance, 0.0].into(), [0.0].into(), 2.0 * distance / speed.min(1.0));
        let s = solve(&cart, &Mesh::uniform(24), Transcription::Trapezoidal, &guess, &Options::default()).unwrap();
        prop_assert_eq!(s.status, Status::Solved);
        let [dual, primal, product, negative] = residuals(&cart, &s);
        // the solver's own 1e-8 is scaled by variables and multipliers of up to some hundreds
        prop_assert!(dual < 1e-6, "stationarity {}", dual);
        prop_assert!(primal < 1e-6, "feasibility {}", primal);
        prop_assert!(product < 1e-5, "complementarity {}", product);
        prop_assert!(negative <= 0.0, "sign {}", negative);
    }
}
