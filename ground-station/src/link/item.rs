//! Mission items as they go over the wire and into `QGC WPL 110` files.

use crate::export::qgc::{Item, PlanFile};
use crate::input::Autopilot;
use mavlink::dialects::common::MISSION_ITEM_INT_DATA;

/// A mission item without its number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MissionItem {
    /// `MAV_CMD`.
    pub command: u16,
    /// `MAV_FRAME`, of those with whole-number latitude and longitude where there is a place.
    pub frame: u8,
    /// `param1` to `param4`; not-a-number leaves it to the autopilot.
    pub parameters: [f32; 4],
    /// Latitude and longitude (1e-7 degrees), or 0.
    pub place: [i32; 2],
    /// Height (m), or `param7`.
    pub height: f32,
}

/// Numbers of MAVLink that are needed to tell items apart.
pub const NAV_WAYPOINT: u16 = 16;
/// `MAV_CMD_NAV_LOITER_TURNS`.
pub const NAV_LOITER_TURNS: u16 = 18;
/// `MAV_CMD_DO_CHANGE_SPEED`.
pub const DO_CHANGE_SPEED: u16 = 178;
/// Latitude, longitude (as numbers), height above mean sea level, and above home; in files, and over the wire.
const FRAME_GLOBAL: u8 = 0;
const FRAME_RELATIVE: u8 = 3;
const FRAME_GLOBAL_INT: u8 = 5;
const FRAME_RELATIVE_INT: u8 = 6;

/// Degrees as whole numbers of 1e-7.
#[must_use]
pub fn whole_degrees(degrees: f64) -> i32 {
    (degrees * 1e7).round() as i32
}

impl MissionItem {
    /// The items of a `.plan` file as its autopilot wants them: ArduPilot has home as the first, which it overwrites.
    #[must_use]
    pub fn of_plan(plan: &PlanFile, autopilot: Autopilot) -> Vec<Self> {
        let [latitude, longitude, altitude] = plan.mission.planned_home_position;
        let home = Self {
            command: NAV_WAYPOINT,
            frame: FRAME_GLOBAL_INT,
            parameters: [0.0; 4],
            place: [whole_degrees(latitude), whole_degrees(longitude)],
            height: altitude as f32,
        };
        let home = (autopilot == Autopilot::ArduPilot).then_some(home);
        home.into_iter().chain(plan.mission.items.iter().map(Self::of_item)).collect()
    }

    fn of_item(item: &Item) -> Self {
        let number = |index: usize| item.params[index].map_or(f32::NAN, |value| value as f32);
        let degrees = |index: usize| item.params[index].map_or(0, whole_degrees);
        let frame = match item.frame as u8 {
            FRAME_GLOBAL => FRAME_GLOBAL_INT,
            FRAME_RELATIVE => FRAME_RELATIVE_INT,
            other => other,
        };
        Self {
            command: item.command as u16,
            frame,
            parameters: [0, 1, 2, 3].map(number),
            place: [degrees(4), degrees(5)],
            height: number(6),
        }
    }

    /// The item as a message carries it.
    #[must_use]
    pub fn of_message(message: &MISSION_ITEM_INT_DATA) -> Self {
        Self {
            command: message.command as u16,
            frame: message.frame as u8,
            parameters: [message.param1, message.param2, message.param3, message.param4],
            place: [message.x, message.y],
            height: message.z,
        }
    }

    /// The item as line `number` of a `QGC WPL 110` file.
    #[must_use]
    pub fn line(&self, number: usize) -> String {
        let frame = match self.frame {
            FRAME_GLOBAL_INT => FRAME_GLOBAL,
            FRAME_RELATIVE_INT => FRAME_RELATIVE,
            other => other,
        };
        // Readers of this old format know no not-a-number; 0 leaves it to the autopilot there.
        let [a, b, c, d] = self.parameters.map(|value| if value.is_finite() { value } else { 0.0 });
        let [latitude, longitude] = self.place.map(|degrees| f64::from(degrees) / 1e7);
        let (command, height, current) = (self.command, self.height, u8::from(number == 0));
        format!(
            "{number}\t{current}\t{frame}\t{command}\t{a}\t{b}\t{c}\t{d}\t{latitude:.7}\t{longitude:.7}\t{height}\t1"
        )
    }
}

/// What an autopilot made of an item, in plain words; nothing if it kept it.
#[must_use]
pub fn difference(number: usize, sent: &MissionItem, kept: &MissionItem) -> Option<String> {
    /// Two steps of the wire's whole numbers: two centimetres.
    const PLACE: i32 = 2;
    let mut parts = Vec::new();
    let same = |a: f32, b: f32| {
        (a - b).abs() <= 1e-3 * a.abs().max(1.0) || (!a.is_finite() && (!b.is_finite() || b == 0.0))
    };
    let mut compare = |name: &str, a: f32, b: f32| {
        if !same(a, b) {
            parts.push(format!("{name} {b} instead of {a}"));
        }
    };
    match sent.command {
        NAV_LOITER_TURNS => {
            compare("turns", sent.parameters[0], kept.parameters[0]);
            compare("radius", sent.parameters[2], kept.parameters[2]);
        }
        DO_CHANGE_SPEED => compare("speed", sent.parameters[1], kept.parameters[1]),
        _ => {}
    }
    compare("height", sent.height, kept.height);
    if sent.command != kept.command {
        parts.push(format!("command {} instead of {}", kept.command, sent.command));
    }
    if (0..2).any(|axis| (i64::from(sent.place[axis]) - i64::from(kept.place[axis])).abs() > i64::from(PLACE))
    {
        parts.push("another place".to_owned());
    }
    (!parts.is_empty()).then(|| format!("item {number}: the autopilot keeps {}", parts.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOITER: MissionItem = MissionItem {
        command: NAV_LOITER_TURNS,
        frame: FRAME_RELATIVE_INT,
        parameters: [1.5, 0.0, -2.5, f32::NAN],
        place: [420_308_000, -936_319_000],
        height: 2.0,
    };

    #[test]
    fn what_an_autopilot_changes_is_said() {
        assert_eq!(difference(3, &LOITER, &LOITER), None);
        let kept = MissionItem { parameters: [1.0, 0.0, -2.0, 0.0], ..LOITER };
        assert_eq!(
            difference(3, &LOITER, &kept).as_deref(),
            Some("item 3: the autopilot keeps turns 1 instead of 1.5, radius -2 instead of -2.5")
        );
        let elsewhere = MissionItem { place: [i32::MIN, i32::MAX], height: 3.0, command: 16, ..LOITER };
        assert!(
            difference(3, &LOITER, &elsewhere)
                .is_some_and(|text| text.contains("another place") && text.contains("command 16"))
        );
    }

    #[test]
    fn lines_have_twelve_fields() {
        let line = LOITER.line(4);
        assert_eq!(line, "4\t0\t3\t18\t1.5\t0\t-2.5\t0\t42.0308000\t-93.6319000\t2\t1");
    }
}
