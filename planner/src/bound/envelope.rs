//! Certified lower bounds on the time of a transition.
//!
//! **Claim.** No admissible motion is faster than [`Envelope::least_time`], whatever its path, attitude and thrust history.
//!
//! *Proof.* Let `n` be any horizontal unit vector, `s = v . n` and `x = p . n`. With thrust at most `T` and quadratic drag,
//! `m s' = T_n - (c/2) |v| s`, `|T_n| <= T`. With `A = T/m`, `k = c/(2m)` and `|v| >= |s|`:
//!
//! ```text
//!     s >= 0:   s' <= A - k s^2           (drag slows the speeding up)
//!     s <  0:   s' <= A + k V |s|         (drag helps to brake; V bounds |v|)
//!     backwards in time from the end, q = T_f - t:
//!     s >= 0:   ds/dq <= A + k V s        (braking, helped by drag)
//!     s <  0:   ds/dq <= A - k s^2
//! ```
//!
//! By the comparison theorem `s(t)` stays below the solution `F(t)` of the first pair from `s(0)` and below the solution
//! `B(T_f - t)` of the second pair from `s(T_f)`. Hence `x(T_f) - x(0) <= D(T_f) = integral of min(F, B)`, and a `T_f` with
//! `D(T_f) < x(T_f) - x(0)` cannot be. `V` itself: `m |v|' <= T + m g - (c/2)|v|^2`, so `|v|` never exceeds the larger of its
//! first value and `sqrt(2 (T + m g)/c)`. Thrust over *all* directions is allowed here, so the bound holds for every model
//! whose thrust is at most `T`; attitude and rates only take freedom away. The bound is the largest over several `n`.
//!
//! *In a steady wind `w`* the same holds in the frame that moves with the air, where `s` is less by `w_n = w . n` and the way to
//! cover is `x(T_f) - x(0) - w_n T_f`: a `T_f` with `D(T_f) + w_n T_f < x(T_f) - x(0)` cannot be, nor can one before both speeds
//! can meet. From there on `D' = min(F, B)` where the two cross, which rises with `T_f`: the left side is convex, and once it has
//! been below the right one it crosses it only once.
//!
//! *From and to at most so fast:* then `F` and `B` start at the greatest speeds, and the two need not meet. Before they can, the lower
//! one alone is `D'`, which rises with `T_f` as well: [`Envelope::least_time_up_to`].

use nalgebra::Vector2;
use quad_dynamics::{GRAVITY, Motion};

/// How fast a vehicle can speed up and brake along a line, whatever else it does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Envelope {
    /// `A`: greatest acceleration without drag (m/s^2).
    acceleration: f64,
    /// `k`: drag coefficient over twice the mass (1/m).
    drag: f64,
    /// `V`: speed through the air that is never exceeded (m/s).
    top_speed: f64,
    /// Velocity of the air: east, north (m/s).
    wind: Vector2<f64>,
}

/// A drag so small that it moves no bound by more than the rounding allowance, for models without drag.
const NEGLIGIBLE_DRAG: f64 = 1e-12;
/// Bounds are multiplied by this: cancellation in [`Envelope::aided`] costs up to 1e-7 of a distance, and rounding must
/// never lift a bound above the truth.
const ROUND_DOWN: f64 = 1.0 - 1e-6;

/// Time and distance to reach a speed.
#[derive(Debug, Clone, Copy, Default)]
struct Reach {
    time: f64,
    distance: f64,
}

impl Envelope {
    /// Of a vehicle with thrust at most `thrust` (N), `mass` (kg), drag coefficient `drag` (kg/m), gravity `gravity`
    /// (m/s^2), whose speed starts at no more than `speed` (m/s).
    pub(crate) fn of_thrust(thrust: f64, mass: f64, drag: f64, gravity: f64, speed: f64) -> Self {
        let k = (drag / (2.0 * mass)).max(NEGLIGIBLE_DRAG);
        let terminal = ((thrust / mass + gravity) / k).sqrt();
        Self { acceleration: thrust / mass, drag: k, top_speed: terminal.max(speed), wind: Vector2::zeros() }
    }

    /// The same in a steady wind (m/s), for vehicles whose first speed over the ground is at most `speed` (m/s).
    pub(crate) fn with_wind(self, wind: Vector2<f64>, speed: f64) -> Self {
        Self { wind, top_speed: self.top_speed.max(speed + wind.norm()), ..self }
    }

    /// Velocity of the air: east, north (m/s).
    pub(crate) fn wind(&self) -> Vector2<f64> {
        self.wind
    }

    /// Of a vehicle whose speed and acceleration are bounded and which feels no drag.
    pub(crate) fn of_limits(speed: f64, acceleration: f64) -> Self {
        Self { acceleration, drag: NEGLIGIBLE_DRAG, top_speed: speed, wind: Vector2::zeros() }
    }

    /// About the greatest acceleration and speed (m/s^2, m/s) while part of the thrust carries the weight.
    pub(crate) fn level_flight(&self) -> [f64; 2] {
        let a = self.acceleration;
        let level = if a > GRAVITY { (a * a - GRAVITY * GRAVITY).sqrt() } else { a };
        [level, (level / self.drag).sqrt().min(self.top_speed)]
    }

    /// The speed at which drag eats all of the acceleration, or the top speed if that is less.
    pub(super) fn asymptote(&self) -> f64 {
        (self.acceleration / self.drag).sqrt().min(self.top_speed)
    }

    /// Least time (s) from speed `from` to speed `to` over `distance` (m) along one line in still air; 0 if nothing can be said.
    pub(crate) fn least_time(&self, distance: f64, from: f64, to: f64) -> f64 {
        self.least_time_with(0.0, distance, from, to)
    }

    /// The same over the ground with the wind blowing at `tail` (m/s) along the line; infinite if it cannot be done.
    pub(super) fn least_time_with(&self, tail: f64, distance: f64, from: f64, to: f64) -> f64 {
        let (from, to) = (from - tail, to - tail);
        let floor = from.max(to);
        let asymptote = self.asymptote();
        if floor >= asymptote * (1.0 - 1e-9) {
            // Faster than drag would allow: all that is certain is the top speed.
            let fastest = self.top_speed.max(floor) + tail;
            return if self.top_speed > 0.0 && fastest > 0.0 {
                (distance / fastest).max(0.0) * ROUND_DOWN
            } else {
                0.0
            };
        }
        let through = |peak: f64| {
            let (forward, backward) = (self.speeding_up(from, peak), self.braking(peak, to));
            let time = forward.time + backward.time;
            Reach { time, distance: forward.distance + backward.distance + tail * time }
        };
        let direct = through(floor);
        if direct.distance >= distance {
            return direct.time.max(0.0) * ROUND_DOWN;
        }
        let (mut low, mut high) = (floor, asymptote * (1.0 - 1e-9));
        let widest = through(high);
        if widest.distance <= distance {
            let cruise = asymptote + tail;
            if cruise <= 0.0 {
                return f64::INFINITY;
            }
            return (widest.time + (distance - widest.distance) / cruise) * ROUND_DOWN;
        }
        // Bisection to the last bit or nearly so.
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if through(middle).distance < distance {
                low = middle;
            } else {
                high = middle;
            }
        }
        through(low).time * ROUND_DOWN
    }

    /// The same from a speed of at most `from` to one of at most `to` (m/s over the ground, not negative): over a short way the slower end
    /// decides, and the speed at the other stays below what is allowed.
    pub(super) fn least_time_up_to(&self, tail: f64, distance: f64, from: f64, to: f64) -> f64 {
        let (first, last) = (from - tail, to - tail);
        let one_way = |speed: f64| {
            let Reach { time, distance } =
                if first < last { self.speeding_up(first, speed) } else { self.braking(speed, last) };
            Reach { time, distance: distance + tail * time }
        };
        let (mut low, mut high) = (first.min(last), first.max(last));
        if high >= self.asymptote() * (1.0 - 1e-9) || one_way(high).distance <= distance {
            return self.least_time_with(tail, distance, from, to);
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if one_way(middle).distance < distance {
                low = middle;
            } else {
                high = middle;
            }
        }
        one_way(low).time.max(0.0) * ROUND_DOWN
    }

    /// Fastest way from speed `from` up to `to >= from`.
    fn speeding_up(&self, from: f64, to: f64) -> Reach {
        let below = self.aided(from.min(0.0), to.min(0.0));
        let above = self.opposed(from.max(0.0), to.max(0.0));
        Reach { time: below.time + above.time, distance: above.distance - below.distance }
    }

    /// Fastest way from speed `from` down to `to <= from`: `speeding_up` seen backwards in time, with aid and opposition swapped.
    fn braking(&self, from: f64, to: f64) -> Reach {
        let above = self.aided(-from.max(0.0), -to.max(0.0));
        let below = self.opposed(-from.min(0.0), -to.min(0.0));
        Reach { time: below.time + above.time, distance: above.distance - below.distance }
    }

    /// From `from` to `to`, `from <= to <= 0`, under `s' = A - k V s`: drag helps. Distance as a positive length.
    fn aided(&self, from: f64, to: f64) -> Reach {
        if from >= to {
            return Reach::default();
        }
        let rate = self.drag * self.top_speed;
        let (fast, slow) = (-from, -to);
        // r' = -A - rate r for r = |s|, so  t = ln((A + rate fast)/(A + rate slow))/rate  and  A t + rate x = fast - slow.
        if rate * fast < 1e-9 * self.acceleration {
            let time = (fast - slow) / self.acceleration;
            return Reach { time, distance: 0.5 * (fast + slow) * time };
        }
        let time = ((rate * (fast - slow)) / (self.acceleration + rate * slow)).ln_1p() / rate;
        Reach { time, distance: ((fast - slow) - self.acceleration * time) / rate }
    }

    /// From `from` to `to`, `0 <= from <= to`, under `s' = A - k s^2`: drag hinders.
    fn opposed(&self, from: f64, to: f64) -> Reach {
        if from >= to {
            return Reach::default();
        }
        let (a, k) = (self.acceleration, self.drag);
        if k * to * to < 1e-9 * a {
            let time = (to - from) / a;
            return Reach { time, distance: 0.5 * (from + to) * time };
        }
        let terminal = (a / k).sqrt();
        let time = ((to / terminal).atanh() - (from / terminal).atanh()) / (a * k).sqrt();
        let distance = (-(k / a) * to * to).ln_1p() - (-(k / a) * from * from).ln_1p();
        Reach { time, distance: -distance / (2.0 * k) }
    }

    /// Least time (s) over an offset (m: east, north), less `slack` (m) in any direction, from one speed over the ground to another at
    /// most (m/s), by the bound along the offset; infinite against more wind than the vehicle is fast.
    pub(crate) fn least_time_along(&self, offset: Vector2<f64>, slack: f64, [from, to]: [f64; 2]) -> f64 {
        let Some(n) = offset.try_normalize(0.0) else { return 0.0 };
        let gap = offset.norm() - slack;
        if gap > 0.0 { self.least_time_with(self.wind.dot(&n), gap, from, to) } else { 0.0 }
    }

    /// Least time (s) from one motion to another, over any path; only horizontal positions and velocities count.
    pub(crate) fn least_time_between(&self, from: &Motion, to: &Motion) -> f64 {
        self.least_time_over((to.position - from.position).xy(), from.velocity.xy(), to.velocity.xy())
    }

    fn least_time_over(&self, offset: Vector2<f64>, from: Vector2<f64>, to: Vector2<f64>) -> f64 {
        let along = |n: Vector2<f64>| {
            self.least_time_with(self.wind.dot(&n), offset.dot(&n), from.dot(&n), to.dot(&n))
        };
        let straight = offset.try_normalize(0.0).map_or(0.0, along);
        // Any set of directions gives a valid bound; more of them gain less than 1 %.
        const DIRECTIONS: usize = 32;
        (0..DIRECTIONS)
            .map(|i| (i as f64 / DIRECTIONS as f64 * std::f64::consts::TAU).sin_cos())
            .map(|(sin, cos)| along(Vector2::new(cos, sin)))
            .fold(straight, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const MASS: f64 = 1.5;
    const GRAVITY: f64 = 9.81;
    const THRUST: f64 = 29.43;
    const DRAG: f64 = 0.15;

    #[test]
    fn no_reference_transition_is_faster_than_its_bound() {
        let table = include_str!("../../tests/data/transitions.csv");
        let mut lines = table.lines();
        let header: Vec<&str> = lines.next().unwrap().split(',').collect();
        let column = |name: &str| header.iter().position(|h| *h == name).unwrap();
        for line in lines {
            let cells: Vec<&str> = line.split(',').collect();
            let at = |name: &str| cells[column(name)].parse::<f64>().unwrap();
            let pair = |what: &str| Vector2::new(at(&format!("{what}x")), at(&format!("{what}y")));
            let (from, to) = (pair("start_v"), pair("end_v"));
            let speed = from.norm();
            let envelope = Envelope::of_thrust(THRUST, MASS, DRAG, GRAVITY, speed);
            let bound = envelope.least_time_over(pair("end_p") - pair("start_p"), from, to);
            assert!(
                bound > 0.0 && bound <= at("tfA_hs80"),
                "id {}: {bound} against {}",
                cells[0],
                at("tfA_hs80")
            );
        }
    }

    /// Without drag the bound on a line is the double integrator's minimum time.
    #[test]
    fn a_drag_free_line_has_the_analytic_minimum_time() {
        let envelope = Envelope::of_limits(1e6, 2.0);
        assert!((envelope.least_time(8.0, 0.0, 0.0) - 4.0).abs() < 1e-4);
        // Top speed 2 m/s: a second up and down over 1 m each, and 3 s at speed.
        let capped = Envelope::of_limits(2.0, 2.0);
        assert!((capped.least_time(8.0, 0.0, 0.0) - 5.0).abs() < 1e-4);
        // Flying away first: brake 1 s over 1 m, then 3 m forward from rest to rest.
        let away = envelope.least_time(2.0, -2.0, 0.0);
        assert!((away - (1.0 + 2.0 * (3.0f64 / 2.0).sqrt())).abs() < 1e-4, "{away}");
    }

    #[test]
    fn the_bound_grows_with_distance_and_starts_at_zero() {
        let envelope = Envelope::of_thrust(THRUST, MASS, DRAG, GRAVITY, 0.0);
        let times: Vec<f64> = (0..2000).map(|d| envelope.least_time(f64::from(d), 5.0, 5.0)).collect();
        assert_eq!(times[0], 0.0);
        assert!(times.windows(2).all(|pair| pair[0] <= pair[1]));
        // Concave, so that it keeps a metric a metric.
        assert!(times.windows(3).all(|t| t[1] - t[0] >= t[2] - t[1] - 1e-7));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]

        /// Any flight under any admissible thrust takes at least its own bound.
        #[test]
        fn no_flight_is_faster_than_its_bound(
            velocity in prop::array::uniform3(-9.0..9.0),
            forces in prop::collection::vec((prop::array::uniform3(-1.0..1.0), 0.0..1.0), 1..8),
            pause in 0.02..0.6,
            wind in prop::sample::select(vec![[0.0, 0.0], [5.0, 2.0], [-3.0, 9.0]]),
        ) {
            let velocity: [f64; 3] = velocity;
            let start = velocity;
            let speed = velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
            let envelope =
                Envelope::of_thrust(THRUST, MASS, DRAG, GRAVITY, speed).with_wind(wind.into(), speed);
            let (mut p, mut v, mut time) = ([0.0; 3], velocity, 0.0);
            let step = 1e-4;
            for (direction, share) in forces {
                let direction: [f64; 3] = direction;
                let norm = direction.iter().map(|d| d * d).sum::<f64>().sqrt().max(1e-9);
                for _ in 0..(pause / step) as usize {
                    let air: [f64; 3] = [v[0] - wind[0], v[1] - wind[1], v[2]];
                    let speed = air.iter().map(|v| v * v).sum::<f64>().sqrt();
                    for axis in 0..3 {
                        let weight = if axis == 2 { GRAVITY } else { 0.0 };
                        let a = (THRUST * share * direction[axis] / norm - 0.5 * DRAG * speed * air[axis]) / MASS - weight;
                        p[axis] += step * (v[axis] + 0.5 * step * a);
                        v[axis] += step * a;
                    }
                    time += step;
                }
            }
            let flat = |v: [f64; 3]| Vector2::new(v[0], v[1]);
            let bound = envelope.least_time_over(flat(p), flat(start), flat(v));
            // The simulation's own steps are off by a few of them.
            prop_assert!(bound <= time + 5.0 * step, "{bound} against {time}");
        }
    }
}
