//! How close vehicles come to each other, proved on the continuous trajectories.

use crate::plan::Approach;

/// How far the distance found may be above the true least one (m).
pub(crate) const RESOLUTION: f64 = 1e-3;

/// A vehicle in the air: where it is, when it flies, and how fast at most.
pub(crate) struct Airborne<'a> {
    /// Position (m) at a time (s after the mission's start).
    pub position: &'a dyn Fn(f64) -> [f64; 3],
    /// First and last moment in the air (s).
    pub flight: [f64; 2],
    /// Speed that is never exceeded (m/s).
    pub top_speed: f64,
}

/// The least distance between two vehicles while both fly, to within [`RESOLUTION`]; `None` if they never fly together.
///
/// The distance `d` of two points changes by at most `L = v_1 + v_2` per second, so over `[a, b]` it is at least
/// `(d(a) + d(b) - L (b - a))/2`. Intervals whose bound is within the resolution of the best distance seen are dropped,
/// the others are halved: no encounter can hide between samples.
pub(crate) fn closest_approach(first: &Airborne, second: &Airborne) -> Option<(f64, f64)> {
    let start = first.flight[0].max(second.flight[0]);
    let end = first.flight[1].min(second.flight[1]);
    if start > end {
        return None;
    }
    let lipschitz = first.top_speed + second.top_speed;
    let distance = |time: f64| {
        let (a, b) = ((first.position)(time), (second.position)(time));
        (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
    };
    let (at_start, at_end) = (distance(start), distance(end));
    let mut best = if at_start <= at_end { (start, at_start) } else { (end, at_end) };
    let mut open = vec![([start, end], [at_start, at_end])];
    while let Some(([a, b], [at_a, at_b])) = open.pop() {
        let lower_bound = 0.5 * (at_a + at_b - lipschitz * (b - a));
        if lower_bound >= best.1 - RESOLUTION {
            continue;
        }
        let middle = 0.5 * (a + b);
        let at_middle = distance(middle);
        if at_middle < best.1 {
            best = (middle, at_middle);
        }
        open.push(([middle, b], [at_middle, at_b]));
        open.push(([a, middle], [at_a, at_middle]));
    }
    Some(best)
}

/// The closest approach over all pairs, vehicles named by their index in `fleet`; `None` entries do not fly.
pub(crate) fn closest_pair(fleet: &[Option<Airborne>]) -> Option<Approach> {
    let mut closest: Option<Approach> = None;
    for (i, first) in fleet.iter().enumerate() {
        for (j, second) in fleet.iter().enumerate().skip(i + 1) {
            let (Some(first), Some(second)) = (first, second) else { continue };
            let Some((time, distance)) = closest_approach(first, second) else { continue };
            if closest.is_none_or(|best| distance < best.distance) {
                closest = Some(Approach { vehicles: [i, j], time, distance });
            }
        }
    }
    closest
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two vehicles on crossing lines that meet for a hundredth of a second, far from any regular sampling time.
    #[test]
    fn a_grazing_encounter_is_found() {
        let meeting = 12.345_678_9;
        let first = |t: f64| [100.0 * (t - meeting), 0.0, 1.0];
        let second = |t: f64| [0.0, 100.0 * (t - meeting), 1.5];
        let airborne = |position| Airborne { position, flight: [0.0, 100.0], top_speed: 100.0 };
        let (time, distance) = closest_approach(&airborne(&first), &airborne(&second)).unwrap();
        assert!((time - meeting).abs() < 1e-4, "{time}");
        assert!((0.5 - distance).abs() <= RESOLUTION, "{distance}");
    }

    #[test]
    fn vehicles_that_never_fly_together_have_no_approach() {
        let still = |_: f64| [0.0; 3];
        let first = Airborne { position: &still, flight: [0.0, 1.0], top_speed: 0.0 };
        let second = Airborne { position: &still, flight: [2.0, 3.0], top_speed: 0.0 };
        assert_eq!(closest_approach(&first, &second), None);
    }
}
