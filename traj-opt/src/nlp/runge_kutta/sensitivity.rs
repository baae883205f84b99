//! Derivatives of a segment's end state and of its part of the Lagrangian.
//!
//! Directions are the controls, the final time and those states that the model reads, in this order. Columns are derivatives of
//! the state by one direction; for products with transposes they are also laid out in panels of [`LANES`] directions. Of the
//! symmetric sum of second derivatives only the pieces on and above the diagonal are formed. States that no stage reads (a
//! position, where nothing depends on it) are no directions: their columns are those of the identity.

use super::sweep::Stage;
use super::{NODE, WEIGHT};
use crate::dense::{Arithmetic, LANES, Lanes, Panel, array, array_mut, fill_panels, pieces};
use crate::nlp::layout::Layout;
use crate::nlp::program::Linearisation;
use nalgebra::{SMatrix, SVector};

/// The stages of a segment, and what else the derivatives depend on.
pub(super) struct Segment<'a, const NX: usize, const NU: usize> {
    pub stages: &'a [Stage<NX, NU>],
    /// Length of a step and its rate with the final time.
    pub h: f64,
    pub h_rate: f64,
    /// Whether second derivatives are wanted.
    pub second: bool,
    /// Leading states that no stage reads.
    pub idle: usize,
}

/// Derivatives by all directions.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sensitivity<const NX: usize, const NU: usize> {
    /// Columns of the state at the start and at the end of a step, at a stage, and of the stage's slope.
    start: Vec<SVector<f64, NX>>,
    end: Vec<SVector<f64, NX>>,
    stage: Vec<SVector<f64, NX>>,
    slope: Vec<SVector<f64, NX>>,
    /// The stage's columns in panels.
    panels: Vec<Panel<NX>>,
    /// Columns of the model's Hessian times the stage's.
    product: Vec<SVector<f64, NX>>,
    /// Second derivatives: a row in pieces for every direction.
    hessian: Vec<Lanes>,
    /// What the rows of the controls have in the model's Hessian by itself, on and below the diagonal.
    mixed: Vec<Lanes>,
    /// Second derivatives by the step length and a direction, and the gradient of the running cost, in pieces.
    by_length: Vec<Lanes>,
    running: Vec<Lanes>,
}

/// Number of leading states that the model reads at no stage.
#[inline(always)]
pub(super) fn idle_states<const NX: usize, const NU: usize>(stages: &[Stage<NX, NU>], second: bool) -> usize {
    let unread = |stage: &Stage<NX, NU>, j: usize| {
        let zero = |column: &[f64; NX]| column.iter().fold(0, |bits, v| bits | (v.to_bits() << 1)) == 0;
        let first = zero(&stage.model.f.state.data.0[j]) && stage.model.running.is_none();
        let h = &stage.hessian;
        let own = || (0..NU).all(|i| h.state_control[(j, i)] == 0.0) && h.state_time[j] == 0.0;
        first && (!second || (zero(&h.state_state.data.0[j]) && own()))
    };
    (0..NX).take_while(|j| stages.iter().all(|stage| unread(stage, *j))).count()
}

impl<const NX: usize, const NU: usize> Sensitivity<NX, NU> {
    /// Number of the final time among the directions; states follow.
    const TIME: usize = NU;

    /// Carries the derivatives through all stages.
    #[inline(always)]
    pub(super) fn propagate<A: Arithmetic>(&mut self, segment: &Segment<NX, NU>) {
        self.reset(segment.idle);
        for (step, stages) in segment.stages.chunks_exact(4).enumerate() {
            self.end.copy_from_slice(&self.start);
            for i in 0..4 {
                self.stage_columns::<A>(segment, stages, i);
                if step == 0 && i == 0 {
                    self.first_stage(segment, &stages[0]);
                } else {
                    self.multiply::<A>(segment, &stages[i]);
                }
                self.advance_end::<A>(segment, &stages[i], i);
                if segment.second {
                    fill_panels(&self.stage, &mut self.panels);
                    self.add_hessian::<A>(&stages[i]);
                    self.add_length::<A>(segment, &stages[i], i);
                } else if stages[i].model.running.is_some() {
                    fill_panels(&self.stage, &mut self.panels);
                    self.add_length::<A>(segment, &stages[i], i);
                }
            }
            std::mem::swap(&mut self.start, &mut self.end);
        }
    }

    /// Unit derivatives at the start of the segment, and sums of zero.
    fn reset(&mut self, idle: usize) {
        let n = Self::TIME + 1 + NX - idle;
        for columns in [&mut self.start, &mut self.end, &mut self.stage, &mut self.slope, &mut self.product] {
            columns.clear();
            columns.resize(n, SVector::zeros());
        }
        for j in idle..NX {
            self.start[Self::TIME + 1 + j - idle][j] = 1.0;
        }
        self.panels.clear();
        self.panels.resize(pieces(n), [[0.0; LANES]; NX]);
        let rows =
            [(&mut self.hessian, n), (&mut self.mixed, NU), (&mut self.by_length, 1), (&mut self.running, 1)];
        for (rows, count) in rows {
            rows.clear();
            rows.resize(count * pieces(n), [0.0; LANES]);
        }
    }

    /// Columns of the state at stage `i`.
    #[inline(always)]
    fn stage_columns<A: Arithmetic>(
        &mut self,
        segment: &Segment<NX, NU>,
        stages: &[Stage<NX, NU>],
        i: usize,
    ) {
        if i == 0 {
            self.stage.copy_from_slice(&self.start);
            return;
        }
        for ((stage, start), slope) in self.stage.iter_mut().zip(&self.start).zip(&self.slope) {
            *stage = *start;
            A::axpy(array_mut(stage), segment.h * NODE[i], array(slope));
        }
        let rate = segment.h_rate * NODE[i];
        A::axpy(array_mut(&mut self.stage[Self::TIME]), rate, array(&stages[i - 1].model.f.value));
    }

    /// What a stage's slope and the gradient of its Hamiltonian have in direction `e` when its state stands still.
    #[inline(always)]
    fn direct(stage: &Stage<NX, NU>, e: usize) -> ([f64; NX], [f64; NX]) {
        let (f, h) = (&stage.model.f, &stage.hessian);
        if e < NU {
            (f.control.data.0[e], h.state_control.data.0[e])
        } else if e == Self::TIME {
            (*array(&(f.time * stage.t_rate)), *array(&(h.state_time * stage.t_rate)))
        } else {
            ([0.0; NX], [0.0; NX])
        }
    }

    /// Slope and product at the first stage of a segment, whose state is the segment's own.
    #[inline(always)]
    fn first_stage(&mut self, segment: &Segment<NX, NU>, stage: &Stage<NX, NU>) {
        for e in 0..self.stage.len() {
            let (slope, product) = if e > Self::TIME {
                let c = e - Self::TIME - 1 + segment.idle;
                (stage.model.f.state.data.0[c], stage.hessian.state_state.data.0[c])
            } else {
                Self::direct(stage, e)
            };
            *array_mut(&mut self.slope[e]) = slope;
            *array_mut(&mut self.product[e]) = product;
        }
    }

    /// Slope and product at a stage.
    #[inline(always)]
    fn multiply<A: Arithmetic>(&mut self, segment: &Segment<NX, NU>, stage: &Stage<NX, NU>) {
        // the number of a position's coordinates is compiled for
        match (segment.idle, segment.second) {
            (3, true) => self.multiply_from::<A, 3, true>(stage),
            (3, false) => self.multiply_from::<A, 3, false>(stage),
            (_, true) => self.multiply_from::<A, 0, true>(stage),
            (_, false) => self.multiply_from::<A, 0, false>(stage),
        }
    }

    #[inline(always)]
    fn multiply_from<A: Arithmetic, const FIRST: usize, const SECOND: bool>(
        &mut self,
        stage: &Stage<NX, NU>,
    ) {
        let (f, h) = (&stage.model.f.state, &stage.hessian.state_state);
        for e in 0..self.stage.len() {
            let (mut slope, mut product) = Self::direct(stage, e);
            let by = array(&self.stage[e]);
            for c in FIRST..NX {
                A::axpy(&mut slope, by[c], &f.data.0[c]);
                if SECOND {
                    A::axpy(&mut product, by[c], &h.data.0[c]);
                }
            }
            *array_mut(&mut self.slope[e]) = slope;
            *array_mut(&mut self.product[e]) = product;
        }
    }

    /// Adds a stage's slope to the end of the step.
    #[inline(always)]
    fn advance_end<A: Arithmetic>(&mut self, segment: &Segment<NX, NU>, stage: &Stage<NX, NU>, i: usize) {
        for (end, slope) in self.end.iter_mut().zip(&self.slope) {
            A::axpy(array_mut(end), segment.h * WEIGHT[i], array(slope));
        }
        let rate = segment.h_rate * WEIGHT[i];
        A::axpy(array_mut(&mut self.end[Self::TIME]), rate, array(&stage.model.f.value));
    }

    /// Adds a stage's second derivatives.
    #[inline(always)]
    fn add_hessian<A: Arithmetic>(&mut self, stage: &Stage<NX, NU>) {
        let n = self.panels.len();
        for (e, row) in self.hessian.chunks_exact_mut(n).enumerate() {
            let product = array(&self.product[e]);
            for piece in e / LANES..n {
                row[piece] = A::combine(row[piece], product, &self.panels[piece]);
            }
        }
        let h = &stage.hessian;
        for (i, row) in self.mixed.chunks_exact_mut(n).enumerate() {
            for piece in 0..=i / LANES {
                row[piece] = A::combine(row[piece], &h.state_control.data.0[i], &self.panels[piece]);
            }
            for j in 0..=i {
                row[j / LANES][j % LANES] += h.control_control[(i, j)];
            }
        }
        if stage.t_rate != 0.0 {
            for e in 0..=Self::TIME {
                let own = if e < NU { h.control_time[e] } else { h.time_time * stage.t_rate };
                let value = h.state_time.dot(&self.stage[e]) + own;
                self.hessian[e * n + Self::TIME / LANES][Self::TIME % LANES] += value * stage.t_rate;
            }
        }
    }

    /// Adds second derivatives by the step length, and the gradient of the running cost.
    #[inline(always)]
    fn add_length<A: Arithmetic>(&mut self, segment: &Segment<NX, NU>, stage: &Stage<NX, NU>, i: usize) {
        let f = &stage.model.f;
        let (b, h) = (WEIGHT[i], segment.h);
        let weight = if segment.second { stage.weight } else { SVector::zeros() };
        let mut by_state = A::tr_mul_vec(&f.state, &weight);
        let mut by_control = A::tr_mul_vec(&f.control, &weight);
        let mut by_time = f.time.dot(&weight) * stage.t_rate;
        if let Some(r) = &stage.model.running {
            by_state += r.x * b;
            by_control += r.u * b;
            by_time += r.t * stage.t_rate * b;
            for (sum, panel) in self.running.iter_mut().zip(&self.panels) {
                *sum = A::combine(*sum, array(&(r.x * (b * h))), panel);
            }
            let mut add = |e: usize, value: f64| self.running[e / LANES][e % LANES] += value;
            (0..NU).for_each(|j| add(j, r.u[j] * b * h));
            add(Self::TIME, b * (h * r.t * stage.t_rate + segment.h_rate * r.value));
        }
        for (sum, panel) in self.by_length.iter_mut().zip(&self.panels) {
            *sum = A::combine(*sum, array(&by_state), panel);
        }
        let mut add = |e: usize, value: f64| self.by_length[e / LANES][e % LANES] += value;
        (0..NU).for_each(|j| add(j, by_control[j]));
        add(Self::TIME, by_time);
    }
}

/// Hands the sums over.
impl<const NX: usize, const NU: usize> Sensitivity<NX, NU> {
    #[inline(always)]
    pub(super) fn write<A: Arithmetic>(
        &self,
        segment: &Segment<NX, NU>,
        layout: &Layout,
        k: usize,
        lambda: &SVector<f64, NX>,
        out: &mut Linearisation<NX, NU>,
    ) {
        let idle = segment.idle;
        let mut a = SMatrix::<f64, NX, NX>::identity();
        for j in idle..NX {
            a.data.0[j] = *array(&self.start[Self::TIME + 1 + j - idle]);
        }
        out.add_gradient(layout.state(k), A::tr_mul_vec(&a, lambda).as_slice());
        out.raw.a[k] = a;
        out.raw.ap[k] = self.start[Self::TIME];
        out.raw.b[k * layout.m..(k + 1) * layout.m].copy_from_slice(&self.start[..NU]);
        for (j, b) in self.start[..NU].iter().enumerate() {
            out.lagrangian[layout.control(k, 0) + j] += b.dot(lambda);
        }
        out.lagrangian[layout.time] += self.start[Self::TIME].dot(lambda);
        if segment.stages.iter().any(|stage| stage.model.running.is_some()) {
            self.write_running(layout, k, out);
        }
        if segment.second {
            self.write_hessian(segment, layout.m, k, out);
        }
    }

    /// Gradient of the running cost; there are no idle states.
    fn write_running(&self, layout: &Layout, k: usize, out: &mut Linearisation<NX, NU>) {
        let running = self.running.as_flattened();
        let (u, x) = (&running[..NU], &running[Self::TIME + 1..Self::TIME + 1 + NX]);
        for (offset, values) in [(layout.control(k, 0), u), (layout.state(k), x)] {
            out.add_objective(offset, values);
            out.add_gradient(offset, values);
        }
        out.objective[layout.time] += running[Self::TIME];
        out.lagrangian[layout.time] += running[Self::TIME];
    }

    #[inline(always)]
    fn write_hessian(&self, segment: &Segment<NX, NU>, m: usize, k: usize, out: &mut Linearisation<NX, NU>) {
        let (idle, first, width) = (segment.idle, Self::TIME + 1, self.panels.len() * LANES);
        let (hessian, mixed) = (self.hessian.as_flattened(), self.mixed.as_flattened());
        let by_length = self.by_length.as_flattened();
        let raw = &mut out.raw;
        for j in 0..NU {
            let row = &hessian[j * width..(j + 1) * width];
            for i in j..NU {
                let value = row[i] + mixed[i * width + j];
                raw.r[(k * m + j) * m + i] += value;
                if i > j {
                    raw.r[(k * m + i) * m + j] += value;
                }
            }
            raw.rp[k * m + j] += row[Self::TIME] + segment.h_rate * by_length[j];
            for (s, value) in raw.s[k * m + j].iter_mut().skip(idle).zip(&row[first..]) {
                *s += value;
            }
        }
        let row = &hessian[Self::TIME * width..(Self::TIME + 1) * width];
        raw.hpp += row[Self::TIME] + 2.0 * segment.h_rate * by_length[Self::TIME];
        for i in idle..NX {
            let e = first + i - idle;
            raw.qp[k][i] += row[e] + segment.h_rate * by_length[e];
            for j in i..NX {
                let value = hessian[e * width + first + j - idle];
                raw.q[k][(j, i)] += value;
                if j > i {
                    raw.q[k][(i, j)] += value;
                }
            }
        }
    }
}
