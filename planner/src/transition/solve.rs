//! The paper's minimum-time transition: solved, looked at between the knots, and solved again where that is not enough.

use super::early_end::{self, EarlyEnd};
use super::examine::{Examination, examine, miss};
use super::flight::Flight;
use super::guess::{bent, guess};
use super::problem::{Goal, KeepOut, MinimumTime};
use super::setting::Setting;
use crate::mission::{Transcription, TransitionSettings};
use crate::plan::{Entry, Miss, Outcome, SolverStatus, Transition};
use quad_dynamics::Motion;
use std::any::Any;
use traj_opt::{Guess, Iteration, Mesh, Options, Solution, Status, Workspace};

/// Solves of one transition with enlarged keep-outs, narrowed heights or finer steps.
const ROUNDS: usize = 6;
/// The same while a keep-out is still entered: they are considered one by one as they are entered.
const MOST_ROUNDS: usize = 16;
/// Scaled residual at which a transition counts as solved: far below what any vehicle can follow.
const TOLERANCE: f64 = 3e-6;
/// First barrier parameter: the guesses meet both ends, and this takes half as many iterations as the solver's own 0.1.
const FIRST_MU: f64 = 0.01;
/// Barrier parameter of a solve from a solution with little changed: the last one, too.
const WARM_MU: f64 = TOLERANCE / 3.0;
/// Longest Runge-Kutta step of a first solve (s). Segments are short where the attitude turns, so that even the longest flights
/// take as long as with fine steps to 2e-4 of their time: enough to see that a candidate loses.
const LONGEST_FIRST_STEP: f64 = 1.0;
/// Segments of a sketch as a share of the mission's, and its longest Runge-Kutta step (s). The times of 200 legs' candidates are up
/// to 5 % long, but alike along a leg: the fastest sketch is at most 0.15 % slower than the fastest transition of the same leg.
const SKETCH_SHARE: f64 = 0.35;
const LONGEST_SKETCH_STEP: f64 = 2.0;
/// The least segments of a sketch.
const LEAST_SEGMENTS: usize = 10;
/// Length (s) that the outermost segments of a mesh should not exceed: a bang-bang flip of the attitude takes 0.2 s.
const OUTER_SEGMENT: f64 = 0.06;

/// Keep-outs at least so far (m) from the straight line are only considered once they have been entered: most never are, and
/// each makes every solve slower.
const NEAR: f64 = 2.0;

/// Everything around a transition that does not change from one candidate to the next.
#[derive(Clone, Copy)]
pub(crate) struct Surroundings<'a> {
    /// Every target's safe distance.
    pub keep_outs: &'a [KeepOut],
    /// Least and greatest height (m).
    pub heights: [f64; 2],
    /// The mission's settings.
    pub settings: &'a TransitionSettings,
    /// Iterations after which a solve has failed; `None` for the solver's own limit.
    pub most_iterations: Option<usize>,
}

/// Residuals of the best failed attempt.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Unsolved {
    pub primal_residual: f64,
    pub dual_residual: f64,
}

impl From<&Unsolved> for Outcome {
    fn from(&Unsolved { primal_residual, dual_residual }: &Unsolved) -> Self {
        Self::Failed { primal_residual, dual_residual }
    }
}

impl Unsolved {
    /// Not even begun.
    const NOTHING: Self = Self { primal_residual: f64::INFINITY, dual_residual: f64::INFINITY };
}

/// How finely a transition is solved that is only to be compared with others.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Detail {
    /// On a third of the segments: tells which candidates of a leg are fast, at a third of the time.
    Sketch,
    /// On all segments with few Runge-Kutta steps: tells how fast the flight is, to 2e-4.
    Full,
}

/// A transition solved well enough to be compared with others, clear of every keep-out.
pub(crate) struct Draft {
    pub transition: Transition,
    /// About how long it takes when solved to the end at this detail (s).
    pub time: f64,
    /// False if it was given up because it takes longer than what it had to beat.
    pub is_complete: bool,
    /// The [`Solved`] of the model at hand.
    solved: Box<dyn Any + Send + Sync>,
}

/// A solution with all that led to it.
struct Solved<const NX: usize, const NU: usize> {
    solution: Solution<NX, NU>,
    setting: Setting,
    transition: Transition,
    /// That of [`Draft`].
    time: f64,
    /// Between the knots; `None` if it loses and was not looked at.
    seen: Option<Examination>,
}

impl<const NX: usize, const NU: usize> From<Solved<NX, NU>> for Draft {
    fn from(solved: Solved<NX, NU>) -> Self {
        Self {
            transition: solved.transition.clone(),
            time: solved.time,
            is_complete: solved.seen.is_some(),
            solved: Box::new(solved),
        }
    }
}

/// The fastest transition from `start` to `goal` found from several guesses; `towards` is where guesses lead (for a
/// circle a promising entry). One that takes longer than `to_beat` (s) is returned as soon as that is clear, as the solver left
/// it: neither solved to the end, nor looked at between the knots.
pub(crate) fn draft<const NX: usize, const NU: usize, F: Flight<NX, NU>>(
    flight: &F,
    start: &Motion,
    goal: Goal,
    towards: &Motion,
    hint: Hint,
    surroundings: &Surroundings,
    (detail, to_beat): (Detail, f64),
) -> Result<Draft, Unsolved> {
    let mut unsolved = Unsolved::NOTHING;
    let attempt = Attempt::new(flight, start, goal, surroundings, detail, to_beat);
    let about = match hint {
        Hint::Time(about) => about,
        Hint::Neighbour(neighbour) => {
            if let Some(first) = bent(flight, neighbour, towards)
                && let Ok(solved) = attempt.keep_clear(First::Guess(first), attempt.near(towards))
            {
                return Ok(solved.into());
            }
            neighbour.duration
        }
        Hint::Sketch(sketch) => {
            if let Some(Solved { solution, setting, .. }) = sketch.solved.downcast_ref()
                && let Ok(solved) =
                    attempt.keep_clear(First::Coarser(solution), setting.as_asked(surroundings))
            {
                return Ok(solved.into());
            }
            sketch.transition.duration
        }
    };
    for (straight, stretch, finer) in [(false, 1.2, 1), (true, 1.5, 1), (false, 2.5, 2)] {
        let attempt = Attempt { segments: attempt.segments * finer, ..attempt };
        let keep_outs = attempt.near(towards);
        let free_yaw = matches!(goal, Goal::Hover(_));
        let first = guess(flight, start, towards, &keep_outs, stretch * about + 0.3, straight, free_yaw);
        match attempt.keep_clear(First::Guess(first), keep_outs) {
            Ok(solved) => return Ok(solved.into()),
            Err(residuals) if residuals.primal_residual <= unsolved.primal_residual => unsolved = residuals,
            Err(_) => {}
        }
    }
    Err(unsolved)
}

/// The transition of a draft as it can be flown: solved again, finer and with what was overstepped put farther away, until its
/// controls lead where they should.
pub(crate) fn polish<const NX: usize, const NU: usize, F: Flight<NX, NU>>(
    flight: &F,
    start: &Motion,
    goal: Goal,
    draft: Draft,
    surroundings: &Surroundings,
) -> Result<Transition, Unsolved> {
    let Ok(solved) = draft.solved.downcast::<Solved<NX, NU>>() else { return Err(Unsolved::NOTHING) };
    let attempt = Attempt::new(flight, start, goal, surroundings, Detail::Full, f64::INFINITY);
    Attempt { enough_mu: None, ..attempt }.mend(*solved)
}

/// Where a solve starts: at a trajectory, or at a solution on the same mesh with its multipliers. The latter only pays where
/// little has changed; from one entry to the next it does not.
enum First<'a, const NX: usize, const NU: usize> {
    Guess(Guess<NX, NU>),
    Solution(Box<Solution<NX, NU>>),
    /// The solution on a coarser mesh.
    Coarser(&'a Solution<NX, NU>),
}

/// What is known of a transition before it is solved.
#[derive(Clone, Copy)]
pub(crate) enum Hint<'a> {
    /// About how long it takes (s).
    Time(f64),
    /// One that starts in the same motion and ends nearby.
    Neighbour(&'a Transition),
    /// Its own sketch.
    Sketch(&'a Draft),
}

struct Attempt<'a, F> {
    flight: &'a F,
    start: &'a Motion,
    goal: Goal<'a>,
    surroundings: &'a Surroundings<'a>,
    /// Greatest barrier parameter with which a solve may end early; `None` to solve to the end.
    enough_mu: Option<f64>,
    to_beat: f64,
    segments: usize,
    longest_step: f64,
}

impl<'a, F> Attempt<'a, F> {
    fn new(
        flight: &'a F,
        start: &'a Motion,
        goal: Goal<'a>,
        surroundings: &'a Surroundings,
        detail: Detail,
        to_beat: f64,
    ) -> Self {
        let all = surroundings.settings.segments;
        let few = (SKETCH_SHARE * all as f64).round().max(LEAST_SEGMENTS as f64) as usize;
        let (enough_mu, segments, longest_step) = match detail {
            Detail::Full => (early_end::DRAFT_MU, all, LONGEST_FIRST_STEP),
            Detail::Sketch => (early_end::SKETCH_MU, few, LONGEST_SKETCH_STEP),
        };
        let enough_mu = Some(enough_mu);
        Self { flight, start, goal, surroundings, enough_mu, to_beat, segments, longest_step }
    }

    /// The keep-outs that a sensible flight may touch: those near the straight line. One that is entered all the same is
    /// added when that is seen.
    fn near(&self, towards: &Motion) -> Vec<KeepOut> {
        let a = self.start.position;
        let (dx, dy) = (towards.position.x - a.x, towards.position.y - a.y);
        let squared = dx * dx + dy * dy;
        let near = |keep_out: &&KeepOut| {
            let (px, py) = (keep_out.centre[0] - a.x, keep_out.centre[1] - a.y);
            let s = if squared > 0.0 { ((px * dx + py * dy) / squared).clamp(0.0, 1.0) } else { 0.0 };
            keep_out.radius > 0.0 && (px - s * dx).hypot(py - s * dy) < keep_out.radius + NEAR
        };
        self.surroundings.keep_outs.iter().filter(near).copied().collect()
    }

    /// Solves, and solves again while a keep-out is entered between the knots.
    fn keep_clear<const NX: usize, const NU: usize>(
        &self,
        first: First<NX, NU>,
        keep_outs: Vec<KeepOut>,
    ) -> Result<Solved<NX, NU>, Unsolved>
    where
        F: Flight<NX, NU>,
    {
        let (heights, longest_step, segments) = (self.surroundings.heights, self.longest_step, self.segments);
        let setting = Setting { keep_outs, heights, longest_step, segments };
        let mut solved = self.solved(first, setting)?;
        for _ in 1..MOST_ROUNDS {
            let Solved { ref mut setting, ref seen, ref transition, .. } = solved;
            if !seen.is_some_and(|seen| setting.put_farther(self.surroundings, transition, &seen)) {
                return Ok(solved);
            }
            solved = self.solved(First::Solution(Box::new(solved.solution)), solved.setting)?;
        }
        Err(unsolved(&solved.solution))
    }

    /// Solves again, each time stricter, until nothing is overstepped any more.
    fn mend<const NX: usize, const NU: usize>(
        &self,
        mut solved: Solved<NX, NU>,
    ) -> Result<Transition, Unsolved>
    where
        F: Flight<NX, NU>,
    {
        for round in 1..=MOST_ROUNDS {
            let Solved { solution, mut setting, transition, seen, .. } = solved;
            let Some(seen) = seen else { return Err(unsolved(&solution)) };
            let segments = setting.segments;
            let stricter = setting.adjust(self.surroundings, 4 * self.segments, &transition, &seen);
            let to_the_end = solution.status == Status::Stopped;
            if !(stricter || to_the_end) || (round >= ROUNDS && seen.clearance >= 0.0) {
                return Ok(transition);
            }
            let first = if setting.segments == segments {
                First::Solution(Box::new(solution))
            } else {
                First::Guess(Guess::from_solution(&solution, 1))
            };
            solved = self.solved(first, setting)?;
        }
        Err(unsolved(&solved.solution))
    }

    /// Solves once, and looks at the result between the knots unless it loses.
    fn solved<const NX: usize, const NU: usize>(
        &self,
        first: First<NX, NU>,
        setting: Setting,
    ) -> Result<Solved<NX, NU>, Unsolved>
    where
        F: Flight<NX, NU>,
    {
        let solution = self.solve(&first, &setting).ok_or(Unsolved::NOTHING)?;
        // Stopped is a candidate that loses, or one that is good enough to be compared.
        if !solution.status.is_success() && solution.status != Status::Stopped {
            return Err(unsolved(&solution));
        }
        let mut transition = record::<NX, NU, F>(&solution);
        let time = match solution.log.last() {
            Some(last) if solution.status == Status::Stopped => {
                last.lagrangian - last.mu * F::ACTIVE_BOUNDS[0] * setting.segments as f64
            }
            _ => transition.duration,
        };
        if time > self.to_beat {
            return Ok(Solved { solution, setting, transition, time, seen: None });
        }
        let seen = self.look(&transition).ok_or_else(|| unsolved(&solution))?;
        complete(&mut transition, &seen, self.miss(&solution, &seen.end));
        Ok(Solved { solution, setting, transition, time, seen: Some(seen) })
    }

    fn solve<const NX: usize, const NU: usize>(
        &self,
        first: &First<NX, NU>,
        setting: &Setting,
    ) -> Option<Solution<NX, NU>>
    where
        F: Flight<NX, NU>,
    {
        let Setting { ref keep_outs, heights, segments, .. } = *setting;
        let problem =
            MinimumTime { flight: self.flight, start: *self.start, goal: self.goal, keep_outs, heights };
        let mut options =
            Options::default().with_tolerance(TOLERANCE).with_initial_mu(FIRST_MU).with_warm_mu(WARM_MU);
        options.max_iterations = self.surroundings.most_iterations.unwrap_or(options.max_iterations);
        let workspace = &mut Workspace::new();
        let early_end = EarlyEnd {
            to_beat: self.to_beat,
            enough_mu: self.enough_mu,
            active_bounds: F::ACTIVE_BOUNDS[1] * segments as f64,
        };
        let watch = |iteration: &Iteration| early_end.watch(iteration);
        let transcription = |uniform: f64| match self.surroundings.settings.transcription {
            Transcription::RungeKutta => {
                traj_opt::Transcription::RungeKutta { substeps: setting.substeps(uniform) }
            }
            Transcription::HermiteSimpson => traj_opt::Transcription::HermiteSimpson,
            Transcription::Trapezoidal => traj_opt::Transcription::Trapezoidal,
        };
        let graded = |final_time: f64| {
            let uniform = final_time / segments as f64;
            (Mesh::graded(segments, 1.0 - OUTER_SEGMENT / uniform), transcription(uniform))
        };
        let solved = match first {
            First::Guess(guess) => {
                let (mesh, how) = graded(guess.final_time());
                traj_opt::solve_with(workspace, &problem, &mesh, how, guess, &options, watch)
            }
            First::Coarser(coarser) => {
                let (mesh, how) = graded(coarser.final_time());
                traj_opt::solve_on_mesh(workspace, &problem, coarser, &mesh, how, &options, watch)
            }
            First::Solution(previous) => {
                let transcription = transcription(previous.final_time() / segments as f64);
                traj_opt::solve_from(workspace, &problem, previous, transcription, &options, watch)
            }
        };
        solved.ok()
    }

    fn look<const NX: usize, const NU: usize>(&self, transition: &Transition) -> Option<Examination>
    where
        F: Flight<NX, NU>,
    {
        let Surroundings { keep_outs, heights, .. } = *self.surroundings;
        examine(self.flight, transition, self.start, keep_outs, heights)
    }

    /// How far the integrated controls end from what the solution claims to reach.
    fn miss<const NX: usize, const NU: usize>(&self, solution: &Solution<NX, NU>, end: &Motion) -> Miss
    where
        F: Flight<NX, NU>,
    {
        match self.goal {
            Goal::Motion(goal) => miss(F::MODEL, end, &goal, false),
            Goal::Hover(goal) => miss(F::MODEL, end, &goal, true),
            Goal::Circle(orbit, direction) => {
                let last = solution.states()[solution.states().len() - 1];
                let [x, y] = orbit.circle.centre;
                let entry = Entry { angle: (last[1] - y).atan2(last[0] - x), direction };
                miss(F::MODEL, end, &orbit.at(entry), false)
            }
        }
    }
}

/// Residuals of a solve that is of no use.
fn unsolved<const NX: usize, const NU: usize>(solution: &Solution<NX, NU>) -> Unsolved {
    Unsolved {
        primal_residual: solution.residuals.primal,
        dual_residual: solution.residuals.dual.max(solution.residuals.complementarity),
    }
}

/// The solution as it stands in the plan, without what only an examination can tell.
fn record<const NX: usize, const NU: usize, F: Flight<NX, NU>>(solution: &Solution<NX, NU>) -> Transition {
    Transition {
        model: F::MODEL,
        duration: solution.final_time(),
        length: 0.0,
        knots: solution.times().to_vec(),
        states: solution.states().iter().map(|state| state.as_slice().to_vec()).collect(),
        controls: solution.controls().iter().map(|control| control.as_slice().to_vec()).collect(),
        control_nodes: solution.transcription().n_local(),
        status: if solution.status == traj_opt::Status::Solved {
            SolverStatus::Solved
        } else {
            SolverStatus::Acceptable
        },
        iterations: solution.iterations,
        dual_residual: solution.residuals.dual.max(solution.residuals.complementarity),
        primal_residual: solution.residuals.primal,
        miss: Miss::default(),
        max_speed: 0.0,
        max_tilt: 0.0,
    }
}

fn complete(transition: &mut Transition, seen: &Examination, miss: Miss) {
    transition.length = seen.length;
    transition.max_speed = seen.max_speed;
    transition.max_tilt = seen.max_tilt;
    transition.miss = miss;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transition::models::{JerkLimitedFlight, PointMassFlight, RigidBodyFlight, ThrustRateFlight};
    use nalgebra::Vector3;
    use quad_dynamics::{Vehicle, VehicleParameters};

    /// What the bounds of a segment cost in the barrier problems on the way to a solution, in barrier parameters.
    fn costs<const NX: usize, const NU: usize, F: Flight<NX, NU>>(
        flight: &F,
        ends: &[Motion; 2],
    ) -> Vec<f64> {
        let settings = TransitionSettings { model: F::MODEL, ..TransitionSettings::default() };
        let surroundings = Surroundings {
            keep_outs: &[],
            heights: [0.0, 100.0],
            settings: &settings,
            most_iterations: None,
        };
        let [start, end] = ends;
        let goal = Goal::Motion(*end);
        let attempt = Attempt::new(flight, start, goal, &surroundings, Detail::Full, f64::INFINITY);
        let attempt = Attempt { enough_mu: None, ..attempt };
        let first = guess(flight, start, end, &[], 6.0, false, false);
        let solved = attempt.keep_clear(First::Guess(first), Vec::new()).map_err(|_| "no solution").unwrap();
        let (time, n) = (solved.solution.final_time(), solved.solution.mesh().n_segments() as f64);
        let nearly = |it: &&Iteration| {
            (1e-4..1e-3).contains(&it.mu) && it.residuals.dual < 1e-3 && it.residuals.primal < 1e-3
        };
        let cost = |it: &Iteration| (it.lagrangian - time) / (it.mu * n);
        solved.solution.log.iter().filter(nearly).map(cost).collect()
    }

    /// A candidate is given up on the strength of the greater number: no barrier may cost more.
    #[test]
    fn bounds_cost_what_the_models_say() {
        let vehicle = Vehicle::new(VehicleParameters::survey_450()).expect("a preset");
        let (settings, calm) = (TransitionSettings::default(), Vector3::zeros());
        let mut seen = [const { Vec::new() }; 4];
        for (east, north) in [(15.0, 4.0), (40.0, -30.0), (0.0, 120.0)] {
            let ends = [Vector3::new(0.0, 0.0, 5.0), Vector3::new(east, north, 6.0)]
                .map(|place| Motion::hover(&vehicle, place, 0.5));
            seen[0].extend(costs(&PointMassFlight::new(&vehicle, &settings, calm), &ends));
            seen[1].extend(costs(&JerkLimitedFlight::new(&vehicle, &settings, calm), &ends));
            seen[2].extend(costs(&ThrustRateFlight::new(&vehicle, &settings, calm), &ends));
            seen[3].extend(costs(&RigidBodyFlight::new(&vehicle, &settings, calm, &[]), &ends));
        }
        let said = [
            PointMassFlight::ACTIVE_BOUNDS,
            JerkLimitedFlight::ACTIVE_BOUNDS,
            ThrustRateFlight::ACTIVE_BOUNDS,
            RigidBodyFlight::ACTIVE_BOUNDS,
        ];
        for (seen, [mean, most]) in seen.iter().zip(said) {
            assert!(!seen.is_empty());
            for cost in seen {
                assert!(
                    *cost <= most && (cost - mean).abs() < 0.4 * mean,
                    "{cost} for {mean}, at most {most}"
                );
            }
        }
    }
}
