//! From metres to paper, with equal axes.

use super::{MapCircle, MapScene};
use crate::plot::labels::Area;

/// Where the map begins on the paper (px).
pub(super) const LEFT: f64 = 64.0;
pub(super) const TOP: f64 = 46.0;
/// Greatest width and height of the map itself (px).
const PAPER: [f64; 2] = [760.0, 760.0];
/// A circle smaller than this (px) is drawn as a symbol of this radius, and the legend says so.
const LEAST_RADIUS: f64 = 5.5;

/// From metres to paper, with equal axes.
pub(super) struct View {
    low: [f64; 2],
    /// px per metre
    pub scale: f64,
    /// px
    pub size: [f64; 2],
}

impl View {
    pub(super) fn of(scene: &MapScene) -> Self {
        let mut low = scene.depot;
        let mut high = scene.depot;
        let mut include = |[east, north]: [f64; 2], reach: f64| {
            low = [low[0].min(east - reach), low[1].min(north - reach)];
            high = [high[0].max(east + reach), high[1].max(north + reach)];
        };
        scene.targets.iter().for_each(|target| include(target.position, target.safe_distance));
        for vehicle in &scene.vehicles {
            include(vehicle.pad, 0.0);
            vehicle.track.iter().for_each(|&point| include(point, 0.0));
            vehicle.circles.iter().for_each(|circle| include(circle.centre, circle.radius));
        }
        let span = [high[0] - low[0], high[1] - low[1]];
        let margin = 0.04 * span[0].max(span[1]).max(1.0);
        let span = span.map(|side| side + 2.0 * margin);
        let scale = (PAPER[0] / span[0]).min(PAPER[1] / span[1]);
        // A sliver of a map would leave no room for its axes.
        let size = span.map(|side| (side * scale).max(160.0));
        let spare = [0, 1].map(|axis| (size[axis] / scale - span[axis]) / 2.0);
        Self { low: [low[0] - margin - spare[0], low[1] - margin - spare[1]], scale, size }
    }

    pub(super) fn at(&self, [east, north]: [f64; 2]) -> [f64; 2] {
        [LEFT + self.scale * (east - self.low[0]), TOP + self.size[1] - self.scale * (north - self.low[1])]
    }

    pub(super) fn paper(&self) -> Area {
        Area { low: [LEFT, TOP], high: [LEFT + self.size[0], TOP + self.size[1]] }
    }

    pub(super) fn high(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.low[axis] + self.size[axis] / self.scale)
    }

    /// West and south of everything (m).
    pub(super) fn low(&self) -> [f64; 2] {
        self.low
    }

    /// Whether a circle is too small to be drawn to scale.
    pub(super) fn is_symbol(&self, circle: &MapCircle) -> bool {
        self.scale * circle.radius < LEAST_RADIUS
    }

    /// The radius with which a circle is drawn (px).
    pub(super) fn radius(&self, circle: &MapCircle) -> f64 {
        (self.scale * circle.radius).max(LEAST_RADIUS)
    }
}
