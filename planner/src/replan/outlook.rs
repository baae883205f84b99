//! How good the plan of a flight under way can still become: lower bounds over every continuation.
//!
//! What is settled stays: a vehicle in the air goes on from its settled motion at its settled time, one on the ground (or, where
//! batteries are swapped, one that has landed) takes off now at the earliest, and one that is lost flies no more. Whoever flies comes
//! home, and somebody circles each target that is left. Over all shares, orders, entries, directions and admissible motions:
//!
//! * the *makespan* is at least the latest end that is settled, and the earliest one at which each vehicle in the air can be home;
//! * for every target it is at least the least over vehicles of its settled time, the least time to the circle, the loiter and the least
//!   time home: whatever else the vehicle does on the way is a motion too, and no motion is faster than the envelope allows;
//! * with `s_i` the settled times, `W` a lower bound on what all vehicles fly from then on together, and `M` the makespan, vehicle `i`
//!   flies no longer than `M - s_i`, so the sum of `max(M - s_i, 0)` is at least `W`;
//! * the *total* is at least the time flown until the settled times, and `W`.
//!
//! `W` is the greater of what it takes to bring all home, and of the forest bound of `mtsp` over the settled motions, the pads and the
//! targets that are left. Nothing is fitted or calibrated. In wind a potential is added to the legs as in `certificate.rs`; a route
//! from `x` to its pad `y` notices `pi . (y - x)`, which is the same for every continuation.

use super::settled::Settled;
use crate::bound::{Drift, Envelope, LegTimes};
use crate::certificate::levelled;
use crate::circles::Orbit;
use crate::legs::Airspace;
use crate::plan::{Circle, Plan, VehiclePlan};
use mtsp::LowerBounds;
use mtsp::lower_bound::{NumRoutes, forest};
use nalgebra::Vector2;
use quad_dynamics::Motion;
use std::sync::Arc;

/// Steps of the forest bound's ascent: at 100 targets a few milliseconds, and within 1 % of what 300 find.
const ITERATIONS: usize = 100;

/// Least times of legs, tabulated for one wind.
#[derive(Debug, Clone)]
pub(super) struct Ways {
    envelope: Envelope,
    fastest: f64,
    between: Drift,
    leaving: Drift,
    landing: Drift,
}

/// A vehicle that can still fly.
#[derive(Debug, Clone, Copy)]
pub(super) struct Start {
    /// Its settled time, or when it can take off at the earliest (s after the mission's start).
    pub time: f64,
    /// Its settled motion; `None` on the pad.
    pub here: Option<Motion>,
    pub pad: [f64; 3],
}

/// What is settled of a mission under way, and what is left to do.
#[derive(Debug, Clone)]
pub(super) struct Outlook<'a> {
    pub ways: &'a Ways,
    pub orbits: &'a [Orbit],
    pub starts: Vec<Start>,
    /// Circles that are left.
    pub open: Vec<usize>,
    /// The latest end that is settled (s after the mission's start).
    pub ended: f64,
    /// What has been flown until the settled times, all vehicles together (s).
    pub flown: f64,
    /// Whether a vehicle may take off again.
    pub swaps: bool,
}

impl Ways {
    /// Those known, if they are those of the airspace; else others.
    pub(super) fn of(airspace: &Airspace, team: &[Settled], known: Option<&Arc<Self>>) -> Arc<Self> {
        let fastest = airspace.orbits.iter().map(|orbit| orbit.circle.speed).fold(0.0, f64::max);
        let under_way = team.iter().filter_map(|settled| settled.here);
        let first = under_way.map(|here| here.velocity.norm()).fold(fastest, f64::max);
        let envelope = airspace.envelope.with_wind(airspace.envelope.wind(), first);
        if let Some(known) = known.filter(|known| known.envelope == envelope && known.fastest == fastest) {
            return Arc::clone(known);
        }
        let [between, leaving, landing] = [[fastest, fastest], [0.0, fastest], [fastest, 0.0]]
            .map(|[from, to]| Drift::new(&envelope, from, to));
        Arc::new(Self { envelope, fastest, between, leaving, landing })
    }

    fn between(&self, a: &Circle, b: &Circle) -> f64 {
        self.between.least_time(between(a.centre, b.centre), a.radius + b.radius)
    }

    /// From a hover on a pad to a circle.
    fn out(&self, pad: [f64; 3], circle: &Circle) -> f64 {
        self.leaving.least_time(between([pad[0], pad[1]], circle.centre), circle.radius)
    }

    fn home(&self, circle: &Circle, pad: [f64; 3]) -> f64 {
        self.landing.least_time(between(circle.centre, [pad[0], pad[1]]), circle.radius)
    }

    /// From a motion to a circle.
    fn onwards(&self, here: &Motion, circle: &Circle) -> f64 {
        let offset = Vector2::from(circle.centre) - here.position.xy();
        let speed = here.velocity.xy().norm();
        if speed <= self.fastest {
            return self.between.least_time(offset, circle.radius);
        }
        finite(self.envelope.least_time_along(offset, circle.radius, [speed, speed]))
    }

    /// From a motion to a hover on a pad.
    fn back(&self, here: &Motion, pad: [f64; 3]) -> f64 {
        let mut there = *here;
        there.position = pad.into();
        there.velocity.fill(0.0);
        finite(self.envelope.least_time_between(here, &there))
    }
}

fn between(a: [f64; 2], b: [f64; 2]) -> Vector2<f64> {
    Vector2::from(b) - Vector2::from(a)
}

/// Against more wind than it is fast a vehicle gets nowhere; then nothing is claimed.
fn finite(time: f64) -> f64 {
    if time.is_finite() { time } else { 0.0 }
}

impl Start {
    /// Where a vehicle can go on: `flights` are its own, with what is settled of each. `None` if it flies no more.
    pub(super) fn of(flights: &[(&VehiclePlan, &Settled)], now: f64, swap_time: Option<f64>) -> Option<Self> {
        let pad = flights.first()?.0.pad;
        if let Some((_, settled)) =
            flights.iter().find(|(_, settled)| settled.here.is_some() && !settled.landed)
        {
            return Some(Self { time: settled.time, here: settled.here, pad });
        }
        let landings = flights.iter().filter(|(_, settled)| settled.landed).map(|(_, settled)| settled.time);
        match landings.reduce(f64::max) {
            None => Some(Self { time: now, here: None, pad }),
            Some(landed) => Some(Self { time: now.max(landed + swap_time?), here: None, pad }),
        }
    }

    fn to(&self, ways: &Ways, circle: &Circle) -> f64 {
        self.here.map_or_else(|| ways.out(self.pad, circle), |here| ways.onwards(&here, circle))
    }

    fn place(&self) -> Vector2<f64> {
        self.here.map_or(Vector2::new(self.pad[0], self.pad[1]), |here| here.position.xy())
    }

    /// The least time to come home (s).
    fn back(&self, ways: &Ways) -> f64 {
        self.here.map_or(0.0, |here| ways.back(&here, self.pad))
    }
}

impl<'a> Outlook<'a> {
    /// The outlook from `now` (s after the mission's start) on; `team` is what is settled of the plan's flights.
    pub(super) fn new(
        ways: &'a Ways,
        airspace: &Airspace<'a>,
        plan: &Plan,
        (team, usable): (&[Settled], &[bool]),
        now: f64,
    ) -> Self {
        let flights = || plan.vehicles.iter().zip(team);
        let swap_time = airspace.mission.swap_time;
        let start = |vehicle: usize| {
            let own: Vec<_> = flights().filter(|(planned, _)| planned.vehicle == vehicle).collect();
            Start::of(&own, now, swap_time)
        };
        let over = flights().filter(|(planned, settled)| planned.lost_at.is_some() || settled.landed);
        let flown = |(planned, settled): (&VehiclePlan, &Settled)| match () {
            () if planned.lost_at.is_some() => planned.duration(),
            () if settled.landed || settled.here.is_some() => settled.time - planned.start_time(),
            () => 0.0,
        };
        Self {
            ways,
            orbits: airspace.orbits,
            starts: (0..usable.len()).filter(|&vehicle| usable[vehicle]).filter_map(start).collect(),
            open: team.iter().flat_map(|settled| settled.open.iter().copied()).collect(),
            ended: over
                .map(|(planned, settled)| match planned.lost_at {
                    Some(_) => planned.end_time(),
                    None => settled.time,
                })
                .fold(0.0, f64::max),
            flown: flights().map(flown).sum(),
            swaps: swap_time.is_some(),
        }
    }

    /// Bounds that hold for every continuation.
    pub(super) fn bounds(&self) -> LowerBounds {
        let work = self.work();
        let airborne = self.starts.iter().filter(|start| start.here.is_some());
        let home = airborne.map(|start| start.time + start.back(self.ways)).fold(self.ended, f64::max);
        let makespan = self.farthest().max(self.shared(work)).max(home);
        // Sums of a few numbers: what rounding can lift them by is far below a nanosecond.
        let down = |bound: f64| (bound * (1.0 - 1e-12)).max(0.0);
        LowerBounds { makespan: down(makespan), total_cost: down(self.flown + work) }
    }

    /// The latest of the times at which each target can be done, its vehicle home.
    fn farthest(&self) -> f64 {
        let done = |circle: &Circle| {
            let by = |start: &Start| {
                start.time + start.to(self.ways, circle) + circle.duration + self.ways.home(circle, start.pad)
            };
            self.starts.iter().map(by).reduce(f64::min).unwrap_or(0.0)
        };
        self.circles().map(done).fold(0.0, f64::max)
    }

    /// The least `M` for which the sum of `max(M - s_i, 0)` is `work`.
    fn shared(&self, work: f64) -> f64 {
        if work <= 0.0 {
            return 0.0;
        }
        let mut times: Vec<f64> = self.starts.iter().map(|start| start.time).collect();
        times.sort_by(f64::total_cmp);
        let mut sum = work;
        let mut level = 0.0;
        for (count, time) in times.iter().enumerate() {
            if count > 0 && *time >= level {
                break;
            }
            sum += time;
            level = sum / (count + 1) as f64;
        }
        level
    }

    /// A lower bound on what all vehicles fly from their settled times on, together (s).
    fn work(&self) -> f64 {
        let home: f64 = self.starts.iter().map(|start| start.back(self.ways)).sum();
        self.forest().unwrap_or(0.0).max(home)
    }

    fn circles(&self) -> impl Iterator<Item = &Circle> {
        self.open.iter().map(|&circle| &self.orbits[circle].circle)
    }

    /// The forest bound; `None` if there is nothing left to circle, or nobody to do it.
    fn forest(&self) -> Option<f64> {
        let circles: Vec<&Circle> = self.circles().collect();
        let (n, m) = (circles.len(), self.starts.len());
        if n == 0 || m == 0 {
            return None;
        }
        // Nodes: where vehicles are, their pads, the circles.
        let place = |node: usize| match node {
            node if node < m => self.starts[node].place(),
            node if node < 2 * m => Vector2::new(self.starts[node - m].pad[0], self.starts[node - m].pad[1]),
            node => circles[node - 2 * m].centre.into(),
        };
        let time = |i: usize, j: usize| match (i.checked_sub(2 * m), j.checked_sub(2 * m)) {
            (Some(a), Some(b)) => self.ways.between(circles[a], circles[b]),
            (None, Some(b)) if i < m => self.starts[i].to(self.ways, circles[b]),
            (None, Some(b)) => self.ways.out(self.starts[i - m].pad, circles[b]),
            (Some(a), None) if j >= m => self.ways.home(circles[a], self.starts[j - m].pad),
            _ => f64::INFINITY,
        };
        let legs = |potential: Vector2<f64>| {
            LegTimes::new(2 * m + n, |i, j| {
                let shift = potential.dot(&(place(j) - place(i)));
                // Legs that nobody flies must not be the least of anything.
                let time = time(i, j);
                if time.is_finite() { time + shift } else { UNUSED }
            })
        };
        let service = std::iter::repeat_n(0.0, 2 * m).chain(circles.iter().map(|circle| circle.duration));
        let (legs, service, potential) = levelled(&self.ways.envelope, legs, service.collect());
        // With swaps there may be as many routes as targets, and all but the first of a vehicle start at its pad.
        let again = (0..m).map(|i| m + i).cycle().take(if self.swaps { n.max(m) } else { 0 });
        let starts: Vec<usize> = (0..m).chain(again.clone()).collect();
        let ends = (0..m).map(|i| m + i).chain(again).map(mtsp::End::At).collect();
        let problem = mtsp::Problem::new(&legs, starts.len()).ok()?;
        let problem = problem.with_depots(starts, ends).ok()?.with_service(service).ok()?;
        // Whoever is in the air comes home, with targets or without.
        let noticed: f64 = self
            .starts
            .iter()
            .map(|start| {
                let offset = Vector2::new(start.pad[0], start.pad[1]) - start.place();
                let idle = start.back(self.ways) + potential.dot(&offset);
                idle.min(0.0) - potential.dot(&offset)
            })
            .sum();
        Some(forest(&problem, NumRoutes::AtMost, ITERATIONS) + noticed)
    }
}

/// Longer (s) than any leg.
const UNUSED: f64 = 1e9;
