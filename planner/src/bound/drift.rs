//! Least times between places in a steady wind, for whole routes.
//!
//! In wind the least time of a leg depends on its direction. Along one horizontal unit vector `n` the bound of `envelope.rs` is an
//! increasing, concave function `h_n` of the distance gained along `n`; over an offset `x` with slack `a` at both ends together, no
//! motion takes less than the greatest `h_n(x . n - a)` over any set of `n`. With the same set for all legs these times obey the
//! triangle inequality, because each `h_n` does along its own line: a detour over a third place, with its circle in between, covers
//! at least as much of `n`. They are not symmetric: `t(x)` is not `t(-x)`.
//!
//! `h_n` is tabulated once for each `n`: a chord of a concave function lies below it, and is concave again.

use super::Envelope;
use christofides::Metric;
use nalgebra::Vector2;

/// Directions `n`: between two of them a distance is underestimated by 0.2 % at most.
const DIRECTIONS: usize = 48;
/// Distances in a table, in equal ratios from the first to the last (m).
const DISTANCES: usize = 40;
const RANGE: [f64; 2] = [0.5, 2000.0];

/// Least times from one speed over the ground to another, whatever the directions of both.
#[derive(Debug, Clone)]
pub(crate) struct Drift {
    /// One for all directions in still air.
    tables: Vec<(Vector2<f64>, Table)>,
    is_calm: bool,
}

/// An increasing, concave function of the distance by its values at some, linear in between and beyond.
#[derive(Debug, Clone)]
struct Table {
    times: [f64; DISTANCES],
    /// Beyond the last distance (s/m).
    slope: f64,
}

fn ratio() -> f64 {
    (RANGE[1] / RANGE[0]).powf(1.0 / (DISTANCES - 1) as f64)
}

fn distance(index: usize) -> f64 {
    RANGE[0] * ratio().powi(index as i32)
}

impl Drift {
    /// For motions that start no faster than `from` and end no faster than `to` (m/s over the ground, not negative).
    pub(crate) fn new(envelope: &Envelope, from: f64, to: f64) -> Self {
        let is_calm = envelope.wind() == Vector2::zeros();
        let n_directions = if is_calm { 1 } else { DIRECTIONS };
        let directions = (0..n_directions).map(|i| i as f64 / DIRECTIONS as f64 * std::f64::consts::TAU);
        let tables = directions
            .map(|angle| Vector2::new(angle.cos(), angle.sin()))
            .filter_map(|n| Some((n, Table::new(envelope, n, from, to)?)))
            .collect();
        Self { tables, is_calm }
    }

    /// No admissible motion over an offset (m: east, north), less `slack` (m) in any direction, takes less (s).
    pub(crate) fn least_time(&self, offset: Vector2<f64>, slack: f64) -> f64 {
        if self.is_calm {
            return self.tables.iter().map(|(_, table)| table.at(offset.norm() - slack)).fold(0.0, f64::max);
        }
        self.tables.iter().map(|(n, table)| table.at(offset.dot(n) - slack)).fold(0.0, f64::max)
    }
}

/// Times of all legs between so many nodes, either way.
#[derive(Debug, Clone)]
pub(crate) struct LegTimes {
    n: usize,
    /// Row by row: from, to.
    times: Vec<f64>,
}

impl LegTimes {
    /// From a function of two different nodes.
    pub(crate) fn new(n: usize, time: impl Fn(usize, usize) -> f64) -> Self {
        let of = |pair: usize| if pair / n == pair % n { 0.0 } else { time(pair / n, pair % n) };
        Self { n, times: (0..n * n).map(of).collect() }
    }

    /// From, to, time; no node with itself.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        let all = self.times.iter().enumerate().map(|(pair, time)| (pair / self.n, pair % self.n, *time));
        all.filter(|(i, j, _)| i != j)
    }

    /// The same with every time changed.
    pub(crate) fn map(self, change: impl Fn(usize, usize, f64) -> f64) -> Self {
        Self::new(self.n, |i, j| change(i, j, self.times[i * self.n + j]))
    }
}

impl Metric for LegTimes {
    fn len(&self) -> usize {
        self.n
    }

    fn distance(&self, i: usize, j: usize) -> f64 {
        self.times[i * self.n + j]
    }
}

impl Table {
    /// `None` where nothing gets ahead against the wind.
    fn new(envelope: &Envelope, n: Vector2<f64>, from: f64, to: f64) -> Option<Self> {
        let tail = envelope.wind().dot(&n);
        // The rounding of the times themselves may bend them the other way: a chord needs its own allowance.
        let time = |index| envelope.least_time_up_to(tail, distance(index), from, to) * (1.0 - 1e-6);
        let times: [f64; DISTANCES] = std::array::from_fn(time);
        let cruise = envelope.asymptote().max(from - tail).max(to - tail) + tail;
        (cruise > 0.0 && times.iter().all(|time| time.is_finite()))
            .then_some(Self { times, slope: (1.0 - 1e-6) / cruise })
    }

    fn at(&self, gained: f64) -> f64 {
        if gained <= 0.0 {
            return 0.0;
        }
        if gained < RANGE[0] {
            return self.times[0] * gained / RANGE[0];
        }
        let place = (gained / RANGE[0]).ln() / ratio().ln();
        let index = place as usize;
        let Some(&next) = self.times.get(index + 1) else {
            let last = self.times[DISTANCES - 1];
            return last + (gained - RANGE[1]).max(0.0) * self.slope;
        };
        let (low, high) = (distance(index), distance(index + 1));
        let share = ((gained - low) / (high - low)).clamp(0.0, 1.0);
        self.times[index] + (next - self.times[index]) * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn tables_are_below_the_bound_and_obey_the_triangle_inequality(
            wind in prop::array::uniform2(-6.0..6.0),
            speed in 0.0..6.0,
            legs in prop::array::uniform2(prop::array::uniform2(-3000.0..3000.0)),
        ) {
            let wind = Vector2::from(wind);
            let envelope = Envelope::of_thrust(29.43, 1.5, 0.15, 9.81, speed).with_wind(wind, speed);
            let drift = Drift::new(&envelope, speed, speed);
            let [a, b] = legs.map(Vector2::from);
            let whole = drift.least_time(a + b, 0.0);
            prop_assert!(whole <= drift.least_time(a, 0.0) + drift.least_time(b, 0.0) + 1e-9);
            for (n, table) in &drift.tables {
                let gained = (a.dot(n)).abs();
                let exact = envelope.least_time_with(wind.dot(n), gained, speed, speed);
                prop_assert!(table.at(gained) <= exact, "{} {exact}", table.at(gained));
                prop_assert!(table.at(gained) > 0.7 * exact - 0.05);
            }
        }

        #[test]
        fn slower_ends_and_other_directions_of_them_take_no_less_than_a_table_says(
            wind in prop::array::uniform2(-6.0..6.0),
            fastest in 0.5..8.0,
            share in 0.0..1.0,
            gained in 0.0..30.0,
        ) {
            let wind = Vector2::from(wind);
            let envelope = Envelope::of_thrust(29.43, 1.5, 0.15, 9.81, fastest).with_wind(wind, fastest);
            for [from, to] in [[0.0, fastest], [fastest, 0.0]] {
                for (n, table) in &Drift::new(&envelope, from, to).tables {
                    let exact = envelope.least_time_with(wind.dot(n), gained, share * from, share * to);
                    prop_assert!(table.at(gained) <= exact, "{} {exact}", table.at(gained));
                }
            }
        }
    }

    #[test]
    fn a_tail_wind_is_faster_than_a_head_wind() {
        let envelope =
            Envelope::of_thrust(29.43, 1.5, 0.15, 9.81, 4.0).with_wind(Vector2::new(6.0, 0.0), 4.0);
        let drift = Drift::new(&envelope, 4.0, 4.0);
        let [there, back] = [200.0, -200.0].map(|x| drift.least_time(Vector2::new(x, 0.0), 0.0));
        assert!(there < 0.6 * back, "{there} {back}");
    }
}
