//! What a known problem is, and how it is run: with any transcription, on a fixed mesh or refined.

use nalgebra::{RealField, SVector};
use traj_opt::{
    Guess, LinearAlgebra, Mesh, Options, Problem, RefineOptions, Status, Transcription, solve, solve_refined,
};

#[allow(dead_code)]
pub const INF: f64 = f64::INFINITY;

pub fn c<T: RealField + Copy>(v: f64) -> T {
    nalgebra::convert(v)
}

pub fn v<const N: usize>(values: [f64; N]) -> SVector<f64, N> {
    SVector::from(values)
}

/// Tolerance of the solver where the value is exact: the gap of the barrier is mu times the number of bounds, which are many.
const FINE: f64 = 1e-10;

/// What a run gave.
#[allow(dead_code)]
pub struct Row {
    pub value: f64,
    pub status: Status,
    pub segments: usize,
    pub iterations: usize,
    /// Greatest error of a segment by integration; not a number without refinement.
    pub error: f64,
}

/// Mesh of a run: so many uniform segments, or refined from so many.
#[derive(Clone, Debug)]
pub enum Mode {
    #[allow(dead_code)]
    Fixed(usize),
    Refined(usize, RefineOptions),
}

/// True if the controls are of order 2: constant or linear over a segment.
fn is_low_order(transcription: Transcription) -> bool {
    matches!(transcription, Transcription::RungeKutta { .. } | Transcription::Trapezoidal)
}

type Run = Box<dyn Fn(Transcription, &Mode, &Options) -> Row>;

/// A problem with its reference value.
pub struct Known {
    pub name: &'static str,
    pub reference: f64,
    /// Relative tolerance to which the reference is trusted and reproduced.
    pub tolerance: f64,
    /// What other transcriptions reach, where that is less.
    others: Vec<(Transcription, f64)>,
    exact: bool,
    pub segments: usize,
    pub refine: RefineOptions,
    sign: f64,
    run: Run,
}

impl Known {
    pub fn new<const NX: usize, const NU: usize, P: Problem<NX, NU> + 'static>(
        name: &'static str,
        problem: P,
        guess: Guess<NX, NU>,
        reference: f64,
        tolerance: f64,
        segments: usize,
    ) -> Self {
        let run = move |transcription, mode: &Mode, options: &Options| {
            let (s, iterations, error) = match mode {
                Mode::Fixed(n) => {
                    let s = solve(&problem, &Mesh::uniform(*n), transcription, &guess, options)
                        .expect("valid input");
                    let iterations = s.iterations;
                    (s, iterations, f64::NAN)
                }
                Mode::Refined(n, refine) => {
                    let mesh = Mesh::uniform(*n);
                    let r = solve_refined(&problem, &mesh, transcription, &guess, options, refine)
                        .expect("valid input");
                    (r.solution, r.iterations, r.error)
                }
            };
            let segments = s.mesh().n_segments();
            Row { value: s.objective, status: s.status, segments, iterations, error }
        };
        let refine =
            RefineOptions::default().with_tolerance(1e-7).with_max_rounds(14).with_max_segments(3000);
        Self {
            name,
            reference,
            tolerance,
            others: vec![],
            exact: false,
            segments,
            refine,
            sign: 1.0,
            run: Box::new(run),
        }
    }

    /// The value is maximised: the cost is its negative.
    pub fn maximised(mut self) -> Self {
        self.sign = -1.0;
        self
    }

    /// The value is known exactly: every transcription is refined until its cost settles.
    pub fn exact(mut self) -> Self {
        self.exact = true;
        self
    }

    /// What a transcription reaches where it is less; infinite if it cannot represent the problem.
    pub fn except(mut self, transcription: Transcription, tolerance: f64) -> Self {
        self.others.push((transcription, tolerance));
        self
    }

    /// Relative tolerance of a transcription; those whose controls are of order 2 are asked for 2e-5 where nothing is exact.
    pub fn tolerance_of(&self, transcription: Transcription) -> f64 {
        match self.others.iter().find(|(other, _)| *other == transcription) {
            Some((_, tolerance)) => *tolerance,
            None if is_low_order(transcription) && !self.exact => self.tolerance.max(2e-5),
            None => self.tolerance,
        }
    }

    /// Sets the refinement.
    #[allow(dead_code)]
    pub fn refined_by(mut self, refine: RefineOptions) -> Self {
        self.refine = refine;
        self
    }

    /// How a transcription is refined: where its controls are of order 2 or the value is exact until the cost settles.
    pub fn mode(&self, transcription: Transcription) -> Mode {
        let (refine, tolerance) = (self.refine.clone(), self.tolerance_of(transcription));
        let refine = if is_low_order(transcription) {
            refine.with_tolerance(tolerance.clamp(1e-7, 1e-6)).with_cost_tolerance(0.5 * tolerance)
        } else if self.exact {
            refine.with_cost_tolerance(0.5 * tolerance)
        } else {
            refine
        };
        Mode::Refined(self.segments, refine)
    }

    pub fn run(&self, transcription: Transcription, mode: &Mode) -> Row {
        self.run_with(transcription, mode, LinearAlgebra::default())
    }

    pub fn run_with(&self, transcription: Transcription, mode: &Mode, algebra: LinearAlgebra) -> Row {
        let tolerance = if self.exact { FINE } else { Options::default().tolerance };
        let options = Options::default().with_max_iterations(1000).with_tolerance(tolerance);
        let row = (self.run)(transcription, mode, &options.with_linear_algebra(algebra));
        Row { value: self.sign * row.value, ..row }
    }

    pub fn relative_error(&self, row: &Row) -> f64 {
        (row.value - self.reference).abs() / self.reference.abs()
    }
}

/// Declares a problem: state and control sizes, right-hand side, cost, bounds, guess.
macro_rules! problem {
    ($name:ident<$nx:literal, $nu:literal>, |$t:ident, $x:ident, $u:ident| $f:expr,
     $(lagrange: $lagrange:expr,)? $(mayer: |$xf:ident, $tf:ident| $mayer:expr,)?
     $(path: [$($path:expr),*] in [$($range:expr),*],)?
     bounds: $bounds:expr, guess: $guess:expr) => {
        #[derive(Clone, Copy)]
        pub struct $name;

        impl traj_opt::Dynamics<$nx, $nu> for $name {
            #[allow(unused_variables)]
            fn derivative<T: nalgebra::RealField + Copy>(&self, $t: T, $x: &nalgebra::SVector<T, $nx>, $u: &nalgebra::SVector<T, $nu>) -> nalgebra::SVector<T, $nx> {
                nalgebra::SVector::from($f)
            }
        }

        impl traj_opt::Problem<$nx, $nu> for $name {
            type Dynamics = Self;

            fn dynamics(&self) -> &Self {
                self
            }

            fn bounds(&self) -> traj_opt::Bounds<$nx, $nu> {
                $bounds
            }

            $(fn lagrange<T: nalgebra::RealField + Copy>(&self, $t: T, $x: &nalgebra::SVector<T, $nx>, $u: &nalgebra::SVector<T, $nu>) -> Option<T> {
                let _ = ($t, $x, $u);
                Some($lagrange)
            })?

            $(fn mayer<T: nalgebra::RealField + Copy>(&self, _: &nalgebra::SVector<T, $nx>, $xf: &nalgebra::SVector<T, $nx>, $tf: T) -> T {
                let _ = ($xf, $tf);
                $mayer
            })?

            $(fn n_path(&self) -> usize {
                [$(stringify!($path)),*].len()
            }

            fn path<T: nalgebra::RealField + Copy>(&self, $t: T, $x: &nalgebra::SVector<T, $nx>, $u: &nalgebra::SVector<T, $nu>, out: &mut [T]) {
                let _ = ($t, $x, $u);
                let values = [$($path),*];
                out.copy_from_slice(&values);
            }

            fn path_bounds(&self, index: usize) -> (f64, f64) {
                [$($range),*][index]
            })?
        }

        impl $name {
            fn guess() -> traj_opt::Guess<$nx, $nu> {
                $guess
            }
        }
    };
}

pub(crate) use problem;
