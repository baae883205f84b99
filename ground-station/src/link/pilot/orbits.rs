//! Circles by PX4's live `DO_ORBIT`: flown to one by one, and left when the vehicle has been seen around them.

use super::{NEAR, PATIENCE, Phase, Pilot, SLOW};
use crate::execution::limits::{ORBIT_ACCELERATION, ORBIT_RADIUS};
use crate::export::qgc::CircleTask;
use crate::link::command::{Answer, Order};
use crate::link::item::whole_degrees;
use crate::link::modes::Mode;
use crate::link::settings::SafeAction;
use crate::words;
use mavlink::dialects::common::{MavCmd, MavMessage};
use std::collections::VecDeque;
use std::f64::consts::TAU;

/// What is left of a route.
#[derive(Debug, Clone, PartialEq)]
pub struct Orbits {
    stops: VecDeque<Stop>,
    order: Option<Order>,
    since: f64,
    /// The angle flown (rad), and the last bearing from the centre.
    flown: f64,
    bearing: Option<f64>,
}

#[derive(Debug, Clone, PartialEq)]
enum Stop {
    /// East, north, up (m).
    At([f64; 3]),
    Around(CircleTask),
}

impl Orbits {
    /// To every circle and around it, and back to the pad.
    pub(super) fn new(circles: &[CircleTask], pad: [f64; 3], now: f64) -> Self {
        let stops = circles.iter().flat_map(|task| {
            let (sin, cos) = task.entry_angle.sin_cos();
            let radius = radius(task);
            let entry = [task.centre[0] + radius * cos, task.centre[1] + radius * sin, task.height];
            [Stop::At(entry), Stop::Around(task.clone())]
        });
        let stops = stops.chain([Stop::At(pad)]).collect();
        Self { stops, order: None, since: now, flown: 0.0, bearing: None }
    }

    pub(super) fn receive(&mut self, message: &MavMessage, now: f64) {
        if let Some(order) = &mut self.order {
            order.receive(message, now);
        }
    }

    fn next(&mut self, now: f64) {
        self.stops.pop_front();
        *self = Self {
            stops: std::mem::take(&mut self.stops),
            order: None,
            since: now,
            flown: 0.0,
            bearing: None,
        };
    }

    /// Adds what a vehicle has flown since its last report.
    fn follow(&mut self, task: &CircleTask, [east, north, _]: [f64; 3]) {
        let bearing = (north - task.centre[1]).atan2(east - task.centre[0]);
        if let Some(last) = self.bearing.replace(bearing) {
            let turned = (bearing - last + 1.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
            self.flown += f64::from(words::sign(task.direction)) * turned;
        }
    }
}

fn radius(task: &CircleTask) -> f64 {
    task.radius.max(ORBIT_RADIUS)
}

fn speed(task: &CircleTask) -> f64 {
    task.speed.min((ORBIT_ACCELERATION * radius(task)).sqrt())
}

impl Pilot {
    pub(super) fn orbit(&mut self, mut orbits: Orbits, outgoing: &mut Vec<MavMessage>, now: f64) {
        let (Some(stop), Some(position)) = (orbits.stops.front().cloned(), self.position()) else {
            if orbits.stops.is_empty() {
                self.say("has flown its circles; lands");
                self.go(Phase::Landing(Box::new(self.mode_order(Mode::Land, now))), now);
            }
            return;
        };
        let fresh = || self.order_of(&stop, now);
        let Some(mut order) = orbits.order.take().or_else(fresh) else { return };
        outgoing.extend(order.poll(now));
        let answer = order.answer().clone();
        orbits.order = Some(order);
        if let Answer::Failed(why) = answer {
            self.make_safe(SafeAction::Return, &why, now);
            return;
        }
        let (is_there, allowed) = match &stop {
            Stop::At(place) => {
                let away = [0, 1, 2].map(|axis| place[axis] - position[axis]);
                let away = away.iter().map(|part| part * part).sum::<f64>().sqrt();
                (answer == Answer::Accepted && away < NEAR && self.state.speed < SLOW, PATIENCE)
            }
            Stop::Around(task) => {
                if self.is_in(Mode::Orbit) {
                    orbits.follow(task, position);
                }
                (orbits.flown >= task.sweep, PATIENCE + 3.0 * task.sweep * radius(task) / speed(task))
            }
        };
        if now - orbits.since > allowed {
            self.make_safe(SafeAction::Return, "makes no progress", now);
            return;
        }
        if is_there {
            if let Stop::Around(task) = &stop {
                self.say(format!("has circled {}", task.name));
            }
            orbits.next(now);
        }
        self.phase = Phase::Orbiting(Box::new(orbits));
    }

    fn order_of(&self, stop: &Stop, now: f64) -> Option<Order> {
        /// Go there now, whatever it does.
        const CHANGE_MODE: f32 = 1.0;
        /// The nose towards the middle.
        const FACE_CENTRE: f32 = 0.0;
        let (command, parameters, [east, north, up]) = match stop {
            Stop::At(place) => (MavCmd::MAV_CMD_DO_REPOSITION, [-1.0, CHANGE_MODE, 0.0, f32::NAN], *place),
            // Clockwise is positive.
            Stop::Around(task) => {
                let radius = -f64::from(words::sign(task.direction)) * radius(task);
                let parameters = [radius as f32, speed(task) as f32, FACE_CENTRE, f32::NAN];
                (MavCmd::MAV_CMD_DO_ORBIT, parameters, [task.centre[0], task.centre[1], task.height])
            }
        };
        let place = self.origin.geographic([east, north]).map(whole_degrees);
        let height = self.ground? + up;
        Some(Order::at(self.target(), command, parameters, (place, height as f32), now))
    }
}
