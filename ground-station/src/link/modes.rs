//! Flight modes by their numbers.

use crate::input::Autopilot;

/// The modes that are commanded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// Follows setpoints: GUIDED, OFFBOARD.
    Setpoints,
    /// Flies its mission.
    Mission,
    /// Stays where it is: BRAKE, AUTO.LOITER. BRAKE needs no remote control, unlike ArduCopter's LOITER.
    Hold,
    /// Flies home at the height that it is set to, and lands: RTL.
    Return,
    /// Lands where it is.
    Land,
    /// Climbs after a command to take off.
    TakeOff,
    /// Circles a place; entered by `DO_ORBIT` alone.
    Orbit,
}

/// PX4 packs a main mode into the third byte and a sub-mode into the fourth.
const fn px4(main: u32, sub: u32) -> u32 {
    main << 16 | sub << 24
}

impl Mode {
    /// The number that a heartbeat has in `custom_mode`.
    #[must_use]
    pub fn number(self, autopilot: Autopilot) -> u32 {
        match (autopilot, self) {
            (Autopilot::ArduPilot, Self::Setpoints | Self::TakeOff) => 4,
            (Autopilot::ArduPilot, Self::Orbit) => 7,
            (Autopilot::ArduPilot, Self::Mission) => 3,
            (Autopilot::ArduPilot, Self::Hold) => 17,
            (Autopilot::ArduPilot, Self::Return) => 6,
            (Autopilot::ArduPilot, Self::Land) => 9,
            (Autopilot::Px4, Self::Setpoints) => px4(6, 0),
            (Autopilot::Px4, Self::Mission) => px4(4, 4),
            (Autopilot::Px4, Self::Hold) => px4(4, 3),
            (Autopilot::Px4, Self::Return) => px4(4, 5),
            (Autopilot::Px4, Self::Land) => px4(4, 6),
            (Autopilot::Px4, Self::TakeOff) => px4(4, 2),
            (Autopilot::Px4, Self::Orbit) => px4(3, 1),
        }
    }

    /// Parameters of `DO_SET_MODE`: base mode, custom mode, sub-mode.
    #[must_use]
    pub fn parameters(self, autopilot: Autopilot) -> [f32; 7] {
        /// `MAV_MODE_FLAG_CUSTOM_MODE_ENABLED`.
        const CUSTOM: f32 = 1.0;
        let number = self.number(autopilot);
        let [main, sub] = match autopilot {
            Autopilot::ArduPilot => [number, 0],
            Autopilot::Px4 => [number >> 16 & 0xFF, number >> 24],
        };
        [CUSTOM, main as f32, sub as f32, 0.0, 0.0, 0.0, 0.0]
    }

    /// Its name on the vehicle.
    #[must_use]
    pub fn name(self, autopilot: Autopilot) -> &'static str {
        match (autopilot, self) {
            (Autopilot::ArduPilot, Self::Setpoints | Self::TakeOff) => "GUIDED",
            (Autopilot::ArduPilot, Self::Orbit) => "CIRCLE",
            (Autopilot::Px4, Self::TakeOff) => "AUTO.TAKEOFF",
            (Autopilot::Px4, Self::Orbit) => "ORBIT",
            (Autopilot::ArduPilot, Self::Mission) => "AUTO",
            (Autopilot::ArduPilot, Self::Hold) => "BRAKE",
            (Autopilot::Px4, Self::Setpoints) => "OFFBOARD",
            (Autopilot::Px4, Self::Mission) => "AUTO.MISSION",
            (Autopilot::Px4, Self::Hold) => "AUTO.LOITER",
            (_, Self::Return) => "RTL",
            (_, Self::Land) => "LAND",
        }
    }
}
