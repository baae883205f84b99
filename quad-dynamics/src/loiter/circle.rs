//! The state on a circle flown at constant speed.

use nalgebra::Vector3;

use super::LoiterYaw;
use crate::frames::{Direction, GRAVITY, Heading};
use crate::motion::{Kinematics, Motion};
use crate::vehicle::Vehicle;

/// The vehicle at `angle` on the circle of `radius` around the origin, at `speed`, in still air.
pub(super) fn motion(
    vehicle: &Vehicle,
    radius: f64,
    speed: f64,
    yaw: LoiterYaw,
    angle: f64,
    direction: Direction,
) -> Motion {
    let outward = Vector3::new(angle.cos(), angle.sin(), 0.0);
    let turn = direction.sign() * speed / radius;
    let velocity = Vector3::new(-outward.y, outward.x, 0.0) * (direction.sign() * speed);
    let acceleration = -outward * (speed * speed / radius);
    // In the frame that turns with the vehicle all vectors stand still: their rates are `turn e_z x vector`.
    let turned = |vector: &Vector3<f64>| Vector3::new(-vector.y, vector.x, 0.0) * turn;
    let force = (acceleration + Vector3::new(0.0, 0.0, GRAVITY)) * vehicle.mass() - vehicle.drag(&velocity);
    let kinematics = Kinematics {
        position: outward * radius,
        velocity,
        acceleration,
        jerk: turned(&acceleration),
        force,
        force_rate: turned(&force),
    };
    let heading = match yaw {
        LoiterYaw::AlongTrack => Heading::AlongTrack,
        LoiterYaw::AtTarget => Heading::Towards(Vector3::zeros()),
    };
    Motion::from_kinematics(vehicle, &kinematics, heading)
}
