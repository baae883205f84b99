//! Many problems of one kind at once.

use crate::{Error, Guess, Mesh, Options, Problem, Solution, Transcription, Workspace, solve_with};
use std::ops::ControlFlow;

/// Solves many similar problems (other end states, other limits), each from its own guess; answers are in the order of the cases.
///
/// With the feature `rayon` they are shared among the threads of the current pool, and a workspace serves one case after the
/// other; without it one workspace serves all.
///
/// # Errors
/// Each case has its own: those of [`solve`](crate::solve).
///
/// # Guarantee
/// Every answer equals that of [`solve`](crate::solve) to the bit, whatever the number of threads.
///
/// # Examples
/// ```
/// use traj_opt::nalgebra::{RealField, SVector};
/// use traj_opt::{Bounds, Dynamics, Guess, Mesh, Options, Problem, Transcription, solve_batch};
///
/// /// A block moves to `self.0` in the least time with an acceleration of at most 1 m/s^2.
/// struct Block(f64);
/// impl Dynamics<2, 1> for Block {
///     fn derivative<T: RealField + Copy>(&self, _: T, x: &SVector<T, 2>, u: &SVector<T, 1>) -> SVector<T, 2> {
///         SVector::from([x[1], u[0]])
///     }
/// }
/// impl Problem<2, 1> for Block {
///     type Dynamics = Self;
///     fn dynamics(&self) -> &Self {
///         self
///     }
///     fn bounds(&self) -> Bounds<2, 1> {
///         let bounds = Bounds::free().with_control([-1.0].into(), [1.0].into());
///         bounds.with_initial_state([0.0, 0.0].into()).with_terminal_state([self.0, 0.0].into())
///     }
///     fn mayer<T: RealField + Copy>(&self, _: &SVector<T, 2>, _: &SVector<T, 2>, final_time: T) -> T {
///         final_time
///     }
/// }
/// let guess = |x: f64| Guess::line([0.0, 0.0].into(), [x, 0.0].into(), [0.0].into(), 1.0);
/// let cases = [1.0, 4.0, 9.0].map(|x| (Block(x), guess(x)));
/// let solved = solve_batch(&cases, &Mesh::uniform(20), Transcription::HermiteSimpson, &Options::default());
/// for (solution, exact) in solved.into_iter().zip([2.0, 4.0, 6.0]) {
///     assert!((solution?.final_time() / exact - 1.0).abs() < 1e-4);
/// }
/// # Ok::<(), traj_opt::Error>(())
/// ```
pub fn solve_batch<const NX: usize, const NU: usize, P: Problem<NX, NU> + Sync>(
    cases: &[(P, Guess<NX, NU>)],
    mesh: &Mesh,
    transcription: Transcription,
    options: &Options,
) -> Vec<Result<Solution<NX, NU>, Error>> {
    let one = |workspace: &mut Workspace<NX, NU>, (problem, guess): &(P, Guess<NX, NU>)| {
        solve_with(workspace, problem, mesh, transcription, guess, options, |_| ControlFlow::Continue(()))
    };
    #[cfg(feature = "rayon")]
    {
        use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
        cases.par_iter().map_init(Workspace::new, one).collect()
    }
    #[cfg(not(feature = "rayon"))]
    {
        let mut workspace = Workspace::new();
        cases.iter().map(|case| one(&mut workspace, case)).collect()
    }
}
