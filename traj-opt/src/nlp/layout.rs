//! Where each variable of the transcribed problem is stored.

use super::tableau::Tableau;
use crate::{Mesh, Transcription};
use std::ops::Range;

/// Which of a segment's states a collocation point uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// The knot at which the segment begins.
    Left,
    /// An inner state of the segment: the middle (Hermite-Simpson) or that of the collocation point with the same number as the
    /// control vector (Radau).
    Middle,
    /// The knot at which the segment ends.
    Right,
}

/// A point at which path constraints are imposed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    pub segment: usize,
    pub place: Place,
    /// Index of the control vector inside the segment.
    pub local: usize,
    /// Time of the point as a fraction of the flight.
    pub fraction: f64,
}

/// Offsets into the flat vector of variables: knot states, controls, middle states, final time, slacks of path constraints,
/// slacks of inequality boundary constraints.
#[derive(Clone, Debug, Default)]
pub(crate) struct Layout {
    pub n_segments: usize,
    pub nx: usize,
    /// Controls of a segment, `n_local * nu`.
    pub m: usize,
    pub nu: usize,
    pub n_path: usize,
    pub controls: usize,
    pub middles: usize,
    pub time: usize,
    pub path_slacks: usize,
    pub boundary_slacks: usize,
    pub n_variables: usize,
    /// True for Hermite-Simpson.
    pub has_middle: bool,
    /// Inner states of a segment.
    pub n_inner: usize,
    /// Coefficients of Radau collocation; empty for the others.
    pub tableau: Tableau,
    pub points: Vec<Point>,
}

impl Layout {
    /// Numbers the variables; `n_boundary_slacks` is the number of boundary inequalities.
    pub fn rebuild(
        &mut self,
        (nx, nu): (usize, usize),
        mesh: &Mesh,
        transcription: Transcription,
        n_path: usize,
        n_boundary_slacks: usize,
    ) {
        let n = mesh.n_segments();
        self.n_segments = n;
        (self.nx, self.nu, self.n_path) = (nx, nu, n_path);
        self.m = transcription.n_local() * nu;
        self.has_middle = transcription.is_hermite_simpson();
        self.tableau = match transcription {
            Transcription::LegendreGaussRadau { .. } => Tableau::new(transcription.control_points()),
            _ => Tableau::default(),
        };
        self.n_inner = transcription.n_inner();
        self.place_points(mesh, transcription);
        self.controls = (n + 1) * nx;
        self.middles = self.controls + n * self.m;
        self.time = self.middles + n * self.n_inner * nx;
        self.path_slacks = self.time + 1;
        self.boundary_slacks = self.path_slacks + self.points.len() * n_path;
        self.n_variables = self.boundary_slacks + n_boundary_slacks;
    }

    fn place_points(&mut self, mesh: &Mesh, transcription: Transcription) {
        self.points.clear();
        let f = mesh.fractions();
        let n = self.n_segments;
        for k in 0..n {
            let mut put = |place, local, s: f64| {
                let fraction = f[k] + s * (f[k + 1] - f[k]);
                self.points.push(Point { segment: k, place, local, fraction });
            };
            if let Transcription::LegendreGaussRadau { .. } = transcription {
                let points = transcription.control_points();
                for (i, &s) in points.iter().enumerate() {
                    put(if i + 1 < points.len() { Place::Middle } else { Place::Right }, i, s);
                }
                continue;
            }
            put(Place::Left, 0, 0.0);
            match transcription {
                Transcription::RungeKutta { .. } if k + 1 == n => put(Place::Right, 0, 1.0),
                Transcription::RungeKutta { .. } => {}
                Transcription::Trapezoidal => put(Place::Right, 1, 1.0),
                _ => {
                    put(Place::Middle, 1, 0.5);
                    put(Place::Right, 2, 1.0);
                }
            }
        }
    }

    pub fn state(&self, knot: usize) -> usize {
        knot * self.nx
    }

    pub fn control(&self, segment: usize, local: usize) -> usize {
        self.controls + segment * self.m + local * self.nu
    }

    pub fn middle(&self, segment: usize) -> usize {
        self.inner(segment, 0)
    }

    pub fn inner(&self, segment: usize, index: usize) -> usize {
        self.middles + (segment * self.n_inner + index) * self.nx
    }

    /// Which of its segment's inner states a point in the middle uses.
    pub fn inner_of(&self, point: &Point) -> usize {
        if self.has_middle { 0 } else { point.local }
    }

    /// Rows of the path constraints at an inner state of a Radau segment.
    pub fn inner_path_rows(&self, segment: usize, index: usize) -> Range<usize> {
        let point = segment * (self.n_inner + 1) + index;
        point * self.n_path..(point + 1) * self.n_path
    }

    /// Offset of the state that a point uses.
    pub fn point_state(&self, point: &Point) -> usize {
        match point.place {
            Place::Left => self.state(point.segment),
            Place::Middle => self.inner(point.segment, self.inner_of(point)),
            Place::Right => self.state(point.segment + 1),
        }
    }
}
