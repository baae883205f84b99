//! Problems with a free start time, and problems of several phases, as problems of one phase.

use crate::{Bounds, ConstraintKind, Dynamics, Guess, Location, Problem};
use nalgebra::{RealField, SVector, convert};

/// A problem whose start time is free: an additional, last component of the state holds the start time, its derivative is zero.
/// `NX1` must be `NX + 1` (checked at compile time).
///
/// The clock of the wrapped functions is `start time + time`; the solver's own time runs from 0 to the *duration*, whose bounds
/// are those of `duration`. [`Bounds::initial_time`] and the bounds on the final time of the wrapped problem are not used; bounds on
/// the final clock belong into its boundary constraints. A static parameter is modelled in the same way: as a component of the
/// state whose derivative is zero and whose start value is free.
#[derive(Clone, Copy, Debug)]
pub struct FreeInitialTime<P, const NX: usize> {
    /// The problem.
    pub problem: P,
    /// Least and greatest start time, s.
    pub initial_time: (f64, f64),
    /// Least and greatest duration, s.
    pub duration: (f64, f64),
}

impl<P, const NX: usize> FreeInitialTime<P, NX> {
    const fn check<const NX1: usize>() {
        assert!(
            NX1 == NX + 1,
            "the state of FreeInitialTime has one component more than that of its problem"
        );
    }
}

impl<P: Problem<NX, NU>, const NX: usize, const NX1: usize, const NU: usize> Dynamics<NX1, NU>
    for FreeInitialTime<P, NX>
{
    fn derivative<T: RealField + Copy>(
        &self,
        time: T,
        x: &SVector<T, NX1>,
        u: &SVector<T, NU>,
    ) -> SVector<T, NX1> {
        const { Self::check::<NX1>() };
        let slope = self.problem.dynamics().derivative(time + x[NX], &part(x, 0), u);
        SVector::from_fn(|i, _| if i < NX { slope[i] } else { T::zero() })
    }
}

impl<P: Problem<NX, NU>, const NX: usize, const NX1: usize, const NU: usize> Problem<NX1, NU>
    for FreeInitialTime<P, NX>
{
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<NX1, NU> {
        let inner = self.problem.bounds();
        let mut bounds = Bounds::free().with_control(inner.control_lower, inner.control_upper);
        copy_states(&inner, &mut bounds, 0);
        (bounds.initial_lower[NX], bounds.initial_upper[NX]) = self.initial_time;
        bounds.with_final_time(self.duration.0, self.duration.1)
    }

    fn mayer<T: RealField + Copy>(&self, start: &SVector<T, NX1>, end: &SVector<T, NX1>, duration: T) -> T {
        self.problem.mayer(&part(start, 0), &part(end, 0), duration + end[NX])
    }

    fn lagrange<T: RealField + Copy>(&self, time: T, x: &SVector<T, NX1>, u: &SVector<T, NU>) -> Option<T> {
        self.problem.lagrange(time + x[NX], &part(x, 0), u)
    }

    fn n_path(&self) -> usize {
        self.problem.n_path()
    }

    fn path<T: RealField + Copy>(&self, time: T, x: &SVector<T, NX1>, u: &SVector<T, NU>, values: &mut [T]) {
        self.problem.path(time + x[NX], &part(x, 0), u, values);
    }

    fn path_bounds(&self, index: usize) -> (f64, f64) {
        self.problem.path_bounds(index)
    }

    fn n_boundary(&self) -> usize {
        self.problem.n_boundary()
    }

    fn boundary<T: RealField + Copy>(
        &self,
        start: &SVector<T, NX1>,
        end: &SVector<T, NX1>,
        duration: T,
        values: &mut [T],
    ) {
        self.problem.boundary(&part(start, 0), &part(end, 0), duration + end[NX], values);
    }

    fn boundary_bounds(&self, index: usize) -> (f64, f64) {
        self.problem.boundary_bounds(index)
    }

    fn n_phases(&self) -> usize {
        self.problem.n_phases()
    }

    fn clock<T: RealField + Copy>(&self, time: T, x: &SVector<T, NX1>) -> T {
        self.problem.clock(time + x[NX], &part(x, 0))
    }

    fn locate(&self, kind: ConstraintKind, index: usize, time: f64, x: &SVector<f64, NX1>) -> Location {
        self.problem.locate(kind, index, time + x[NX], &part(x, 0))
    }
}

/// What links the end of one phase to the start of the next.
pub trait Linkage<const NA: usize, const NB: usize> {
    /// Number of constraints.
    fn len(&self) -> usize;

    /// True if nothing is linked.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Writes the `len` functions that must be zero, of the first phase's last state and the second phase's first. They should be
    /// linear in at least one of the two: the mixed second derivative is left out of the Newton step.
    fn residual<T: RealField + Copy>(&self, end: &SVector<T, NA>, start: &SVector<T, NB>, values: &mut [T]);
}

/// The state is continuous from phase to phase.
#[derive(Clone, Copy, Debug, Default)]
pub struct Continuous;

impl<const N: usize> Linkage<N, N> for Continuous {
    fn len(&self) -> usize {
        N
    }

    fn residual<T: RealField + Copy>(&self, end: &SVector<T, N>, start: &SVector<T, N>, values: &mut [T]) {
        for (value, i) in values.iter_mut().zip(0..N) {
            *value = start[i] - end[i];
        }
    }
}

/// Two phases, linked where the first ends and the second begins; a phase may itself be two linked phases.
///
/// Both are stacked on one normalised time from 0 to 1: the state is `(xa, xb, Ta, Tb)` with the durations as components whose
/// derivative is zero, the control `(ua, ub)`; `NX` must be `NA + NB + 2` and `NU` be `MA + MB` (checked at compile time). There is one
/// clock: it starts at the `initial_time` of the first phase and the second phase goes on where it stood. Only where the second is
/// itself linked does that one keep a clock of its own: nest to the left, `(a, b), c`. Bounds on final times are read as bounds on
/// durations from the phase's `initial_time`. Costs are added. The stage structure, and a cost linear in the segments, is kept.
#[derive(Clone, Copy, Debug)]
pub struct Linked<A, B, L, const NA: usize, const NB: usize, const MA: usize, const MB: usize> {
    /// The first phase.
    pub first: A,
    /// The second phase.
    pub second: B,
    /// What links them.
    pub linkage: L,
}

impl<A, B, L, const NA: usize, const NB: usize, const MA: usize, const MB: usize>
    Linked<A, B, L, NA, NB, MA, MB>
where
    A: Problem<NA, MA>,
    B: Problem<NB, MB>,
    L: Linkage<NA, NB>,
{
    const fn check<const NX: usize, const NU: usize>() {
        assert!(NX == NA + NB + 2, "the state of linked phases is both states and two durations");
        assert!(NU == MA + MB, "the control of linked phases is both controls");
    }

    /// Guesses of both phases as one.
    #[must_use]
    pub fn guess<const NX: usize, const NU: usize>(
        &self,
        first: &Guess<NA, MA>,
        second: &Guess<NB, MB>,
    ) -> Guess<NX, NU> {
        const { Self::check::<NX, NU>() };
        let durations = [
            first.final_time() - self.first.bounds().initial_time,
            second.final_time() - self.second.bounds().initial_time,
        ];
        Guess::from_fn(1.0, 64, |s| {
            let ((xa, ua), (xb, ub)) = (first.sample(s), second.sample(s));
            (stack(&xa, &xb, durations), SVector::from_fn(|i, _| if i < MA { ua[i] } else { ub[i - MA] }))
        })
    }

    /// Phase (0 or 1) and index within it of a component of the stacked state; `None` for the durations.
    #[must_use]
    pub fn phase_of_state(&self, component: usize) -> Option<(usize, usize)> {
        match component {
            i if i < NA => Some((0, i)),
            i if i < NA + NB => Some((1, i - NA)),
            _ => None,
        }
    }

    /// Phase (0 or 1) and index within it of a path constraint.
    #[must_use]
    pub fn phase_of_path(&self, index: usize) -> (usize, usize) {
        let n = self.first.n_path();
        if index < n { (0, index) } else { (1, index - n) }
    }

    /// Solver times of both phases at the normalised time `s`.
    fn times<T: RealField + Copy, const NX: usize>(&self, s: T, x: &SVector<T, NX>) -> [T; 2] {
        let durations = [x[NA + NB], x[NA + NB + 1]];
        let start = convert::<f64, T>(self.first.bounds().initial_time);
        let second = if self.second.n_phases() > 1 {
            convert::<f64, T>(self.second.bounds().initial_time)
        } else {
            self.first.clock(start + durations[0], &part(x, 0))
        };
        [start + durations[0] * s, second + durations[1] * s]
    }
}

impl<
    A,
    B,
    L,
    const NA: usize,
    const NB: usize,
    const MA: usize,
    const MB: usize,
    const NX: usize,
    const NU: usize,
> Dynamics<NX, NU> for Linked<A, B, L, NA, NB, MA, MB>
where
    A: Problem<NA, MA>,
    B: Problem<NB, MB>,
    L: Linkage<NA, NB>,
{
    fn derivative<T: RealField + Copy>(
        &self,
        s: T,
        x: &SVector<T, NX>,
        u: &SVector<T, NU>,
    ) -> SVector<T, NX> {
        const { Self::check::<NX, NU>() };
        let durations = [x[NA + NB], x[NA + NB + 1]];
        let times = self.times(s, x);
        let a = self.first.dynamics().derivative(times[0], &part(x, 0), &part(u, 0)) * durations[0];
        let b = self.second.dynamics().derivative(times[1], &part(x, NA), &part(u, MA)) * durations[1];
        stack(&a, &b, [T::zero(); 2])
    }
}

impl<
    A,
    B,
    L,
    const NA: usize,
    const NB: usize,
    const MA: usize,
    const MB: usize,
    const NX: usize,
    const NU: usize,
> Problem<NX, NU> for Linked<A, B, L, NA, NB, MA, MB>
where
    A: Problem<NA, MA>,
    B: Problem<NB, MB>,
    L: Linkage<NA, NB>,
{
    type Dynamics = Self;

    fn dynamics(&self) -> &Self {
        self
    }

    fn bounds(&self) -> Bounds<NX, NU> {
        let (a, b) = (self.first.bounds(), self.second.bounds());
        let mut bounds = Bounds::free().with_final_time(1.0, 1.0);
        copy_states(&a, &mut bounds, 0);
        copy_states(&b, &mut bounds, NA);
        for i in 0..MA {
            (bounds.control_lower[i], bounds.control_upper[i]) = (a.control_lower[i], a.control_upper[i]);
        }
        for i in 0..MB {
            (bounds.control_lower[MA + i], bounds.control_upper[MA + i]) =
                (b.control_lower[i], b.control_upper[i]);
        }
        let durations = [
            ((a.final_time_lower - a.initial_time).max(0.0), a.final_time_upper - a.initial_time),
            ((b.final_time_lower - b.initial_time).max(0.0), b.final_time_upper - b.initial_time),
        ];
        for (i, (lower, upper)) in durations.into_iter().enumerate() {
            (bounds.initial_lower[NA + NB + i], bounds.initial_upper[NA + NB + i]) = (lower, upper);
        }
        bounds
    }

    fn mayer<T: RealField + Copy>(&self, start: &SVector<T, NX>, end: &SVector<T, NX>, _: T) -> T {
        let times = self.times(T::one(), end);
        self.first.mayer(&part(start, 0), &part(end, 0), times[0])
            + self.second.mayer(&part(start, NA), &part(end, NA), times[1])
    }

    fn lagrange<T: RealField + Copy>(&self, s: T, x: &SVector<T, NX>, u: &SVector<T, NU>) -> Option<T> {
        let durations = [x[NA + NB], x[NA + NB + 1]];
        let times = self.times(s, x);
        let a = self.first.lagrange(times[0], &part(x, 0), &part(u, 0)).map(|cost| cost * durations[0]);
        let b = self.second.lagrange(times[1], &part(x, NA), &part(u, MA)).map(|cost| cost * durations[1]);
        match (a, b) {
            (Some(a), Some(b)) => Some(a + b),
            (one, other) => one.or(other),
        }
    }

    fn n_path(&self) -> usize {
        self.first.n_path() + self.second.n_path()
    }

    fn path<T: RealField + Copy>(&self, s: T, x: &SVector<T, NX>, u: &SVector<T, NU>, values: &mut [T]) {
        let times = self.times(s, x);
        let (a, b) = values.split_at_mut(self.first.n_path());
        self.first.path(times[0], &part(x, 0), &part(u, 0), a);
        self.second.path(times[1], &part(x, NA), &part(u, MA), b);
    }

    fn path_bounds(&self, index: usize) -> (f64, f64) {
        match self.phase_of_path(index) {
            (0, i) => self.first.path_bounds(i),
            (_, i) => self.second.path_bounds(i),
        }
    }

    fn n_boundary(&self) -> usize {
        self.first.n_boundary() + self.second.n_boundary() + self.linkage.len()
    }

    fn boundary<T: RealField + Copy>(
        &self,
        start: &SVector<T, NX>,
        end: &SVector<T, NX>,
        _: T,
        values: &mut [T],
    ) {
        let times = self.times(T::one(), end);
        let (a, rest) = values.split_at_mut(self.first.n_boundary());
        let (b, link) = rest.split_at_mut(self.second.n_boundary());
        self.first.boundary(&part(start, 0), &part(end, 0), times[0], a);
        self.second.boundary(&part(start, NA), &part(end, NA), times[1], b);
        self.linkage.residual(&part(end, 0), &part(start, NA), link);
    }

    fn boundary_bounds(&self, index: usize) -> (f64, f64) {
        let (a, b) = (self.first.n_boundary(), self.second.n_boundary());
        if index < a {
            self.first.boundary_bounds(index)
        } else if index < a + b {
            self.second.boundary_bounds(index - a)
        } else {
            (0.0, 0.0)
        }
    }

    fn n_phases(&self) -> usize {
        self.first.n_phases() + self.second.n_phases()
    }

    fn clock<T: RealField + Copy>(&self, s: T, x: &SVector<T, NX>) -> T {
        self.second.clock(self.times(s, x)[1], &part(x, NA))
    }

    fn locate(&self, kind: ConstraintKind, index: usize, s: f64, x: &SVector<f64, NX>) -> Location {
        let times = self.times(s, x);
        let (of_a, of_b) = match kind {
            ConstraintKind::Path => (self.first.n_path(), self.second.n_path()),
            ConstraintKind::Boundary => (self.first.n_boundary(), self.second.n_boundary()),
            ConstraintKind::Control => (MA, MB),
            _ => (NA, NB),
        };
        let phase = self.first.n_phases();
        if index < of_a {
            self.first.locate(kind, index, times[0], &part(x, 0))
        } else if index < of_a + of_b {
            let found = self.second.locate(kind, index - of_a, times[1], &part(x, NA));
            Location { phase: found.phase + phase, ..found }
        } else if kind == ConstraintKind::Boundary {
            let time = self.second.clock(self.times(0.0, x)[1], &part(x, NA));
            Location { kind: ConstraintKind::Linkage, index: index - of_a - of_b, phase, time }
        } else {
            let later = index - of_a - of_b;
            let duration = x[NA + NB + later.min(1)];
            let phase = later.min(1) * phase;
            Location { kind: ConstraintKind::Duration, index: 0, phase, time: duration }
        }
    }
}

/// The components from `offset` on.
fn part<T: RealField + Copy, const N: usize, const M: usize>(
    x: &SVector<T, N>,
    offset: usize,
) -> SVector<T, M> {
    SVector::from_fn(|i, _| x[offset + i])
}

/// `(a, b, durations)`.
fn stack<T: RealField + Copy, const NA: usize, const NB: usize, const NX: usize>(
    a: &SVector<T, NA>,
    b: &SVector<T, NB>,
    durations: [T; 2],
) -> SVector<T, NX> {
    SVector::from_fn(|i, _| match i {
        i if i < NA => a[i],
        i if i < NA + NB => b[i - NA],
        i => durations[(i - NA - NB).min(1)],
    })
}

/// Copies all bounds on states to the components from `offset` on.
fn copy_states<const N: usize, const MU: usize, const NX: usize, const NU: usize>(
    from: &Bounds<N, MU>,
    to: &mut Bounds<NX, NU>,
    offset: usize,
) {
    for i in 0..N {
        to.state_lower[offset + i] = from.state_lower[i];
        to.state_upper[offset + i] = from.state_upper[i];
        to.initial_lower[offset + i] = from.initial_lower[i];
        to.initial_upper[offset + i] = from.initial_upper[i];
        to.terminal_lower[offset + i] = from.terminal_lower[i];
        to.terminal_upper[offset + i] = from.terminal_upper[i];
    }
}
