//! What a solve needs before its first iteration: memory of the right sizes, a starting point inside the bounds, scales.

use super::barrier::DEFAULT_PUSH;
use super::filter::MOST_RESERVED;
use super::interior_point::{LEAST_DAMPING, Memory, Start, StateScale};
use super::program::Program;
use super::setup;
use crate::{Guess, Options, Problem};
use nalgebra::SVector;

/// Relaxation of bounds.
const RELAX: f64 = 1e-8;

impl<const NX: usize, const NU: usize> Memory<NX, NU> {
    /// Sizes everything for a program and sets the starting point.
    pub fn start<P: Problem<NX, NU>>(
        &mut self,
        program: &Program<NX, NU, P>,
        guess: &Guess<NX, NU>,
        final_time: f64,
        options: &Options,
    ) {
        self.prepare(program, options);
        setup::fill_guess(program, &self.layout, guess, &mut self.w);
        if program.free_time {
            self.w[self.layout.time] = final_time;
        }
        self.bounds.push_inside(&mut self.w, DEFAULT_PUSH);
        self.mu = options.initial_mu;
        self.place_slacks(program);
        self.bounds.start_multipliers(&self.w, self.mu);
    }

    /// Sizes everything for a program; sets bounds and scales.
    pub fn prepare<P: Problem<NX, NU>>(&mut self, program: &Program<NX, NU, P>, options: &Options) {
        self.rows.rebuild(program.problem, &program.bounds);
        let n_path = program.problem.n_path();
        self.layout.rebuild((NX, NU), program.mesh, program.transcription, n_path, self.rows.n_slacks);
        let (n, m, nb) = (self.layout.n_segments, self.layout.m, self.rows.len());
        self.values.resize(&self.layout, nb);
        self.trial_values.resize(&self.layout, nb);
        self.corrected.resize(&self.layout, nb);
        self.duals.reset(&self.layout, nb);
        self.direction.duals.reset(&self.layout, nb);
        self.correction.duals.reset(&self.layout, nb);
        for v in [&mut self.trial, &mut self.direction.w, &mut self.correction.w] {
            v.clear();
            v.resize(self.layout.n_variables, 0.0);
        }
        let implicit = program.transcription.resolves_end();
        self.lin.resize(&self.layout, nb, implicit);
        self.lq.resize(n, m, nb);
        self.rhs.resize(n, m, nb);
        self.step.resize(n, m, nb);
        setup::free_start(&program.bounds, &mut self.free_start);
        self.riccati.resize(n, m, nb, &self.free_start, program.free_time);
        #[cfg(feature = "faer")]
        if options.linear_algebra == crate::LinearAlgebra::Sparse {
            self.riccati.sparse.get_or_insert_default();
        } else {
            self.riccati.sparse = None;
        }
        self.scratch.resize(n_path.max(self.rows.n_functions));
        self.log.clear();
        self.log.reserve(options.max_iterations.min(MOST_RESERVED) + 1);
        self.filter.reserve(options.max_iterations);
        self.set_scales(program);
        setup::fill_bounds(program, &self.layout, &self.rows, &mut self.bounds);
        self.bounds.relax(RELAX);
        self.delta = 0.0;
        self.initial_time = program.bounds.initial_time;
        self.damping = LEAST_DAMPING;
        self.starts_from = Start::Guess;
        self.least_mu = options.tolerance / 10.0;
    }

    fn set_scales<P: Problem<NX, NU>>(&mut self, program: &Program<NX, NU, P>) {
        setup::variable_scales(program, &self.layout, &mut self.variable_scale);
        let s = &program.scales;
        self.states = StateScale { scale: s.state, weight: s.state.map(|v| 1.0 / (v * v)) };
        self.time_weight = 1.0 / (s.time * s.time);
        self.control_weight.clear();
        self.control_weight.extend((0..self.layout.m).map(|j| 1.0 / s.control[j % NU.max(1)].powi(2)));
    }

    /// Slacks at the values of their constraints, inside the bounds; then all scales.
    fn place_slacks<P: Problem<NX, NU>>(&mut self, program: &Program<NX, NU, P>) {
        let layout = &self.layout;
        program.evaluate(layout, &self.rows, &mut self.w, &mut self.scratch, &mut self.values);
        for i in 0..self.values.path.len() {
            self.w[layout.path_slacks + i] = self.values.path[i];
        }
        for (row, slack) in self.rows.slack.iter().enumerate() {
            if let Some(slack) = slack {
                self.w[layout.boundary_slacks + slack] = self.values.boundary[row];
            }
        }
        self.bounds.push_inside(&mut self.w, DEFAULT_PUSH);
        program.evaluate(layout, &self.rows, &mut self.w, &mut self.scratch, &mut self.values);
        self.measure(program);
    }

    /// Scales of path and boundary rows and of the cost from their gradients.
    pub fn measure<P: Problem<NX, NU>>(&mut self, program: &Program<NX, NU, P>) {
        self.linearise_first_order(program);
        let layout = &self.layout;
        let n = layout.n_path;
        let scales = &program.scales;
        self.path_scale.clear();
        self.path_scale.resize(n, 1e-2);
        for (i, (gx, gu)) in self.lin.path_x.iter().zip(&self.lin.path_u).enumerate() {
            let size = gx.component_mul(&scales.state).amax().max(gu.component_mul(&scales.control).amax());
            self.path_scale[i % n] = self.path_scale[i % n].max(size);
        }
        for i in layout.path_slacks..layout.boundary_slacks {
            self.variable_scale[i] = self.path_scale[(i - layout.path_slacks) % n];
        }
        self.boundary_scale.clear();
        for row in 0..self.rows.len() {
            let size = |v: &SVector<f64, NX>| v.component_mul(&scales.state).amax();
            let ends = size(&self.lin.raw.e0[row]).max(size(&self.lin.raw.ef[row]));
            let scale = ends.max(self.lin.raw.et[row].abs() * scales.time).max(1e-2);
            self.boundary_scale.push(scale);
            if let Some(slack) = self.rows.slack.get(row).copied().flatten() {
                self.variable_scale[layout.boundary_slacks + slack] = scale;
            }
        }
        let gradient = self.lin.objective.iter().zip(&self.variable_scale).map(|(g, s)| (g * s).abs());
        self.objective_scale = gradient.fold(1.0, f64::max);
    }
}
