//! Dynamics of one's own: a cart swings up its pole with least effort. Drawn as a film strip, its mesh refined until the pole stands
//! when the controls are flown, and checked against an integration that knows nothing of the solver.
//!
//!     cargo run --release -p traj-opt --example custom_dynamics

use traj_opt::nalgebra::{RealField, SVector, convert};
use traj_opt::{
    Bounds, Dynamics, Guess, IntegrateOptions, Mesh, Options, Problem, RefineOptions, Trajectory,
    Transcription, solve_refined,
};

const GRAVITY: f64 = 9.81;
const DURATION: f64 = 2.0;

/// State: place of the cart (m), angle of the pole from hanging (rad), and their rates. Control: the force on the cart (N).
struct CartPole {
    cart: f64,
    pole: f64,
    length: f64,
    force: f64,
    travel: f64,
}

impl Dynamics<4, 1> for CartPole {
    /// M. Kelly, *An introduction to trajectory optimization*, SIAM Review 59 (2017), eqs. 6.1 and 6.2.
    fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 4>, u: &SVector<T, 1>) -> SVector<T, 4> {
        let [m1, m2, l, g] = [self.cart, self.pole, self.length, GRAVITY].map(convert::<f64, T>);
        let (sin, cos) = x[1].sin_cos();
        let swing = l * m2 * sin * x[3] * x[3];
        let inertia = m1 + m2 * sin * sin;
        let cart = (swing + u[0] + m2 * g * cos * sin) / inertia;
        let pole = -(swing * cos + u[0] * cos + (m1 + m2) * g * sin) / (l * inertia);
        SVector::from([x[2], x[3], cart, pole])
    }
}

impl Problem<4, 1> for CartPole {
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<4, 1> {
        Bounds::free()
            .with_control([-self.force].into(), [self.force].into())
            .with_initial_state(SVector::zeros())
            .with_terminal_state(self.upright())
            .with_final_time(DURATION, DURATION)
    }

    fn lagrange<T: RealField + Copy>(&self, _: T, _: &SVector<T, 4>, u: &SVector<T, 1>) -> Option<T> {
        Some(u[0] * u[0])
    }
}

impl CartPole {
    fn upright(&self) -> SVector<f64, 4> {
        [self.travel, std::f64::consts::PI, 0.0, 0.0].into()
    }

    /// Mechanical energy (J), least when the pole hangs at rest.
    fn energy(&self, x: &SVector<f64, 4>) -> f64 {
        let (sin, cos) = x[1].sin_cos();
        let tip = [x[2] + self.length * x[3] * cos, self.length * x[3] * sin];
        let kinetic = self.cart * x[2] * x[2] + self.pole * (tip[0] * tip[0] + tip[1] * tip[1]);
        0.5 * kinetic + self.pole * GRAVITY * self.length * (1.0 - cos)
    }
}

/// Columns and rows a metre; a character is twice as high as wide.
const SCALE: [f64; 2] = [24.0, 12.0];

/// One picture: the cart on its track, the pole as dots.
fn frame(model: &CartPole, x: &SVector<f64, 4>) -> Vec<String> {
    let reach = (model.length * SCALE[1]).ceil();
    let width = ((model.travel + 2.0 * model.length) * SCALE[0]).ceil() as usize + 1;
    let mut rows = vec![vec![' '; width]; 2 * reach as usize + 1];
    let mut put = |share: f64, mark: char| {
        let column = (x[0] + model.length * (1.0 + share * x[1].sin())) * SCALE[0];
        let row = reach + share * model.length * x[1].cos() * SCALE[1];
        if let Some(cell) =
            rows.get_mut(row.round() as usize).and_then(|row| row.get_mut(column.round() as usize))
        {
            *cell = mark;
        }
    };
    (1..10).for_each(|i| put(f64::from(i) / 10.0, '.'));
    put(1.0, 'O');
    put(0.0, '#');
    rows.into_iter().map(|row| row.into_iter().collect::<String>().trim_end().to_owned()).collect()
}

fn film(model: &CartPole, flown: &Trajectory<4>) {
    for moment in [0.0, 0.55, 0.9, 1.3, 1.5, 1.65, DURATION] {
        let state = flown.state_at(moment);
        println!("t = {moment:.2} s, energy {:5.2} J", model.energy(&state));
        frame(model, &state).iter().filter(|row| !row.is_empty()).for_each(|row| println!("  {row}"));
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = CartPole { cart: 1.0, pole: 0.3, length: 0.5, force: 20.0, travel: 1.0 };
    let guess = Guess::line(SVector::zeros(), model.upright(), [0.0].into(), DURATION);
    let refine = RefineOptions::default().with_tolerance(1e-7);
    let (mesh, options) = (Mesh::uniform(20), Options::default());
    let refined = solve_refined(&model, &mesh, Transcription::HermiteSimpson, &guess, &options, &refine)?;
    let solution = &refined.solution;
    if !refined.converged {
        return Err(format!("{}: {:?}", solution.status, solution.diagnosis).into());
    }

    let flown = solution.integrate(&model, &IntegrateOptions::default())?;
    film(&model, &flown);
    let greatest = solution.controls().iter().map(|u| u[0].abs()).fold(0.0, f64::max);
    println!("{}: effort {:.4} N^2 s, force at most {greatest:.2} N", solution.status, solution.objective);
    let (segments, miss) = (solution.mesh().n_segments(), (flown.end_state() - model.upright()).amax());
    println!(
        "{segments} segments, {} iterations; flown, the pole misses upright by {miss:.1e}",
        refined.iterations
    );
    Ok(())
}
