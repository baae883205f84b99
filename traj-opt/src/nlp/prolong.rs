//! Starting on a finer mesh from the primal and dual variables of a solution on a coarser one.
//!
//! The multiplier of a bound or path constraint at a collocation point grows with the share of the flight that the point stands for.
//! Divided by it the multipliers converge as the mesh is refined, and are interpolated; costates are interpolated as they are.

use super::interior_point::{Memory, Start};
use super::layout::Layout;
use super::program::Program;
use super::tableau::Tableau;
use super::warm::Point;
use crate::interpolate::bracket;
use crate::{Guess, Options, Problem, Solution, Transcription};

/// A mesh with its variables and the shares of its collocation points.
struct Grid<'a> {
    layout: &'a Layout,
    fractions: &'a [f64],
    points: &'static [f64],
    /// Quadrature weights of the points of a segment.
    weights: Vec<f64>,
}

impl<'a> Grid<'a> {
    fn new(layout: &'a Layout, fractions: &'a [f64], transcription: Transcription) -> Self {
        let points = transcription.control_points();
        let table = Tableau::new(points);
        let last = points.len() - 1;
        let weights = if last == 0 { vec![1.0] } else { (0..=last).map(|j| table.weight(last, j)).collect() };
        Self { layout, fractions, points, weights }
    }

    fn length(&self, segment: usize) -> f64 {
        self.fractions[segment + 1] - self.fractions[segment]
    }

    fn middle(&self, segment: usize) -> f64 {
        0.5 * (self.fractions[segment] + self.fractions[segment + 1])
    }

    fn share_of_point(&self, segment: usize, local: usize) -> f64 {
        self.weights[local] * self.length(segment)
    }

    /// Half of what lies on either side.
    fn share_of_knot(&self, knot: usize) -> f64 {
        let (left, right) = (knot.saturating_sub(1), (knot + 1).min(self.layout.n_segments));
        0.5 * (self.fractions[right] - self.fractions[left])
    }

    fn path_slack(&self, segment: usize, local: usize) -> usize {
        self.layout.path_slacks + (segment * self.points.len() + local) * self.layout.n_path
    }

    /// Multipliers `z` of bounds on a coarser grid, on this one.
    fn prolong(&self, coarse: &Self, z: &[f64]) -> Vec<f64> {
        let (fine, old) = (self.layout, coarse.layout);
        let mut out = vec![0.0; fine.n_variables];
        for knot in 0..=fine.n_segments {
            let (a, b, s) = bracket(coarse.fractions, self.fractions[knot]);
            for i in 0..fine.nx {
                let density = |knot: usize| z[old.state(knot) + i] / coarse.share_of_knot(knot);
                let mean = density(a) * (1.0 - s) + density(b) * s;
                out[fine.state(knot) + i] = mean * self.share_of_knot(knot);
            }
        }
        for k in 0..fine.n_segments {
            self.prolong_segment(coarse, k, z, &mut out);
        }
        out[fine.time] = z[old.time];
        out[fine.boundary_slacks..].copy_from_slice(&z[old.boundary_slacks..]);
        out
    }

    /// Those of controls, inner states and path constraints in segment `k`.
    fn prolong_segment(&self, coarse: &Self, k: usize, z: &[f64], out: &mut [f64]) {
        let (fine, old) = (self.layout, coarse.layout);
        let (parent, _, _) = bracket(coarse.fractions, self.middle(k));
        let start = coarse.fractions[parent];
        for local in 0..self.points.len() {
            let fraction = self.fractions[k] + self.points[local] * self.length(k);
            let (a, b, s) = bracket(coarse.points, (fraction - start) / coarse.length(parent));
            let share = self.share_of_point(k, local);
            let (first, second) = (coarse.share_of_point(parent, a), coarse.share_of_point(parent, b));
            let mut carry = |to: usize, from: usize, other: usize, n: usize| {
                for i in 0..n {
                    out[to + i] = share * (z[from + i] / first * (1.0 - s) + z[other + i] / second * s);
                }
            };
            carry(fine.control(k, local), old.control(parent, a), old.control(parent, b), fine.nu);
            let slack = |local| coarse.path_slack(parent, local);
            carry(self.path_slack(k, local), slack(a), slack(b), fine.n_path);
        }
        let shrinkage = self.length(k) / coarse.length(parent);
        for i in 0..fine.n_inner * fine.nx {
            out[fine.inner(k, 0) + i] = shrinkage * z[old.inner(parent, 0) + i];
        }
    }
}

impl<const NX: usize, const NU: usize> Memory<NX, NU> {
    /// Starts where a solution on a coarser mesh of the same problem ended, with the barrier parameter of a warm start; false, and
    /// started from the guess alone, if its multipliers are of another shape.
    pub fn start_on_finer<P: Problem<NX, NU>>(
        &mut self,
        program: &Program<NX, NU, P>,
        coarser: &Solution<NX, NU>,
        guess: &Guess<NX, NU>,
        options: &Options,
    ) -> bool {
        self.start(program, guess, guess.final_time(), options);
        let layout = std::mem::take(&mut self.layout);
        let mut old = Layout::default();
        let transcription = program.transcription;
        old.rebuild((NX, NU), coarser.mesh(), transcription, layout.n_path, self.rows.n_slacks);
        let coarse = Grid::new(&old, coarser.mesh().fractions(), transcription);
        let fine = Grid::new(&layout, program.mesh.fractions(), transcription);
        let Point { w, duals, z_lower, z_upper } = &coarser.point;
        let fits = w.len() == old.n_variables
            && duals.defect.len() == old.n_segments
            && duals.boundary.len() == self.duals.boundary.len();
        if !fits {
            self.layout = layout;
            return false;
        }
        let left = coarser.log.last().map_or(0.0, |last| last.mu);
        let thinned = left * old.n_segments as f64 / layout.n_segments as f64;
        self.mu = thinned.max(options.warm_mu * self.objective_scale);
        self.approach_centre(&fine.prolong(&coarse, z_lower), &fine.prolong(&coarse, z_upper));
        let middles: Vec<f64> = (0..old.n_segments).map(|k| coarse.middle(k)).collect();
        for k in 0..layout.n_segments {
            let (a, b, s) = bracket(&middles, fine.middle(k));
            self.duals.defect[k] = duals.defect[a] * (1.0 - s) + duals.defect[b] * s;
        }
        self.duals.boundary.copy_from_slice(&duals.boundary);
        for (y, slack) in self.duals.path.iter_mut().zip(layout.path_slacks..) {
            *y = self.bounds.z_upper[slack] - self.bounds.z_lower[slack];
        }
        self.layout = layout;
        program.evaluate(&self.layout, &self.rows, &mut self.w, &mut self.scratch, &mut self.values);
        self.linearise_first_order(program);
        self.spread_costates();
        self.starts_from = Start::CoarserMesh;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Mesh;

    const TRANSCRIPTIONS: [Transcription; 4] = [
        Transcription::RungeKutta { substeps: 1 },
        Transcription::Trapezoidal,
        Transcription::HermiteSimpson,
        Transcription::LegendreGaussRadau { degree: 3 },
    ];

    /// A multiplier of constant density has the same one, hence the same sum, on every mesh.
    #[test]
    fn constant_densities_stay_constant() {
        let meshes = [Mesh::graded(5, 0.6), Mesh::graded(13, 0.2)];
        for transcription in TRANSCRIPTIONS {
            let mut layouts = [Layout::default(), Layout::default()];
            for (layout, mesh) in layouts.iter_mut().zip(&meshes) {
                layout.rebuild((2, 1), mesh, transcription, 0, 0);
            }
            let [coarse, fine] = [0, 1].map(|i| Grid::new(&layouts[i], meshes[i].fractions(), transcription));
            let expected = |grid: &Grid| {
                let mut z = vec![0.0; grid.layout.n_variables];
                for knot in 0..=grid.layout.n_segments {
                    z[grid.layout.state(knot)] = 3.0 * grid.share_of_knot(knot);
                }
                for k in 0..grid.layout.n_segments {
                    for local in 0..grid.points.len() {
                        z[grid.layout.control(k, local)] = 7.0 * grid.share_of_point(k, local);
                    }
                }
                z
            };
            let controls: f64 = expected(&fine)[fine.layout.controls..fine.layout.middles].iter().sum();
            assert!((controls - 7.0).abs() < 1e-12, "{transcription:?}: shares sum up to {controls} / 7");
            let found = fine.prolong(&coarse, &expected(&coarse));
            for (found, expected) in found.iter().zip(expected(&fine)) {
                assert!((found - expected).abs() < 1e-12, "{transcription:?}: {found} for {expected}");
            }
        }
    }
}
