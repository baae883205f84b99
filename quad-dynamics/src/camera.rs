//! What the camera sees of the target.

use nalgebra::{UnitQuaternion, Vector3};

use crate::error::{Error, Field, Requirement};
use crate::frames::Direction;
use crate::loiter::Loiter;
use crate::motion::Motion;

/// A camera on the vehicle.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[non_exhaustive]
pub struct Camera {
    /// Direction of the optical axis from body x to the left, rad.
    pub mount_yaw: f64,
    /// Direction of the optical axis downwards from the body's x-y plane, rad.
    pub mount_pitch: f64,
    /// Whole angle of view across, rad, below pi.
    pub horizontal_view: f64,
    /// Whole angle of view up and down, rad, below pi.
    pub vertical_view: f64,
    /// Whether a gimbal keeps the camera level: roll and pitch of the body do not reach it, yaw does.
    pub stabilised: bool,
}

/// The target in the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct View {
    /// Angle of the target's centre from the optical axis, to the right, rad.
    pub right: f64,
    /// Angle of the target's centre from the optical axis, upwards, rad.
    pub up: f64,
    /// Distance, m.
    pub distance: f64,
    /// Whether the target's centre is in the picture.
    pub in_view: bool,
}

impl Camera {
    /// A camera with these whole angles of view (rad) across and up and down, along body x, fixed.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless both are above zero and below pi.
    pub fn new(horizontal_view: f64, vertical_view: f64) -> Result<Self, Error> {
        let range = Requirement::Between { low: 0.0, high: std::f64::consts::PI };
        range.check(Field::AngleOfView, horizontal_view)?;
        range.check(Field::AngleOfView, vertical_view)?;
        Ok(Self { mount_yaw: 0.0, mount_pitch: 0.0, horizontal_view, vertical_view, stabilised: false })
    }

    /// The same mounted `yaw` to the left and `pitch` downwards, rad.
    #[must_use]
    pub fn with_mount(mut self, yaw: f64, pitch: f64) -> Self {
        self.mount_yaw = yaw;
        self.mount_pitch = pitch;
        self
    }

    /// The same on a gimbal that keeps it level, or not.
    #[must_use]
    pub fn with_stabilised(mut self, stabilised: bool) -> Self {
        self.stabilised = stabilised;
        self
    }

    /// Where a target (m, world) is in the picture, from a motion.
    #[must_use]
    pub fn view(&self, motion: &Motion, target: &Vector3<f64>) -> View {
        let sight = target - motion.position;
        let body = if self.stabilised { level_attitude(motion) } else { motion.attitude };
        let mount = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), self.mount_yaw)
            * UnitQuaternion::from_axis_angle(&Vector3::y_axis(), self.mount_pitch);
        let seen = (body * mount).inverse_transform_vector(&sight);
        let right = (-seen.y).atan2(seen.x);
        let up = seen.z.atan2(seen.x);
        // In front, and within the rectangle of the picture plane.
        let within = |angle: f64, view: f64| angle.abs() <= 0.5 * view;
        let in_view = seen.x > 0.0 && within(right, self.horizontal_view) && within(up, self.vertical_view);
        View { right, up, distance: sight.norm(), in_view }
    }

    /// Share of a loiter during which a target's centre is in the picture, the target `above` metres over the circle's
    /// plane (below: negative) and `offset` (m, world, x-y) from its centre.
    ///
    /// Sampled at 720 angles. With no offset the answer is 0 or 1, since the circle looks the same from everywhere on it.
    #[must_use]
    pub fn share_in_view(&self, loiter: &Loiter, direction: Direction, above: f64, offset: [f64; 2]) -> f64 {
        const N_ANGLES: usize = 720;
        let target = Vector3::new(offset[0], offset[1], above);
        let angle = |i: usize| i as f64 * std::f64::consts::TAU / N_ANGLES as f64;
        let seen = (0..N_ANGLES).filter(|i| self.view(&loiter.state(angle(*i), direction), &target).in_view);
        seen.count() as f64 / N_ANGLES as f64
    }

    /// Share of the picture's height that something `height` metres tall takes at a distance (m), facing the camera.
    #[must_use]
    pub fn share_of_picture(&self, height: f64, distance: f64) -> f64 {
        height / (2.0 * distance * (0.5 * self.vertical_view).tan())
    }

    /// The distance (m) at which something `height` metres tall takes this share of the picture's height.
    #[must_use]
    pub fn distance_for(&self, height: f64, share: f64) -> f64 {
        height / (2.0 * share * (0.5 * self.vertical_view).tan())
    }

    /// The radius (m) of the circle on which something `height` metres tall takes this share of the picture's height, flown
    /// `above` (m, either sign) its middle; `None` if it looks smaller than that from right above.
    #[must_use]
    pub fn radius_for(&self, height: f64, share: f64, above: f64) -> Option<f64> {
        let squared = self.distance_for(height, share).powi(2) - above * above;
        (squared > 0.0 && squared.is_finite()).then(|| squared.sqrt())
    }
}

/// The body turned back to level, its heading kept.
fn level_attitude(motion: &Motion) -> UnitQuaternion<f64> {
    let forward = motion.attitude * Vector3::x();
    UnitQuaternion::from_axis_angle(&Vector3::z_axis(), forward.y.atan2(forward.x))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LoiterSpec, LoiterYaw, Vehicle};

    #[test]
    fn banking_moves_the_target_out_of_a_fixed_camera() -> Result<(), Error> {
        let vehicle = Vehicle::survey_450();
        let spec = LoiterSpec::new(3.0).with_yaw(LoiterYaw::AtTarget);
        let loiter = Loiter::new(&vehicle, &spec)?;
        let camera = Camera::new(1.2, 0.7)?;
        let direction = Direction::CounterClockwise;
        // Accelerating towards the target lowers the nose by the bank: the target is that much above the axis.
        let view = camera.view(&loiter.state(0.4, direction), &Vector3::zeros());
        assert!((view.up - loiter.bank).abs() < 0.02 && (view.distance - 3.0).abs() < 1e-12);
        assert_eq!(camera.share_in_view(&loiter, direction, 0.0, [0.0, 0.0]), 0.0);
        let tilted = camera.with_mount(0.0, -loiter.bank);
        assert_eq!(tilted.share_in_view(&loiter, direction, 0.0, [0.0, 0.0]), 1.0);
        let gimbal = camera.with_stabilised(true);
        assert_eq!(gimbal.share_in_view(&loiter, direction, 0.0, [0.0, 0.0]), 1.0);
        let partly = camera.with_stabilised(true).share_in_view(&loiter, direction, 0.0, [2.5, 0.0]);
        assert!(partly > 0.1 && partly < 0.9, "{partly}");
        Ok(())
    }

    /// Along the track, a camera to the left sees the target of a counter-clockwise circle.
    #[test]
    fn a_side_camera_sees_along_the_track() -> Result<(), Error> {
        let loiter = Loiter::new(&Vehicle::survey_450(), &LoiterSpec::new(3.0))?;
        let camera =
            Camera::new(1.2, 0.9)?.with_mount(std::f64::consts::FRAC_PI_2, 0.0).with_stabilised(true);
        assert_eq!(camera.share_in_view(&loiter, Direction::CounterClockwise, 0.0, [0.0, 0.0]), 1.0);
        assert_eq!(camera.share_in_view(&loiter, Direction::Clockwise, 0.0, [0.0, 0.0]), 0.0);
        assert!((camera.share_of_picture(1.0, camera.distance_for(1.0, 0.4)) - 0.4).abs() < 1e-12);
        for above in [0.0, 1.5, -1.0] {
            let radius = camera.radius_for(1.8, 0.4, above).unwrap_or(f64::NAN);
            assert!((camera.share_of_picture(1.8, radius.hypot(above)) - 0.4).abs() < 1e-12, "{above}");
        }
        for (height, share, above) in
            [(1.8, 0.4, 30.0), (1.8, 0.0, 1.0), (f64::NAN, 0.4, 1.0), (-1.0, 0.0, 0.0)]
        {
            assert_eq!(camera.radius_for(height, share, above), None);
        }
        Ok(())
    }
}
