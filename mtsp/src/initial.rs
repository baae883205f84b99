use crate::{Error, Problem};
use christofides::Metric;
pub(crate) fn routes<M: Metric>(problem: &Problem<'_, M>) -> Result<Vec<Vec<usize>>, Error> {
    let mut r = vec![vec![]; problem.vehicles()];
    for (i, &t) in problem.targets().iter().enumerate() { r[i % problem.vehicles()].push(t); }
    Ok(r)
}
