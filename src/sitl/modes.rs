//! Both autopilots' flight modes and the numbers by which MAVLink names them.

use std::time::Duration;

/// Whose behaviour the vehicle has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AutopilotKind {
    /// PX4 multicopter
    Px4,
    /// ArduCopter
    ArduPilot(ArduPilotRelease),
}

/// ArduPilot renamed parameters and changed their units with 4.7.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ArduPilotRelease {
    /// 4.6: `WPNAV_SPEED` in cm/s, `ANGLE_MAX` in centidegrees, `SYSID_MYGCS`
    V4_6,
    /// 4.7: `WP_SPD` in m/s, `ATC_ANGLE_MAX` in degrees, `MAV_GCS_SYSID`
    V4_7,
}

impl AutopilotKind {
    /// MAV_AUTOPILOT.
    pub(super) fn mav_autopilot(self) -> u8 {
        match self {
            Self::Px4 => 12,
            Self::ArduPilot(_) => 3,
        }
    }

    pub(super) fn is_px4(self) -> bool {
        self == Self::Px4
    }

    /// Period of physics, control and message loop. ArduPilot's main loop runs at 400 Hz; PX4's simulation
    /// and its message loop step at 250 Hz.
    pub(super) fn loop_period(self) -> Duration {
        match self {
            Self::Px4 => Duration::from_micros(4000),
            Self::ArduPilot(_) => Duration::from_micros(2500),
        }
    }

    /// Physics steps in a loop period.
    pub(super) fn steps_a_loop(self) -> u32 {
        match self {
            Self::Px4 => 2,
            Self::ArduPilot(_) => 1,
        }
    }
}

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

const PX4_AUTO: u32 = 4;

impl Mode {
    /// HEARTBEAT.custom_mode; `None` where this autopilot has no such mode. PX4: main mode in bits 16 to 23,
    /// sub mode in 24 to 31.
    #[must_use]
    pub fn custom_mode(self, kind: AutopilotKind) -> Option<u32> {
        let px4 = |main: u32, sub: u32| Some(main << 16 | sub << 24);
        match kind {
            AutopilotKind::Px4 => match self {
                Self::Altitude => px4(2, 0),
                Self::Position => px4(3, 0),
                Self::Takeoff => px4(PX4_AUTO, 2),
                Self::Hold => px4(PX4_AUTO, 3),
                Self::Return => px4(PX4_AUTO, 5),
                Self::Land => px4(PX4_AUTO, 6),
                Self::Guided => px4(6, 0),
                Self::Stabilize => px4(7, 0),
                Self::Brake => None,
            },
            AutopilotKind::ArduPilot(_) => match self {
                Self::Stabilize => Some(0),
                Self::Altitude => Some(2),
                Self::Guided => Some(4),
                Self::Hold => Some(5),
                Self::Return => Some(6),
                Self::Land => Some(9),
                Self::Position => Some(16),
                Self::Brake => Some(17),
                Self::Takeoff => None,
            },
        }
    }

    /// The mode of that number.
    #[must_use]
    pub fn from_custom_mode(kind: AutopilotKind, custom_mode: u32) -> Option<Self> {
        ALL.into_iter().find(|mode| mode.custom_mode(kind) == Some(custom_mode))
    }

    /// The autopilot's own name.
    #[must_use]
    pub fn name(self, kind: AutopilotKind) -> &'static str {
        let (px4, ardupilot) = match self {
            Self::Stabilize => ("Stabilized", "STABILIZE"),
            Self::Altitude => ("Altitude", "ALT_HOLD"),
            Self::Position => ("Position", "POSHOLD"),
            Self::Hold => ("Hold", "LOITER"),
            Self::Brake => ("Hold", "BRAKE"),
            Self::Guided => ("Offboard", "GUIDED"),
            Self::Takeoff => ("Takeoff", "GUIDED"),
            Self::Return => ("Return", "RTL"),
            Self::Land => ("Land", "LAND"),
        };
        if kind.is_px4() { px4 } else { ardupilot }
    }

    /// The mode cannot be flown without a position estimate.
    pub(super) fn needs_position(self) -> bool {
        !matches!(self, Self::Stabilize | Self::Altitude | Self::Land)
    }

    /// A pilot's sticks move the vehicle in it.
    pub(super) fn is_manual(self) -> bool {
        matches!(self, Self::Stabilize | Self::Altitude | Self::Position)
    }

    /// The autopilot does not arm in it; PX4 does not stay in it when it disarms.
    pub(super) fn refuses_arming(self) -> bool {
        matches!(self, Self::Return | Self::Land | Self::Brake)
    }
}
