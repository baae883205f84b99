//! Pictures of a plan as SVG, drawn from plain data.
//!
//! The writer is our own hundred lines: a map wants equal axes, dashed tours, arrows on circles and labels that keep out
//! of each other's way, which charting libraries leave to the caller anyway, and a picture without embedded fonts or
//! scripts opens everywhere.

mod axis;
mod from_plan;
mod labels;
mod map;
mod palette;
mod path;
mod profile;
mod svg;

pub use axis::{tick_label, ticks};
pub use from_plan::{map_scene, speed, tilt, vehicle_profile};
pub use map::{MapCircle, MapScene, MapTarget, MapVehicle, map};
pub use palette::colour;
pub use profile::{Band, Limit, Panel, Profile, profile};
pub use svg::{Anchor, Stroke, Svg, TextStyle};
