//! The flight modes that the vehicle can fly.

use super::Firmware;
use crate::autopilot::{FlightMode, FlownBy, ardupilot, px4};

/// A flight mode; what both autopilots have is one mode here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// PX4 STABILIZED, Copter STABILIZE
    Stabilize,
    /// PX4 ALTCTL, Copter ALT_HOLD
    Altitude,
    /// PX4 POSCTL, Copter POSHOLD
    Position,
    /// PX4 AUTO.LOITER ("Hold"), Copter LOITER
    Hold,
    /// Copter BRAKE
    Brake,
    /// PX4 OFFBOARD, Copter GUIDED
    Guided,
    /// PX4 AUTO.TAKEOFF
    Takeoff,
    /// PX4 AUTO.RTL, Copter RTL
    Return,
    /// PX4 AUTO.LAND, Copter LAND
    Land,
}

const ALL: [Mode; 9] = [
    Mode::Stabilize,
    Mode::Altitude,
    Mode::Position,
    Mode::Hold,
    Mode::Brake,
    Mode::Guided,
    Mode::Takeoff,
    Mode::Return,
    Mode::Land,
];

impl Mode {
    /// The autopilot's entry; `None` where this autopilot has no such mode.
    fn entry(self, firmware: Firmware) -> Option<&'static FlightMode> {
        let (of_px4, of_ardupilot) = match self {
            Self::Stabilize => (Some(&px4::STABILIZED), Some(&ardupilot::STABILIZE)),
            Self::Altitude => (Some(&px4::ALTITUDE), Some(&ardupilot::ALT_HOLD)),
            Self::Position => (Some(&px4::POSITION), Some(&ardupilot::POSHOLD)),
            Self::Hold => (Some(&px4::LOITER), Some(&ardupilot::LOITER)),
            Self::Brake => (None, Some(&ardupilot::BRAKE)),
            Self::Guided => (Some(&px4::OFFBOARD), Some(&ardupilot::GUIDED)),
            Self::Takeoff => (Some(&px4::TAKEOFF), None),
            Self::Return => (Some(&px4::RETURN), Some(&ardupilot::RETURN)),
            Self::Land => (Some(&px4::LAND), Some(&ardupilot::LAND)),
        };
        if firmware.is_px4() { of_px4 } else { of_ardupilot }
    }

    /// HEARTBEAT.custom_mode; `None` where this autopilot has no such mode.
    #[must_use]
    pub fn custom_mode(self, firmware: Firmware) -> Option<u32> {
        self.entry(firmware).map(|mode| mode.number)
    }

    /// The mode of that number.
    #[must_use]
    pub fn from_custom_mode(firmware: Firmware, custom_mode: u32) -> Option<Self> {
        ALL.into_iter().find(|mode| mode.custom_mode(firmware) == Some(custom_mode))
    }

    /// The autopilot's own name.
    #[must_use]
    pub fn name(self, firmware: Firmware) -> &'static str {
        self.entry(firmware).map_or("", |mode| mode.title)
    }

    /// The mode cannot be flown without a position estimate.
    pub(super) fn needs_position(self) -> bool {
        !matches!(self, Self::Stabilize | Self::Altitude | Self::Land)
    }

    /// A pilot's sticks move PX4 in it.
    pub(super) fn is_manual(self) -> bool {
        self.entry(Firmware::PX4).is_some_and(|mode| mode.flown_by == FlownBy::Pilot)
    }

    /// The autopilot does not arm in it; PX4 does not stay in it when it disarms.
    pub(super) fn refuses_arming(self) -> bool {
        matches!(self, Self::Return | Self::Land | Self::Brake)
    }
}
