//! The smallest ball around points: circle in the plane, sphere in space.

use crate::error::{Error, check_finite};
use crate::geometry::{distance, safe_scale, scaled, squared_distance};

/// A ball: centre and radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball<const D: usize> {
    /// The centre.
    pub centre: [f64; D],
    /// The radius, not negative.
    pub radius: f64,
}

/// The smallest circle that holds all points: [`smallest_enclosing_ball`] in the plane.
///
/// # Errors
/// [`Error::NonFiniteCoordinate`].
///
/// # Examples
/// ```
/// let circle = cluster::smallest_enclosing_circle(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.5]])?;
/// assert_eq!((circle.centre, circle.radius), ([1.0, 0.0], 1.0));
/// # Ok::<(), cluster::Error>(())
/// ```
pub fn smallest_enclosing_circle(points: &[[f64; 2]]) -> Result<Ball<2>, Error> {
    smallest_enclosing_ball(points)
}

/// The smallest sphere that holds all points: [`smallest_enclosing_ball`] in space.
///
/// # Errors
/// [`Error::NonFiniteCoordinate`].
pub fn smallest_enclosing_sphere(points: &[[f64; 3]]) -> Result<Ball<3>, Error> {
    smallest_enclosing_ball(points)
}

/// The smallest ball that holds all points.
///
/// Move-to-front recursion (Welzl 1991, doi:10.1007/BFb0038202) with farthest-point pivots (Gärtner 1999,
/// doi:10.1007/3-540-48481-7_29).
///
/// # Returns
/// The ball; of no points the ball of radius 0 at the origin. The radius is the distance, as computed, from the centre to the farthest
/// point, so that every point is inside to the bit.
///
/// # Errors
/// [`Error::NonFiniteCoordinate`].
///
/// # Complexity
/// Linear in the number of points in practice, for a fixed dimension; allocates one index a point.
pub fn smallest_enclosing_ball<const D: usize>(points: &[[f64; D]]) -> Result<Ball<D>, Error> {
    check_finite(points)?;
    let Some(&origin) = points.first() else {
        return Ok(Ball { centre: [0.0; D], radius: 0.0 });
    };
    // Shift and scale: the support is solved for relative to one of the points anyway.
    let scale = safe_scale(points);
    let work = scaled(points, scale);
    let mut search = Search { points: &work, order: (0..points.len()).collect() };
    let ball = search.pivot();
    let mut centre = ball.centre.map(|x| x / scale);
    if centre.iter().any(|x| !x.is_finite()) {
        centre = origin;
    }
    let radius = points.iter().map(|p| distance(p, &centre)).fold(0.0, f64::max);
    Ok(Ball { centre, radius })
}

/// Relative excess of a squared distance that counts as inside: a few units in the last place.
const INSIDE: f64 = 1e-14;

/// Squared sine below which a further support point counts as affinely dependent on the others.
const DEPENDENT: f64 = 1e-24;

struct Search<'a, const D: usize> {
    points: &'a [[f64; D]],
    order: Vec<usize>,
}

/// A ball by squared radius, while searching.
#[derive(Clone, Copy)]
struct Candidate<const D: usize> {
    centre: [f64; D],
    squared_radius: f64,
}

impl<const D: usize> Candidate<D> {
    fn holds(&self, point: &[f64; D]) -> bool {
        squared_distance(point, &self.centre) <= self.squared_radius * (1.0 + INSIDE)
    }
}

impl<const D: usize> Search<'_, D> {
    /// Adds the farthest point to the front of the list until none is outside. The radius grows each time; only the
    /// pivots so far, a handful, are searched.
    fn pivot(&mut self) -> Candidate<D> {
        let mut ball = Candidate { centre: self.points[0], squared_radius: -1.0 };
        for active in 0..=self.points.len() {
            let squared = |i: usize| squared_distance(&self.points[i], &ball.centre);
            let (position, farthest) = (0..self.order.len()).fold((0, -1.0), |best, position| {
                let s = squared(self.order[position]);
                if s > best.1 { (position, s) } else { best }
            });
            if farthest <= ball.squared_radius * (1.0 + INSIDE) {
                return ball;
            }
            let pivot = self.order.remove(position);
            let next = self.with_support(active, &mut vec![pivot]);
            self.order.insert(0, pivot);
            if next.squared_radius <= ball.squared_radius {
                return ball; // rounding only: no progress is left
            }
            ball = next;
        }
        ball
    }

    /// The smallest ball around the first `count` points of the order that has `support` on its boundary.
    fn with_support(&mut self, count: usize, support: &mut Vec<usize>) -> Candidate<D> {
        let Some(mut ball) = circumscribed(self.points, support) else {
            return Candidate { centre: self.points[support[0]], squared_radius: -1.0 };
        };
        if support.len() == D + 1 {
            return ball;
        }
        for position in 0..count {
            let point = self.order[position];
            if ball.holds(&self.points[point]) {
                continue;
            }
            support.push(point);
            let next = self.with_support(position, support);
            support.pop();
            if next.squared_radius > ball.squared_radius {
                ball = next;
                self.order[..=position].rotate_right(1);
            }
        }
        ball
    }
}

/// The smallest ball with all support points on its boundary: its centre is their circumcentre within their affine
/// hull, `c = p0 + sum l_j q_j` with `2 (q_i . q_j) l = q_i . q_i`, `q_j = p_j - p0`. None if they are affinely dependent.
fn circumscribed<const D: usize>(points: &[[f64; D]], support: &[usize]) -> Option<Candidate<D>> {
    let base = points[support[0]];
    let sides: Vec<[f64; D]> =
        support[1..].iter().map(|&i| std::array::from_fn(|axis| points[i][axis] - base[axis])).collect();
    // Gram-Schmidt: solve for the centre along one new orthogonal direction at a time.
    let mut directions: Vec<[f64; D]> = Vec::with_capacity(sides.len());
    let mut offset = [0.0; D];
    for side in &sides {
        let mut normal = *side;
        for _ in 0..2 {
            for direction in &directions {
                let along = dot(&normal, direction) / dot(direction, direction);
                normal = std::array::from_fn(|axis| normal[axis] - along * direction[axis]);
            }
        }
        let (length, whole) = (dot(&normal, &normal), dot(side, side));
        if length <= DEPENDENT * whole || whole == 0.0 {
            return None;
        }
        // |offset|^2 = |offset - side|^2 on the boundary: 2 side . offset = side . side.
        let step = (0.5 * whole - dot(side, &offset)) / length;
        offset = std::array::from_fn(|axis| offset[axis] + step * normal[axis]);
        directions.push(normal);
    }
    let centre = std::array::from_fn(|axis| base[axis] + offset[axis]);
    Some(Candidate { centre, squared_radius: dot(&offset, &offset) })
}

fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    (0..D).map(|axis| a[axis] * b[axis]).sum()
}
