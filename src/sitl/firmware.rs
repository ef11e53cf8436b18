//! Whose behaviour the vehicle has.

use std::time::Duration;

use crate::autopilot::{ARDUPILOT, Autopilot, PX4, Release, Stack};

/// An autopilot in one of its releases: whose behaviour the vehicle has. Each of them is one of the constants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Firmware {
    autopilot: Autopilot,
    release: Release,
}

impl Firmware {
    /// PX4 multicopter
    pub const PX4: Self = Self { autopilot: Autopilot::Px4, release: Release::new(1, 16) };
    /// ArduCopter 4.6: `WPNAV_SPEED` in cm/s, `ANGLE_MAX` in centidegrees, `SYSID_MYGCS`
    pub const ARDUPILOT_4_6: Self = Self { autopilot: Autopilot::ArduPilot, release: Release::new(4, 6) };
    /// ArduCopter 4.7: `WP_SPD` in m/s, `ATC_ANGLE_MAX` in degrees, `MAV_GCS_SYSID`
    pub const ARDUPILOT_4_7: Self = Self { autopilot: Autopilot::ArduPilot, release: Release::new(4, 7) };

    /// The latest release of an autopilot; `None` for one that is not simulated.
    #[must_use]
    pub fn of(autopilot: Autopilot) -> Option<Self> {
        match autopilot {
            Autopilot::Px4 => Some(Self::PX4),
            Autopilot::ArduPilot => Some(Self::ARDUPILOT_4_7),
            Autopilot::Other | Autopilot::Unknown => None,
        }
    }

    /// Which software.
    #[must_use]
    pub fn autopilot(self) -> Autopilot {
        self.autopilot
    }

    /// Which release of it.
    #[must_use]
    pub fn release(self) -> Release {
        self.release
    }

    /// What is known of the autopilot.
    #[must_use]
    pub fn stack(self) -> &'static Stack {
        if self.is_px4() { &PX4 } else { &ARDUPILOT }
    }

    /// It is PX4, and else ArduPilot.
    #[must_use]
    pub fn is_px4(self) -> bool {
        self.autopilot == Autopilot::Px4
    }

    /// Period of physics, control and message loop. ArduPilot's main loop runs at 400 Hz; PX4's simulation
    /// and its message loop step at 250 Hz.
    pub(super) fn loop_period(self) -> Duration {
        Duration::from_micros(if self.is_px4() { 4000 } else { 2500 })
    }

    /// Physics steps in a loop period.
    pub(super) fn steps_a_loop(self) -> u32 {
        if self.is_px4() { 2 } else { 1 }
    }
}
