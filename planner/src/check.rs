//! All that is wrong with a mission, found before any planning.

use crate::circles::{geometry, groups, loiter_of, orbits};
use crate::error::Problem;
use crate::mission::{Entries, Mission, Model};
use crate::planning::envelope;
use crate::reach;
use crate::transition::hover;

/// More pads than this stand around no depot; a number alone must not take memory.
const MOST_VEHICLES: usize = 1000;
/// Coordinates beyond this (m) are no local field any more, and lose millimetres in the solver.
const FARTHEST: f64 = 1e5;
/// More wind than any vehicle flies in (m/s).
const STRONGEST: f64 = 100.0;

impl Mission {
    /// All that is wrong with the mission, in the order of its fields; empty if it can be planned.
    ///
    /// Numbers are checked first; questions of geometry and thrust are asked only once all numbers make sense. Merged
    /// targets are judged by their common circle. O(n^2) in the number of targets.
    #[must_use]
    pub fn problems(&self) -> Vec<Problem> {
        let mut problems = self.number_problems();
        if problems.is_empty() {
            self.loiter_problems(&mut problems);
        }
        if problems.is_empty() {
            self.budget_problems(&mut problems);
            self.distance_problems(&mut problems);
        }
        if problems.is_empty() {
            problems.extend(orbits(self).map_or_else(
                |_| Vec::new(),
                |orbits| {
                    let envelope = envelope(self, &orbits);
                    reach::problems(self, &orbits, envelope)
                },
            ));
        }
        problems
    }

    /// Where each vehicle hovers before and after its flight (m, east-north-up): equally spaced on a circle around the
    /// depot, neighbours a fifth farther apart than the separation; one vehicle alone hovers above the depot. Those
    /// of the first 1000 vehicles, since larger fleets are refused.
    #[must_use]
    pub fn pads(&self) -> Vec<[f64; 3]> {
        let n = self.fleet.vehicles.min(MOST_VEHICLES);
        let half_step = std::f64::consts::PI / n as f64;
        let radius = if n < 2 { 0.0 } else { 0.6 * self.fleet.separation / half_step.sin() };
        (0..n)
            .map(|i| (2.0 * half_step * i as f64).sin_cos())
            .map(|(sin, cos)| {
                [self.depot[0] + radius * cos, self.depot[1] + radius * sin, self.loiter.height]
            })
            .collect()
    }

    fn number_problems(&self) -> Vec<Problem> {
        let mut ranges = Ranges(Vec::new());
        self.check_fleet(&mut ranges);
        self.check_loiter(&mut ranges);
        self.check_transition(&mut ranges);
        self.check_targets(&mut ranges);
        ranges.within(
            "environment.wind",
            &self.environment.wind,
            -STRONGEST,
            STRONGEST,
            "from -100 to 100 (m/s)",
        );
        ranges.within("targets.merge_within", &[self.merge_within], 0.0, FARTHEST, "from 0 to 100000 (m)");
        ranges.0.extend(self.group_problems());
        ranges.0
    }

    fn group_problems(&self) -> Vec<Problem> {
        let Some(groups) = &self.groups else { return Vec::new() };
        let mut times = vec![0; self.targets.len()];
        let mut problems = Vec::new();
        for (group, members) in groups.iter().enumerate() {
            let known = members.iter().all(|&member| member < times.len());
            if members.is_empty() || !known {
                problems.push(Problem::BadGroup { group });
            }
            for &member in members.iter().filter(|_| known) {
                times[member] += 1;
            }
        }
        let wrong = times.into_iter().enumerate().filter(|&(_, groups)| groups != 1);
        problems.extend(wrong.map(|(target, groups)| Problem::NotGrouped { target, groups }));
        problems
    }

    fn check_fleet(&self, ranges: &mut Ranges) {
        ranges.within("depot.position", &self.depot, -FARTHEST, FARTHEST, "within 100 km of the origin");
        if self.fleet.vehicles == 0 {
            ranges.0.push(Problem::NoVehicles);
        }
        let most = MOST_VEHICLES as f64;
        ranges.within("fleet.vehicles", &[self.fleet.vehicles as f64], 0.0, most, "up to 1000");
        ranges.within("fleet.separation", &[self.fleet.separation], 0.0, 1000.0, "from 0 to 1000 (m)");
        ranges.above_zero("fleet.endurance", self.fleet.endurance, f64::INFINITY, "above 0 (s)");
        if let Some(camera) = self.camera {
            let range = "from 0 to 10000 (m)";
            ranges.within("camera.target_height", &[camera.target_height], 0.0, 1e4, range);
        }
        if let Some(swap_time) = self.swap_time {
            ranges.within("fleet.swap_time", &[swap_time], 0.0, 1e6, "from 0 to 1000000 (s)");
        }
    }

    fn check_loiter(&self, ranges: &mut Ranges) {
        let loiter = &self.loiter;
        ranges.above_zero("loiter.radius", loiter.radius, 1e4, "above 0, up to 10000 (m)");
        ranges.above_zero("loiter.height", loiter.height, 1e4, "above 0, up to 10000 (m)");
        ranges.above_zero(
            "loiter.sweep",
            loiter.sweep,
            200.0 * std::f64::consts::PI,
            "above 0, up to a hundred circles",
        );
        ranges.above_zero("loiter.thrust_budget", loiter.thrust_budget, 1.0, "above 0, up to 1");
        ranges.above_zero("loiter.speed_limit", loiter.speed_limit, f64::INFINITY, "above 0 (m/s)");
        ranges.above_zero(
            "loiter.acceleration_limit",
            loiter.acceleration_limit,
            f64::INFINITY,
            "above 0 (m/s^2)",
        );
    }

    fn check_transition(&self, ranges: &mut Ranges) {
        let transition = &self.transition;
        if let Entries::Sampled(n) = transition.entries {
            ranges.within("transition.entries", &[n as f64], 1.0, 360.0, "from 1 to 360, or \"free\"");
        }
        ranges.within("transition.segments", &[transition.segments as f64], 4.0, 2000.0, "from 4 to 2000");
        ranges.above_zero("transition.thrust_budget", transition.thrust_budget, 1.0, "above 0, up to 1");
        ranges.within(
            "transition.safe_distance",
            &[transition.safe_distance],
            0.0,
            1e4,
            "from 0 to 10000 (m)",
        );
        let [low, high] = transition.heights;
        ranges.within("transition.heights", &[low, high], 0.0, 2e4, "from 0 to 20000 (m), least first");
        if low >= high {
            ranges.out("transition.heights", high, "from 0 to 20000 (m), least first");
        }
        if transition.model == Model::JerkLimited {
            let shaping = &transition.shaping;
            let limits = [
                ("speed", shaping.speed),
                ("acceleration", shaping.acceleration),
                ("jerk", shaping.jerk),
                ("climb_speed", shaping.climb_speed),
                ("descent_speed", shaping.descent_speed),
                ("vertical_acceleration", shaping.vertical_acceleration),
                ("vertical_jerk", shaping.vertical_jerk),
            ];
            for (key, value) in limits {
                ranges.above_zero(&format!("transition.shaping.{key}"), value, 1e4, "above 0, up to 10000");
            }
        }
    }

    fn check_targets(&self, ranges: &mut Ranges) {
        if self.targets.is_empty() {
            ranges.0.push(Problem::NoTargets);
        }
        for (i, target) in self.targets.iter().enumerate() {
            let field = |key: &str| format!("targets.{key}[{i}]");
            ranges.within(
                &field("positions"),
                &target.position,
                -FARTHEST,
                FARTHEST,
                "within 100 km of the origin",
            );
            if let Some(radius) = target.radius {
                ranges.above_zero(&field("radius"), radius, 1e4, "above 0, up to 10000 (m)");
            }
            if let Some(height) = target.height {
                ranges.above_zero(&field("height"), height, 1e4, "above 0, up to 10000 (m)");
            }
            if let Some(distance) = target.safe_distance {
                ranges.within(&field("safe_distance"), &[distance], 0.0, 1e4, "from 0 to 10000 (m)");
            }
        }
    }

    fn loiter_problems(&self, problems: &mut Vec<Problem>) {
        // Targets share most settings: report the first of each radius that cannot be flown, not a hundred times the same.
        let mut seen = Vec::new();
        for i in 0..self.targets.len() {
            let radius = self.radius(i);
            if seen.contains(&radius) {
                continue;
            }
            seen.push(radius);
            if let Err(source) = loiter_of(self, radius) {
                problems.push(Problem::Loiter { target: i, source });
            }
        }
    }

    fn budget_problems(&self, problems: &mut Vec<Problem>) {
        let vehicle = &self.fleet.vehicle;
        let transition = &self.transition;
        let mut seen = Vec::new();
        let unlike = |i: &usize| {
            let radius = self.radius(*i);
            let first = !seen.contains(&radius);
            if first {
                seen.push(radius);
            }
            first
        };
        let loiters = (0..self.targets.len())
            .filter(unlike)
            .filter_map(|i| Some((i, loiter_of(self, self.radius(i)).ok()?)));
        if transition.model == Model::JerkLimited {
            for (target, loiter) in loiters {
                let shaping = &transition.shaping;
                let acceleration = loiter.speed() * loiter.speed() / self.radius(target);
                let jerk = acceleration * loiter.angular_speed();
                let mut below = |limit, value: f64, needed: f64| {
                    if value < needed * (1.0 - 1e-9) {
                        problems.push(Problem::ShapingBelowLoiter { limit, value, needed, target });
                    }
                };
                below("speed", shaping.speed, loiter.speed());
                below("acceleration", shaping.acceleration, acceleration);
                below("jerk", shaping.jerk, jerk);
                if !problems.is_empty() {
                    return;
                }
            }
            return;
        }
        let available = transition.thrust_budget * vehicle.max_thrust();
        let still = vehicle.weight();
        let in_wind = hover(self, [0.0; 3], 0.0).collective_thrust;
        let hover = if self.environment.is_windy() { in_wind } else { still };
        let needs =
            loiters.map(|(_, loiter)| (loiter.thrust(), "the loiter")).chain([(hover * 1.01, "hover")]);
        let Some((needed, what)) = needs.max_by(|a, b| a.0.total_cmp(&b.0)) else { return };
        if needed > available * (1.0 + 1e-9) {
            let least = (needed / vehicle.max_thrust() * 1000.0).ceil() / 1000.0;
            problems.push(Problem::TransitionBudget {
                budget: transition.thrust_budget,
                available,
                needed,
                what,
                least,
            });
        }
    }

    fn distance_problems(&self, problems: &mut Vec<Problem>) {
        let distance = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        let heights = self.transition.heights;
        for (i, target) in self.targets.iter().enumerate() {
            let (radius, safe_distance, height) = (self.radius(i), self.safe_distance(i), self.height(i));
            if radius < safe_distance {
                problems.push(Problem::CircleInsideSafeDistance { target: i, radius, safe_distance });
            }
            if height < heights[0] || height > heights[1] {
                problems.push(Problem::HeightOutsideLimits { target: i, height, heights });
            }
            let closest = self
                .pads()
                .iter()
                .map(|pad| distance([pad[0], pad[1]], target.position))
                .fold(f64::INFINITY, f64::min);
            if closest < safe_distance {
                problems.push(Problem::DepotTooClose { target: i, distance: closest, safe_distance });
            }
        }
        for members in groups(self) {
            let (centre, radius, _) = geometry(self, &members);
            for second in (0..self.targets.len()).filter(|i| !members.contains(i)) {
                let between = distance(centre, self.targets[second].position);
                let safe_distance = self.safe_distance(second);
                // The circle's closest point to the other centre is |between - radius| away: a large circle may run around
                // a close target without coming near it.
                if (between - radius).abs() < safe_distance {
                    let first = members[0];
                    problems.push(Problem::TargetsTooClose {
                        first,
                        second,
                        distance: between,
                        radius,
                        safe_distance,
                    });
                }
            }
        }
    }

    /// Radius of the circle around target `i` (m).
    pub(crate) fn radius(&self, i: usize) -> f64 {
        self.targets[i].radius.unwrap_or(self.loiter.radius)
    }

    /// Height of the circle around target `i` (m).
    pub(crate) fn height(&self, i: usize) -> f64 {
        self.targets[i].height.unwrap_or(self.loiter.height)
    }

    /// Distance kept from target `i` (m).
    pub(crate) fn safe_distance(&self, i: usize) -> f64 {
        self.targets[i].safe_distance.unwrap_or(self.transition.safe_distance)
    }
}

/// Collects numbers that are out of range; NaN is out of every range.
struct Ranges(Vec<Problem>);

impl Ranges {
    fn out(&mut self, field: &str, value: f64, range: &'static str) {
        self.0.push(Problem::OutOfRange { field: field.to_owned(), value, range });
    }

    fn within(&mut self, field: &str, values: &[f64], least: f64, greatest: f64, range: &'static str) {
        for &value in values {
            if !(least..=greatest).contains(&value) {
                self.out(field, value, range);
            }
        }
    }

    fn above_zero(&mut self, field: &str, value: f64, greatest: f64, range: &'static str) {
        if !(value > 0.0 && value <= greatest) {
            self.out(field, value, range);
        }
    }
}
