//! How an autopilot is made to fly a plan, and what it will really do.
//!
//! | way | ArduCopter | PX4 | circle as planned? |
//! |---|---|---|---|
//! | [`Way::Stream`] | GUIDED | OFFBOARD | yes, within the autopilot's shaping limits |
//! | [`Way::LoiterItems`] | `LOITER_TURNS` | refused | whole metres, `CIRCLE_RATE`, a stop before and after |
//! | [`Way::Polygon`] | waypoints, camera held on the target | the same | corners, uneven speed |
//! | [`Way::LiveOrbit`] | not known to 4.6 and 4.7 | `DO_ORBIT`, left by a timer | radius from 1 m, at most 2 m/s^2 |
//!
//! Numbers without a source below are measured on ArduCopter 4.6.2 in simulation, without wind.

pub mod limits;
mod outcome;

pub use outcome::{CircleOutcome, Execution, execution, streamed};

use crate::input::Autopilot;
use limits::{
    ACCELERATION, CIRCLE_RATE, GETTING_MOVING, LARGEST_RADIUS, LOST_BY_ITEMS, MOST_TURNS, WHOLE_METRES,
};
use std::f64::consts::TAU;

/// A way to make an autopilot fly circles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Way {
    /// Position, velocity, acceleration and yaw as setpoints, many times a second.
    Stream,
    /// A mission with a `LOITER_TURNS` item per circle.
    LoiterItems,
    /// A mission with a polygon of waypoints per circle.
    Polygon,
    /// A live `DO_ORBIT` command per circle.
    LiveOrbit,
}

impl Way {
    /// The way in which a mission file flies circles on an autopilot.
    #[must_use]
    pub fn of_missions(autopilot: Autopilot) -> Self {
        match autopilot {
            Autopilot::ArduPilot => Self::LoiterItems,
            Autopilot::Px4 => Self::Polygon,
        }
    }

    /// Why an autopilot does not know this way, if so.
    #[must_use]
    pub fn refusal(self, autopilot: Autopilot) -> Option<&'static str> {
        match (self, autopilot) {
            (Self::LoiterItems, Autopilot::Px4) => Some("PX4 refuses a mission with LOITER_TURNS items"),
            (Self::LiveOrbit, Autopilot::ArduPilot) => {
                Some("ArduCopter 4.6 and 4.7 do not know the DO_ORBIT command")
            }
            _ => None,
        }
    }
}

/// What a `LOITER_TURNS` item of ArduCopter makes of a circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoiterItem {
    /// Turns that the item stores.
    pub turns: f64,
    /// Radius that the item stores (m).
    pub radius: f64,
    /// Time on the circle (s).
    pub duration: f64,
    /// Angle seen from the target (rad).
    pub seen: f64,
}

impl LoiterItem {
    /// The item for a circle of a radius (m) and sweep (rad), flown from a waypoint speed (m/s).
    ///
    /// The radius is rounded up, never down: a smaller circle could enter a safe distance.
    #[must_use]
    pub fn new(radius: f64, sweep: f64, waypoint_speed: f64) -> Self {
        let step = if radius.ceil() > WHOLE_METRES { 10.0 } else { 1.0 };
        let radius = ((radius / step - 1e-6).ceil() * step).clamp(1.0, LARGEST_RADIUS);
        let asked = sweep / TAU;
        let turns = if asked < 1.0 - 1e-9 { asked } else { (asked + 1e-9).floor().min(MOST_TURNS) };
        let speed = (CIRCLE_RATE * radius).min(waypoint_speed).min((0.5 * ACCELERATION * radius).sqrt());
        let duration = TAU * turns * radius / speed + GETTING_MOVING;
        Self { turns, radius, duration, seen: (TAU * turns - LOST_BY_ITEMS).max(0.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Flown by ArduCopter 4.6.2 in simulation: radius and turns read back, time on the circle, degrees seen.
    const FLOWN: [(f64, f64, f64, f64); 3] =
        [(2.0, 1.0, 19.7, 340.0), (3.0, 1.0, 19.7, 339.0), (5.0, 0.5, 11.0, 160.0)];

    #[test]
    fn loiter_items_are_what_was_flown() {
        for (radius, turns, seconds, degrees) in FLOWN {
            let item = LoiterItem::new(radius, turns * TAU, 5.0);
            assert_eq!((item.radius, item.turns), (radius, turns));
            assert!((item.duration - seconds).abs() < 0.5, "{item:?}");
            assert!((item.seen.to_degrees() - degrees).abs() < 1.5, "{item:?}");
        }
        assert_eq!(LoiterItem::new(2.9, 1.5 * TAU, 5.0).turns, 1.0);
        assert_eq!(LoiterItem::new(300.5, TAU, 5.0).radius, 310.0);
        assert_eq!(LoiterItem::new(1e9, TAU, 5.0).radius, LARGEST_RADIUS);
    }

    #[test]
    fn ways_that_an_autopilot_does_not_know_are_refused() {
        for way in [Way::Stream, Way::Polygon] {
            assert!(way.refusal(Autopilot::ArduPilot).is_none() && way.refusal(Autopilot::Px4).is_none());
        }
        assert!(Way::LoiterItems.refusal(Autopilot::Px4).is_some());
        assert!(Way::LiveOrbit.refusal(Autopilot::ArduPilot).is_some());
        for autopilot in [Autopilot::ArduPilot, Autopilot::Px4] {
            assert!(Way::of_missions(autopilot).refusal(autopilot).is_none());
        }
    }
}
